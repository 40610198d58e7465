#include "standing/structural_state.h"

#include <span>

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

Detached::Motion StructuralState::motion_of(const Detached& part) const {
  Vec6 momentum = Vec6::Zero();
  Vec3 displacement = Vec3::Zero();
  double mass = 0;
  const auto add = [&](double weighs, std::span<const NodeId> nodes) {
    mass += weighs;
    for (const NodeId node : nodes) {
      const Vec6& own = moves(statics.component(node)) ? motion->displacement(node) : account.displacement(node);
      displacement += weighs / static_cast<double>(nodes.size()) * own.head<3>();
    }
  };
  for (const MemberId member : part.members) {
    momentum += motion->momentum().of(member);
    add(loads.mass(member), building[member].nodes);
  }
  for (const PanelId panel : part.panels) {
    momentum += motion->momentum().of(panel);
    add(loads.mass(panel), building[panel].nodes);
  }
  for (const NodeId node : part.nodes) {
    momentum += motion->momentum().of(node);
    add(loads.mass(node), {&node, 1});
  }
  Detached::Motion found;
  found.momentum = momentum.head<3>();
  found.angular = momentum.tail<3>();
  if (mass > 0) found.displacement = displacement / mass;
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
