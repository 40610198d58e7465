#include "renderer/renderer.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <stdexcept>

#include "renderer/gpu_scene.h"
#include "renderer/gpu_timer.h"
#include "renderer/render_targets.h"
#include "renderer/shaders.h"
#include "renderer/shadow_light.h"
#include "renderer/shapes/dust_buffer.h"
#include "renderer/shapes/overlay_buffer.h"

namespace topple::viewer {
namespace {

using structure::PanelKind;

/// Colours fade over this length from a joint, as a share of the building's radius, within these limits by storey size.
constexpr float fade_share = 0.085F;
/// Where colours carry a meaning, this share of the light is the same on every side.
constexpr float colour_light = 0.5F;
/// Occlusion looks this far, as a share of the building's radius.
constexpr float occlusion_share = 0.09F;
/// Of the light beyond white, what a lens spreads.
constexpr float bloom_share = 0.5F;

/// 1, 2 or 5 times a power of ten next below.
double round_spacing(double length) {
  const double power = std::pow(10.0, std::floor(std::log10(length)));
  const double lead = length / power;
  return power * (lead >= 5 ? 5 : lead >= 2 ? 2 : 1);
}

/// The largest distance from the origin of anything drawn, no more than four building radii (what flies farther casts
/// no shadow).
float drawn_radius(const SceneInstances& scene) {
  const auto own = static_cast<float>(std::max(scene.bounds().radius(), 1e-3));
  float radius = own;
  const auto reach = [&](const glm::vec3& p) { radius = std::max(radius, glm::length(p)); };
  for (const auto& batch : scene.members())
    for (std::size_t i = batch.standing; i < batch.instances.size(); ++i) reach(batch.instances[i].first_end);
  for (const auto& instance : scene.projectiles().instances) reach(instance.position);
  return std::min(radius * 1.1F, 4 * own);
}

}  // namespace

struct Renderer::State {
  Programs programs;
  GpuScene scene;
  RenderTargets targets;
  ShadowMap shadow{shadow_size};
  GlBuffer block = make_buffer(), ground_vertices = make_buffer();
  GlVertexArray empty = make_vertex_array(), ground = make_vertex_array();
  OverlayBuffer diagrams, marks, extra;
  DustBuffer dust;
  GpuTimer timer;
  double ground_height = 0;
  PictureBlock picture{};
  float half_field = 0.4F;  ///< tangent of half the field of view

  State(const SceneInstances& instances, double height) : scene(instances), ground_height(height) { make_ground(); }
  void make_ground();
  void fill_block(const SceneInstances& instances, const Camera& camera, const ViewOptions& options, glm::ivec2 size);
  void send_block();
  [[nodiscard]] std::size_t member_level(const SceneInstances& instances) const;
  void draw_shadows();
  void draw_scene(const SceneInstances& instances, const ViewOptions& options, const Overlay& lines);
  void draw_panels(PanelKind kind, float opacity);
  void blend_panels(PanelKind kind);
  void draw_glass(const ViewOptions& options);
  void draw_overlay(const SceneInstances& instances, const Overlay& more);
  void draw_dust(const SceneInstances& instances);
  void draw_on_top();
  void draw_buried_arrows();
  /// Spreads what is brighter than white. False: nothing of that kind can be in the picture.
  bool spread_glow();
  void finish(const ViewOptions& options);
};

void Renderer::State::make_ground() {
  const float corners[] = {-1, -1, 1, -1, -1, 1, 1, 1};
  glBindVertexArray(ground.get());
  glBindBuffer(GL_ARRAY_BUFFER, ground_vertices.get());
  glBufferData(GL_ARRAY_BUFFER, sizeof corners, corners, GL_STATIC_DRAW);
  glEnableVertexAttribArray(0);
  glVertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, 0, nullptr);
  glBindVertexArray(0);
}

