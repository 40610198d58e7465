// How a standing frame answers a unit force: compliance, joint demands, and the mass that takes part.
#include <Eigen/Geometry>
#include <algorithm>

#include "failure/panel_demand.h"
#include "model/index_of.h"
#include "standing/frame_response.h"
#include "standing/shell_reading.h"

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
  const Vec6& rigid_end = response.displacement(nodes[end]);
  const Vec3 turn = rigid_end.tail<3>(), held = rigid_end.head<3>() + turn.cross(member.offsets[end]);
  const Vec3 along = (end == 0 ? member.length : -member.length) * member.axes.row(0).transpose();
  return {held, held + turn.cross(along)};
}

}  // namespace

FrameResponse::FrameResponse(const Sources& sources)
    : building_(sources.parts.building()),
      from_(sources),
      critical_energies_(static_cast<std::size_t>(sources.statics.components()), -1.0),
      certain_masses_(critical_energies_.size()) {}

PlacedLoad FrameResponse::load_at(const ContactPlace& place, const Vec3& force, const Vec3& moment) const {
  if (place.panel.valid() && !from_.parts.bearings.tracks(place.panel)) return load_on_shell(place, force);
  return load_at_place(building_, from_.parts.bearings, place, force, moment);
}

/// What the panel's nodes get of a force on it; its own give is that with its nodes held.
PlacedLoad FrameResponse::load_on_shell(const ContactPlace& place, const Vec3& force) const {
  const PanelSuperelement& shell = *from_.shells.of(place.panel);
  PanelLoading loading;
  loading.forces.push_back({place.point, force});
  PlacedLoad placed;
  placed.panel = place.panel;
  placed.on_shell = {place.point, force};
  const std::vector<Vec6> at_nodes = shell.loads_at_nodes(loading);
  const std::vector<NodeId> nodes = building_[place.panel].all_nodes();
  for (std::size_t n = 0; n < nodes.size(); ++n)
    if (!at_nodes[n].isZero(0)) placed.nodes.emplace_back(nodes[n], at_nodes[n]);
  placed.bending_compliance = shell.compliance(loading.forces.front());
  return placed;
}

FrameStatics::ResponseLoads FrameResponse::response_loads(const PlacedLoad& placed) const {
  FrameStatics::ResponseLoads unit;
  unit.members = placed.members;
  for (const auto& [node, load] : placed.nodes)
    if (from_.node_solved[index_of(node)]) unit.nodes.emplace_back(node, load);
  return unit;
}

double FrameResponse::compliance(const Shape& shape) const {
  return work(building_, shape.placed, shape.placed, shape.response) + shape.placed.bending_compliance;
}

/// Component by component: what is not joined does not feel each other.
FrameResponse::CoupledResponse FrameResponse::couple(std::span<const ContactPlace> places,
                                                     std::span<const Vec3> directions, bool near) const {
  const auto n = static_cast<Eigen::Index>(places.size());
  CoupledResponse answer;
  answer.compliance = answer.inertia = Eigen::MatrixXd::Zero(n, n);
  answer.places.resize(places.size());
  std::map<int, std::vector<Eigen::Index>> joined;
  for (std::size_t i = 0; i < places.size(); ++i)
    joined[from_.components.of(places[i])].push_back(static_cast<Eigen::Index>(i));
  for (const auto& [c, own] : joined) {
    std::vector<PlacedLoad> placed;
    std::vector<FrameStatics::ResponseLoads> forces;
    for (const Eigen::Index i : own) {
      const auto at = static_cast<std::size_t>(i);
      placed.push_back(this->load_at(places[at], directions[at]));
      forces.push_back(response_loads(placed.back()));
    }
    const std::vector<FrameStatics::Response> responses =
        near ? from_.statics.respond_near(c, forces) : from_.statics.respond(c, forces);
    std::vector<Shape> shapes;
    for (std::size_t i = 0; i < own.size(); ++i) shapes.push_back({placed[i], responses[i]});
    answer.inertia(own, own) = near ? least_inertia(c, shapes) : inertia(c, shapes);
    for (std::size_t i = 0; i < own.size(); ++i) {
      for (std::size_t j = 0; j <= i; ++j)
        answer.compliance(own[i], own[j]) = answer.compliance(own[j], own[i]) =
            i == j ? compliance(shapes[i]) : work(building_, placed[i], placed[j], responses[j]);
      UnitResponse& one = answer.places[static_cast<std::size_t>(own[i])];
      one.compliance = answer.compliance(own[i], own[i]);
      if (one.compliance > 0)
        one.rayleigh_mass = std::max(0.0, answer.inertia(own[i], own[i])) / (one.compliance * one.compliance);
      one.demands = near ? near_demands(shapes, i) : response_demands(c, shapes[i]);
    }
  }
  return answer;
}

