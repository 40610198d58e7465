#pragma once
// Parts of shader sources that several programs share.

namespace topple::viewer {

/// Version, the block of per-picture values, and what every program may use.
extern const char *const picture_glsl;
/// sky_light(direction): what comes from there.
extern const char *const sky_glsl;
/// Surfaces of materials: colour, roughness and fine shape, computed from the place in the undeformed building.
extern const char *const materials_glsl;
/// Light on a surface: sun with shadows, sky, ground.
extern const char *const lighting_glsl;
/// The sky with its clouds and the trees on the horizon; the ground about the building.
extern const char *const sky_fragment_glsl, *const ground_vertex_glsl, *const ground_fragment_glsl;
/// One soft disc of dust, smoke or flame.
extern const char *const dust_vertex_glsl, *const dust_fragment_glsl;

}  // namespace topple::viewer
