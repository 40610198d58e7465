#pragma once
// Plays what is heard of a run where the eye is, by OpenAL: through the machine's device, or into memory for videos and
// tests.
#include <glm/vec3.hpp>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "renderer/camera.h"
#include "renderer/snapshot.h"

namespace topple::viewer {

/// m/s: what is far off is heard later than it is seen.
inline constexpr double speed_of_sound = 343;

class Speaker {
 public:
  /// The usual device; null where there is none, or none that works.
  [[nodiscard]] static std::unique_ptr<Speaker> open();
  /// Into memory: see render(). Throws std::runtime_error where OpenAL cannot.
  [[nodiscard]] static std::unique_ptr<Speaker> into_memory();
  ~Speaker();
  Speaker(const Speaker&) = delete;
  Speaker& operator=(const Speaker&) = delete;

  /// Starts what has become audible since the last call: what happened between its moment and this one, at the eye's
  /// distance. Silent after a jump in time. `pace`: simulated seconds for each second; slower sounds lower.
  void hear(const Snapshot& moment, const Camera& camera, double pace);
  void set_volume(double volume);  ///< 0 to 1
  /// The next so many samples in stereo, left and right in turn, -1 to 1. Only into_memory().
  [[nodiscard]] std::vector<float> render(int count);
  /// Sounds that play now.
  [[nodiscard]] int playing() const;

 private:
  struct State;
  explicit Speaker(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// Samples in stereo as a WAV file of 16 bits. Throws std::runtime_error with the path.
void write_wav(const std::string& file, const std::vector<float>& samples);

}  // namespace topple::viewer
