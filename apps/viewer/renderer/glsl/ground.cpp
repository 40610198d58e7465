// What is around the building: sky with clouds, trees on the horizon, a paved yard in a meadow.
#include "renderer/glsl/glsl.h"

namespace topple::viewer {

const char* const sky_fragment_glsl = R"(
in vec2 place;
out vec4 result;
vec3 direction(vec2 clip) {
  vec4 p = inverse_view_projection * vec4(clip, 1.0, 1.0);
  return normalize(p.xyz / p.w - eye.xyz);
}
// A layer of broken clouds, seen from below.
vec4 cloud(vec3 way) {
  if (way.z < 0.015) return vec4(0.0);
  vec2 q = 1.6 * way.xy / (way.z + 0.12);
  float body = clouds(vec3(q, 3.7)), fine = clouds(vec3(4.1 * q, 8.3));
  float cover = smoothstep(0.50, 0.78, 0.78 * body + 0.22 * fine);
  float thick = smoothstep(0.58, 0.95, 0.8 * body + 0.2 * fine);
  vec3 light = mix(vec3(1.00, 0.99, 0.97), vec3(0.68, 0.72, 0.79), thick) * (0.55 + 0.22 * max(0.0, dot(way, sun.xyz)));
  return vec4(light * sun_light(), cover * smoothstep(0.015, 0.16, way.z));
}
// Height of the trees on the horizon, as a slope.
float trees(vec3 way) {
  float turn = atan(way.y, way.x);
  return 0.003 + 0.008 * value_noise(vec3(9.0 * turn, 1.0, 0.0)) + 0.004 * value_noise(vec3(70.0 * turn, 2.0, 0.0)) +
         0.003 * value_noise(vec3(300.0 * turn, 3.0, 0.0));
}
void main() {
  vec3 way = direction(place);
  vec3 light = sky_light(normalize(vec3(way.xy, max(way.z, 0.004))));
  vec3 disc = sun_light() * 6.0 * smoothstep(0.99985, 0.99995, dot(way, sun.xyz));
  vec3 colour = light + disc;
  if (opacity.y > 0.5) {
    vec4 layer = cloud(way);
    colour = mix(colour, layer.rgb, layer.a);
    float edge = max(fwidth(way.z), 1e-4);
    float wood = 1.0 - smoothstep(-edge, edge, way.z - trees(way));
    vec3 leaves = mix(light, linear(vec3(0.26, 0.33, 0.26)), 0.60);
    colour = mix(colour, mix(far_land(way), leaves, smoothstep(-0.004, 0.004, way.z)), wood);
  }
  result = vec4(colour, 1.0);
}
)";

const char* const ground_vertex_glsl = R"(
layout(location = 0) in vec2 position;
out vec3 point;
void main() {
  point = vec3(eye.xy + position * sizes.x * 60.0, eye.w);
  gl_Position = view_projection * vec4(point, 1.0);
}
)";

