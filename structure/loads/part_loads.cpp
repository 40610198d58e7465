// Loads of one combination, by the part that carries them.
#include <cmath>

#include "loads/case_loads.h"
#include "topple/structure/error.h"
#include "topple/structure/frame.h"

namespace topple::structure {

namespace {

/// Coefficient of thermal expansion; an error names the key where it is needed and not given.
double expansion(const Material& material) {
  if (!material.thermal_expansion)
    throw InputError("materials." + material.name +
                     ".thermal_expansion: a temperature load needs it, accepted is a number in 1/K");
  return *material.thermal_expansion;
}

/// A load's components in the member's axes, per length of member.
Vec6 to_local(const Member& member, LoadFrame frame, Vec6 load) {
  if (frame == LoadFrame::local) return load;
  if (frame == LoadFrame::projected) {
    // Given per length of the member as it is seen along the load: across component i it looks sqrt(1 - x_i^2) as long.
    for (int i = 0; i < 6; ++i) {
      const double along = member.axes(0, i % 3);
      load[i] *= std::sqrt(std::max(0.0, 1 - along * along));
    }
  }
  Vec6 local;
  local.head<3>() = member.axes * load.head<3>();
  local.tail<3>() = member.axes * load.tail<3>();
  return local;
}

solver::BeamLoad member_load(const Building& building, const MemberLoad& load, double factor) {
  const Member& member = building[load.member];
  solver::BeamLoad out;
  out.beam = load.member.index;
  out.from = load.from;
  out.to = load.to;
  switch (load.kind) {
    case MemberLoad::Kind::distributed:
      out.kind = solver::BeamLoad::Kind::distributed;
      out.first = factor * to_local(member, load.frame, load.first);
      out.last = factor * to_local(member, load.frame, load.last);
      break;
    case MemberLoad::Kind::point:
      out.kind = solver::BeamLoad::Kind::point;
      out.first =
          factor * to_local(member, load.frame == LoadFrame::projected ? LoadFrame::global : load.frame, load.first);
      break;
    case MemberLoad::Kind::temperature: {
      const double alpha = factor * expansion(building[member.material]);
      out.kind = solver::BeamLoad::Kind::temperature;
      out.strain = alpha * load.temperature;
      out.curvature_y = alpha * load.gradient_y;
      out.curvature_z = alpha * load.gradient_z;
      break;
    }
  }
  return out;
}

/// The sum of the cases' self weights: a multiple of gravity as a vector.
Vec3 self_weight(const Building& building, const Combination& combination) {
  Vec3 sum = Vec3::Zero();
  for (const auto& [id, factor] : combination.factors) sum += factor * building[id].self_weight;
  return sum * building.gravity;
}

void add_self_weight(const Building& building, const Vec3& acceleration, PartLoads& loads) {
  if (acceleration.isZero(0)) return;
  for (std::size_t i = 0; i < building.members.size(); ++i) {
    const Member& member = building.members[i];
    const double mass = building[member.material].density * building[member.section].area;
    if (mass == 0) continue;
    solver::BeamLoad load;
    load.beam = static_cast<int>(i);
    load.to = member.length;
    load.first.head<3>() = member.axes * (mass * acceleration);
    load.last = load.first;
    loads.members[i].push_back(load);
  }
  for (std::size_t i = 0; i < building.panels.size(); ++i) {
    const Panel& panel = building.panels[i];
    loads.panels[i].body_force = building[panel.material].density * panel.thickness * acceleration;
  }
}

void add_case(const Building& building, const LoadCase& load_case, double factor, PartLoads& loads) {
  for (const MemberLoad& load : load_case.members)
    loads.members[static_cast<std::size_t>(load.member.index)].push_back(member_load(building, load, factor));
  for (const PanelLoad& load : load_case.panels) {
    PanelAction& action = loads.panels[static_cast<std::size_t>(load.panel.index)];
    action.pressure += factor * load.pressure;
    if (load.temperature != 0)
      action.strain += factor * load.temperature * expansion(building[building[load.panel].material]);
  }
  for (const NodeLoad& load : load_case.nodes)
    loads.nodes[static_cast<std::size_t>(load.node.index)] += factor * load.load;
  for (const Settlement& settlement : load_case.settlements)
    loads.settlements.push_back({settlement.node.index, settlement.component, factor * settlement.value});
}

}  // namespace

PartLoads part_loads(const Building& building, CombinationId id) { return part_loads(building, building[id]); }

PartLoads part_loads(const Building& building, const Combination& combination) {
  PartLoads loads;
  loads.members.resize(building.members.size());
  loads.panels.resize(building.panels.size());
  loads.nodes.assign(building.nodes.size(), Vec6::Zero());
  add_self_weight(building, self_weight(building, combination), loads);
  for (const auto& [case_id, factor] : combination.factors)
    if (factor != 0) add_case(building, building[case_id], factor, loads);
  return loads;
}

}  // namespace topple::structure
