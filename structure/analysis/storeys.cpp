#include "analysis/storeys.h"

#include <algorithm>
#include <cmath>

#include "model/index_of.h"

namespace topple::structure {

Storeys::Storeys(const Building& building) : building_(building), storey_of_(building.members.size(), -1) {
  for (const Member& member : building.members)
    if (member.kind == MemberKind::post)
      for (const NodeId node : member.nodes) levels_.push_back(building[node].position.z());
  if (levels_.empty()) return;
  std::sort(levels_.begin(), levels_.end());
  const double same = 1e-6 * std::max(1e-300, levels_.back() - levels_.front());  // rounding of coordinates
  levels_.erase(std::unique(levels_.begin(), levels_.end(), [&](double a, double b) { return b - a <= same; }),
                levels_.end());
  for (std::size_t i = 0; i < building.members.size(); ++i) {
    const Member& member = building.members[i];
    if (member.kind != MemberKind::post) continue;
    const double top = std::max(building[member.nodes[0]].position.z(), building[member.nodes[1]].position.z());
    const auto level = std::lower_bound(levels_.begin(), levels_.end(), top - same) - levels_.begin();
    storey_of_[i] = static_cast<int>(level) - 1;
  }
}

std::vector<StoreyResult> Storeys::results(const std::vector<Vec6>& displacements,
                                           const std::vector<MemberResult>& members) const {
  std::vector<StoreyResult> storeys(count());
  for (std::size_t i = 0; i < building_.members.size(); ++i) {
    if (storey_of_[i] < 0) continue;
    const Member& post = building_.members[i];
    StoreyResult& storey = storeys[static_cast<std::size_t>(storey_of_[i])];
    const auto at = [&](std::size_t end) { return index_of(post.nodes[end]); };
    const double height = std::abs(building_[post.nodes[1]].position.z() - building_[post.nodes[0]].position.z());
    if (height > 0)
      storey.drift =
          std::max(storey.drift, (displacements[at(1)].head<2>() - displacements[at(0)].head<2>()).norm() / height);
    const bool upwards = building_[post.nodes[0]].position.z() < building_[post.nodes[1]].position.z();
    const Vec3 at_bottom =
        post.axes.transpose() * (upwards ? members[i].end_forces.head<3>() : members[i].end_forces.segment<3>(6));
    storey.shear[0] -= at_bottom.x();
    storey.shear[1] -= at_bottom.y();
  }
  return storeys;
}

}  // namespace topple::structure
