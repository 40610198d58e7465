#include <algorithm>
#include <array>

#include "formats/geometry.h"
#include "formats/physical_model.h"
#include "topple/structure/error.h"
#include "topple/structure/formats/files.h"
#include "topple/structure/frame.h"

namespace topple::structure {

namespace {

[[noreturn]] void refuse(const Building& building, const std::string& place, const std::string& what) {
  throw InputError(building.file + ", " + place + ": " + what + " is not built yet; accepted: leave it out");
}

// Each function refuses one feature; a feature that is built for one purpose is left out of that purpose's list below.

/// A membrane is one element and a cladding none.
void refuse_meshes_of_panels(const Building& building) {
  for (const Panel& panel : building.panels)
    if (panel.model != PanelModel::shell && panel.mesh != std::array<int, 2>{1, 1})
      throw InputError(building.file + ", panels." + panel.name + ".mesh: found a mesh in a " +
                       std::string(panel.model == PanelModel::membrane ? "membrane" : "cladding") +
                       "; accepted: \"model\": \"shell\", or leave it out");
}
void refuse_semi_rigid_edges(const Building& building) {
  for (const Joint& joint : building.joints)
    if (joint.panel.valid() && (joint.stiffness.array() != unlimited).any())
      refuse(building, "joint " + joint.name, "`stiffness` of a shell's edge");
}
void refuse_one_way_members(const Building& building) {
  for (const Member& member : building.members)
    if (member.axial != AxialAction::both)
      refuse(building, "members." + member.name + ".axial",
             member.axial == AxialAction::tension ? "\"tension\"" : "\"compression\"");
}
/// Bodies and fractures of panels are plane.
void refuse_warped_shells(const Building& building) {
  for (const Panel& panel : building.panels) {
    std::array<Vec3, 4> corners;
    for (std::size_t i = 0; i < 4; ++i) corners[i] = building[panel.nodes[i]].position;
    if (formats::panel_geometry(corners).warp > formats::largest_warp)
      refuse(building, "panels." + panel.name, "a panel that is warped by more than 1 % of its longer diagonal");
  }
}
void refuse_diaphragms(const Building& building) {
  for (const Diaphragm& diaphragm : building.diaphragms)
    refuse(building, "diaphragms." + diaphragm.name, "a diaphragm");
}

}  // namespace

void refuse_unbuilt(const Building& building, Purpose purpose) {
  using Refusal = void (*)(const Building&);
  static constexpr std::array<Refusal, 1> analyse{refuse_meshes_of_panels};
  static constexpr std::array<Refusal, 5> demolish{refuse_meshes_of_panels, refuse_semi_rigid_edges,
                                                   refuse_one_way_members, refuse_warped_shells, refuse_diaphragms};
  switch (purpose) {
    case Purpose::analyse:
      for (const Refusal refusal : analyse) refusal(building);
      break;
    case Purpose::demolish:
      for (const Refusal refusal : demolish) refusal(building);
      formats::require_physical(building);
      break;
    case Purpose::inspect:
      break;
  }
}

}  // namespace topple::structure
