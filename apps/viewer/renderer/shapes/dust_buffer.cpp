#include "renderer/shapes/dust_buffer.h"

#include <algorithm>
#include <cstddef>
#include <glm/geometric.hpp>

namespace topple::viewer {

DustBuffer::DustBuffer() {
  glBindVertexArray(array_.get());
  glBindBuffer(GL_ARRAY_BUFFER, instances_.get());
  const auto attribute = [](GLuint location, GLint components, std::size_t offset) {
    glEnableVertexAttribArray(location);
    glVertexAttribPointer(location, components, GL_FLOAT, GL_FALSE, sizeof(DustInstance),
                          reinterpret_cast<const void*>(offset));
    glVertexAttribDivisor(location, 1);
  };
  attribute(0, 3, offsetof(DustInstance, position));
  attribute(1, 1, offsetof(DustInstance, radius));
  attribute(2, 1, offsetof(DustInstance, opacity));
  glEnableVertexAttribArray(3);
  glVertexAttribPointer(3, 4, GL_UNSIGNED_BYTE, GL_TRUE, sizeof(DustInstance),
                        reinterpret_cast<const void*>(offsetof(DustInstance, colour)));
  glVertexAttribDivisor(3, 1);
  attribute(4, 1, offsetof(DustInstance, seed));
  glBindVertexArray(0);
}

void DustBuffer::update(const std::vector<DustInstance>& dust, const glm::vec3& eye) {
  sorted_ = dust;
  glows_ = std::any_of(dust.begin(), dust.end(), [](const DustInstance& one) { return one.colour >> 24U != 0; });
  if (sorted_.empty()) return;
  const auto away = [&](const DustInstance& one) { return glm::dot(one.position - eye, one.position - eye); };
  std::sort(sorted_.begin(), sorted_.end(),
            [&](const DustInstance& a, const DustInstance& b) { return away(a) > away(b); });
  glBindBuffer(GL_ARRAY_BUFFER, instances_.get());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(sorted_.size() * sizeof(DustInstance)), sorted_.data(),
               GL_STREAM_DRAW);
}

void DustBuffer::draw() const {
  if (sorted_.empty()) return;
  glBindVertexArray(array_.get());
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(sorted_.size()));
  glBindVertexArray(0);
}

}  // namespace topple::viewer
