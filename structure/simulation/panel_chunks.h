#pragma once
// A panel that has come off, broken into chunks: their mass, shapes and meshes.
#include <memory>
#include <optional>
#include <vector>

#include "simulation/mass_properties.h"
#include "topple/fracture/mesh.h"
#include "topple/fracture/panel_settings.h"

namespace topple::structure {

/// One convex chunk, in global axes of the undeformed building.
struct PanelChunk {
  MassProperties rest;
  double volume = 0;                           ///< m3
  std::vector<Vec3> hull;                      ///< corners of its collision shape, about the centre of mass
  std::shared_ptr<const fracture::Mesh> mesh;  ///< about the centre of mass
  bool hit = false;                            ///< the hit broke it out; else it is of the rest
};

/// Breaks a whole panel of this mass where a point of the undeformed building is hit. Masses, first and second moments
/// of all chunks add up to those of the panel. `space`: the eight corners of the panel's own collision shape, within
/// which the chunks' shapes stay, a little apart, so that none starts inside a neighbour or what the panel was joined
/// to. Empty when the hit breaks nothing out.
[[nodiscard]] std::vector<PanelChunk> break_panel(const Building& building, PanelId id, double mass,
                                                  const std::vector<Vec3>& space, const Vec3& at,
                                                  std::optional<double> radius,
                                                  const fracture::PanelSettings& settings);

}  // namespace topple::structure
