#include "renderer/shaders.h"

#include <stdexcept>
#include <utility>
#include <vector>

#include "renderer/glsl/glsl.h"

namespace topple::viewer {
namespace {

constexpr const char* member_vertex = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 first_end;
layout(location = 3) in vec4 rotation;
layout(location = 4) in float span;
layout(location = 5) in vec3 displacement1;
layout(location = 6) in vec3 rotation1;
layout(location = 7) in vec3 displacement2;
layout(location = 8) in vec3 rotation2;
layout(location = 9) in vec3 bulge;
layout(location = 10) in vec4 base;
layout(location = 11) in vec4 end1;
layout(location = 12) in vec4 end2;
out vec3 point, surface_normal;
out vec3 plain, part_point, part_normal;
flat out int material;
out vec4 colour1, colour2;
out vec2 along;  // distances from the two ends
// Axis bent as a cubic between the ends' displacements and rotations, section turned with it.
void bend(float s, vec3 x, out vec3 axis_moves, out vec3 section_turns) {
  float s2 = s * s, s3 = s2 * s;
  vec3 slope1 = cross(rotation1, x), slope2 = cross(rotation2, x);
  vec3 chord = displacement2 - displacement1;
  vec3 across = chord - x * dot(chord, x);
  vec3 stretch = x * dot(chord, x) * s;
  axis_moves = displacement1 + stretch + (3.0 * s2 - 2.0 * s3) * across + span * ((s - 2.0 * s2 + s3) * slope1 + (s3 - s2) * slope2);
  vec3 slope = (6.0 * s - 6.0 * s2) * across / span + (1.0 - 4.0 * s + 3.0 * s2) * slope1 + (3.0 * s2 - 2.0 * s) * slope2;
  // The shape of a bar that is fixed at both ends and pushed in the middle, as a power.
  float rest = 1.0 - s;
  axis_moves += 16.0 * s2 * rest * rest * bulge;
  slope += 32.0 * s * rest * (1.0 - 2.0 * s) * bulge / span;
  section_turns = cross(x, slope) + x * mix(dot(rotation1, x), dot(rotation2, x), s);
}
void main() {
  vec3 x = turn(rotation, vec3(1, 0, 0)), moves, turns;
  bend(position.x, x, moves, turns);
  vec3 arm = turn(rotation, vec3(0, position.yz)), n = turn(rotation, normal);
  // A turn by a vector, exact at any size so that a large scale does not swell the section.
  float angle = length(turns);
  if (angle > 1e-9) {
    vec4 q = vec4(turns / angle * sin(angle / 2.0), cos(angle / 2.0));
    arm = turn(q, arm);
    n = turn(q, n);
  }
  point = first_end + x * position.x * span + moves + arm;
  surface_normal = n;
  plain = linear(base.rgb);
  material = int(base.a * 255.0 + 0.5);
  part_point = vec3(position.x * span, position.yz);
  part_normal = normal;
  colour1 = vec4(linear(end1.rgb), end1.a);
  colour2 = vec4(linear(end2.rgb), end2.a);
  along = span * vec2(position.x, 1.0 - position.x);
  gl_Position = TRANSFORM * vec4(point, 1.0);
}
)";

constexpr const char* member_fragment = R"(
in vec3 point, surface_normal;
in vec3 plain, part_point, part_normal;
flat in int material;
in vec4 colour1, colour2;
in vec2 along;
out vec4 result;
float fade(float distance, float reach) { float t = clamp(1.0 - distance / reach, 0.0, 1.0); return t * t * (3.0 - 2.0 * t); }
void main() {
  if (material < 255) {
    // The ends of what has come off are torn; those of what stands lie in joints.
    vec3 normal = normalize(surface_normal);
    Surface s = surface_of(material, plain, part_point, part_normal, abs(part_normal.x) > 0.9 && material != 2 ? 1.0 : 0.0);
    result = vec4(shade(s, bumped(normal, point, s.height), point, normal), 1.0);
    return;
  }
  float span = along.x + along.y, reach = min(sizes.w, 0.5 * span);
  vec3 albedo;
  if (mode.x > 0.5 && colour1.a + colour2.a > 0.0) {
    albedo = mix(colour1.rgb, colour2.rgb, along.x / span);
  } else {
    albedo = mix(plain, colour1.rgb, colour1.a * fade(along.x, reach));
    albedo = mix(albedo, colour2.rgb, colour2.a * fade(along.y, reach));
  }
  result = vec4(shade_even(albedo, normalize(surface_normal), point), 1.0);
}
)";

