// Light on surfaces.
#include "renderer/glsl/glsl.h"

namespace topple::viewer {

// Reflection by Trowbridge and Reitz' facets (GGX: Walter and others 2007), their shadowing by Smith in Hammon's form
// (2017), Fresnel's law by Schlick (1994). Shadows: three maps for near, middle and far; the first that holds the
// place. A fourth looks straight down: what lies under a roof gets less of the sky.
const char* const lighting_glsl = R"(
uniform sampler2DArrayShadow shadow_map;
float gradient_noise(vec2 p) { return fract(52.9829189 * fract(dot(p, vec2(0.06711056, 0.00583715)))); }
float sunlight(vec3 point, vec3 normal) {
  if (sun.w < 0.5) return 1.0;
  float slope = 1.0 - max(0.0, dot(normal, sun.xyz));
  for (int k = 0; k < 3; ++k) {
    vec4 clip = light[k] * vec4(point + normal * texels[k] * (1.0 + 3.0 * slope), 1.0);
    vec3 p = clip.xyz * 0.5 + 0.5;
    if (any(lessThan(p, vec3(0.004, 0.004, 0.0))) || any(greaterThan(p, vec3(0.996, 0.996, 1.0)))) continue;
    float texel = 1.0 / float(textureSize(shadow_map, 0).x);
    // The sun's disc is half a degree wide: edges are as soft as far casters make them, within two texels and six.
    float reach = clamp(0.05 / texels[k], 1.6, 5.0) * texel;
    float angle = 6.2831853 * gradient_noise(gl_FragCoord.xy), lit = 0.0;
    for (int i = 0; i < 12; ++i) {  // Vogel's disk
      float r = sqrt((float(i) + 0.5) / 12.0) * reach, a = angle + 2.3999632 * float(i);
      lit += texture(shadow_map, vec4(p.xy + r * vec2(cos(a), sin(a)), float(k), p.z));
    }
    return lit / 12.0;
  }
  return 1.0;
}
// Share of the sky above a place that nothing covers, by eight rays within a cone of 45 degrees.
float open_sky(vec3 point, vec3 normal) {
  // Where colours or bare frames are read, nothing is dark that panels cover which are seen through.
  if (sun.w < 0.5 || opacity.y < 0.5) return 1.0;
  const float reach = 2.4;  // m: about a room's half width
  float angle = 6.2831853 * gradient_noise(gl_FragCoord.xy + 17.0), open = 0.0;
  for (int i = 0; i < 8; ++i) {
    float r = sqrt((float(i) + 0.5) / 8.0) * reach, a = angle + 2.3999632 * float(i);
    vec3 from = point + normal * 0.25 + vec3(normal.xy * r + r * vec2(cos(a), sin(a)), r + 0.1);
    vec3 p = (light[3] * vec4(from, 1.0)).xyz * 0.5 + 0.5;
    open += any(lessThan(p, vec3(0.0))) || any(greaterThan(p, vec3(1.0))) ? 1.0 : texture(shadow_map, vec4(p.xy, 3.0, p.z));
  }
  return open / 8.0;
}
vec3 reflected(Surface s, vec3 n, vec3 v, vec3 l) {
  vec3 h = normalize(v + l), f0 = mix(vec3(0.04), s.albedo, s.metal);
  float nl = max(dot(n, l), 0.0), nv = max(dot(n, v), 1e-3), nh = max(dot(n, h), 0.0), a = s.roughness * s.roughness;
  float spread = nh * nh * (a * a - 1.0) + 1.0;
  float facets = a * a / (3.14159265 * spread * spread);
  float seen_both = 0.5 / mix(2.0 * nl * nv, nl + nv, a);
  vec3 fresnel = f0 + (1.0 - f0) * pow(1.0 - max(dot(v, h), 0.0), 5.0);
  return ((1.0 - fresnel) * (1.0 - s.metal) * s.albedo / 3.14159265 + min(facets * seen_both, 8.0) * fresnel) * nl;
}
vec3 shade(Surface s, vec3 normal, vec3 point, vec3 flat_normal) {
  vec3 v = normalize(eye.xyz - point);
  float facing = dot(flat_normal, sun.xyz);
  float lit = facing > 0.0 ? sunlight(point, flat_normal) * smoothstep(0.0, 0.08, facing) : 0.0;
  vec3 result = 3.14159265 * sun_light() * lit * reflected(s, normal, v, sun.xyz);
  vec3 f0 = mix(vec3(0.04), s.albedo, s.metal);
  vec3 fresnel = f0 + (max(vec3(1.0 - s.roughness), f0) - f0) * pow(1.0 - max(dot(normal, v), 0.0), 5.0);
  vec3 mirrored = reflect(-v, normal);
  vec3 sharp = mirrored.z > 0.0 ? sky_light(mirrored) : earth * sun_light() * 0.5;
  vec3 around = mix(sharp, sky_from(mirrored), smoothstep(0.05, 0.6, s.roughness));
  // Light that comes back from what stands around, away from the sun.
  float back = 0.10 * max(0.0, dot(normal, normalize(vec3(-sun.x, -sun.y, 0.25))));
  float open = mix(0.30, 1.0, open_sky(point, flat_normal));
  result += open * (1.0 - fresnel) * (1.0 - s.metal) * s.albedo * (sky_from(normal) + back);
  return result + open * fresnel * around * (1.0 - 0.6 * s.roughness);
}
// Double glazing of clear float glass: its four faces mirror, by Schlick's form of Fresnel's law at a refractive index of
// 1.5, which is 0.14 of what comes straight on, and 0.07 of the rest stays in it: EN 410 has about 0.80 for what goes
// through. Where it is broken, light is scattered out of the edge.
vec4 glass(vec3 tint, vec3 normal, vec3 point, float broken) {
  vec3 v = normalize(eye.xyz - point);
  float one = 0.04 + 0.96 * pow(1.0 - abs(dot(normal, v)), 5.0), all_faces = 4.0 * one / (1.0 + 3.0 * one);
  vec3 mirrored = reflect(-v, normal);
  vec3 around = mirrored.z > 0.0 ? sky_light(mirrored) : earth * sun_light() * 0.5;
  float lit = sunlight(point, normal);
  vec3 glint = sun_light() * lit * 40.0 * pow(max(dot(mirrored, sun.xyz), 0.0), 3000.0);
  float kept = mix(0.07, 0.65, broken);
  vec3 body = mix(tint, linear(vec3(0.62, 0.78, 0.74)), broken) * (sky_from(normal) + 0.35 * lit * sun_light());
  float opaque = all_faces + (1.0 - all_faces) * kept;
  return vec4((all_faces * (around + glint) + (1.0 - all_faces) * kept * body) / opaque, opaque);
}
vec3 shade_plain(vec3 albedo, vec3 normal, vec3 point, float roughness) {
  return shade(Surface(albedo, roughness, 0.0, 0.0), normal, point, normal);
}
// Of members, whose colours may carry a meaning.
vec3 shade_even(vec3 albedo, vec3 normal, vec3 point) {
  vec3 even = albedo * (1.35 + 0.25 * normal.z + 0.15 * dot(normal, normalize(eye.xyz - point)));
  return mix(shade_plain(albedo, normal, point, 0.6), even, mode.w);
}
)";

}  // namespace topple::viewer
