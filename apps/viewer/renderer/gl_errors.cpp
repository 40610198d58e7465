#include "renderer/gl_errors.h"

#include <epoxy/gl.h>

#include <array>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <utility>

namespace topple::viewer {
namespace {

/// A context belongs to one thread at a time, and tells on that thread.
thread_local std::string told;

void hear(GLenum, GLenum type, GLuint, GLenum, GLsizei, const GLchar* text, const void*) {
  if (type != GL_DEBUG_TYPE_ERROR && type != GL_DEBUG_TYPE_UNDEFINED_BEHAVIOR) return;
  if (told.empty()) told = text;  // the first is the cause of what follows
}

}  // namespace

void listen_for_gl_errors() {
  told.clear();  // what another context told, and nobody asked for, is none of this one's
  if (!epoxy_has_gl_extension("GL_KHR_debug")) return;
  glEnable(GL_DEBUG_OUTPUT);
  glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
  glDebugMessageCallback(hear, nullptr);
}

void check_gl_errors() {
  const std::string words = std::exchange(told, {});
  const GLenum error = glGetError();
  if (error == GL_NO_ERROR && words.empty()) return;
  std::array<char, 16> number{};
  std::snprintf(number.data(), number.size(), "0x%04x", error);
  throw std::runtime_error(std::string("OpenGL reports error ") + number.data() + (words.empty() ? "" : ": " + words));
}

}  // namespace topple::viewer