constexpr const char* panel_vertex = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 corner1;
layout(location = 3) in vec3 corner2;
layout(location = 4) in vec3 corner3;
layout(location = 5) in vec3 corner4;
layout(location = 6) in float thickness;
layout(location = 7) in vec4 base;
layout(location = 8) in vec4 edge1;
layout(location = 9) in vec4 edge2;
layout(location = 10) in vec4 edge3;
layout(location = 11) in vec4 edge4;
layout(location = 12) in vec3 rest1;
layout(location = 13) in vec3 rest2;
layout(location = 14) in vec3 rest4;
out vec3 point, surface_normal;
out vec3 plain, part_point, part_normal;
flat out int material;
out vec4 colours[4];
out vec4 distances;
vec4 tint(vec4 edge) { return vec4(linear(edge.rgb), edge.a); }
void main() {
  float s = position.x, t = position.y;
  vec3 along_s = mix(corner2 - corner1, corner3 - corner4, t), along_t = mix(corner4 - corner1, corner3 - corner2, s);
  vec3 across = normalize(cross(along_s, along_t));
  point = mix(mix(corner1, corner2, s), mix(corner4, corner3, s), t) + across * position.z * thickness;
  surface_normal = normal.x * along_s / dot(along_s, along_s) + normal.y * along_t / dot(along_t, along_t) + normal.z * across;
  surface_normal = normalize(surface_normal);
  vec3 side = rest2 - rest1, up = rest4 - rest1, out_of = normalize(cross(side, up));
  part_point = rest1 + s * side + t * up + out_of * position.z * thickness;
  part_normal = normalize(normal.x * side / dot(side, side) + normal.y * up / dot(up, up) + normal.z * out_of);
  plain = linear(base.rgb);
  material = int(base.a * 255.0 + 0.5);
  colours = vec4[4](tint(edge1), tint(edge2), tint(edge3), tint(edge4));
  float width = length(along_s), height = length(along_t);
  distances = vec4(t * height, (1.0 - s) * width, (1.0 - t) * height, s * width);
  gl_Position = TRANSFORM * vec4(point, 1.0);
  if (!drawn_now(material)) gl_Position = not_drawn;
}
)";

constexpr const char* panel_fragment = R"(
in vec3 point, surface_normal;
in vec3 plain, part_point, part_normal;
flat in int material;
in vec4 colours[4];
in vec4 distances;
out vec4 result;
// Glass is framed along its edges, and standing glass divided by posts into lights no wider than 1.6 m. Share of a pixel.
float bar_of_window(vec4 edges, bool stands) {
  const float bar = 0.06, widest = 1.6;
  float width = edges.y + edges.w, light = stands ? width / ceil(width / widest) : width;
  float across = lines_covered((edges.w + 0.5 * bar) / light, bar / light, fwidth(edges.w) / light);
  float level = clamp((bar - min(edges.x, edges.z)) / max(fwidth(edges.x), 1e-4) + 0.5, 0.0, 1.0);
  return 1.0 - (1.0 - across) * (1.0 - level);
}
void main() {
  vec3 normal = normalize(surface_normal);
  if (material == 4) {
    result = glass(plain, normal, point, 0.0);
    float bar = bar_of_window(distances, abs(part_normal.z) < 0.5);
    Surface painted = Surface(linear(vec3(0.11, 0.12, 0.13)), 0.75, 0.0, 0.0);
    if (bar > 0.0) result = mix(result, vec4(shade(painted, normal, point, normal), 1.0), bar);
    return;
  }
  if (material < 255) {
    Surface s = surface_of(material, plain, part_point, part_normal, 0.0);
    float open = 0.0;
    for (int e = 0; e < 4; ++e) open = max(open, colours[e].a * clamp(1.0 - distances[e] / 2.2, 0.0, 1.0));
    crack(s, on_face(part_point, part_normal), open, length(fwidth(part_point)));
    result = vec4(shade(s, bumped(normal, point, s.height), point, normal), opacity.x);
    return;
  }
  vec3 albedo = plain;
  float reach = 0.6 * sizes.w;
  for (int e = 0; e < 4; ++e) {
    float t = clamp(1.0 - distances[e] / reach, 0.0, 1.0);
    albedo = mix(albedo, colours[e].rgb, 0.85 * colours[e].a * t * t);
  }
  result = vec4(shade_plain(albedo, normal, point, 0.9), opacity.x);
}
)";

