// What materials look like: computed, no picture files.
#include "renderer/glsl/glsl.h"

namespace topple::viewer {

// The numbers of materials are those of renderer/shapes/looks.h. Fine shape bends the normal by the height's slope on
// the screen: Mikkelsen, Bump Mapping Unparametrized Surfaces on the GPU (2010). What is finer than a pixel fades.
const char* const materials_glsl = R"(
struct Surface { vec3 albedo; float roughness, metal, height; };
float hash(vec3 p) {
  uvec3 q = uvec3(ivec3(floor(p)) + 32768);
  uint n = q.x * 1597334677u ^ q.y * 3812015801u ^ q.z * 2798796415u;
  n = (n ^ (n >> 15)) * 2246822519u;
  return float((n ^ (n >> 13)) & 0xFFFFFFu) / 16777216.0;
}
float value_noise(vec3 p) {
  vec3 i = floor(p), f = fract(p);
  f = f * f * (3.0 - 2.0 * f);
  vec4 low = vec4(hash(i), hash(i + vec3(1, 0, 0)), hash(i + vec3(0, 1, 0)), hash(i + vec3(1, 1, 0)));
  vec4 high = vec4(hash(i + vec3(0, 0, 1)), hash(i + vec3(1, 0, 1)), hash(i + vec3(0, 1, 1)), hash(i + vec3(1, 1, 1)));
  vec4 mid = mix(low, high, f.z);
  return mix(mix(mid.x, mid.y, f.x), mix(mid.z, mid.w, f.x), f.y);
}
float clouds(vec3 p) { return 0.53 * value_noise(p) + 0.31 * value_noise(2.1 * p + 7.3) + 0.16 * value_noise(4.3 * p + 19.1); }
// Share of a pattern of this size (m) that a pixel of this width still shows.
float seen(float size, float pixel) { return clamp(1.6 - 2.2 * pixel / size, 0.0, 1.0); }
// Share of a pixel of width f that lines of width w (both in periods) about the whole numbers cover, exactly.
float line_sum(float x, float w) { return floor(x) * w + clamp(fract(x), 0.0, w); }
float lines_covered(float x, float w, float f) {
  f = max(f, 1e-4);
  return (line_sum(x + 0.5 * (w + f), w) - line_sum(x + 0.5 * (w - f), w)) / f;
}
// Coordinates on a face of this normal: across, and up where the face stands.
vec2 on_face(vec3 p, vec3 n) {
  if (abs(n.z) > 0.8) return p.xy;
  vec3 along = normalize(vec3(-n.y, n.x, 0.0));
  return vec2(dot(p, along), p.z);
}
// Distance to the borders of cells at random places, in cells: where cracks run.
float cell_border(vec2 p) {
  vec2 i = floor(p);
  float first = 9.0, second = 9.0;
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x) {
      vec2 c = i + vec2(x, y);
      vec2 d = c + vec2(hash(vec3(c, 1.0)), hash(vec3(c, 2.0))) - p;
      float r = dot(d, d);
      second = min(second, max(first, r));
      first = min(first, r);
    }
  return sqrt(second) - sqrt(first);
}
Surface concrete(vec3 base, vec3 p, vec2 q, float pixel, float broken) {
  float stain = clouds(0.55 * p), fine = value_noise(55.0 * p);
  // Air holes and the joints of the boards that it was cast in.
  float hole = smoothstep(0.90, 0.95, value_noise(38.0 * p)) * seen(0.03, pixel);
  float board = smoothstep(0.012, 0.004, abs(fract(q.y / 1.22 + 0.13) - 0.5) * 1.22) * seen(0.02, pixel);
  Surface s = Surface(base * (0.80 + 0.36 * stain + 0.06 * (fine - 0.5)), 0.86, 0.0, 0.0);
  s.albedo *= 1.0 - 0.35 * hole - 0.16 * board;
  s.height = 0.0012 * fine * seen(0.02, pixel) - 0.004 * hole - 0.002 * board;
  if (broken > 0.5) {
    // Aggregate: stones of one to three centimetres in paler paste.
    float border = cell_border(q / 0.035), stone = smoothstep(0.06, 0.22, border) * seen(0.035, pixel);
    vec3 kind = mix(vec3(0.42, 0.37, 0.31), vec3(0.60, 0.58, 0.55), hash(vec3(floor(q / 0.035), 5.0)));
    s.albedo = mix(base * 1.08, linear(kind), 0.75 * stone) * (0.72 + 0.5 * clouds(9.0 * p));
    s.height = 0.012 * stone + 0.05 * clouds(7.0 * p);
    s.roughness = 0.97;
  }
  return s;
}
Surface brick(vec3 base, vec3 p, vec3 n, vec2 q, float pixel, float broken) {
  // Half-brick bond of 240 x 71 x 115 mm with joints of a centimetre (DIN 105, normal format in courses of 83.3 mm).
  vec2 size = abs(n.z) > 0.8 ? vec2(0.25, 0.125) : vec2(0.25, 0.0833);
  vec2 cell = q / size, wide = fwidth(cell);
  float row = floor(cell.y);
  cell.x += 0.5 * mod(row, 2.0);
  float shown = seen(0.09, pixel);
  vec2 line = vec2(lines_covered(cell.x, 0.044, wide.x), lines_covered(cell.y, 0.132, wide.y));
  float joint = 1.0 - (1.0 - line.x) * (1.0 - line.y);
  float own = hash(vec3(floor(cell.x), row, 3.0)), grain = clouds(30.0 * p);
  vec3 clay = base * mix(vec3(0.72, 0.66, 0.66), vec3(1.26, 1.20, 1.10), mix(0.5, own, 0.15 + 0.85 * shown));
  vec3 mortar = linear(vec3(0.60, 0.585, 0.555));
  Surface s = Surface(mix(clay * (0.86 + 0.28 * grain), mortar * (0.9 + 0.2 * grain), joint), 0.9, 0.0, 0.0);
  // Batches of bricks differ; rain leaves streaks.
  float batch = value_noise(vec3(floor(cell.x / 3.0), row / 2.0, 11.0)), streak = value_noise(vec3(2.2 * q.x, 0.25 * q.y, 6.0));
  s.albedo *= (0.82 + 0.26 * clouds(0.5 * p)) * (0.90 + 0.20 * batch) * (0.93 + 0.12 * streak);
  s.height = (0.004 * (1.0 - joint) + 0.0015 * grain) * shown;
  if (broken > 0.5) {
    s.albedo = mix(base * 1.15, mortar, 0.28 * clouds(14.0 * p)) * (0.62 + 0.62 * clouds(11.0 * p));
    s.height = 0.045 * clouds(9.0 * p) + 0.010 * own;
    s.roughness = 0.98;
  }
  return s;
}
Surface steel(vec3 base, vec3 p, float pixel) {
  // Primed: dull paint, worn and rusty in places.
  float wear = smoothstep(0.62, 0.80, clouds(2.3 * p)), fine = value_noise(60.0 * p);
  Surface s = Surface(base * (0.90 + 0.2 * clouds(0.8 * p)), 0.52 + 0.1 * fine, 0.25, 0.0);
  s.albedo = mix(s.albedo, linear(vec3(0.36, 0.22, 0.15)) * (0.8 + 0.4 * fine), 0.55 * wear);
  s.roughness = mix(s.roughness, 0.85, wear);
  s.metal *= 1.0 - wear;
  s.height = 0.0006 * wear * fine * seen(0.02, pixel);
  return s;
}
Surface timber(vec3 base, vec3 p, float pixel) {
  float ring = sin(60.0 * (p.y + 0.6 * p.z + 0.12 * clouds(vec3(0.4, 3.0, 3.0) * p))) * seen(0.08, pixel);
  float fibre = value_noise(p * vec3(6.0, 160.0, 160.0)) * seen(0.01, pixel);
  Surface s = Surface(base * (0.92 + 0.14 * ring + 0.14 * (fibre - 0.5)), 0.72, 0.0, 0.0006 * ring);
  return s;
}
Surface plaster(vec3 base, vec3 p, float pixel, float broken) {
  float fine = value_noise(110.0 * p), stain = clouds(0.6 * p);
  Surface s = Surface(base * (0.90 + 0.16 * stain), 0.93, 0.0, 0.0010 * fine * seen(0.01, pixel));
  if (broken > 0.5) {
    s.albedo *= 0.75 + 0.3 * clouds(12.0 * p);
    s.height = 0.03 * clouds(9.0 * p);
  }
  return s;
}
// Dark lines that open with the amount (0 to 1), from the coarse net to the fine.
void crack(inout Surface s, vec2 q, float amount, float pixel) {
  if (amount <= 0.0) return;
  vec2 bent = q + 0.09 * vec2(value_noise(vec3(7.0 * q, 1.0)), value_noise(vec3(7.0 * q, 4.0)));
  float width = 0.02 + 0.05 * amount + 1.1 * pixel;
  float line = 1.0 - smoothstep(0.25 * width, width, cell_border(bent / 0.75) * 0.75);
  float some = smoothstep(1.0 - amount, 1.15 - amount, value_noise(vec3(1.7 * q, 9.0)));
  float dark = line * some * clamp(amount * 1.5, 0.0, 1.0);
  s.albedo *= 1.0 - 0.78 * dark;
  s.height -= 0.01 * dark;
}
Surface surface_of(int material, vec3 base, vec3 p, vec3 n, float broken) {
  vec2 q = on_face(p, n);
  float pixel = length(fwidth(p));
  if (material == 1) return concrete(base, p, q, pixel, broken);
  if (material == 2) return steel(base, p, pixel);
  if (material == 3) return brick(base, p, n, q, pixel, broken);
  if (material == 4) return Surface(base, 0.06, 0.0, 0.0);
  if (material == 5) return plaster(base, p, pixel, broken);
  if (material == 6) return timber(base, p, pixel);
  return Surface(base, 0.8, 0.0, 0.0);
}
vec3 bumped(vec3 normal, vec3 point, float height) {
  vec3 x = dFdx(point), y = dFdy(point), r1 = cross(y, normal), r2 = cross(normal, x);
  float det = dot(x, r1);
  if (abs(det) < 1e-12) return normal;
  vec3 slope = (dFdx(height) * r1 + dFdy(height) * r2) / det;
  float steep = length(slope);
  return normalize(normal - slope * (min(steep, 0.9) / max(steep, 1e-6)));
}
)";

}  // namespace topple::viewer
