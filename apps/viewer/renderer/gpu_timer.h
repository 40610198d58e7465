#pragma once
// How long the graphics card works on a picture, asked for without waiting for it.
#include <epoxy/gl.h>

#include <array>
#include <cstddef>

namespace topple::viewer {

/// On the context that is current when it is made, begun, ended and destroyed.
class GpuTimer {
 public:
  GpuTimer() { glGenQueries(static_cast<GLsizei>(queries_.size()), queries_.data()); }
  ~GpuTimer() { glDeleteQueries(static_cast<GLsizei>(queries_.size()), queries_.data()); }
  GpuTimer(const GpuTimer&) = delete;
  GpuTimer& operator=(const GpuTimer&) = delete;
  void begin() { glBeginQuery(GL_TIME_ELAPSED, queries_[next_]); }
  /// Takes over what the card has finished meanwhile: of a picture some pictures ago.
  void end() {
    glEndQuery(GL_TIME_ELAPSED);
    asked_[next_] = true;
    next_ = (next_ + 1) % queries_.size();
    if (!asked_[next_]) return;
    GLint there = GL_FALSE;
    glGetQueryObjectiv(queries_[next_], GL_QUERY_RESULT_AVAILABLE, &there);
    if (there != GL_TRUE) return;
    GLuint64 nanoseconds = 0;
    glGetQueryObjectui64v(queries_[next_], GL_QUERY_RESULT, &nanoseconds);
    milliseconds_ = 1e-6 * static_cast<double>(nanoseconds);
  }
  /// 0 before the first is there.
  [[nodiscard]] double milliseconds() const { return milliseconds_; }

 private:
  static constexpr std::size_t ring = 4;  ///< pictures that may be under way
  std::array<GLuint, ring> queries_{};
  std::array<bool, ring> asked_{};
  std::size_t next_ = 0;
  double milliseconds_ = 0;
};

}  // namespace topple::viewer