const char* const ground_fragment_glsl = R"(
in vec3 point;
out vec4 result;
float lines(vec2 p, float spacing, float pixels) {
  vec2 q = p / spacing, width = fwidth(q) * pixels;
  vec2 near_line = abs(fract(q - 0.5) - 0.5);
  vec2 covered = (1.0 - smoothstep(0.5 * width, 1.5 * width, near_line)) * clamp(0.35 / width, 0.0, 1.0);
  return max(covered.x, covered.y);
}
// Gravel, with the grid: what colours that mean something lie on.
Surface gravel(float pixel) {
  float fine = mix(0.5, clouds(9.0 * point), seen(0.15, pixel));
  Surface s = Surface(linear(vec3(0.580, 0.570, 0.545)) * (0.82 + 0.16 * fine + 0.20 * clouds(0.11 * point)), 0.95, 0.0, 0.02 * (fine - 0.5));
  if (sizes.y > 0.0) {
    float calm = exp(-length(point.xy) / (5.0 * sizes.x));
    s.albedo *= 1.0 - 0.16 * calm * lines(point.xy, sizes.y, 1.0) - 0.20 * calm * lines(point.xy, sizes.y * 5.0, 1.3);
  }
  return s;
}
Surface meadow(float pixel) {
  float broad = clouds(0.045 * point), patch_of = clouds(0.33 * point), fine = mix(0.5, clouds(11.0 * point), seen(0.12, pixel));
  float blade = mix(0.5, value_noise(38.0 * point), seen(0.04, pixel));
  vec3 green = mix(linear(vec3(0.29, 0.34, 0.20)), linear(vec3(0.41, 0.41, 0.28)), smoothstep(0.3, 0.75, 0.6 * broad + 0.4 * patch_of));
  vec3 soil = linear(vec3(0.47, 0.41, 0.33));
  float bare = smoothstep(0.60, 0.74, 0.55 * patch_of + 0.45 * clouds(1.1 * point + 5.0));
  Surface s = Surface(mix(green, soil, 0.7 * bare) * (0.62 + 0.44 * fine + 0.32 * blade), 0.97, 0.0, 0.0);
  s.height = 0.035 * (fine - 0.5) + 0.012 * blade;
  return s;
}
// Slabs of 1.2 m, laid with joints, stained and worn.
Surface paving(float pixel) {
  vec2 q = point.xy / 1.2, wide = fwidth(q);
  float own = hash(vec3(floor(q), 2.0)), fine = mix(0.5, clouds(23.0 * point), seen(0.06, pixel));
  float joint = 1.0 - (1.0 - lines_covered(q.x, 0.012, wide.x)) * (1.0 - lines_covered(q.y, 0.012, wide.y));
  float stain = clouds(0.42 * point), spot = smoothstep(0.66, 0.80, clouds(2.3 * point + 9.0));
  Surface s = Surface(linear(vec3(0.560, 0.550, 0.525)) * (0.66 + 0.42 * stain + 0.10 * fine), 0.9, 0.0, 0.002 * fine);
  s.albedo *= mix(1.0, 0.90 + 0.18 * own, seen(1.2, pixel)) * (1.0 - 0.16 * spot) * (1.0 - 0.6 * joint);
  return s;
}
Surface yard(float pixel) {
  // The plot ends six metres from the building with a kerb; grass grows in from its border.
  float out_by = length(max(abs(point.xy) - plot.xy - vec2(6.0), 0.0)) + min(0.0, max(abs(point.x) - plot.x, abs(point.y) - plot.y) - 6.0);
  float ragged = out_by + 0.5 * (clouds(1.3 * point) - 0.5);
  float grass = smoothstep(-0.02 - pixel, 0.06 + pixel, out_by - 0.15);
  Surface s = paving(pixel), m = meadow(pixel);
  s.albedo = mix(s.albedo, linear(vec3(0.42, 0.37, 0.29)), 0.55 * smoothstep(-1.6, 0.1, ragged));
  float kerb = smoothstep(-0.15 - pixel, -0.15 + pixel, out_by) * (1.0 - grass);
  s.albedo = mix(s.albedo, linear(vec3(0.66, 0.64, 0.60)), 0.8 * kerb);
  return Surface(mix(s.albedo, m.albedo, grass), mix(s.roughness, m.roughness, grass), 0.0, mix(s.height, m.height, grass));
}
void main() {
  float away = length(point.xy - eye.xy), far = 1.0 - exp(-away / (14.0 * sizes.x)), pixel = length(fwidth(point));
  vec3 up = vec3(0, 0, 1), way = normalize(point - eye.xyz);
  bool real = opacity.y > 0.5;
  Surface s;
  if (real) s = yard(pixel); else s = gravel(pixel);
  vec3 lit = shade(s, bumped(up, point, s.height), point, up);
  vec3 haze_there = real ? far_land(way) : sky_light(normalize(vec3(way.xy, 0.004)));
  result = vec4(mix(lit, haze_there, far * far), 1.0);
}
)";

}  // namespace topple::viewer
