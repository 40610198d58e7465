// How a standing frame answers a unit force: compliance, joint demands, and the mass that takes part.
#include <Eigen/Geometry>
#include <algorithm>

#include "index_of.h"
#include "panel_demand.h"
#include "placed_load.h"
#include "standing_state.h"

namespace topple::structure {

namespace {

/// Demands below this share of the largest are rounding.
constexpr double negligible = 1e-12;

/// Loads of the placed force that act on one member.
std::vector<solver::BeamLoad> loads_on(const PlacedLoad& placed, MemberId member) {
  std::vector<solver::BeamLoad> own;
  for (const auto& [bearing, load] : placed.members)
    if (bearing == member) own.push_back(load);
  return own;
}

/// Work of the placed force through a response: the compliance where it is a unit force.
double work(const Building& building, const PlacedLoad& placed, const FrameStatics::Response& response) {
  double sum = 0;
  for (const auto& [member, load] : placed.members) {
    const Vec3 force = building[member].axes.transpose() * load.first.head<3>();
    sum += force.dot(response.point_displacement(member, load.from, loads_on(placed, member)));
  }
  for (const auto& [node, load] : placed.nodes) sum += load.dot(response.displacement(node));
  return sum;
}

/// Integral of the squared displacement along a member, per length: Gauss-Legendre with four points on each side of
/// every load (exact for cubic shapes, those of a beam under point loads).
double mean_square(const Building& building, MemberId member, const FrameStatics::Response& response,
                   const std::vector<solver::BeamLoad>& own) {
  constexpr double inner = 0.33998104358485626, outer = 0.86113631159405257;
  constexpr double inner_weight = 0.65214515486254614 / 2, outer_weight = 0.34785484513745386 / 2;
  constexpr std::array<std::pair<double, double>, 4> gauss{{{0.5 * (1 - outer), outer_weight},
                                                            {0.5 * (1 - inner), inner_weight},
                                                            {0.5 * (1 + inner), inner_weight},
                                                            {0.5 * (1 + outer), outer_weight}}};
  const double length = building[member].length;
  std::vector<double> cuts{0, length};
  for (const solver::BeamLoad& load : own) cuts.push_back(load.from);
  std::sort(cuts.begin(), cuts.end());
  double sum = 0;
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i)
    for (const auto& [at, weight] : gauss)
      sum += weight * (cuts[i + 1] - cuts[i]) *
             response.point_displacement(member, cuts[i] + at * (cuts[i + 1] - cuts[i]), own).squaredNorm();
  return sum / length;
}

}  // namespace

FrameStatics::ResponseLoads StandingFrame::State::response_loads(const PlacedLoad& placed) const {
  FrameStatics::ResponseLoads unit;
  unit.members = placed.members;
  for (const auto& [node, load] : placed.nodes)
    if (node_solved[index_of(node)]) unit.nodes.emplace_back(node, load);
  return unit;
}

int StandingFrame::State::component(const ContactPlace& place) const {
  if (place.node.valid()) return statics.component(place.node);
  return place.member.valid() ? statics.component(place.member) : statics.component(building[place.panel].nodes[0]);
}

StandingFrame::UnitResponse StandingFrame::State::respond(const ContactPlace& place, const Vec3& direction) const {
  const PlacedLoad placed = this->place(place, direction);
  const int c = component(place);
  const FrameStatics::Response response = statics.respond(c, response_loads(placed));
  UnitResponse answer;
  answer.compliance = compliance(placed, response);
  answer.demands = response_demands(c, placed, response);
  answer.rayleigh_mass = rayleigh_mass(c, placed, response, answer.compliance);
  return answer;
}

double StandingFrame::State::compliance(const PlacedLoad& placed, const FrameStatics::Response& response) const {
  return work(building, placed, response) + placed.bending_compliance;
}

