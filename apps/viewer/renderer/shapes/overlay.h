#pragma once
// Lines and plain triangles drawn over the scene: diagrams, arrows, marks.
#include <glm/vec3.hpp>
#include <vector>

#include "renderer/shapes/palette.h"

namespace topple::viewer {

struct OverlayVertex {
  glm::vec3 position;  ///< relative to SceneInstances::origin()
  Rgba colour;
};
struct Overlay {
  std::vector<OverlayVertex> triangles, lines;  ///< by threes, by twos; hidden by what stands before them
  std::vector<OverlayVertex> lines_on_top;      ///< never hidden
  std::uint64_t revision = 0;                   ///< counts changes, for those who keep a copy
  void clear() {
    triangles.clear(), lines.clear(), lines_on_top.clear();
    ++revision;
  }
};

}  // namespace topple::viewer
