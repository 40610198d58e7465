#pragma once
// A member or a panel: what a thing in the collision world, a hit or a contact is part of.
#include "topple/structure/building.h"

namespace topple::structure {

struct Part {
  MemberId member;  ///< one of the two is valid
  PanelId panel;

  Part() = default;
  explicit Part(MemberId id) : member(id) {}
  explicit Part(PanelId id) : panel(id) {}
  [[nodiscard]] bool valid() const { return member.valid() || panel.valid(); }
  auto operator<=>(const Part&) const = default;
};
template <class Archive>
void serialize(Archive& archive, Part& part) {
  auto& [member, panel] = part;
  archive(member, panel);
}

/// Members first, then panels: one number for each part.
[[nodiscard]] inline std::int64_t part_number(const Building& building, Part part) {
  if (part.member.valid()) return part.member.index;
  return static_cast<std::int64_t>(building.members.size()) + part.panel.index;
}
[[nodiscard]] inline Part part_of_number(const Building& building, std::int64_t number) {
  const auto n = static_cast<std::size_t>(number);
  return n < building.members.size() ? Part(MemberId(n)) : Part(PanelId(n - building.members.size()));
}
[[nodiscard]] inline const std::string& part_name(const Building& building, Part part) {
  return part.member.valid() ? building[part.member].name : building[part.panel].name;
}
[[nodiscard]] inline std::size_t part_count(const Building& building) {
  return building.members.size() + building.panels.size();
}

}  // namespace topple::structure
