// What can be told of a push at little cost: a bound by strain energy under which no joint fails, so that most impacts
// of debris need not be solved for.
//
// A push adds the displacements of its own response. An element without load of its own whose end feels the force
// component s of that response holds at least the strain energy s^2 / 2k, k being its stiffness against that freedom
// with all others held; no element holds more than the whole push has put in, F^2 C / 2. So a joint with the slack s
// in one sense cannot fail below s^2 / 2k. Breaks only soften: the undamaged stiffness stays a bound.
#include <algorithm>

#include "failure/panel_demand.h"
#include "model/index_of.h"
#include "standing/frame_response.h"
#include "standing/shell_reading.h"

namespace topple::structure {

namespace {

/// Components of the demand that add up under Interaction::sum.
constexpr std::array<Eigen::Index, 3> normal_stress{0, 4, 5};

double squared(double x) { return x * x; }

/// Least energy at which a demand beyond `demand` fails, per sense; `k`: stiffness against each component.
double least_energy(const JointCapacity& capacity, double strength, const Vec6& demand, const Vec6& k) {
  double least = unlimited;
  const auto sense = [&](std::size_t number, double present, Eigen::Index component) {
    const double limit = strength * capacity.value[number];
    if (limit < unlimited && k(component) > 0)
      least = std::min(least, squared(std::max(0.0, limit - present)) / (2 * k(component)));
  };
  sense(0, demand(0), 0);
  sense(1, -demand(0), 0);
  for (Eigen::Index c = 1; c < 6; ++c) sense(static_cast<std::size_t>(c) + 1, std::abs(demand(c)), c);
  if (capacity.interaction == Interaction::sum) {
    // |s1| / c1 + |s2| / c2 + ... <= sqrt(2 U) (sqrt(k1) / c1 + sqrt(k2) / c2 + ...)
    double reach = 0;
    for (Eigen::Index c : normal_stress) {
      const double limit = strength * (c == 0 ? std::min(capacity.value[0], capacity.value[1])
                                              : capacity.value[static_cast<std::size_t>(c) + 1]);
      if (limit < unlimited) reach += std::sqrt(k(c)) / limit;
    }
    const double slack = std::max(0.0, 1 - utilisation(capacity, demand, strength).value);
    if (reach > 0) least = std::min(least, squared(slack / reach) / 2);
  }
  return least;
}

}  // namespace

void FrameResponse::forget_bounds(int c) {
  critical_energies_[static_cast<std::size_t>(c)] = -1;
  certain_masses_[static_cast<std::size_t>(c)].clear();
}

double FrameResponse::critical_energy(JointId joint) const {
  const Joint& own = building_[joint];
  const Vec6& demand = from_.joints.demand(joint);
  const double strength = from_.joints.strength(joint);
  if (structure::utilisation(own.capacity, demand, strength).value >= 1) return unlimited;  // its break is no push's
  return least_energy(own.capacity, strength, demand,
                      from_.statics.stiffness_diagonal(own.member).segment<6>(6 * own.end));
}

double FrameResponse::critical_energy(int c) const {
  double& least = critical_energies_[static_cast<std::size_t>(c)];
  if (least >= 0) return least;
  least = unlimited;
  for (JointId joint : from_.components.joints[static_cast<std::size_t>(c)]) {
    if (!from_.parts.standing(joint)) continue;
    const Joint& own = building_[joint];
    if (own.member.valid())
      least = std::min(least, critical_energy(joint));
    else if (!from_.parts.bearings.tracks(own.panel))
      least = 0;  // a supported edge of a shell: no bound is known
  }
  return least;
}

/// Of a member whose ends move by a and b, the straight line between has |a|^2 + a.b + |b|^2 over three of its mass
/// times one, never less than a sixth of |a|^2 + |b|^2; a panel moves with its corners, as in rayleigh_mass().
const std::vector<double>& FrameResponse::certain_masses(int c) const {
  std::vector<double>& mass = certain_masses_[static_cast<std::size_t>(c)];
  if (!mass.empty()) return mass;
  mass.assign(building_.nodes.size(), 0.0);
  for (MemberId member : from_.statics.members(c)) {
    if (!from_.parts.stands(member) || !from_.parts.segments.holds(building_.joint(member, 0)) ||
        !from_.parts.segments.holds(building_.joint(member, 1)))
      continue;
    for (NodeId node : building_[member].nodes) mass[index_of(node)] += std::max(0.0, from_.loads.mass(member)) / 6;
  }
  for (PanelId panel : from_.components.panels[static_cast<std::size_t>(c)])
    if (from_.parts.stands(panel) && from_.parts.bearings.tracks(panel))
      for (NodeId node : building_[panel].nodes) mass[index_of(node)] += from_.loads.mass(panel) / 4;
  for (NodeId node : from_.statics.nodes(c))
    if (from_.parts.stands(node)) mass[index_of(node)] += from_.loads.mass(node);
  return mass;
}

/// Members that bear any of the forces directly, each once.
std::vector<MemberId> FrameResponse::bearing_members(std::span<const Shape> shapes) {
  std::vector<MemberId> members;
  for (const Shape& shape : shapes)
    for (const auto& [member, load] : shape.placed.members)
      if (std::find(members.begin(), members.end(), member) == members.end()) members.push_back(member);
  return members;
}

/// What inertia() is at least, whatever combination of the forces acts: the products over the masses that certainly
/// move with the nodes that are known.
Eigen::MatrixXd FrameResponse::least_inertia(int c, std::span<const Shape> shapes) const {
  const auto n = static_cast<Eigen::Index>(shapes.size());
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(n, n);
  Eigen::Matrix3Xd moved(3, n);
  const auto add = [&](NodeId node, double mass) {
    if (mass == 0 || !shapes.front().response.known(node)) return;
    for (Eigen::Index i = 0; i < n; ++i)
      moved.col(i) = shapes[static_cast<std::size_t>(i)].response.displacement(node).head<3>();
    sum.noalias() += mass * (moved.transpose() * moved);
  };
  const std::vector<double>& mass = certain_masses(c);
  for (NodeId node : from_.statics.nodes(c)) add(node, mass[index_of(node)]);
  // Members that bear a force bend as well: their share is left out.
  for (MemberId member : bearing_members(shapes))
    if (from_.parts.segments.holds(building_.joint(member, 0)) &&
        from_.parts.segments.holds(building_.joint(member, 1)))
      for (NodeId node : building_[member].nodes) add(node, -std::max(0.0, from_.loads.mass(member)) / 6);
  return sum;
}

/// What the force on one of the shapes adds at the members that bear any of them and the panel that it lies on.
FrameResponse::Demands FrameResponse::near_demands(std::span<const Shape> shapes, std::size_t pushed) const {
  Demands demands;
  const auto& [placed, response] = shapes[pushed];
  const auto add = [&](JointId joint, const Vec6& demand) {
    if (building_[joint].capacity.breakable && from_.parts.standing(joint) && !demand.isZero(0))
      demands.emplace_back(joint, demand);
  };
  for (MemberId member : bearing_members(shapes)) {
    const solver::Vec12 end_forces = response.end_forces(member);
    for (int end = 0; end < 2; ++end) add(building_.joint(member, end), member_joint_demand(end_forces, end));
  }
  if (placed.panel.valid() && from_.parts.bearings.tracks(placed.panel))
    for (int edge = 0; edge < 4; ++edge)
      add(building_.joint(placed.panel, edge), handed_edge_demand(building_, from_.parts.bearings, placed.panel, edge,
                                                                  placed.edge_force[static_cast<std::size_t>(edge)]));
  return demands;
}

}  // namespace topple::structure
