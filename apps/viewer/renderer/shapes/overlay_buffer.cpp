#include "renderer/shapes/overlay_buffer.h"

#include <cstddef>

namespace topple::viewer {

OverlayBuffer::OverlayBuffer() {
  glBindVertexArray(array_.get());
  glBindBuffer(GL_ARRAY_BUFFER, vertices_.get());
  glEnableVertexAttribArray(0);
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(OverlayVertex), nullptr);
  glEnableVertexAttribArray(1);
  glVertexAttribPointer(1, 4, GL_UNSIGNED_BYTE, GL_TRUE, sizeof(OverlayVertex),
                        reinterpret_cast<const void*>(offsetof(OverlayVertex, colour)));
  glBindVertexArray(0);
}

void OverlayBuffer::update(const Overlay& overlay) {
  if (seen_ == &overlay && revision_ == overlay.revision && overlay.revision != 0) return;
  seen_ = &overlay;
  revision_ = overlay.revision;
  triangles_ = static_cast<GLsizei>(overlay.triangles.size());
  lines_ = static_cast<GLsizei>(overlay.lines.size());
  on_top_ = static_cast<GLsizei>(overlay.lines_on_top.size());
  if (triangles_ + lines_ + on_top_ == 0) return;
  const auto bytes = [](const std::vector<OverlayVertex>& list) {
    return static_cast<GLsizeiptr>(list.size() * sizeof(OverlayVertex));
  };
  glBindBuffer(GL_ARRAY_BUFFER, vertices_.get());
  glBufferData(GL_ARRAY_BUFFER, bytes(overlay.triangles) + bytes(overlay.lines) + bytes(overlay.lines_on_top), nullptr,
               GL_STREAM_DRAW);
  GLintptr at = 0;
  for (const auto* list : {&overlay.triangles, &overlay.lines, &overlay.lines_on_top}) {
    if (!list->empty()) glBufferSubData(GL_ARRAY_BUFFER, at, bytes(*list), list->data());
    at += bytes(*list);
  }
}

void OverlayBuffer::draw() const {
  glBindVertexArray(array_.get());
  if (triangles_ > 0) glDrawArrays(GL_TRIANGLES, 0, triangles_);
  if (lines_ > 0) glDrawArrays(GL_LINES, triangles_, lines_);
}

void OverlayBuffer::draw_on_top() const {
  glBindVertexArray(array_.get());
  if (on_top_ > 0) glDrawArrays(GL_LINES, triangles_ + lines_, on_top_);
}

}  // namespace topple::viewer
