#pragma once
// A ground that shakes under the building, and everything on it.
#include <cstdint>
#include <memory>

#include "topple/structure/motion.h"

namespace topple::viewer {

/// Everything is told in the axes of the ground, where an acceleration of the ground is a gravity the other way
/// (d'Alembert), on what stands and on what lies about.
struct Earthquake {
  std::shared_ptr<const structure::TimeHistory> ground;  ///< accelerations along the global axes, m/s2
};
/// m/s2, at a time since its beginning; zero before and after.
[[nodiscard]] structure::Vec3 ground_acceleration(const structure::TimeHistory& ground, double time);
/// Throws structure::InputError for a series that is no acceleration.
void require_ground(const structure::TimeHistory& ground);

/// Strong motion on firm soil by chance: a stationary process with the spectrum of Kanai and Tajimi (ground frequency
/// 5 pi rad/s, damping 0.6), summed from cosines of random phases (Shinozuka and Jan, J. Sound Vib. 25, 1972), that
/// swells in the first tenth of its length and dies away in the last half. x and y are independent of each other; the
/// larger reaches the peak. Numbers: m/s2; s.
[[nodiscard]] structure::TimeHistory strong_motion(double peak, double duration, std::uint64_t seed = 1);

}  // namespace topple::viewer
