#include "renderer/shapes/palette.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>

namespace topple::viewer {
namespace {

glm::vec4 blend(Rgba a, Rgba b, double share) { return glm::mix(unpack(a), unpack(b), static_cast<float>(share)); }

/// Full red, green or yellow: the smaller share turns the larger one's hue towards both.
Rgba force_torque_hue(double force, double torque, const JointPalette& palette) {
  const double larger = std::max(force, torque);
  if (larger <= 0) return palette.force;
  const double both = std::min(force, torque) / larger;
  return rgba(blend(force > torque ? palette.force : palette.torque, palette.both, both));
}

double component_share(const FrameAnswer::Joint& joint, const structure::JointCapacity& capacity,
                       const ViewOptions& options, double largest) {
  const auto c = static_cast<std::size_t>(options.component);
  const double demand = joint.demand[c];
  if (options.scale == Scale::largest_in_view) return largest > 0 ? demand / largest : 0;
  constexpr std::array<structure::Sense, 6> senses{structure::Sense::tension,  structure::Sense::shear_y,
                                                   structure::Sense::shear_z,  structure::Sense::torsion,
                                                   structure::Sense::moment_y, structure::Sense::moment_z};
  const structure::Sense sense = c == 0 && demand < 0 ? structure::Sense::compression : senses[c];
  return demand / (joint.strength * capacity.value[static_cast<std::size_t>(sense)]);
}

}  // namespace

Rgba rgba(glm::vec4 colour) {
  const auto byte = [](float x) { return static_cast<unsigned>(std::lround(255 * std::clamp(x, 0.0F, 1.0F))); };
  return rgba(byte(colour.r), byte(colour.g), byte(colour.b), byte(colour.a));
}

glm::vec4 unpack(Rgba colour) {
  const auto part = [colour](unsigned shift) { return static_cast<float>(colour >> shift & 0xFFU) / 255.0F; };
  return {part(0), part(8), part(16), part(24)};
}

Rgba with_alpha(Rgba colour, double alpha) {
  return (colour & 0x00FFFFFFU) | static_cast<Rgba>(std::lround(255 * std::clamp(alpha, 0.0, 1.0))) << 24U;
}

Rgba member_colour(structure::MemberKind kind) {
  switch (kind) {
    case structure::MemberKind::post:
      return rgba(92, 106, 122);
    case structure::MemberKind::beam:
      return rgba(140, 152, 164);
    case structure::MemberKind::brace:
      return rgba(164, 120, 92);
  }
  return plain_member;
}

Rgba panel_colour(structure::PanelKind kind) {
  return kind == structure::PanelKind::slab ? rgba(206, 200, 190) : rgba(222, 205, 180);
}

Rgba piece_colour(structure::PieceKind kind) {
  switch (kind) {
    case structure::PieceKind::slab:
      return panel_colour(structure::PanelKind::slab);
    case structure::PieceKind::wall:
      return panel_colour(structure::PanelKind::wall);
    case structure::PieceKind::post:
      return member_colour(structure::MemberKind::post);
    case structure::PieceKind::beam:
      return member_colour(structure::MemberKind::beam);
    case structure::PieceKind::brace:
      return member_colour(structure::MemberKind::brace);
  }
  return plain_member;
}

JointPalette joint_palette(bool colour_blind_safe) {
  // Okabe and Ito's colours where red and green must not be told apart.
  if (colour_blind_safe) return {rgba(230, 159, 0), rgba(86, 180, 233), rgba(204, 121, 167), rgba(20, 20, 20)};
  return {rgba(226, 38, 30), rgba(28, 176, 58), rgba(248, 206, 32), rgba(30, 78, 232)};
}

Rgba utilisation_colour(double utilisation) {
  constexpr std::array<Rgba, 6> map{rgba(68, 1, 84),   rgba(59, 82, 139),  rgba(33, 145, 140),
                                    rgba(94, 201, 98), rgba(253, 231, 37), rgba(253, 231, 37)};
  if (utilisation > 1) return rgba(235, 40, 28);
  const double place = 4 * std::clamp(utilisation, 0.0, 1.0);
  const auto i = static_cast<std::size_t>(place);
  return rgba(blend(map[i], map[i + 1], place - static_cast<double>(i)));
}

Rgba signed_colour(double share) {
  constexpr Rgba negative = rgba(33, 90, 200), none = rgba(196, 196, 196), positive = rgba(205, 40, 36);
  return rgba(blend(none, share < 0 ? negative : positive, std::min(1.0, std::abs(share))));
}

Rgba segment_colour(std::int64_t number, bool colour_blind_safe) {
  // Okabe and Ito's, without black.
  constexpr std::array<Rgba, 7> safe{rgba(0, 114, 178),  rgba(230, 159, 0), rgba(0, 158, 115), rgba(204, 121, 167),
                                     rgba(86, 180, 233), rgba(213, 94, 0),  rgba(240, 228, 66)};
  if (colour_blind_safe) return safe[static_cast<std::size_t>(number) % safe.size()];
  // Hues by the golden ratio: any run of numbers is spread evenly round the circle.
  const double hue = 6 * std::fmod(0.42 + 0.6180339887498949 * static_cast<double>(number), 1.0);
  const double chroma = 0.62, low = 0.24;
  const auto channel = [&](double shift) {
    const double x = std::fmod(hue + shift, 6.0);
    return static_cast<float>(low + chroma * std::clamp(std::min(x, 4 - x), 0.0, 1.0));
  };
  return rgba(glm::vec4(channel(2), channel(0), channel(4), 1));
}

Rgba failed_colour(const ViewOptions& options) {
  // Blue already says something in these views.
  const bool map = options.colouring == Colouring::component || options.colouring == Colouring::utilisation ||
                   options.colouring == Colouring::path || options.colouring == Colouring::segments;
  return map ? rgba(20, 20, 20) : joint_palette(options.colour_blind_safe).failed;
}

double joint_value(const FrameAnswer::Joint& joint, const ViewOptions& options) {
  if (options.colouring == Colouring::component)
    return std::abs(joint.demand[static_cast<std::size_t>(options.component)]);
  return std::max(joint.force_share, joint.torque_share);
}

Rgba joint_colour(const FrameAnswer::Joint& joint, const structure::JointCapacity& capacity, const ViewOptions& options,
                  double largest) {
  const JointPalette palette = joint_palette(options.colour_blind_safe);
  if (options.colouring == Colouring::materials) return 0;
  if (!joint.intact) return with_alpha(failed_colour(options), options.failed_joints ? 1 : 0);
  if (options.colouring == Colouring::plain || options.colouring == Colouring::segments ||
      options.colouring == Colouring::path || !joint.standing)
    return 0;
  if (options.colouring == Colouring::utilisation) return utilisation_colour(joint.utilisation);
  if (options.colouring == Colouring::component)
    return signed_colour(component_share(joint, capacity, options, largest));
  const double full = options.scale == Scale::capacity ? 1.0 : std::max(largest, 1e-9);
  const double force = joint.force_share / full, torque = joint.torque_share / full;
  // The root: at a third of the capacity a joint is to be seen, not only near its failure.
  return with_alpha(force_torque_hue(force, torque, palette), std::sqrt(std::max(force, torque)));
}

}  // namespace topple::viewer
