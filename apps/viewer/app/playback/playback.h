#pragma once
// Which moment of the run is seen: the present, or one of those that have been recorded.
#include <optional>

#include "app/driver.h"

namespace topple::viewer {

class Playback {
 public:
  explicit Playback(Driver& driver) : driver_(driver) {}

  /// s, within what was recorded; the simulation pauses.
  void seek(double time);
  /// From what is looked at; beyond the end of what was recorded is the present.
  void seek_by(double seconds);
  static constexpr double key_step = 0.25;  ///< s, of a key
  void seek_present();
  /// Runs again from the beginning where the past was not recorded (the run was loaded), so that it can be looked back
  /// at.
  void record_past();
  /// Plays on from what is looked at, or no more.
  void replay(bool on) { replaying_ = on; }
  [[nodiscard]] bool replaying() const { return replaying_; }
  /// s; none: the present.
  [[nodiscard]] const std::optional<double>& looking_at() const { return looking_at_; }
  /// The run goes on from the moment that is looked at; what came after it is forgotten. No effect in the present.
  void go_on_from_here();

  /// This much time of a person goes by, s.
  void advance(double seconds);
  /// What is seen.
  [[nodiscard]] Snapshot now() const;

 private:
  Driver& driver_;
  std::optional<double> looking_at_;
  bool replaying_ = false;
};

}  // namespace topple::viewer
