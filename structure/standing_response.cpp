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

/// Work of a placed force through the response to another (or to itself).
double work(const Building& building, const PlacedLoad& placed, const PlacedLoad& cause,
            const FrameStatics::Response& response) {
  double sum = 0;
  for (const auto& [member, load] : placed.members) {
    const Vec3 force = building[member].axes.transpose() * load.first.head<3>();
    sum += force.dot(response.point_displacement(member, load.from, loads_on(cause, member)));
  }
  for (const auto& [node, load] : placed.nodes) sum += load.dot(response.displacement(node));
  return sum;
}

/// A response along one member, and the forces of it that act there.
struct AlongMember {
  const FrameStatics::Response& response;
  std::vector<solver::BeamLoad> own;
};

/// Integral of the product of two displacements along a member, per length: Gauss-Legendre with four points on each
/// side of every load (exact for cubic shapes, those of a beam under point loads).
double mean_product(const Building& building, MemberId member, const AlongMember& a, const AlongMember& b) {
  constexpr double inner = 0.33998104358485626, outer = 0.86113631159405257;
  constexpr double inner_weight = 0.65214515486254614 / 2, outer_weight = 0.34785484513745386 / 2;
  constexpr std::array<std::pair<double, double>, 4> gauss{{{0.5 * (1 - outer), outer_weight},
                                                            {0.5 * (1 - inner), inner_weight},
                                                            {0.5 * (1 + inner), inner_weight},
                                                            {0.5 * (1 + outer), outer_weight}}};
  const double length = building[member].length;
  std::vector<double> cuts{0, length};
  for (const AlongMember* one : {&a, &b})
    for (const solver::BeamLoad& load : one->own) cuts.push_back(load.from);
  std::sort(cuts.begin(), cuts.end());
  const bool same = &a.response == &b.response;
  double sum = 0;
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i)
    for (const auto& [at, weight] : gauss) {
      const double x = cuts[i] + at * (cuts[i + 1] - cuts[i]);
      const Vec3 one = a.response.point_displacement(member, x, a.own);
      const Vec3 other = same ? one : b.response.point_displacement(member, x, b.own);
      sum += weight * (cuts[i + 1] - cuts[i]) * one.dot(other);
    }
  return sum / length;
}

/// Displacements of the ends of a member that bears nothing of the force. One that hangs by one end moves with it as it
/// is.
std::pair<Vec3, Vec3> straight_line(const Building& building, MemberId id, const std::array<bool, 2>& holds,
                                    const FrameStatics::Response& response) {
  const Member& member = building[id];
  const auto& nodes = member.nodes;
  if (holds[0] && holds[1])
    return {response.displacement(nodes[0]).head<3>(), response.displacement(nodes[1]).head<3>()};
  const std::size_t end = holds[0] ? 0 : 1;
  const Vec6& hub = response.displacement(nodes[end]);
  const Vec3 turn = hub.tail<3>(), held = hub.head<3>() + turn.cross(member.offsets[end]);
  const Vec3 along = (end == 0 ? member.length : -member.length) * member.axes.row(0).transpose();
  return {held, held + turn.cross(along)};
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
  return work(building, placed, placed, response) + placed.bending_compliance;
}

StandingFrame::CoupledResponse StandingFrame::State::respond(std::span<const ContactPlace> places,
                                                             std::span<const Vec3> directions) const {
  const auto n = static_cast<Eigen::Index>(places.size());
  CoupledResponse answer;
  answer.compliance = answer.inertia = Eigen::MatrixXd::Zero(n, n);
  std::vector<PlacedLoad> placed;
  std::vector<FrameStatics::Response> responses;
  for (std::size_t i = 0; i < places.size(); ++i) {
    placed.push_back(this->place(places[i], directions[i]));
    responses.push_back(statics.respond(component(places[i]), response_loads(placed.back())));
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const int c = component(places[at]);
    for (Eigen::Index j = 0; j <= i; ++j) {
      const auto other = static_cast<std::size_t>(j);
      if (component(places[other]) != c) continue;  // what is not joined does not feel each other
      answer.compliance(i, j) =
          i == j ? compliance(placed[at], responses[at]) : work(building, placed[at], placed[other], responses[other]);
      answer.inertia(i, j) = shared_inertia(c, {placed[at], responses[at]}, {placed[other], responses[other]});
      answer.compliance(j, i) = answer.compliance(i, j);
      answer.inertia(j, i) = answer.inertia(i, j);
    }
    UnitResponse one;
    one.compliance = answer.compliance(i, i);
    one.rayleigh_mass = one.compliance > 0 ? answer.inertia(i, i) / (one.compliance * one.compliance) : 0;
    one.demands = response_demands(c, placed[at], responses[at]);
    answer.places.push_back(std::move(one));
  }
  return answer;
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
  const Shape shape{placed, response};
  return shared_inertia(c, shape, shape) / (compliance * compliance);
}