void Renderer::State::fill_block(const SceneInstances& instances, const Camera& camera, const ViewOptions& options,
                                 glm::ivec2 size) {
  const auto radius = static_cast<float>(std::max(instances.bounds().radius(), 1e-3));
  const glm::vec3 eye(camera.eye - instances.origin());
  const float away = glm::length(eye);
  half_field = static_cast<float>(std::tan(camera.field_of_view / 2));
  const float near = std::max(0.02F * radius * 0.1F, (away - 4 * radius) * 0.5F), far = away + 80 * radius;
  const float reach = drawn_radius(instances);
  picture.view_projection =
      camera.projection(static_cast<double>(size.x) / size.y, near, far) * camera.view(instances.origin());
  picture.inverse_view_projection = glm::inverse(picture.view_projection);
  set_light_matrices(picture, camera, instances.origin(), reach);
  picture.eye = glm::vec4(eye, static_cast<float>(ground_height - instances.origin().z));
  picture.sun = glm::vec4(glm::normalize(to_sun), options.shadows ? 1.0F : 0.0F);
  const auto spacing = options.grid ? static_cast<float>(round_spacing(radius / 4)) : 0.0F;
  picture.sizes = glm::vec4(radius, spacing, 0, fade_share * radius);
  picture.picture = glm::vec4(size, near, far);
  const bool map = options.colouring == Colouring::utilisation || options.colouring == Colouring::component ||
                   options.colouring == Colouring::path;
  picture.mode = glm::vec4(map ? 1.0F : 0.0F, options.ambient_occlusion ? 1.0F : 0.0F, occlusion_share * radius,
                           options.analysis() ? colour_light : 0.0F);
  const glm::dvec3 half = (instances.bounds().high - instances.bounds().low) / 2.0;
  picture.plot = glm::vec4(half.x, half.y, 0, 0);
  picture.opacity = glm::vec4(1, options.colouring == Colouring::materials ? 1 : 0, 0, 0);
}

void Renderer::State::send_block() {
  glBindBuffer(GL_UNIFORM_BUFFER, block.get());
  glBufferData(GL_UNIFORM_BUFFER, sizeof picture, &picture, GL_STREAM_DRAW);
  glBindBufferBase(GL_UNIFORM_BUFFER, picture_binding, block.get());
}

/// Of detail: bent where that is seen; else straight; boxes where members are but a few pixels wide.
std::size_t Renderer::State::member_level(const SceneInstances& instances) const {
  constexpr float few_pixels = 4;
  if (instances.bent()) return 0;
  // Where the building is nearest: all rows of pixels together span this many metres there.
  const glm::vec3 half((instances.bounds().high - instances.bounds().low) / 2.0), eye(picture.eye);
  const float away = glm::length(eye - glm::clamp(eye, -half, half)), height = 2 * half_field * away;
  return instances.member_width() * picture.picture.y < few_pixels * height ? 3 : 1;
}

void Renderer::State::draw_shadows() {
  glViewport(0, 0, shadow.size(), shadow.size());
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(1.5F, 2.0F);
  for (int layer = 0; layer < ShadowMap::layers; ++layer) {
    picture.opacity.z = static_cast<float>(layer);
    send_block();
    glBindFramebuffer(GL_FRAMEBUFFER, shadow.framebuffer(layer));
    glClear(GL_DEPTH_BUFFER_BIT);
    glUseProgram(programs.member_shadow.get());
    scene.draw_members(2);
    glUseProgram(programs.panel_shadow.get());
    scene.draw_panels(PanelKind::slab);
    scene.draw_panels(PanelKind::wall);
    glUseProgram(programs.rigid_shadow.get());
    scene.draw_rigid();
  }
  glDisable(GL_POLYGON_OFFSET_FILL);
}

void Renderer::State::draw_panels(PanelKind kind, float opacity) {
  if (opacity <= 0) return;
  picture.opacity.x = opacity;
  send_block();
  glUseProgram(programs.panel.get());
  // A panel's face in the plane of a member's hides it.
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(-1.0F, -4.0F);
  if (opacity >= 1)
    scene.draw_panels(kind);
  else
    blend_panels(kind);
  glDisable(GL_POLYGON_OFFSET_FILL);
}

void Renderer::State::blend_panels(PanelKind kind) {
  // The nearest surface alone is blended: first its depth, then its colour, so that no order has to be kept.
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  scene.draw_panels(kind);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glEnable(GL_BLEND);
  scene.draw_panels(kind);
  glDisable(GL_BLEND);
}