std::vector<std::pair<JointId, Vec6>> StandingFrame::State::response_demands(
    int c, const PlacedLoad& placed, const FrameStatics::Response& response) const {
  std::vector<std::pair<JointId, Vec6>> demands;
  Vec6 largest = Vec6::Zero();
  MemberId member_read;
  solver::Vec12 end_forces;
  PanelId panel_read;  // a shell
  std::array<Vec6, 4> of_edges;
  for (JointId joint : checked_joints[static_cast<std::size_t>(c)]) {
    if (!holds(joint) || label(joint) < 0) continue;
    const Joint& own = building[joint];
    Vec6 demand = Vec6::Zero();
    if (own.member.valid()) {
      if (own.member != member_read) end_forces = response.end_forces(own.member);
      member_read = own.member;
      demand = member_joint_demand(end_forces, own.end);
    } else if (!bearings.serves(own.panel)) {
      if (own.panel != panel_read) {
        PanelLoading unit;
        if (own.panel == placed.panel) unit.forces.push_back(placed.on_shell);
        of_edges = shell_edge_demands(own.panel, node_displacements(own.panel, response), unit);
      }
      panel_read = own.panel;
      demand = of_edges[static_cast<std::size_t>(own.end)];
    } else if (own.panel == placed.panel) {
      demand = handed_edge_demand(building, bearings, own.panel, own.end,
                                  placed.edge_force[static_cast<std::size_t>(own.end)]);
    }
    if (demand.isZero(0)) continue;
    largest = largest.cwiseMax(demand.cwiseAbs());
    demands.emplace_back(joint, demand);
  }
  std::erase_if(demands, [&](const auto& entry) {
    return (entry.second.cwiseAbs().array() <= negligible * largest.array()).all();
  });
  return demands;
}

/// Rayleigh: the mass that, moving with the contact place, has the kinetic energy of the whole static shape.
double StandingFrame::State::rayleigh_mass(int c, const PlacedLoad& placed, const FrameStatics::Response& response,
                                           double compliance) const {
  if (!(compliance > 0)) return 0;
  double sum = 0;
  for (MemberId member : statics.members(c)) {
    if (!stands(member) || loads.mass(member) <= 0) continue;
    const std::vector<solver::BeamLoad> own = loads_on(placed, member);
    const auto& nodes = building[member].nodes;
    if (own.empty() && segments.holds(building.joint(member, 0)) && segments.holds(building.joint(member, 1))) {
      // Far from the contact a straight line between the ends is near enough; the cost stays small.
      const Vec3 a = response.displacement(nodes[0]).head<3>(), b = response.displacement(nodes[1]).head<3>();
      sum += loads.mass(member) * (a.dot(a) + a.dot(b) + b.dot(b)) / 3;
    } else {
      sum += loads.mass(member) * mean_square(building, member, response, own);
    }
  }
  for (NodeId node : statics.nodes(c))
    if (stands(node)) sum += loads.mass(node) * response.displacement(node).head<3>().squaredNorm();
  for (PanelId panel : component_panels[static_cast<std::size_t>(c)]) {
    if (!stands(panel)) continue;
    sum += loads.mass(panel) * panel_mean_square(panel, placed, response);
  }
  return sum / (compliance * compliance);
}

/// A panel moves with its corners; of a shell all nodes are known.
double StandingFrame::State::panel_mean_square(PanelId panel, const PlacedLoad& placed,
                                               const FrameStatics::Response& response) const {
  if (bearings.serves(panel)) {
    double mean = 0;
    for (const NodeId node : building[panel].nodes) mean += response.displacement(node).head<3>().squaredNorm() / 4;
    return mean;
  }
  PanelLoading unit;
  if (panel == placed.panel) unit.forces.push_back(placed.on_shell);
  return shells.of(panel)->mean_square_motion(node_displacements(panel, response), unit);
}

double StandingFrame::State::displacement_along(const ContactPlace& place, const Vec3& direction) const {
  const PlacedLoad placed = this->place(place, direction);
  double sum = 0;
  for (const auto& [member, load] : placed.members) {
    const Vec3 force = building[member].axes.transpose() * load.first.head<3>();
    sum += force.dot(statics.point_displacement(member, load.from, loads.on(member)));
  }
  for (const auto& [node, load] : placed.nodes) sum += load.dot(statics.displacement(node));
  return sum;
}

}  // namespace topple::structure
