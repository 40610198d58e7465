#include "app/playback/camera_path.h"

namespace topple::viewer {

bool CameraPath::fly() {
  constexpr double leg = 3;  // s, between two views
  if (views_.size() < 2) return false;
  flight_ = {views_, leg, 0};
  return true;
}

void CameraPath::glide(const Camera& from, const Camera& to, double over) {
  flight_.reset();
  if (over > 0) flight_ = {{from, to}, over, 0};
}

std::optional<Camera> CameraPath::advance(double seconds) {
  if (!flight_) return std::nullopt;
  flight_->gone += seconds;
  const Camera camera = along_path(flight_->views, flight_->gone / flight_->leg);
  if (flight_->gone >= flight_->leg * static_cast<double>(flight_->views.size() - 1)) flight_.reset();
  return camera;
}

}  // namespace topple::viewer