/// What is behind it is there already. Panes behind panes add up in any order well enough: none hides much.
void Renderer::State::draw_glass(const ViewOptions& options) {
  picture.opacity.w = 1;
  send_block();
  glEnable(GL_BLEND);
  glDepthMask(GL_FALSE);
  glUseProgram(programs.panel.get());
  if (options.slab_opacity_now() > 0) scene.draw_panels(PanelKind::slab);
  if (options.wall_opacity_now() > 0) scene.draw_panels(PanelKind::wall);
  glUseProgram(programs.rigid.get());
  scene.draw_rigid();
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
  picture.opacity.w = 0;
  send_block();
}

void Renderer::State::draw_overlay(const SceneInstances& instances, const Overlay& more) {
  diagrams.update(instances.diagrams());
  marks.update(instances.marks());
  extra.update(more);
  glUseProgram(programs.line.get());
  glEnable(GL_BLEND);
  glDisable(GL_CULL_FACE);
  glDepthMask(GL_FALSE);
  for (const OverlayBuffer* buffer : {&diagrams, &marks, &extra}) buffer->draw();
  glDepthMask(GL_TRUE);
  glEnable(GL_CULL_FACE);
  glDisable(GL_BLEND);
}

void Renderer::State::draw_dust(const SceneInstances& instances) {
  dust.update(instances.dust(), glm::vec3(picture.eye));
  if (dust.empty()) return;
  targets.resolve_depth();
  glActiveTexture(GL_TEXTURE0 + depth_unit);
  glBindTexture(GL_TEXTURE_2D, targets.resolved().depth.get());
  glUseProgram(programs.dust.get());
  glEnable(GL_BLEND);
  glDisable(GL_CULL_FACE);
  glDepthMask(GL_FALSE);
  dust.draw();
  glDepthMask(GL_TRUE);
  glEnable(GL_CULL_FACE);
  glDisable(GL_BLEND);
}

void Renderer::State::draw_on_top() {
  glUseProgram(programs.line.get());
  glDisable(GL_DEPTH_TEST);
  glEnable(GL_BLEND);
  for (const OverlayBuffer* buffer : {&diagrams, &marks, &extra}) buffer->draw_on_top();
  glDisable(GL_BLEND);
  glEnable(GL_DEPTH_TEST);
}

/// Reactions push from below: they are seen through the ground.
void Renderer::State::draw_buried_arrows() {
  glUseProgram(programs.rigid.get());
  glDepthFunc(GL_ALWAYS);
  scene.draw_buried_arrows();
  glDepthFunc(GL_LEQUAL);
}

void Renderer::State::draw_scene(const SceneInstances& instances, const ViewOptions& options, const Overlay& lines) {
  glBindFramebuffer(GL_FRAMEBUFFER, targets.multisampled());
  glViewport(0, 0, targets.size().x, targets.size().y);
  glActiveTexture(GL_TEXTURE0 + shadow_unit);
  glBindTexture(GL_TEXTURE_2D_ARRAY, shadow.texture());
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  glUseProgram(programs.member.get());
  scene.draw_members(member_level(instances));
  glUseProgram(programs.rigid.get());
  scene.draw_rigid();
  scene.draw_arrows();
  const float slabs = options.slab_opacity_now(), walls = options.wall_opacity_now();
  if (slabs >= 1) draw_panels(PanelKind::slab, 1);
  if (walls >= 1) draw_panels(PanelKind::wall, 1);
  glUseProgram(programs.ground.get());
  glDisable(GL_CULL_FACE);
  glBindVertexArray(ground.get());
  glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  glUseProgram(programs.sky.get());
  glBindVertexArray(empty.get());
  glDepthFunc(GL_LEQUAL);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glEnable(GL_CULL_FACE);
  // Before what shows through, whose depth would hide it.
  draw_buried_arrows();
  draw_overlay(instances, lines);
  if (slabs < 1) draw_panels(PanelKind::slab, slabs);
  if (walls < 1) draw_panels(PanelKind::wall, walls);
  if (instances.has_glass() && options.colouring == Colouring::materials) draw_glass(options);
  draw_dust(instances);
  draw_on_top();
}