constexpr const char* rigid_vertex = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 place;
layout(location = 3) in vec4 rotation;
layout(location = 4) in vec3 scale;
layout(location = 5) in vec4 colour;
layout(location = 6) in vec3 rest;
layout(location = 15) in float torn;
out vec3 point, surface_normal;
out vec3 albedo, part_point, part_normal;
out float broken;
flat out int material;
void main() {
  part_point = position * scale + rest;
  part_normal = normalize(normal / scale);
  broken = torn;
  material = int(colour.a * 255.0 + 0.5);
  point = place + turn(rotation, position * scale);
  surface_normal = turn(rotation, normal / scale);
  albedo = linear(colour.rgb);
  gl_Position = TRANSFORM * vec4(point, 1.0);
  if (!drawn_now(material)) gl_Position = not_drawn;
}
)";

constexpr const char* rigid_fragment = R"(
in vec3 point, surface_normal;
in vec3 albedo, part_point, part_normal;
in float broken;
flat in int material;
out vec4 result;
void main() {
  vec3 normal = normalize(surface_normal);
  if (material == 255) {
    result = vec4(shade_plain(albedo, normal, point, 0.45), 1.0);
    return;
  }
  if (material == 4) {
    result = glass(albedo, normal, point, broken);
    return;
  }
  bool bar = broken > 1.5;
  Surface s = bar ? surface_of(2, linear(vec3(0.42, 0.25, 0.17)), part_point, normalize(part_normal), 0.0)
                  : surface_of(material, albedo, part_point, normalize(part_normal), broken);
  result = vec4(shade(s, bumped(normal, point, s.height), point, normal), 1.0);
}
)";

constexpr const char* depth_fragment = "void main() {}\n";

/// One triangle that covers the picture.
constexpr const char* cover_vertex = R"(
out vec2 place;
void main() {
  place = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
  gl_Position = vec4(place, 1.0, 1.0);
}
)";

constexpr const char* line_vertex = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec4 colour;
out vec4 tint;
void main() {
  tint = vec4(linear(colour.rgb), colour.a);
  gl_Position = view_projection * vec4(position, 1.0);
}
)";
constexpr const char* line_fragment = R"(
in vec4 tint;
out vec4 result;
void main() { result = tint; }
)";

/// Share of the hemisphere above each point that near geometry covers, from the depth buffer.
constexpr const char* occlusion_fragment = R"(
in vec2 place;
out float result;
uniform sampler2D depth_map;
vec3 point_at(vec2 uv, float depth) {
  vec4 p = inverse_view_projection * vec4(vec3(uv, depth) * 2.0 - 1.0, 1.0);
  return p.xyz / p.w;
}
void main() {
  vec2 uv = place * 0.5 + 0.5;
  float depth = texture(depth_map, uv).r;
  vec3 here = point_at(uv, depth);
  // Far off the depth buffer is too coarse to tell a surface from its neighbour.
  if (depth >= 1.0 || length(here - eye.xyz) > length(eye.xyz) + 6.0 * sizes.x) { result = 1.0; return; }
  vec3 normal = normalize(cross(dFdx(here), dFdy(here)));
  if (dot(normal, eye.xyz - here) < 0.0) normal = -normal;
  float reach = mode.z, covered = 0.0;
  float angle = 6.2831853 * fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715))));
  vec4 clip = view_projection * vec4(here, 1.0);
  float pixels = clamp(reach * picture.y / clip.w, 3.0, 0.12 * picture.y);
  for (int i = 0; i < 12; ++i) {
    float r = (float(i) + 0.5) / 12.0, a = angle + 2.3999632 * float(i);
    vec2 q = uv + r * pixels * vec2(cos(a), sin(a)) / picture.xy;
    vec3 arm = point_at(q, texture(depth_map, q).r) - here;
    float distance = length(arm) + 1e-6;
    covered += max(0.0, dot(normal, arm / distance) - 0.12) * smoothstep(2.0, 0.6, distance / reach);
  }
  result = clamp(1.0 - 1.7 * covered / 12.0, 0.0, 1.0);
}
)";