/// The product of two static shapes, integrated over the mass of the component.
double StandingFrame::State::shared_inertia(int c, const Shape& a, const Shape& b) const {
  const bool same = &a.response == &b.response;
  double sum = 0;
  for (MemberId member : statics.members(c)) {
    if (!stands(member) || loads.mass(member) <= 0) continue;
    AlongMember along_a{a.response, loads_on(a.placed, member)}, along_b{b.response, {}};
    if (!same) along_b.own = loads_on(b.placed, member);
    if (!along_a.own.empty() || !along_b.own.empty()) {
      sum += loads.mass(member) * mean_product(building, member, along_a, along_b);
      continue;
    }
    // Far from the contact a straight line between the ends is near enough; the cost stays small.
    const std::array<bool, 2> holds{segments.holds(building.joint(member, 0)),
                                    segments.holds(building.joint(member, 1))};
    const auto [a0, a1] = straight_line(building, member, holds, a.response);
    if (same) {
      sum += loads.mass(member) * (a0.dot(a0) + a0.dot(a1) + a1.dot(a1)) / 3;
      continue;
    }
    const auto [b0, b1] = straight_line(building, member, holds, b.response);
    sum += loads.mass(member) * (a0.dot(b0) + (a0.dot(b1) + a1.dot(b0)) / 2 + a1.dot(b1)) / 3;
  }
  for (NodeId node : statics.nodes(c))
    if (stands(node))
      sum += loads.mass(node) * a.response.displacement(node).head<3>().dot(b.response.displacement(node).head<3>());
  for (PanelId panel : component_panels[static_cast<std::size_t>(c)])
    if (stands(panel)) sum += loads.mass(panel) * panel_mean_product(panel, a, b);
  return sum;
}

/// A panel moves with its corners; of a shell all nodes are known.
double StandingFrame::State::panel_mean_product(PanelId panel, const Shape& a, const Shape& b) const {
  if (bearings.serves(panel)) {
    double mean = 0;
    for (const NodeId node : building[panel].nodes)
      mean += a.response.displacement(node).head<3>().dot(b.response.displacement(node).head<3>()) / 4;
    return mean;
  }
  const auto loading = [&](const PlacedLoad& placed, double factor) {
    PanelLoading result;
    if (panel == placed.panel) {
      result.forces.push_back(placed.on_shell);
      result.forces.back().force *= factor;
    }
    return result;
  };
  const PanelSuperelement& shell = *shells.of(panel);
  const std::vector<Vec6> at_a = node_displacements(panel, a.response);
  if (&a.response == &b.response) return shell.mean_square_motion(at_a, loading(a.placed, 1));
  // By the squares of the sum and of the difference.
  const std::vector<Vec6> at_b = node_displacements(panel, b.response);
  double product = 0;
  for (const double sign : {1.0, -1.0}) {
    std::vector<Vec6> at = at_a;
    for (std::size_t i = 0; i < at.size(); ++i) at[i] += sign * at_b[i];
    PanelLoading both = loading(a.placed, 1);
    const PanelLoading other = loading(b.placed, sign);
    both.forces.insert(both.forces.end(), other.forces.begin(), other.forces.end());
    product += sign * shell.mean_square_motion(at, both) / 4;
  }
  return product;
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
