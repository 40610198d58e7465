// Where buckling members bend most: against the closed forms of Euler's cases, and against the exact curve of a
// beam-column.
#include <catch2/catch.hpp>
#include <cmath>

#include "elements/beam_column.h"
#include "topple/solver/buckling_bend.h"

namespace {

using namespace topple::solver;

constexpr double pi = 3.14159265358979323846, length = 6, EI = 2e11 * 1e-5;
constexpr double clamped_pinned = 4.4934094579090642;  // the first root of tan x = x

Beam column() {
  Beam beam;
  beam.length = length;
  beam.youngs_modulus = 2e11;
  beam.shear_modulus = 8e10;
  beam.area = 0.01;
  beam.Iy = 3e-5;
  beam.Iz = 1e-5;
  beam.J = 1e-5;
  return beam;
}
Beam pinned(bool first, bool second) {
  Beam beam = column();
  if (first) beam.end_stiffness[0].tail<2>().setZero();
  if (second) beam.end_stiffness[1].tail<2>().setZero();
  return beam;
}
double euler(double kL) { return kL * kL * EI / (length * length); }

}  // namespace

TEST_CASE("a pinned column bends most in its middle") {
  const Beam beam = pinned(true, true);
  CHECK(buckling_load_between_resting_ends(beam) == Approx(euler(pi)).epsilon(1e-9));
  const BucklingBend bend = buckling_bend(beam, euler(pi), Vec12::Zero());
  CHECK(bend.place == Approx(length / 2).epsilon(1e-9));
  CHECK(bend.at_ends[0] < 1e-9 * bend.moment);
  CHECK(bend.at_ends[1] < 1e-9 * bend.moment);
}

TEST_CASE("a column that is clamped at one end bends most at 0.35 of its length from the pinned one") {
  for (const bool clamped_below : {true, false}) {
    const Beam beam = pinned(!clamped_below, clamped_below);
    CHECK(buckling_load_between_resting_ends(beam) == Approx(euler(clamped_pinned)).epsilon(1e-9));
    const BucklingBend bend = buckling_bend(beam, euler(clamped_pinned), Vec12::Zero());
    // From the pinned end the moment is a sine: highest at a quarter of its wave, sqrt(1 + 1/x2) of that at the clamp.
    const double from_pin = length * pi / 2 / clamped_pinned;
    CHECK(bend.place == Approx(clamped_below ? length - from_pin : from_pin).epsilon(1e-8));
    CHECK(bend.moment / bend.at_ends[clamped_below ? 0 : 1] ==
          Approx(std::sqrt(1 + 1 / (clamped_pinned * clamped_pinned))).epsilon(1e-8));
  }
}

TEST_CASE("a clamped column bends as much at its ends as in its middle") {
  const Beam beam = column();
  CHECK(buckling_load_between_resting_ends(beam) == Approx(euler(2 * pi)).epsilon(1e-9));
  const BucklingBend bend = buckling_bend(beam, euler(2 * pi), Vec12::Zero());
  CHECK(bend.at_ends[0] == Approx(bend.moment).epsilon(1e-8));
  CHECK(bend.at_ends[1] == Approx(bend.moment).epsilon(1e-8));
}

TEST_CASE("a column whose head sways without turning bends most at both ends, one with a free head at its foot") {
  Vec12 sways = Vec12::Zero();
  sways(7) = 1;
  const BucklingBend bend = buckling_bend(column(), euler(pi), sways);
  CHECK(bend.at_ends[0] == Approx(bend.moment).epsilon(1e-9));
  CHECK(bend.at_ends[1] == Approx(bend.moment).epsilon(1e-9));
  CHECK(bend.moment == Approx(euler(pi) / 2));  // P times half the sway

  Vec12 leans = sways;
  leans(11) = pi / 2 / length;
  const BucklingBend free = buckling_bend(column(), euler(pi / 2), leans);
  CHECK(free.place == 0);
  CHECK(free.moment == Approx(euler(pi / 2)));
  CHECK(free.at_ends[1] < 1e-9 * free.moment);
}

TEST_CASE("the bend in a shape is that of the exact beam-column with shear and springs, in either plane") {
  for (const bool xz : {false, true})
    for (const double spring : {1e5, 3e6, double(rigid)}) {
      Beam beam = column();
      (xz ? beam.shear_area_z : beam.shear_area_y) = 1e-5;
      beam.end_stiffness[1](xz ? 4 : 5) = spring;
      beam.end_stiffness[0](xz ? 2 : 1) = 8e5;
      const double P = 0.5 * EI / (length * length);
      const Eigen::Vector4d motion(0.3, -0.1, 0.5, 0.2);
      Vec12 rigid_ends = Vec12::Zero();
      if (xz)
        rigid_ends(2) = motion(0), rigid_ends(4) = -motion(1), rigid_ends(8) = motion(2), rigid_ends(10) = -motion(3);
      else
        rigid_ends(1) = motion(0), rigid_ends(5) = motion(1), rigid_ends(7) = motion(2), rigid_ends(11) = motion(3);
      const double bending = 2e11 * (xz ? 3e-5 : 1e-5);
      const ColumnStretch stretch{0, length, {-P, 0, 0}};
      const BeamColumn exact({bending, 1 / (8e10 * 1e-5), 0}, {&stretch, 1}, {8e5, rigid, rigid, spring});
      const BeamColumn::Curve curve = exact.curve(motion);
      double most = 0;
      for (int i = 0; i <= 1000; ++i) most = std::max(most, std::abs(curve.value(2, length * i / 1000)));
      const BucklingBend bend = buckling_bend(beam, P, rigid_ends);
      CAPTURE(xz, spring);
      CHECK(bend.moment == Approx(most).epsilon(1e-5));
      CHECK(bend.at_ends[0] == Approx(std::abs(curve.value(2, 0))).epsilon(1e-8));
      CHECK(bend.at_ends[1] == Approx(std::abs(curve.value(2, length))).epsilon(1e-8));
      CHECK(std::abs(curve.value(2, bend.place)) == Approx(bend.moment).epsilon(1e-8));
    }
}
