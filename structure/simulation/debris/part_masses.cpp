#include "simulation/debris/part_masses.h"

#include <algorithm>

#include "model/index_of.h"
#include "topple/structure/error.h"

namespace topple::structure {

namespace {

void require_mass(const Building& building, CombinationId combination, const char* place, const std::string& name,
                  double mass) {
  if (mass > 0) return;
  throw InputError(building.file + ": " + place + "." + name + ": weighs nothing in combination \"" +
                   building[combination].name +
                   "\"; expected a downward load (self weight, pressure or member load) above 0");
}

}  // namespace

PartMasses::PartMasses(const Building& building, CombinationId combination, const StandingFrame& frame) {
  PartLoads loads = part_loads(building, combination);
  for (std::size_t i = 0; i < building.members.size(); ++i) {
    const Member& member = building.members[i];
    require_mass(building, combination, "members", member.name, frame.mass(MemberId(i)));
    members_.push_back(member_mass(building, member, line_mass(member, loads.members[i], building.gravity)));
  }
  for (std::size_t i = 0; i < building.panels.size(); ++i) {
    const double mass = frame.mass(PanelId(i));
    require_mass(building, combination, "panels", building.panels[i].name, mass);
    panels_.push_back(panel_mass(building, building.panels[i], mass));
  }
  for (std::size_t i = 0; i < building.nodes.size(); ++i)
    nodes_.push_back(point_mass(building.nodes[i].position, frame.node_mass(NodeId(i))));
  member_loads_ = std::move(loads.members);
}

MassProperties PartMasses::of(const Building& building, MemberId id, double from, double to) const {
  const Member& member = building[id];
  const auto& all = member_loads_[index_of(id)];
  std::vector<solver::BeamLoad> there;
  for (solver::BeamLoad load : all) {
    if (load.kind == solver::BeamLoad::Kind::point) {
      if (load.from >= from && (load.from < to || to == member.length)) there.push_back(load);
    } else if (load.kind == solver::BeamLoad::Kind::distributed) {
      const double begin = std::max(load.from, from), end = std::min(load.to, to);
      if (!(end > begin)) continue;
      const auto at = [&](double x) -> Vec6 {
        return load.first + (x - load.from) / (load.to - load.from) * (load.last - load.first);
      };
      const Vec6 first = at(begin), last = at(end);
      load.first = first;
      load.last = last;
      load.from = begin;
      load.to = end;
      there.push_back(load);
    }
  }
  const LineMass line = line_mass(member, there, building.gravity);
  return line.mass > 0 ? member_mass(building, member, line) : MassProperties();
}

MassProperties PartMasses::of(const Detached& part) const {
  MassProperties sum;
  for (const MemberId member : part.members) sum.add(of(member));
  for (const PanelId panel : part.panels) sum.add(of(panel));
  for (const NodeId node : part.nodes) sum.add(of(node));
  return sum;
}

}  // namespace topple::structure
