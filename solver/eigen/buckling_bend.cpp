#include "topple/solver/buckling_bend.h"

#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>

namespace topple::solver {
namespace {

constexpr double pi = 3.14159265358979323846;

/// One bending plane: freedoms v1, r1, v2, r2, where a positive rotation is v' of a member without shear.
struct Plane {
  double EI = 0, shear_compliance = 0, length = 0;
  std::array<double, 4> spring{};
};

Plane plane_of(const Beam& beam, bool xz) {
  Plane plane;
  plane.EI = beam.youngs_modulus * (xz ? beam.Iy : beam.Iz);
  const double area = xz ? beam.shear_area_z : beam.shear_area_y;
  plane.shear_compliance = area > 0 ? 1 / (beam.shear_modulus * area) : 0;
  plane.length = beam.length;
  for (std::size_t end = 0; end < 2; ++end) {
    plane.spring[2 * end] = beam.end_stiffness[end](xz ? 2 : 1);
    plane.spring[2 * end + 1] = beam.end_stiffness[end](xz ? 4 : 5);
  }
  return plane;
}

Eigen::Vector4d rigid_ends_in(const Vec12& rigid_ends, bool xz) {
  return xz ? Eigen::Vector4d(rigid_ends(2), -rigid_ends(4), rigid_ends(8), -rigid_ends(10))
            : Eigen::Vector4d(rigid_ends(1), rigid_ends(5), rigid_ends(7), rigid_ends(11));
}

double wave_number(const Plane& plane, double compression) {
  return std::sqrt(compression / (plane.EI * (1 - compression * plane.shear_compliance)));
}
double compression_at(const Plane& plane, double k) {
  const double P = plane.EI * k * k;
  return P / (1 + P * plane.shear_compliance);
}

/// The four conditions at the ends on c0, c1 L, c2, c3, all of a length: what the spring gives is what the member
/// bears.
struct Conditions {
  Eigen::Matrix4d of_shape;
  Eigen::Vector4d of_rigid_ends;  ///< what each rigid end's freedom counts in its condition
};
Conditions conditions(const Plane& plane, double compression) {
  const double L = plane.length, P = compression, k = wave_number(plane, P);
  const double softened = k * (1 - P * plane.shear_compliance);
  Conditions all;
  for (int end = 0; end < 2; ++end) {
    const double x = end == 0 ? 0 : L, sign = end == 0 ? 1 : -1;
    const double c = std::cos(k * x), s = std::sin(k * x);
    const Eigen::RowVector4d shift(1, x / L, c, s), turn(0, 1, -softened * L * s, softened * L * c);
    const Eigen::RowVector4d bears(0, 0, -P * c, -P * s), thrust(0, -P / L, 0, 0);
    const auto row = [&](int freedom, const Eigen::RowVector4d& moved, const Eigen::RowVector4d& borne, double scale) {
      // Of the spring's stiffness and that of the member: 1 and 0 when it is rigid, 0 and 1 when it is released.
      const double spring = plane.spring[static_cast<std::size_t>(freedom)];
      const double held = std::isinf(spring) ? 1 : spring / (spring + scale);
      const double free = std::isinf(spring) ? 0 : 1 / (spring + scale);
      all.of_shape.row(freedom) = held * moved - sign * free * borne;
      all.of_rigid_ends(freedom) = held;
    };
    row(2 * end, shift, thrust, plane.EI / (L * L * L));
    // The turn counts times the length, the moment so too over the length.
    row(2 * end + 1, turn, bears * L, plane.EI / L);
    all.of_rigid_ends(2 * end + 1) *= L;
  }
  return all;
}

/// Of the plane alone, between resting rigid ends.
double resting_load(const Plane& plane) {
  constexpr int trials = 256;
  constexpr double widest = 2 * pi * (1 + 1e-9);  // kL of rigid ends
  double before = 0, last = 0;
  const auto determinant = [&](double kL) {
    return conditions(plane, compression_at(plane, kL / plane.length)).of_shape.determinant();
  };
  for (int i = 1; i <= trials; ++i) {
    const double here = widest * i / trials, value = determinant(here);
    // Near zero the determinant goes to zero with the fourth power, whatever the ends are.
    if (i > 1 && before != 0 && value * before <= 0) {
      double low = last, high = here;
      for (int turn = 0; turn < 60; ++turn) {
        const double middle = low + (high - low) / 2;
        (determinant(middle) * before > 0 ? low : high) = middle;
      }
      return compression_at(plane, low / plane.length);
    }
    before = value;
    last = here;
  }
  return std::numeric_limits<double>::infinity();
}

/// The moment along the member: its size, place and ends.
BucklingBend bend_of(const Plane& plane, double compression, const Eigen::Vector4d& shape) {
  const double k = wave_number(plane, compression), L = plane.length;
  const auto moment = [&](double x) {
    return std::abs(compression * (shape(2) * std::cos(k * x) + shape(3) * std::sin(k * x)));
  };
  BucklingBend bend;
  bend.at_ends = {moment(0), moment(L)};
  bend.place = bend.at_ends[1] > bend.at_ends[0] ? L : 0;
  bend.moment = std::max(bend.at_ends[0], bend.at_ends[1]);
  // Where it is level: tan kx = c3/c2.
  double level = std::atan2(shape(3), shape(2)) / k;
  while (level <= 0) level += pi / k;
  while (level > pi / k) level -= pi / k;
  // Of an end and a place inside that bend as much, the place inside.
  constexpr double as_much = 1 - 1e-6;
  for (double x = level; x < L; x += pi / k)
    if (moment(x) > as_much * bend.moment) {
      bend.moment = std::max(bend.moment, moment(x));
      bend.place = x;
    }
  return bend;
}

Eigen::Vector4d shape_between(const Plane& plane, double compression, const Eigen::Vector4d& rigid_ends) {
  const Conditions ends = conditions(plane, compression);
  return ends.of_shape.fullPivLu().solve(ends.of_rigid_ends.cwiseProduct(rigid_ends));
}

Eigen::Vector4d resting_shape(const Plane& plane, double compression) {
  const Conditions ends = conditions(plane, compression);
  return Eigen::JacobiSVD<Eigen::Matrix4d>(ends.of_shape, Eigen::ComputeFullV).matrixV().col(3);
}

}  // namespace

double buckling_load_between_resting_ends(const Beam& beam) {
  return std::min(resting_load(plane_of(beam, false)), resting_load(plane_of(beam, true)));
}

BucklingBend buckling_bend(const Beam& beam, double compression, const Vec12& rigid_ends) {
  if (rigid_ends.isZero(0)) {
    const Plane xy = plane_of(beam, false), xz = plane_of(beam, true);
    const double in_xy = resting_load(xy), in_xz = resting_load(xz);
    const double load = std::min(in_xy, in_xz);
    if (std::isinf(load)) return {};
    const Plane& plane = in_xz < in_xy ? xz : xy;
    return bend_of(plane, load, resting_shape(plane, load));
  }
  // Below this, times the length, the shape is the cubic to ten digits and the four functions are all but dependent.
  constexpr double slightest = 0.02;
  BucklingBend most;
  for (const bool xz : {false, true}) {
    const Plane plane = plane_of(beam, xz);
    const double P = std::max(compression, compression_at(plane, slightest / plane.length));
    const BucklingBend own = bend_of(plane, P, shape_between(plane, P, rigid_ends_in(rigid_ends, xz)));
    const std::array<double, 2> ends{std::max(most.at_ends[0], own.at_ends[0]),
                                     std::max(most.at_ends[1], own.at_ends[1])};
    if (own.moment > most.moment) most = own;
    most.at_ends = ends;
  }
  return most;
}

}  // namespace topple::solver
