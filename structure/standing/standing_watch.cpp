#include "standing/standing_watch.h"

#include <algorithm>

#include "failure/panel_demand.h"
#include "model/index_of.h"

namespace topple::structure {

double StandingFrame::State::Watch::read(JointId joint, const Vec6& demand) {
  if (!frame_.building[joint].capacity.breakable || !frame_.parts.standing(joint)) return 0;
  slow_ ? frame_.joints.set_slow_demand(joint, demand) : frame_.joints.set_demand(joint, demand);
  return frame_.joints.felt(joint).value;
}

double StandingFrame::State::Watch::member_use(MemberId member, const solver::Vec12& forces) {
  double use = 0;
  for (int end = 0; end < 2; ++end)
    use = std::max(use, read(frame_.building.joint(member, end), member_joint_demand(forces, end)));
  return use;
}

double StandingFrame::State::Watch::membrane_use(PanelId membrane, const std::array<Vec6, 4>& corner_forces) {
  frame_.edge_loads.set_corner_forces(membrane, corner_forces);
  const std::array<Vec6, 4>& demands = frame_.edge_loads.read(membrane);
  double use = 0;
  for (int edge = 0; edge < 4; ++edge)
    use = std::max(use, read(frame_.building.joint(membrane, edge), demands[static_cast<std::size_t>(edge)]));
  return use;
}

/// Of any demand within these bounds. A sudden loss multiplies changes.
double StandingFrame::State::Watch::growth(JointId joint, const Vec6& most) const {
  const JointCapacity& capacity = frame_.building[joint].capacity;
  const double strength = frame_.joints.strength(joint);
  Vec6 pushed = most;
  pushed(0) = -most(0);
  return std::max(1.0, frame_.rules.sudden) * std::max(structure::utilisation(capacity, most, strength).value,
                                                       structure::utilisation(capacity, pushed, strength).value);
}

double StandingFrame::State::Watch::member_growth(MemberId member, const solver::Vec12& root) {
  double largest = 0;
  for (int end = 0; end < 2; ++end)
    largest = std::max(largest, growth(frame_.building.joint(member, end), root.segment<6>(6 * end)));
  return largest;
}

/// Edge demands are linear in the corner forces: the sum of what each of their components can do.
double StandingFrame::State::Watch::membrane_growth(PanelId membrane, const std::array<Vec6, 4>& root) {
  const PanelEdges edges = panel_edges(frame_.building, membrane);
  std::array<Vec6, 4> most{Vec6::Zero(), Vec6::Zero(), Vec6::Zero(), Vec6::Zero()};
  for (std::size_t corner = 0; corner < 4; ++corner) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      std::array<Vec6, 4> force{Vec6::Zero(), Vec6::Zero(), Vec6::Zero(), Vec6::Zero()};
      force[corner](axis) = root[corner](axis);
      const std::array<Vec6, 4> demands = membrane_edge_demands(edges, force);
      for (std::size_t edge = 0; edge < 4; ++edge) most[edge] += demands[edge].cwiseAbs();
    }
  }
  double largest = 0;
  for (int edge = 0; edge < 4; ++edge)
    largest = std::max(largest, growth(frame_.building.joint(membrane, edge), most[static_cast<std::size_t>(edge)]));
  return largest;
}

}  // namespace topple::structure
