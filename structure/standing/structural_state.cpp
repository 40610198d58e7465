#include "standing/structural_state.h"

#include <algorithm>
#include <array>

#include "topple/structure/error.h"

namespace topple::structure {

namespace {

/// The combination's loads; a settlement would have to be held through every change and is refused.
PartLoads loads_to_stand(const Building& building, CombinationId combination) {
  PartLoads loads = part_loads(building, combination);
  if (loads.settlements.empty()) return loads;
  const Node& node = building.nodes[static_cast<std::size_t>(loads.settlements.front().node)];
  throw InputError(building.file + ": combinations." + building[combination].name + ": settles node " + node.name +
                   "; demolition takes combinations without settlements");
}

}  // namespace

StructuralState::StructuralState(const Building& given, CombinationId of_loads, const FailureRules& failure,
                                 int given_threads)
    : building(given),
      combination(of_loads),
      rules(failure),
      threads(given_threads),
      parts(given),
      shells(given),
      loads(given, loads_to_stand(given, combination), parts.bearings, shells),
      statics(given, shells, threads),
      components(given, statics),
      joints(given, failure.sudden),
      in_solver(given, statics),
      account(
          {given, parts.segments, parts.bearings, loads, statics, in_solver.held_nodes(), in_solver.member_loads()}),
      response({parts, shells, loads, statics, joints, components, in_solver.held_nodes()}),
      contacts(response, loads),
      to_check(components.joints.size(), 1) {
  if (rules.second_order) statics.use_second_order();
}

bool StructuralState::stands(const ContactPlace& place) const {
  if (place.node.valid()) return stands(place.node) && in_solver.holds(place.node);
  return place.member.valid() ? stands(place.member) : place.panel.valid() && stands(place.panel);
}

PanelLoading StructuralState::loading(PanelId panel) const {
  PanelLoading loading;
  loading.traction = loads.traction(panel);
  for (const auto& [key, contact] : contacts.all())
    if (contact.place.panel == panel) loading.forces.push_back({contact.place.point, contact.force});
  return loading;
}

void StructuralState::add_displacement(MemberId id, RigidDisplacementFit& to) const {
  const Member& member = building[id];
  const std::array<Vec3, 2> at{building[member.nodes[0]].position + member.offsets[0],
                               building[member.nodes[1]].position + member.offsets[1]};
  const Vec3 along = (at[1] - at[0]) / member.length;
  const solver::Vec12 ends = ends_of(id);
  const Vec3 first = ends.segment<3>(0), second = ends.segment<3>(6);
  // As a rod across its axis; about that as one of a hundredth of its length.
  constexpr double thick = 1e-4;
  const double mass = loads.mass(id), across = mass * member.length * member.length / 12;
  const Mat3 inertia = across * (Mat3::Identity() - (1 - thick) * along * along.transpose());
  const Vec3 turned = along.cross(second - first) / member.length +
                      along * along.dot(Vec3(ends.segment<3>(3) + ends.segment<3>(9))) / 2;
  to.add(mass, (at[0] + at[1]) / 2, inertia, (first + second) / 2, turned);
}

/// By its corners that leave with the part, or, of one that leaves alone, by all that anything tells of.
void StructuralState::add_displacement(PanelId id, const Detached& part, RigidDisplacementFit& to) const {
  RigidDisplacementFit corners;
  Vec3 centre = Vec3::Zero();
  int count = 0;
  for (const NodeId node : building[id].nodes) {
    centre += building[node].position / 4;
    const bool goes = part.nodes.empty() ? parts.segments.degree(node) > 0
                                         : std::binary_search(part.nodes.begin(), part.nodes.end(), node);
    if (!goes) continue;
    corners.add_point(1, building[node].position, displacement_of(node).head<3>());
    ++count;
  }
  const Vec3 turned = count > 2 ? corners.turned() : Vec3(Vec3::Zero());
  // Four points of a quarter each have a plate's second moments (Gauss), if they turn as it does.
  Mat3 inertia = Mat3::Zero();
  for (const NodeId node : building[id].nodes)
    if (count > 2) inertia += point_inertia(loads.mass(id) / 12, building[node].position - centre);
  to.add(loads.mass(id), centre, inertia, corners.moved(), turned);
}

/// Displacements of its own ends, global axes.
solver::Vec12 StructuralState::ends_of(MemberId id) const {
  if (moves(statics.component(id))) return motion->ends(id);
  solver::Vec12 ends;
  for (std::size_t end = 0; end < 2; ++end) {
    const Member& member = building[id];
    const Vec6& node = account.displacement(member.nodes[end]);
    const Vec3 turned = node.tail<3>();
    ends.segment<6>(static_cast<Eigen::Index>(6 * end)) << node.head<3>() + turned.cross(member.offsets[end]), turned;
  }
  return ends;
}

const Vec6& StructuralState::displacement_of(NodeId node) const {
  return moves(statics.component(node)) ? motion->displacement(node) : account.displacement(node);
}

Detached::Motion StructuralState::motion_of(const Detached& part) const {
  Vec6 momentum = Vec6::Zero();
  RigidDisplacementFit displacement;
  for (const MemberId member : part.members) {
    momentum += motion->momentum().of(member);
    add_displacement(member, displacement);
  }
  for (const PanelId panel : part.panels) {
    momentum += motion->momentum().of(panel);
    add_displacement(panel, part, displacement);
  }
  for (const NodeId node : part.nodes) {
    momentum += motion->momentum().of(node);
    displacement.add_point(loads.mass(node), building[node].position, displacement_of(node).head<3>());
  }
  Detached::Motion found;
  found.momentum = momentum.head<3>();
  found.angular = momentum.tail<3>();
  found.displacement = displacement.moved();
  found.turned = displacement.turned();
  return found;
}

void StructuralState::write_loads() {
  const FrameLoads::Changed changed = loads.extract_changed();
  if (motion && !changed.none()) motion->update_masses();
  for (MemberId member : changed.members) {
    if (!stands(member)) continue;
    account.write(member);
    in_solver.write(member, loads.on(member));
  }
  for (NodeId node : changed.nodes) {
    if (!in_solver.holds(node)) continue;
    account.write(node, in_solver.load(node));
    in_solver.write(node, loads.on(node));
  }
}

void StructuralState::drop(NodeId node) {
  if (!in_solver.holds(node)) return;
  contacts.drop(node);
  in_solver.drop(node);
}

void StructuralState::hand_on_anew(PanelId panel) {
  account.change(panel).hand_on(panel);
  loads.hand_on_anew(panel);
}

void StructuralState::update_stiffness(PanelId panel, const Eigen::MatrixXd& before) {
  const Eigen::MatrixXd now = shells.of(panel)->stiffness();
  account.change(panel).soften(panel, before - now);
  statics.set_stiffness(panel, now);
}

}  // namespace topple::structure
