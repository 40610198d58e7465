#include "solver/free_rotation.h"

#include <algorithm>
#include <cmath>

namespace topple::collision {

namespace {

using Quat = Eigen::Quaterniond;

/// Largest turn about one principal axis in a part of the step, rad, and the most parts: beyond, a body spins by more
/// than 200 rad in a step, which no contact gives.
constexpr double largest_turn = 0.05;
constexpr int most_parts = 4096;

struct Turn {
  double sine, cosine;
  /// By series, to rounding up to the largest turn of a part.
  explicit Turn(double x) {
    if (std::abs(x) > 2 * largest_turn) {
      sine = std::sin(x), cosine = std::cos(x);
      return;
    }
    const double s = x * x;
    sine = x * (1 - s / 6 * (1 - s / 20 * (1 - s / 42 * (1 - s / 72))));
    cosine = 1 - s / 2 * (1 - s / 12 * (1 - s / 30 * (1 - s / 56 * (1 - s / 90))));
  }
};

/// Momentum in the body's axes, and how its axes turned since the beginning.
struct Turning {
  Vec3 momentum;
  Quat turned = Quat::Identity();

  void about(int axis, const Vec3& inertia, double time) {
    const double angle = momentum[axis] / inertia[axis] * time;
    const int next = (axis + 1) % 3, last = (axis + 2) % 3;
    const Turn whole(angle), half(angle / 2);
    const double a = momentum[next], b = momentum[last];
    momentum[next] = whole.cosine * a + whole.sine * b;
    momentum[last] = whole.cosine * b - whole.sine * a;
    Vec3 vector = Vec3::Zero();
    vector[axis] = half.sine;
    turned *= Quat(half.cosine, vector.x(), vector.y(), vector.z());
  }
};

}  // namespace

FreeRotation rotated_freely(const FreeRotation& now, const Vec3& inertia, double time) {
  Turning turning;
  turning.momentum = inertia.cwiseProduct(now.orientation.conjugate() * now.spin);
  // No axis can come to turn faster than with all of the momentum about it; what it does turn by is far less when the
  // body tumbles, so the parts go by the energy: the fastest rate that it allows.
  const double energy = turning.momentum.cwiseQuotient(inertia).dot(turning.momentum), size = turning.momentum.norm();
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
  const Quat orientation = (now.orientation * turning.turned).normalized();
  return {orientation, orientation * turning.momentum.cwiseQuotient(inertia)};
}

}  // namespace topple::collision
