#include "app/playback/playback.h"

#include <algorithm>
#include <array>

namespace topple::viewer {

Snapshot Playback::now() const {
  return looking_at_ ? driver_.recording().at(*looking_at_) : driver_.moment().interpolated();
}

void Playback::advance(double seconds) {
  if (!looking_at_ || !replaying_) return;
  const auto span = driver_.recording().span();
  looking_at_ = *looking_at_ + seconds * driver_.speed();
  if (*looking_at_ >= span[1]) {
    looking_at_ = span[1];
    replaying_ = false;
  }
}

void Playback::seek(double time) {
  const auto span = driver_.recording().span();
  looking_at_ = std::clamp(time, span[0], span[1]);
  driver_.set_paused(true);
}

void Playback::seek_by(double seconds) {
  const std::array<double, 2> span = driver_.recording().span();
  const double time = looking_at_.value_or(span[1]) + seconds;
  time < span[1] ? seek(std::max(time, span[0])) : seek_present();
}

void Playback::seek_present() {
  looking_at_.reset();
  replaying_ = false;
}

void Playback::record_past() {
  driver_.order_and_show([](Session& session) { session.record_past(); });
}

void Playback::go_on_from_here() {
  if (!looking_at_) return;
  const std::int64_t step = driver_.recording().at(*looking_at_).step;
  seek_present();
  driver_.order_and_show([step](Session& session) { session.return_to(step); });
}

}  // namespace topple::viewer
