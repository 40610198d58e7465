#pragma once
// An OpenGL 3.3 core context without any window or display server: EGL's surfaceless platform.
#include <memory>

namespace topple::viewer {

class HeadlessContext {
 public:
  /// Makes it current on this thread. Throws std::runtime_error with one line that says what is missing.
  HeadlessContext();
  ~HeadlessContext();
  HeadlessContext(const HeadlessContext&) = delete;
  HeadlessContext& operator=(const HeadlessContext&) = delete;
  void make_current() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace topple::viewer
