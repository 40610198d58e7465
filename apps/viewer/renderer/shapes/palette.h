#pragma once
// Colours of parts and joints, as 8-bit sRGB. The alpha of a joint's colour says how far it covers the part's own.
#include <cstdint>
#include <glm/vec4.hpp>

#include "renderer/snapshot.h"
#include "renderer/view_options.h"
#include "topple/structure/piece_kind.h"

namespace topple::viewer {

using Rgba = std::uint32_t;  ///< red in the lowest byte, as OpenGL reads it
[[nodiscard]] constexpr Rgba rgba(unsigned red, unsigned green, unsigned blue, unsigned alpha = 255) {
  return red | green << 8U | blue << 16U | alpha << 24U;
}
/// Components 0 to 1.
[[nodiscard]] Rgba rgba(glm::vec4 colour);
[[nodiscard]] glm::vec4 unpack(Rgba colour);
/// The same colour with another alpha, 0 to 1.
[[nodiscard]] Rgba with_alpha(Rgba colour, double alpha);

[[nodiscard]] Rgba member_colour(structure::MemberKind kind);
[[nodiscard]] Rgba panel_colour(structure::PanelKind kind);
[[nodiscard]] Rgba piece_colour(structure::PieceKind kind);
inline constexpr Rgba projectile_colour = rgba(58, 52, 54), drawn_colour = rgba(214, 200, 176),
                      plain_member = rgba(150, 155, 160);

struct JointPalette {
  Rgba force, torque, both, failed;
  Rgba yielded = rgba(250, 250, 250);  ///< of marks: no other colour stays apart from those of all views for everyone
};
[[nodiscard]] JointPalette joint_palette(bool colour_blind_safe);

/// The utilisation map: dark at 0, bright yellow at 1, red above (viridis-like, so that it reads in print and by
/// everyone).
[[nodiscard]] Rgba utilisation_colour(double utilisation);
/// Signed share from -1 (blue) over 0 (grey) to 1 (red).
[[nodiscard]] Rgba signed_colour(double share);

/// Colours that tell connected parts apart: neighbours in number differ most.
[[nodiscard]] Rgba segment_colour(std::int64_t number, bool colour_blind_safe);
inline constexpr Rgba load_colour = rgba(126, 60, 190), reaction_colour = rgba(16, 134, 74),
                      contact_colour = rgba(236, 112, 20);

/// Colour of a joint; `largest` is the largest value in view that Scale::largest_in_view refers to.
[[nodiscard]] Rgba joint_colour(const FrameAnswer::Joint& joint, const structure::JointCapacity& capacity,
                                const ViewOptions& options, double largest);
/// Of joints that failed, in this view.
[[nodiscard]] Rgba failed_colour(const ViewOptions& options);
/// The value that joint_colour compares with `largest`.
[[nodiscard]] double joint_value(const FrameAnswer::Joint& joint, const ViewOptions& options);

}  // namespace topple::viewer
