#include "simulation/part_masses.h"

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
  const PartLoads loads = part_loads(building, combination);
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
}

MassProperties PartMasses::of(const Detached& part) const {
  MassProperties sum;
  for (const MemberId member : part.members) sum.add(of(member));
  for (const PanelId panel : part.panels) sum.add(of(panel));
  for (const NodeId node : part.nodes) sum.add(of(node));
  return sum;
}

}  // namespace topple::structure