/// What glows by itself is brighter than anything lit: the light beyond `threshold` is spread by a lens. First taken
/// and shrunk to a quarter, then blurred along each axis (the weights are those of a normal distribution).
constexpr const char* bright_fragment = R"(
in vec2 place;
out vec4 result;
uniform sampler2D colour_map;
void main() {
  vec2 uv = place * 0.5 + 0.5, texel = 1.0 / vec2(textureSize(colour_map, 0));
  vec3 sum = vec3(0.0);
  const float threshold = 2.6;
  for (int i = 0; i < 4; ++i) {
    vec3 c = texture(colour_map, uv + texel * vec2(i % 2 == 0 ? -1.0 : 1.0, i < 2 ? -1.0 : 1.0)).rgb;
    float most = max(c.r, max(c.g, c.b));
    sum += c * clamp((most - threshold) / max(most, 1e-4), 0.0, 1.0);
  }
  result = vec4(min(sum / 4.0, vec3(24.0)), 1.0);
}
)";
constexpr const char* blur_fragment = R"(
in vec2 place;
out vec4 result;
uniform sampler2D glow_map;
uniform vec2 along;
void main() {
  vec2 uv = place * 0.5 + 0.5, texel = along / vec2(textureSize(glow_map, 0));
  vec3 sum = vec3(0.0);
  float weights = 0.0;
  for (int i = -6; i <= 6; ++i) {
    float w = exp(-float(i * i) / 14.0);
    sum += w * texture(glow_map, uv + float(i) * texel).rgb;
    weights += w;
  }
  result = vec4(sum / weights, 1.0);
}
)";

/// Occlusion, bloom, tone curve, gamma.
constexpr const char* finish_fragment = R"(
in vec2 place;
out vec4 result;
uniform sampler2D colour_map, depth_map, occlusion_map, glow_map;
uniform float bloom;
float occlusion(vec2 uv, float depth) {
  float sum = 0.0, weight = 0.0;
  vec2 texel = 1.0 / vec2(textureSize(occlusion_map, 0));
  for (int y = -1; y <= 2; ++y)
    for (int x = -1; x <= 2; ++x) {
      vec2 q = uv + (vec2(x, y) - 0.5) * texel;
      float w = exp(-abs(texture(depth_map, q).r - depth) / max(1e-7, (1.0 - depth) * 0.02));
      sum += w * texture(occlusion_map, q).r;
      weight += w;
    }
  return weight > 0.0 ? sum / weight : 1.0;
}
vec3 tone(vec3 x) { return clamp((x * (2.2 * x + 0.05)) / (x * (2.1 * x + 0.58) + 0.16), 0.0, 1.0); }
void main() {
  vec2 uv = place * 0.5 + 0.5;
  vec3 colour = texture(colour_map, uv).rgb;
  float depth = texture(depth_map, uv).r;
  if (mode.y > 0.5 && depth < 1.0) colour *= mix(1.0, occlusion(uv, depth), 0.8);
  if (bloom > 0.0) colour += bloom * texture(glow_map, uv).rgb;
  // Rounding to 8 bits at random, so that no steps are seen on large faces.
  float grain = fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715)))) - 0.5;
  result = vec4(pow(tone(colour * 0.62), vec3(1.0 / 2.2)) + grain / 255.0, 1.0);
}
)";

