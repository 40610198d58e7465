#pragma once
// Parts of shader sources that several programs share.

namespace topple::viewer {

/// Version, the block of per-picture values, and what every program may use.
extern const char* const picture_glsl;
/// sky_light(direction): what comes from there.
extern const char* const sky_glsl;
/// Surfaces of materials: colour, roughness and fine shape, computed from the place in the undeformed building.
extern const char* const materials_glsl;
/// Light on a surface: sun with shadows, sky, ground.
extern const char* const lighting_glsl;

}  // namespace topple::viewer
