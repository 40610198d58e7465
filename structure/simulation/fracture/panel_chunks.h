#pragma once
// A panel that has come off, broken into chunks: their mass, shapes and meshes.
#include "simulation/fracture/broken_panel.h"

namespace topple::structure {

/// Breaks a whole panel of this mass where a point of the undeformed building is hit. Masses, first and second moments
/// of all chunks add up to those of the panel. `space`: as BrokenPanel has it. Empty when the hit breaks nothing out.
[[nodiscard]] std::vector<PanelChunk> break_panel(const Building& building, PanelId id, double mass,
                                                  const std::vector<Vec3>& space, const Vec3& at,
                                                  std::optional<double> radius,
                                                  const fracture::PanelSettings& settings);

/// The same for one that has been broken before: what the hit breaks out, then all the rest.
[[nodiscard]] std::vector<PanelChunk> break_up(BrokenPanel panel, const Vec3& at, std::optional<double> radius);

}  // namespace topple::structure
