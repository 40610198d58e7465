#include "standing/joint_watch.h"

#include <algorithm>

#include "failure/panel_demand.h"

namespace topple::structure {

double JointAnswers::Watch::read(JointId joint, const Vec6& demand) {
  if (!state_.building[joint].capacity.breakable || !state_.parts.standing(joint)) return 0;
  slow_ ? state_.joints.set_slow_demand(joint, demand) : state_.joints.set_demand(joint, demand);
  return state_.joints.amplified(joint).value;
}

double JointAnswers::Watch::member_utilisation(MemberId member, const solver::Vec12& forces) {
  double use = 0;
  for (int end = 0; end < 2; ++end)
    use = std::max(use, read(state_.building.joint(member, end), member_joint_demand(forces, end)));
  return use;
}

double JointAnswers::Watch::membrane_utilisation(PanelId membrane, const std::array<Vec6, 4>& corner_forces) {
  edge_loads_.set_corner_forces(membrane, corner_forces);
  const std::array<Vec6, 4>& demands = edge_loads_.read(membrane);
  double use = 0;
  for (int edge = 0; edge < 4; ++edge)
    use = std::max(use, read(state_.building.joint(membrane, edge), demands[static_cast<std::size_t>(edge)]));
  return use;
}

/// Of any demand within these bounds. A sudden loss multiplies changes.
double JointAnswers::Watch::growth(JointId joint, const Vec6& most) const {
  const JointCapacity& capacity = state_.building[joint].capacity;
  const double strength = state_.joints.strength(joint);
  Vec6 pushed = most;
  pushed(0) = -most(0);
  return std::max(1.0, state_.rules.sudden) * std::max(structure::utilisation(capacity, most, strength).value,
                                                       structure::utilisation(capacity, pushed, strength).value);
}

double JointAnswers::Watch::member_growth(MemberId member, const solver::Vec12& root) {
  double largest = 0;
  for (int end = 0; end < 2; ++end)
    largest = std::max(largest, growth(state_.building.joint(member, end), root.segment<6>(6 * end)));
  return largest;
}

/// Edge demands are linear in the corner forces: the sum of what each of their components can do.
double JointAnswers::Watch::membrane_growth(PanelId membrane, const std::array<Vec6, 4>& root) {
  const PanelEdgeAxes edges = panel_edge_axes(state_.building, membrane);
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
    largest = std::max(largest, growth(state_.building.joint(membrane, edge), most[static_cast<std::size_t>(edge)]));
  return largest;
}

}  // namespace topple::structure
