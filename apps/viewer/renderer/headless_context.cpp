#include "renderer/headless_context.h"

#include <epoxy/egl.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "renderer/gl_errors.h"

namespace topple::viewer {

struct HeadlessContext::State {
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLContext context = EGL_NO_CONTEXT;
  ~State() {
    if (display == EGL_NO_DISPLAY) return;
    eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    if (context != EGL_NO_CONTEXT) eglDestroyContext(display, context);
    eglTerminate(display);
  }
};

namespace {

[[noreturn]] void refuse(const std::string& why) {
  throw std::runtime_error("no picture can be drawn without a window: " + why);
}

EGLDisplay surfaceless_display() {
  if (!epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless"))
    refuse("EGL lacks the surfaceless platform (Mesa's libegl has it)");
  return eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
}

}  // namespace

HeadlessContext::HeadlessContext() : state_(std::make_unique<State>()) {
  state_->display = surfaceless_display();
  EGLint major = 0, minor = 0;
  if (state_->display == EGL_NO_DISPLAY || eglInitialize(state_->display, &major, &minor) != EGL_TRUE)
    refuse("EGL cannot be initialised");
  if (eglBindAPI(EGL_OPENGL_API) != EGL_TRUE) refuse("EGL has no desktop OpenGL");
  std::vector<EGLint> attributes{EGL_CONTEXT_MAJOR_VERSION,       3,
                                 EGL_CONTEXT_MINOR_VERSION,       3,
                                 EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT};
#ifndef NDEBUG
  attributes.insert(attributes.end(), {EGL_CONTEXT_OPENGL_DEBUG, EGL_TRUE});  // EGL 1.5
#endif
  attributes.push_back(EGL_NONE);
  state_->context = eglCreateContext(state_->display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes.data());
  if (state_->context == EGL_NO_CONTEXT) refuse("the driver has no OpenGL 3.3 core context");
  make_current();
  listen_for_gl_errors();
}
HeadlessContext::~HeadlessContext() = default;

void HeadlessContext::make_current() const {
  if (eglMakeCurrent(state_->display, EGL_NO_SURFACE, EGL_NO_SURFACE, state_->context) != EGL_TRUE)
    refuse("the driver cannot draw without a surface");
}

}  // namespace topple::viewer
