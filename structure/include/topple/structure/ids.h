#pragma once
#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>

namespace topple::structure {

/// Index into the array of one kind of thing; distinct types that do not convert into each other.
template <class Tag>
struct Id {
  std::int32_t index = -1;  ///< place in the array; -1: none
  constexpr Id() = default;
  /// The id of place i.
  constexpr explicit Id(std::size_t i) : index(static_cast<std::int32_t>(i)) {}
  /// False for a default-made id. Whether the array is that long is not known here.
  [[nodiscard]] constexpr bool valid() const { return index >= 0; }
  /// By index.
  constexpr auto operator<=>(const Id&) const = default;  // NOLINT(modernize-use-nullptr)
};

using NodeId = Id<struct NodeTag>;
using MemberId = Id<struct MemberTag>;
using PanelId = Id<struct PanelTag>;
using MaterialId = Id<struct MaterialTag>;
using SectionId = Id<struct SectionTag>;
using JointTypeId = Id<struct JointTypeTag>;
using LoadCaseId = Id<struct LoadCaseTag>;
using CombinationId = Id<struct CombinationTag>;
/// A member end or a panel edge: see Building::joint().
using JointId = Id<struct JointTag>;

}  // namespace topple::structure

template <class Tag>
struct std::hash<topple::structure::Id<Tag>> {
  std::size_t operator()(const topple::structure::Id<Tag>& id) const noexcept {
    return std::hash<std::int32_t>{}(id.index);
  }
};
