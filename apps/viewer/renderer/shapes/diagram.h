#pragma once
// Internal forces drawn along a member, as an engineer draws them: bending moments on the side that they tense.
#include <array>
#include <glm/vec2.hpp>

#include "renderer/instances/instance_batch.h"
#include "renderer/shapes/overlay.h"

namespace topple::viewer {

/// Local direction in which positive values of each of the six forces are drawn: axial, torsion and shears along the
/// member's z or y, moments towards the fibres in tension (+z for moment_y, -y for moment_z).
[[nodiscard]] glm::vec3 diagram_direction(int component);

/// Adds one member's diagram: a filled band, its outline and ordinates; positive and negative parts in the colours of
/// signed_colour(). `values`: intervals + 1 of them at even places; `reach`: drawn length for a value of 1.
void add_diagram(Overlay& overlay, const MemberInstance& member, const float* values, int intervals, int component,
                 float reach);

/// A box of a member or the border of a panel in lines that are never hidden, for what is hovered over or selected.
void add_mark(Overlay& overlay, const MemberInstance& member, glm::vec2 half_size, Rgba colour);
void add_mark(Overlay& overlay, const PanelInstance& panel, Rgba colour);

}  // namespace topple::viewer
