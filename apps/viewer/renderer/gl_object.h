#pragma once
// OpenGL handles that belong to exactly one owner each. All of them need the context current that made them, also when
// they are destroyed.
#include <epoxy/gl.h>

#include <utility>

namespace topple::viewer {

/// Move-only owner of one OpenGL name; `Release` deletes it.
template <void (*Release)(GLuint)>
class GlObject {
 public:
  GlObject() = default;
  explicit GlObject(GLuint name) : name_(name) {}
  GlObject(GlObject&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
  GlObject& operator=(GlObject&& other) noexcept {
    std::swap(name_, other.name_);
    return *this;
  }
  GlObject(const GlObject&) = delete;
  GlObject& operator=(const GlObject&) = delete;
  ~GlObject() {
    if (name_ != 0) Release(name_);
  }
  [[nodiscard]] GLuint get() const { return name_; }
  explicit operator bool() const { return name_ != 0; }

 private:
  GLuint name_ = 0;
};

namespace gl_release {
inline void buffer(GLuint name) { glDeleteBuffers(1, &name); }
inline void vertex_array(GLuint name) { glDeleteVertexArrays(1, &name); }
inline void texture(GLuint name) { glDeleteTextures(1, &name); }
inline void framebuffer(GLuint name) { glDeleteFramebuffers(1, &name); }
inline void renderbuffer(GLuint name) { glDeleteRenderbuffers(1, &name); }
inline void program(GLuint name) { glDeleteProgram(name); }
inline void shader(GLuint name) { glDeleteShader(name); }
}  // namespace gl_release

using GlBuffer = GlObject<gl_release::buffer>;
using GlVertexArray = GlObject<gl_release::vertex_array>;
using GlTexture = GlObject<gl_release::texture>;
using GlFramebuffer = GlObject<gl_release::framebuffer>;
using GlRenderbuffer = GlObject<gl_release::renderbuffer>;
using GlProgram = GlObject<gl_release::program>;
using GlShader = GlObject<gl_release::shader>;

template <class Object>
[[nodiscard]] Object make_gl(void (*generate)(GLsizei, GLuint*)) {
  GLuint name = 0;
  generate(1, &name);
  return Object(name);
}
// epoxy's functions are function pointers behind macros: these give them one type.
[[nodiscard]] inline GlBuffer make_buffer() {
  return make_gl<GlBuffer>([](GLsizei n, GLuint* names) { glGenBuffers(n, names); });
}
[[nodiscard]] inline GlVertexArray make_vertex_array() {
  return make_gl<GlVertexArray>([](GLsizei n, GLuint* names) { glGenVertexArrays(n, names); });
}
[[nodiscard]] inline GlTexture make_texture() {
  return make_gl<GlTexture>([](GLsizei n, GLuint* names) { glGenTextures(n, names); });
}
[[nodiscard]] inline GlFramebuffer make_framebuffer() {
  return make_gl<GlFramebuffer>([](GLsizei n, GLuint* names) { glGenFramebuffers(n, names); });
}
[[nodiscard]] inline GlRenderbuffer make_renderbuffer() {
  return make_gl<GlRenderbuffer>([](GLsizei n, GLuint* names) { glGenRenderbuffers(n, names); });
}

}  // namespace topple::viewer