FrameResponse::Demands FrameResponse::response_demands(int c, const Shape& shape) const {
  const auto& [placed, response] = shape;
  Demands demands;
  Vec6 largest = Vec6::Zero();
  MemberId member_read;
  solver::Vec12 end_forces;
  PanelId panel_read;  // a shell
  std::array<Vec6, 4> of_edges;
  for (JointId joint : from_.components.joints[static_cast<std::size_t>(c)]) {
    const Joint& own = building_[joint];
    // What lies on members hands on its own load alone.
    if (!own.member.valid() && own.panel != placed.panel && from_.parts.bearings.tracks(own.panel)) continue;
    if (!from_.parts.standing(joint)) continue;
    Vec6 demand = Vec6::Zero();
    if (own.member.valid()) {
      if (own.member != member_read) end_forces = response.end_forces(own.member);
      member_read = own.member;
      demand = member_joint_demand(end_forces, own.end);
    } else if (!from_.parts.bearings.tracks(own.panel)) {
      if (own.panel != panel_read) {
        PanelLoading unit;
        if (own.panel == placed.panel) unit.forces.push_back(placed.on_shell);
        of_edges = shell_edge_demands(*from_.shells.of(own.panel), from_.parts.bearings, own.panel,
                                      node_displacements(building_[own.panel], response), unit);
      }
      panel_read = own.panel;
      demand = of_edges[static_cast<std::size_t>(own.end)];
    } else if (own.panel == placed.panel) {
      demand = handed_edge_demand(building_, from_.parts.bearings, own.panel, own.end,
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

/// The products of static shapes, each with each, integrated over the mass of the component. Rayleigh's mass, which
/// moving with a contact place has the kinetic energy of the whole static shape, is the square's over that of the
/// compliance.
Eigen::MatrixXd FrameResponse::inertia(int c, std::span<const Shape> shapes) const {
  const auto n = static_cast<Eigen::Index>(shapes.size());
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(n, n);
  std::vector<MemberId> bearing;
  for (const Shape& shape : shapes)
    for (const auto& [member, load] : shape.placed.members) bearing.push_back(member);
  std::sort(bearing.begin(), bearing.end());
  Eigen::Matrix3Xd first(3, n), second(3, n);
  for (MemberId member : from_.statics.members(c)) {
    const double mass = from_.loads.mass(member);
    if (!from_.parts.stands(member) || mass <= 0) continue;
    // Far from the contacts a straight line between the ends is near enough; the cost stays small.
    const std::array<bool, 2> holds{from_.parts.segments.holds(building_.joint(member, 0)),
                                    from_.parts.segments.holds(building_.joint(member, 1))};
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto ends = straight_line(building_, member, holds, shapes[static_cast<std::size_t>(i)].response);
      first.col(i) = ends.first;
      second.col(i) = ends.second;
    }
    const bool bears = std::binary_search(bearing.begin(), bearing.end(), member);
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index j = 0; j <= i; ++j) {
        if (bears) {
          const Shape &a = shapes[static_cast<std::size_t>(i)], &b = shapes[static_cast<std::size_t>(j)];
          const AlongMember along_a{a.response, loads_on(a.placed, member)};
          const AlongMember along_b{b.response, loads_on(b.placed, member)};
          if (!along_a.own.empty() || !along_b.own.empty()) {
            sum(i, j) += mass * mean_product(building_, member, along_a, along_b);
            continue;
          }
        }
        sum(i, j) +=
            mass *
            (first.col(i).dot(first.col(j)) + (first.col(i).dot(second.col(j)) + second.col(i).dot(first.col(j))) / 2 +
             second.col(i).dot(second.col(j))) /
            3;
      }
  }
  add_inertia_of_nodes(c, shapes, sum);
  for (PanelId panel : from_.components.panels[static_cast<std::size_t>(c)]) {
    if (!from_.parts.stands(panel)) continue;
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index j = 0; j <= i; ++j)
        sum(i, j) += from_.loads.mass(panel) * panel_mean_product(panel, shapes[static_cast<std::size_t>(i)],
                                                                  shapes[static_cast<std::size_t>(j)]);
  }
  return sum.selfadjointView<Eigen::Lower>();
}

void FrameResponse::add_inertia_of_nodes(int c, std::span<const Shape> shapes, Eigen::MatrixXd& sum) const {
  for (NodeId node : from_.statics.nodes(c)) {
    const double mass = from_.loads.mass(node);
    if (mass == 0 || !from_.parts.stands(node)) continue;
    for (std::size_t i = 0; i < shapes.size(); ++i)
      for (std::size_t j = 0; j <= i; ++j)
        sum(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) +=
            mass * shapes[i].response.displacement(node).head<3>().dot(shapes[j].response.displacement(node).head<3>());
  }
}

/// A panel moves with its corners; of a shell all nodes are known.
double FrameResponse::panel_mean_product(PanelId panel, const Shape& a, const Shape& b) const {
  if (from_.parts.bearings.tracks(panel)) {
    double mean = 0;
    for (const NodeId node : building_[panel].nodes)
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
  const PanelSuperelement& shell = *from_.shells.of(panel);
  const std::vector<Vec6> at_a = node_displacements(building_[panel], a.response);
  if (&a.response == &b.response) return shell.mean_square_motion(at_a, loading(a.placed, 1));
  // By the squares of the sum and of the difference.
  const std::vector<Vec6> at_b = node_displacements(building_[panel], b.response);
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

double FrameResponse::displacement_along(const ContactPlace& place, const Vec3& direction) const {
  const PlacedLoad placed = this->load_at(place, direction);
  double sum = 0;
  for (const auto& [member, load] : placed.members) {
    const Vec3 force = building_[member].axes.transpose() * load.first.head<3>();
    sum += force.dot(from_.statics.point_displacement(member, load.from, from_.loads.on(member)));
  }
  for (const auto& [node, load] : placed.nodes) sum += load.dot(from_.statics.displacement(node));
  return sum;
}

}  // namespace topple::structure