GlShader compile(GLenum kind, const std::vector<std::string>& parts, const std::string& name) {
  GlShader shader(glCreateShader(kind));
  std::vector<const char*> texts;
  for (const std::string& part : parts) texts.push_back(part.c_str());
  glShaderSource(shader.get(), static_cast<GLsizei>(texts.size()), texts.data(), nullptr);
  glCompileShader(shader.get());
  GLint compiled = 0;
  glGetShaderiv(shader.get(), GL_COMPILE_STATUS, &compiled);
  if (compiled != GL_TRUE) {
    std::string log(4096, '\0');
    GLsizei length = 0;
    glGetShaderInfoLog(shader.get(), static_cast<GLsizei>(log.size()), &length, log.data());
    log.resize(static_cast<std::size_t>(length));
    throw std::runtime_error("shader '" + name + "' does not compile: " + log);
  }
  return shader;
}

/// `transform` replaces TRANSFORM in a vertex shader: the camera or the light.
std::string with_transform(std::string text, const std::string& transform) {
  const std::string word = "TRANSFORM";
  const auto at = text.find(word);
  return at == std::string::npos ? text : text.replace(at, word.size(), transform);
}

void bind_names(GLuint program) {
  glUniformBlockBinding(program, glGetUniformBlockIndex(program, "Picture"), picture_binding);
  glUseProgram(program);
  const std::pair<const char*, GLint> units[] = {{"shadow_map", shadow_unit},
                                                 {"colour_map", colour_unit},
                                                 {"depth_map", depth_unit},
                                                 {"occlusion_map", occlusion_unit},
                                                 {"glow_map", glow_unit}};
  for (const auto& [name, unit] : units) {
    const GLint location = glGetUniformLocation(program, name);
    if (location >= 0) glUniform1i(location, unit);
  }
  glUseProgram(0);
}

GlProgram link(const std::string& name, const char* vertex, const std::string& fragment, const std::string& transform) {
  const GlShader v = compile(GL_VERTEX_SHADER, {picture_glsl, with_transform(vertex, transform)}, name);
  const GlShader f = compile(GL_FRAGMENT_SHADER, {picture_glsl, fragment}, name);
  GlProgram program(glCreateProgram());
  glAttachShader(program.get(), v.get());
  glAttachShader(program.get(), f.get());
  glLinkProgram(program.get());
  GLint linked = 0;
  glGetProgramiv(program.get(), GL_LINK_STATUS, &linked);
  if (linked != GL_TRUE) {
    std::string log(4096, '\0');
    GLsizei length = 0;
    glGetProgramInfoLog(program.get(), static_cast<GLsizei>(log.size()), &length, log.data());
    log.resize(static_cast<std::size_t>(length));
    throw std::runtime_error("shader program '" + name + "' does not link: " + log);
  }
  glDetachShader(program.get(), v.get());
  glDetachShader(program.get(), f.get());
  if (glGetUniformBlockIndex(program.get(), "Picture") != GL_INVALID_INDEX) bind_names(program.get());
  return program;
}

GlProgram lit(const std::string& name, const char* vertex, const char* fragment) {
  return link(name, vertex, std::string(sky_glsl) + materials_glsl + lighting_glsl + fragment, "view_projection");
}
GlProgram shadow(const std::string& name, const char* vertex) {
  return link(name, vertex, depth_fragment, "light[int(opacity.z + 0.5)]");
}

}  // namespace

Programs::Programs()
    : member(lit("member", member_vertex, member_fragment)),
      member_shadow(shadow("member shadow", member_vertex)),
      panel(lit("panel", panel_vertex, panel_fragment)),
      panel_shadow(shadow("panel shadow", panel_vertex)),
      rigid(lit("rigid", rigid_vertex, rigid_fragment)),
      rigid_shadow(shadow("rigid shadow", rigid_vertex)),
      sky(link("sky", cover_vertex, std::string(sky_glsl) + materials_glsl + sky_fragment_glsl, "")),
      ground(lit("ground", ground_vertex_glsl, ground_fragment_glsl)),
      line(link("line", line_vertex, line_fragment, "")),
      dust(link("dust", dust_vertex_glsl, std::string(sky_glsl) + materials_glsl + dust_fragment_glsl, "")),
      occlusion(link("occlusion", cover_vertex, occlusion_fragment, "")),
      bright(link("bright", cover_vertex, bright_fragment, "")),
      blur(link("blur", cover_vertex, blur_fragment, "")),
      finish(link("finish", cover_vertex, finish_fragment, "")) {}

}  // namespace topple::viewer
