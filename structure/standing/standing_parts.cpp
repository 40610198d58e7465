#include "standing/standing_parts.h"

#include "loads/placed_load.h"
#include "model/index_of.h"

namespace topple::structure {

StandingParts::StandingParts(const Building& building)
    : building_(building), edges_(building), segments(building), bearings(building, edges_) {}

bool StandingParts::holds(JointId joint) const {
  const Joint& own = building_[joint];
  if (own.member.valid() || !bearings.tracks(own.panel)) return segments.holds(joint);
  return bearings.holds(own.panel)[static_cast<std::size_t>(own.end)];
}

int StandingParts::label(JointId joint) const {
  const Joint& own = building_[joint];
  if (own.member.valid()) return segments.label(own.member);
  if (!bearings.tracks(own.panel)) return segments.label(own.panel);
  if (!bearings.stands(own.panel)) return -1;
  const auto member = bearings.bearing_member(own.panel);
  return member ? segments.label(*member) : segments.label(bearings.bearing_node(own.panel));
}

Vec3 StandingParts::position(JointId joint) const {
  const Joint& own = building_[joint];
  if (own.member.valid()) return on_axis(building_, own.member, own.end == 0 ? 0 : building_[own.member].length);
  const auto& nodes = building_[own.panel].nodes;
  const auto edge = static_cast<std::size_t>(own.end);
  return 0.5 * (building_[nodes[edge]].position + building_[nodes[(edge + 1) % 4]].position);
}

int StandingParts::segment(MemberId member) const {
  const int label = segments.label(member);
  return label < 0 ? -1 : numbers()[static_cast<std::size_t>(label)];
}

bool StandingParts::one_segment(const std::vector<MemberId>& members) const {
  int only = -1;
  for (const MemberId member : members) {
    const int label = segments.label(member);
    if (label < 0 || label == only) continue;
    if (only >= 0) return false;
    only = label;
  }
  return true;
}

const std::vector<int>& StandingParts::numbers() const {
  if (!numbers_.empty()) return numbers_;
  std::vector<char> has_part(static_cast<std::size_t>(segments.labels()), 0);
  for (std::size_t m = 0; m < building_.members.size(); ++m)
    if (const int label = segments.label(MemberId(m)); label >= 0) has_part[static_cast<std::size_t>(label)] = 1;
  for (std::size_t p = 0; p < building_.panels.size(); ++p)  // shells; others belong to what bears them
    if (const int label = segments.label(PanelId(p)); label >= 0) has_part[static_cast<std::size_t>(label)] = 1;
  numbers_.assign(has_part.size() + 1, -1);  // the last entry counts
  int count = 0;
  for (std::size_t n = 0; n < building_.nodes.size(); ++n) {
    const int label = segments.label(NodeId(n));
    if (label < 0 || !has_part[static_cast<std::size_t>(label)]) continue;
    int& number = numbers_[static_cast<std::size_t>(label)];
    if (number < 0) number = count++;
  }
  numbers_.back() = count;
  return numbers_;
}

}  // namespace topple::structure
