#pragma once
// Dust on the graphics card: soft discs that face the eye, farthest first.
#include <vector>

#include "renderer/gl_object.h"
#include "renderer/shapes/dust.h"

namespace topple::viewer {

class DustBuffer {
 public:
  DustBuffer();
  /// `eye` in the axes of the instances.
  void update(const std::vector<DustInstance>& dust, const glm::vec3& eye);
  /// With the dust program in use and blending on.
  void draw() const;
  [[nodiscard]] bool empty() const { return sorted_.empty(); }
  /// Some of it is brighter than what is lit.
  [[nodiscard]] bool glows() const { return glows_; }

 private:
  GlBuffer instances_ = make_buffer();
  GlVertexArray array_ = make_vertex_array();
  std::vector<DustInstance> sorted_;
  bool glows_ = false;
};

}  // namespace topple::viewer
