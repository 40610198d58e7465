#include "renderer/picture_renderer.h"

#include <algorithm>
#include <limits>

#include "renderer/gl_errors.h"
#include "renderer/headless_context.h"

namespace topple::viewer {

struct PictureRenderer::State {
  HeadlessContext context;  // first: it must outlive what is made in it
  SceneInstances scene;
  Renderer renderer;
  glm::ivec2 size;
  State(const structure::Building& building, double ground, int width, int height)
      : scene(building, ground), renderer(scene, ground), size(width, height) {}
};

PictureRenderer::PictureRenderer(const structure::Building& building, double ground, int width, int height)
    : state_(std::make_unique<State>(building, ground, width, height)) {}
PictureRenderer::~PictureRenderer() = default;

Camera PictureRenderer::default_camera() const {
  return frame(state_->scene.bounds(), static_cast<double>(state_->size.x) / state_->size.y);
}

Image PictureRenderer::draw(const Snapshot& snapshot, const Camera& camera, const ViewOptions& options,
                            const Overlay& overlay) {
  state_->context.make_current();
  state_->scene.update(snapshot, options);
  state_->renderer.draw(state_->scene, camera, options, state_->size, overlay);
  Image image = state_->renderer.read();
  check_gl_errors();
  return image;
}

void PictureRenderer::write(const Snapshot& snapshot, const Camera& camera, const ViewOptions& options,
                            const std::string& file) {
  write_png(draw(snapshot, camera, options), file);
}

const SceneInstances& PictureRenderer::scene() const { return state_->scene; }

double ground_height(const structure::Building& building, const structure::Scenario& scenario) {
  if (scenario.ground) return *scenario.ground;
  double lowest = std::numeric_limits<double>::infinity();
  for (const structure::NodeSupport& support : building.supports)
    lowest = std::min(lowest, building[support.node].position.z());
  for (const structure::EdgeSupport& support : building.edge_supports)
    for (const structure::NodeId node : building[support.panel].nodes)
      lowest = std::min(lowest, building[node].position.z());
  return lowest == std::numeric_limits<double>::infinity() ? 0 : lowest;
}

}  // namespace topple::viewer
