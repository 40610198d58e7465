#include "solver/free_spin.h"

#include <LinearMath/btMatrix3x3.h>

#include <algorithm>
#include <cmath>

namespace topple::collision {

namespace {

/// Largest turn about one principal axis in a part of the step, rad, and the most parts: beyond, a body spins by more
/// than 200 rad in a step, which no contact gives.
constexpr double largest_turn = 0.05;
constexpr int most_parts = 4096;

/// Momentum in the body's axes, and how its axes turned since the beginning.
struct Turning {
  btVector3 momentum;
  btQuaternion turned = btQuaternion::getIdentity();

  void about(int axis, const btVector3& inertia, double time) {
    const double angle = momentum[axis] / inertia[axis] * time;
    const int next = (axis + 1) % 3, last = (axis + 2) % 3;
    const double c = std::cos(angle), s = std::sin(angle), a = momentum[next], b = momentum[last];
    momentum[next] = c * a + s * b;
    momentum[last] = c * b - s * a;
    btVector3 half(0, 0, 0);
    half[axis] = std::sin(angle / 2);
    turned *= btQuaternion(half.x(), half.y(), half.z(), std::cos(angle / 2));
  }
};

}  // namespace

FreeSpin turned_freely(const FreeSpin& spin, const btVector3& inertia, double time) {
  const btMatrix3x3 axes(spin.orientation);
  Turning turning;
  turning.momentum = inertia * (spin.angular_velocity * axes);
  // No axis can come to turn faster than with all of the momentum about it; what it does turn by is far less when the
  // body tumbles, so the parts go by the energy: the fastest rate that it allows.
  const btVector3 rate = turning.momentum / inertia;
  const double energy = rate.dot(turning.momentum);
  const double size = turning.momentum.length();
  double fastest = 0;
  for (int axis = 0; axis < 3; ++axis)
    fastest = std::max(fastest, std::min(size / inertia[axis], std::sqrt(energy / inertia[axis])));
  const int parts = static_cast<int>(std::clamp(std::ceil(fastest * time / largest_turn), 1.0, double(most_parts)));
  const double h = time / parts;
  for (int part = 0; part < parts; ++part) {
    turning.about(0, inertia, h / 2);
    turning.about(1, inertia, h / 2);
    turning.about(2, inertia, h);
    turning.about(1, inertia, h / 2);
    turning.about(0, inertia, h / 2);
  }
  const btQuaternion orientation = (spin.orientation * turning.turned).normalized();
  return {orientation, btMatrix3x3(orientation) * (turning.momentum / inertia)};
}

}  // namespace topple::collision