bool Renderer::State::spread_glow() {
  if (!dust.glows()) return false;
  const glm::ivec2 size = targets.glow_size();
  glViewport(0, 0, size.x, size.y);
  const auto pass = [&](const GlProgram& program, int to) {
    glBindFramebuffer(GL_FRAMEBUFFER, targets.glow(to).framebuffer.get());
    glUseProgram(program.get());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(glow_unit));
    glBindTexture(GL_TEXTURE_2D, targets.glow(to).colour.get());
  };
  const GLint along = glGetUniformLocation(programs.blur.get(), "along");
  pass(programs.bright, 0);
  glUseProgram(programs.blur.get());
  glUniform2f(along, 1, 0);
  pass(programs.blur, 1);
  glUniform2f(along, 0, 1);
  pass(programs.blur, 0);
  return true;
}

void Renderer::State::finish(const ViewOptions& options) {
  targets.resolve();
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  glBindVertexArray(empty.get());
  const auto bind = [](GLint unit, const GlTexture& texture) {
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    glBindTexture(GL_TEXTURE_2D, texture.get());
  };
  bind(colour_unit, targets.resolved().colour);
  bind(depth_unit, targets.resolved().depth);
  bind(occlusion_unit, targets.occlusion().colour);
  if (options.ambient_occlusion) {
    glBindFramebuffer(GL_FRAMEBUFFER, targets.occlusion().framebuffer.get());
    glViewport(0, 0, (targets.size().x + 1) / 2, (targets.size().y + 1) / 2);
    glUseProgram(programs.occlusion.get());
    glDrawArrays(GL_TRIANGLES, 0, 3);
  }
  const bool glows = spread_glow();
  glBindFramebuffer(GL_FRAMEBUFFER, targets.finished().framebuffer.get());
  glViewport(0, 0, targets.size().x, targets.size().y);
  glUseProgram(programs.finish.get());
  glUniform1f(glGetUniformLocation(programs.finish.get(), "bloom"), glows ? bloom_share : 0.0F);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glBindVertexArray(0);
  glUseProgram(0);
  glActiveTexture(GL_TEXTURE0);
}

Renderer::Renderer(const SceneInstances& scene, double ground) {
  if (epoxy_gl_version() < 33) throw std::runtime_error("OpenGL 3.3 is needed, this context has less");
  state_ = std::make_unique<State>(scene, ground);
}
Renderer::~Renderer() = default;

void Renderer::draw(const SceneInstances& scene, const Camera& camera, const ViewOptions& options, glm::ivec2 size,
                    const Overlay& overlay) {
  State& s = *state_;
  s.targets.resize(size);
  s.timer.begin();
  s.scene.update(scene);
  s.fill_block(scene, camera, options, s.targets.size());
  s.send_block();
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_BLEND);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);
  glEnable(GL_CULL_FACE);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  if (options.shadows) s.draw_shadows();
  s.draw_scene(scene, options, overlay);
  s.finish(options);
  s.timer.end();
}

double Renderer::graphics_milliseconds() const { return state_->timer.milliseconds(); }
unsigned Renderer::framebuffer() const { return state_->targets.finished().framebuffer.get(); }
glm::ivec2 Renderer::size() const { return state_->targets.size(); }

Image read_framebuffer(unsigned framebuffer, glm::ivec2 size) {
  Image image;
  image.width = size.x;
  image.height = size.y;
  const std::size_t row = 4 * static_cast<std::size_t>(image.width);
  std::vector<std::uint8_t> upside_down(row * static_cast<std::size_t>(image.height));
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, image.width, image.height, GL_RGBA, GL_UNSIGNED_BYTE, upside_down.data());
  image.pixels.resize(upside_down.size());
  for (int y = 0; y < image.height; ++y)
    std::copy_n(upside_down.begin() + static_cast<std::ptrdiff_t>(row) * y, row,
                image.pixels.begin() + static_cast<std::ptrdiff_t>(row) * (image.height - 1 - y));
  return image;
}

Image Renderer::read() const { return read_framebuffer(framebuffer(), size()); }

}  // namespace topple::viewer
