// Loads of one combination, by the part that carries them.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "loads/case_loads.h"
#include "model/index_of.h"
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

double mass_per_length(const Building& building, const Member& member) {
  return building[member.material].density * building[member.section].area;
}

/// Calls use(member, make) for all that acts on members: their own weight, then what each case brings. make() is the
/// load.
template <class Use>
void for_each_member_load(const Building& building, const Combination& combination, Use use) {
  const Vec3 acceleration = self_weight(building, combination);
  for (std::size_t i = 0; i < building.members.size() && !acceleration.isZero(0); ++i) {
    const Member& member = building.members[i];
    const double mass = mass_per_length(building, member);
    if (mass == 0) continue;
    use(i, [&] {
      solver::BeamLoad load;
      load.beam = static_cast<int>(i);
      load.to = member.length;
      load.first.head<3>() = member.axes * (mass * acceleration);
      load.last = load.first;
      return load;
    });
  }
  for (const auto& [id, factor] : combination.factors) {
    if (factor == 0) continue;
    for (const MemberLoad& load : building[id].members)
      use(index_of(load.member), [&] { return member_load(building, load, factor); });
  }
}

void add_weight_of_panels(const Building& building, const Vec3& acceleration, PartLoads& loads) {
  if (acceleration.isZero(0)) return;
  for (std::size_t i = 0; i < building.panels.size(); ++i) {
    const Panel& panel = building.panels[i];
    loads.panels[i].body_force = building[panel.material].density * panel.thickness * acceleration;
  }
}

/// But for its loads on members.
void add_case(const Building& building, const LoadCase& load_case, double factor, PartLoads& loads) {
  for (const PanelLoad& load : load_case.panels) {
    PanelAction& action = loads.panels[index_of(load.panel)];
    action.pressure += factor * load.pressure;
    if (load.temperature != 0)
      action.strain += factor * load.temperature * expansion(building[building[load.panel].material]);
  }
  for (const NodeLoad& load : load_case.nodes) loads.nodes[index_of(load.node)] += factor * load.load;
  for (const Settlement& settlement : load_case.settlements)
    loads.settlements.push_back({settlement.node.index, settlement.component, factor * settlement.value});
}

/// In the members' order, and for each in the order in which they come.
std::vector<solver::BeamLoad> member_loads(const Building& building, const Combination& combination) {
  std::vector<std::size_t> next(building.members.size() + 1, 0);
  for_each_member_load(building, combination, [&](std::size_t member, const auto&) { ++next[member + 1]; });
  std::partial_sum(next.begin(), next.end(), next.begin());
  std::vector<solver::BeamLoad> loads(next.back());
  for_each_member_load(building, combination,
                       [&](std::size_t member, const auto& make) { loads[next[member]++] = make(); });
  return loads;
}

}  // namespace

PartLoads loads_beside_members(const Building& building, const Combination& combination) {
  PartLoads loads;
  loads.panels.resize(building.panels.size());
  loads.nodes.assign(building.nodes.size(), Vec6::Zero());
  add_weight_of_panels(building, self_weight(building, combination), loads);
  for (const auto& [case_id, factor] : combination.factors)
    if (factor != 0) add_case(building, building[case_id], factor, loads);
  return loads;
}

PartLoads part_loads(const Building& building, CombinationId id) { return part_loads(building, building[id]); }

PartLoads part_loads(const Building& building, const Combination& combination) {
  PartLoads loads = loads_beside_members(building, combination);
  loads.members.resize(building.members.size());
  for_each_member_load(building, combination,
                       [&](std::size_t member, const auto& make) { loads.members[member].push_back(make()); });
  return loads;
}

bool has_meshes(const Frame& frame) {
  return std::any_of(frame.meshes.begin(), frame.meshes.end(),
                     [](const PanelMesh& mesh) { return !mesh.elements.empty(); });
}

CombinationLoads combination_loads(const Building& building, const Frame& frame, const EdgeMembers& edges,
                                   const Combination& combination) {
  CombinationLoads loads{loads_beside_members(building, combination), {}, {}, {}};
  loads.set = load_set(building, edges, loads.parts, member_loads(building, combination), &loads.edge_forces);
  if (!has_meshes(frame)) return loads;
  loads.whole = std::move(loads.set);
  loads.set = on_frame(building, frame, loads.parts, *loads.whole);
  return loads;
}

}  // namespace topple::structure
