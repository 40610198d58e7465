#pragma once
// An overlay on the graphics card; sent again only when it changed.
#include "renderer/gl_object.h"
#include "renderer/shapes/overlay.h"

namespace topple::viewer {

class OverlayBuffer {
 public:
  OverlayBuffer();
  void update(const Overlay& overlay);
  /// With the line program in use. What may be hidden, and what is never.
  void draw() const;
  void draw_on_top() const;

 private:
  GlBuffer vertices_ = make_buffer();
  GlVertexArray array_ = make_vertex_array();
  GLsizei triangles_ = 0, lines_ = 0, on_top_ = 0;  ///< vertices, one after the other
  const Overlay* seen_ = nullptr;
  std::uint64_t revision_ = 0;
};

}  // namespace topple::viewer
