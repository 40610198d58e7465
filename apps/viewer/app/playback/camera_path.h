#pragma once
// Places that the eye is to fly through, and its flight.
#include <optional>
#include <vector>

#include "renderer/camera.h"

namespace topple::viewer {

class CameraPath {
 public:
  void add(const Camera& view) { views_.push_back(view); }
  [[nodiscard]] std::size_t size() const { return views_.size(); }
  void forget() { views_.clear(), flight_.reset(); }
  /// Through them all, at an even pace. False, and nothing, with fewer than two.
  [[nodiscard]] bool fly();
  /// From one place to another in this time, s; at once where it is 0.
  void glide(const Camera& from, const Camera& to, double over);
  [[nodiscard]] bool flying() const { return flight_.has_value(); }
  /// Where the eye is when this much time has gone by, s; nothing when it does not fly.
  [[nodiscard]] std::optional<Camera> advance(double seconds);

 private:
  /// How long each leg takes, how long the flight has gone on, s.
  struct Flight {
    std::vector<Camera> views;
    double leg = 0, gone = 0;
  };
  std::vector<Camera> views_;
  std::optional<Flight> flight_;
};

}  // namespace topple::viewer
