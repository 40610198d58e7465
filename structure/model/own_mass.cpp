#include "model/own_mass.h"

#include "model/panel_area.h"

namespace topple::structure {

double own_mass(const Building& building, MemberId member) {
  const Member& one = building[member];
  return building[one.section].area * one.length * building[one.material].density;
}

double own_mass(const Building& building, PanelId panel) {
  const Panel& one = building[panel];
  return panel_area(building, one, true) * one.thickness * building[one.material].density;
}

double own_mass(const Building& building) {
  double mass = 0;
  for (std::size_t m = 0; m < building.members.size(); ++m) mass += own_mass(building, MemberId(m));
  for (std::size_t p = 0; p < building.panels.size(); ++p) mass += own_mass(building, PanelId(p));
  return mass;
}

}  // namespace topple::structure
