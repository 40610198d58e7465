#pragma once
// What OpenGL complains of.
namespace topple::viewer {

/// From now on the current context's driver tells errors, and what is undefined, in words (KHR_debug), where it can.
void listen_for_gl_errors();

/// Throws std::runtime_error, with the driver's words if it told any, when OpenGL has had an error since the last call.
void check_gl_errors();

}  // namespace topple::viewer
