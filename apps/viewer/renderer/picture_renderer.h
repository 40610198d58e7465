#pragma once
// Pictures of a building without a window: what `demolish --images` and the headless viewer use.
#include <memory>
#include <string>

#include "renderer/camera.h"
#include "renderer/renderer.h"
#include "renderer/snapshot.h"
#include "renderer/view_options.h"
#include "topple/structure/building.h"

namespace topple::viewer {

class PictureRenderer {
 public:
  /// Makes an OpenGL context of its own, current on this thread. The building must outlive it; `ground` is the ground's
  /// height. Throws std::runtime_error with one line when this machine cannot draw.
  PictureRenderer(const structure::Building& building, double ground, int width, int height);
  ~PictureRenderer();

  /// A camera that sees the whole building, with room for what falls.
  [[nodiscard]] Camera default_camera() const;
  [[nodiscard]] Image draw(const Snapshot& snapshot, const Camera& camera, const ViewOptions& options = {},
                           const Overlay& overlay = {});
  /// Draws and writes a PNG. Throws std::runtime_error when the file cannot be written.
  void write(const Snapshot& snapshot, const Camera& camera, const ViewOptions& options, const std::string& file);
  [[nodiscard]] const SceneInstances& scene() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Height of the ground of a scenario: what it says, or the lowest support.
[[nodiscard]] double ground_height(const structure::Building& building, const structure::Scenario& scenario);

}  // namespace topple::viewer
