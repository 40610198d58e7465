// Dust, smoke and flames: soft discs that face the eye, lit as balls, ragged by noise that drifts with them.
#include "renderer/glsl/glsl.h"

namespace topple::viewer {

const char* const dust_vertex_glsl = R"(
layout(location = 0) in vec3 centre;
layout(location = 1) in float radius;
layout(location = 2) in float density;
layout(location = 3) in vec4 colour;  // alpha: how far it glows by itself
layout(location = 4) in float seed;
uniform sampler2DArrayShadow shadow_map;
out vec2 place;
out float height, thickness, share, own, sunny, glow;
out vec3 tint, side, up, toward;
float in_sun(vec3 p) {
  if (sun.w < 0.5) return 1.0;
  for (int k = 0; k < 3; ++k) {
    vec3 q = (light[k] * vec4(p, 1.0)).xyz * 0.5 + 0.5;
    if (all(greaterThan(q, vec3(0.004))) && all(lessThan(q, vec3(0.996)))) return texture(shadow_map, vec4(q.xy, float(k), q.z));
  }
  return 1.0;
}
void main() {
  place = vec2(gl_VertexID % 2 == 0 ? -1.0 : 1.0, gl_VertexID < 2 ? -1.0 : 1.0);
  vec3 away = centre - eye.xyz;
  side = normalize(cross(away, abs(away.z) > 0.99 * length(away) ? vec3(1, 0, 0) : vec3(0, 0, 1)));
  up = normalize(cross(side, away));
  toward = -normalize(away);
  vec3 point = centre + radius * (place.x * side + place.y * up);
  height = point.z - eye.w;
  thickness = radius;
  share = density;
  own = seed;
  tint = linear(colour.rgb);
  glow = colour.a;
  // A cloud is as large as some places of it: three along its width.
  sunny = (in_sun(centre) + in_sun(centre + 0.6 * radius * side) + in_sun(centre - 0.6 * radius * side)) / 3.0;
  gl_Position = view_projection * vec4(point, 1.0);
}
)";

const char* const dust_fragment_glsl = R"(
in vec2 place;
in float height, thickness, share, own, sunny, glow;
in vec3 tint, side, up, toward;
out vec4 result;
uniform sampler2D depth_map;
float metres(float depth) { return picture.z * picture.w / (picture.w - depth * (picture.w - picture.z)); }
void main() {
  float r2 = dot(place, place);
  if (r2 >= 1.0) discard;
  // Billows, and what is torn off them.
  float broad = clouds(vec3(2.4 * place, 5.0 * own) + 31.0 * own), fine = clouds(vec3(7.5 * place, 9.0 * own) + 17.0 * own);
  float noise = 0.62 * broad + 0.38 * fine;
  // Ragged: noise eats from the rim inwards.
  float body = 1.0 - r2, soft = smoothstep(0.12, 1.05, body * (0.05 + 1.9 * noise));
  // No edge is seen where the ground or a wall cuts the disc.
  float behind = metres(texelFetch(depth_map, ivec2(gl_FragCoord.xy), 0).r) - metres(gl_FragCoord.z);
  soft *= smoothstep(-0.05 * thickness, 0.7 * thickness, behind) * smoothstep(0.0, 0.35 * thickness, height);
  vec3 normal = normalize(place.x * side + place.y * up + (0.4 + sqrt(body)) * toward + 0.6 * (noise - 0.5) * side);
  // Light goes through and is scattered on: the far side is not dark.
  float facing = 0.45 + 0.55 * max(0.0, dot(normal, sun.xyz));
  vec3 lit = tint * (sun_light() * (0.10 + 0.75 * sunny) * facing + 0.9 * sky_from(normal));
  vec3 own_light = tint * tint * 9.0 * (0.5 + noise);
  result = vec4(mix(lit, own_light, glow), share * soft);
}
)";

}  // namespace topple::viewer
