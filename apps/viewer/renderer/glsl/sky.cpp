// The block of per-picture values, and the sky.
#include "renderer/glsl/glsl.h"

namespace topple::viewer {

const char* const picture_glsl = R"(#version 330 core
layout(std140) uniform Picture {
  mat4 view_projection, inverse_view_projection, light[4];
  vec4 eye, sun, sizes, picture, mode, opacity, reaches, texels, plot;
};
vec3 linear(vec3 srgb) { return pow(srgb, vec3(2.2)); }
vec3 turn(vec4 q, vec3 v) { return v + 2.0 * cross(q.xyz, cross(q.xyz, v) + q.w * v); }
const vec3 earth = vec3(0.30, 0.28, 0.25);
// What is seen through is drawn by itself, after all else.
bool drawn_now(int material) { return (material == 4) == (opacity.w > 0.5); }
const vec4 not_drawn = vec4(0.0, 0.0, 2.0, 1.0);
)";

// Light scattered once in a clear atmosphere of even layers (air over 8 km, haze over 1.2 km), seen through the
// relative air mass of Kasten and Young (Applied Optics 28, 1989); Rayleigh's and Henyey and Greenstein's phase
// functions.
const char* const sky_glsl = R"(
const vec3 air = vec3(0.046, 0.108, 0.265);  // optical depth upwards at 680, 550, 440 nm
const vec3 haze = vec3(0.03);
float air_mass(float height) {
  float h = clamp(height, 0.0, 1.0), degrees_down = 57.29578 * acos(h);
  return 1.0 / (h + 0.50572 * pow(96.07995 - degrees_down, -1.6364));
}
vec3 sun_light() { return 2.75 * exp(-(air + haze) * air_mass(sun.z)); }
vec3 sky_light(vec3 direction) {
  float mu = dot(direction, sun.xyz), g = 0.72;
  float rayleigh = 0.75 * (1.0 + mu * mu), mie = (1.0 - g * g) / pow(1.0 + g * g - 2.0 * g * mu, 1.5);
  // What far air scatters has come a longer way as well: beyond this many masses the sky grows no paler.
  vec3 through = exp(-(air + haze) * min(9.0, air_mass(max(direction.z, 0.0))));
  // Light scattered more than once brightens the sky evenly: about a third as much again.
  vec3 scattered = (air * (rayleigh + 0.45) + haze * (0.55 * mie + 0.45)) / (air + haze) * (1.0 - through);
  return 1.25 * scattered * exp(-0.5 * (air + haze) * air_mass(sun.z));
}
// Meadows and woods too far off to be told apart, through the air before them.
vec3 far_land(vec3 direction) { return mix(sky_light(normalize(vec3(direction.xy, 0.004))), linear(vec3(0.40, 0.43, 0.35)), 0.60); }
// Over all of the half space about a normal, from a few directions.
vec3 sky_from(vec3 normal) {
  float up = 0.5 + 0.5 * normal.z;
  vec3 zenith = sky_light(vec3(0.0, 0.0, 1.0)), side = sky_light(normalize(vec3(normal.xy * 0.8 + 1e-4, 0.35)));
  vec3 above = mix(side, zenith, 0.35 + 0.45 * up);
  // Clouds are a part of what is above, and white.
  above = mix(above, vec3(1.15 * dot(above, vec3(0.30, 0.59, 0.11))), 0.45);
  vec3 ground = earth * (0.35 * sun_light() * max(sun.z, 0.0) + 0.6 * zenith);
  return 1.2 * mix(ground, above, up * up * (3.0 - 2.0 * up));
}
)";

}  // namespace topple::viewer
