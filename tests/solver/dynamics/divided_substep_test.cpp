// Substeps that are too long for what goes on: told beforehand, and taken in parts.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "dynamics/post_with_mass.h"
#include "frames.h"
#include "topple/solver/frame_dynamics.h"

using namespace topple::test;

namespace {

/// Bending moments over one capacity.
class Moments : public JointLaw {
 public:
  explicit Moments(double capacity) : capacity_(capacity) {}
  [[nodiscard]] double beam_utilisation(int /*beam*/, const Vec12& forces) const override {
    return std::max(use(forces, 0), use(forces, 1));
  }
  [[nodiscard]] double end_utilisation(int /*beam*/, int end, const Vec12& forces) const override {
    return use(forces, end);
  }

 private:
  [[nodiscard]] double use(const Vec12& forces, int end) const {
    return forces.segment<2>(6 * end + 4).norm() / capacity_;
  }
  double capacity_;
};

constexpr double whole = 1.0 / 480;
constexpr double never = std::numeric_limits<double>::infinity(), always = 1e-15;

FrameDynamics swaying(double substep, int most_parts, double largest_error) {
  FrameModel model = tower(4, 3);
  for (Beam& beam : model.beams) beam.density = 7850;
  DynamicOptions options;
  options.substep = substep;
  options.shortest_impulse = whole;
  options.damping = {0.3, 1e-3};
  options.most_parts = most_parts;
  options.largest_error = largest_error;
  FrameDynamics made(model, {}, options);
  made.set_node_load(17, components(1000, 2000, -5000, 30, 0, 50));
  return made;
}

void strike(FrameDynamics& frame, double impulse) {
  frame.strike(std::vector<FrameDynamics::Impulse>{{22, components(impulse, 0, 0, 0, 0, 0)}});
}

double largest_difference(const std::vector<Vec6>& one, const std::vector<Vec6>& other) {
  double off = 0, size = 0;
  for (std::size_t n = 0; n < one.size(); ++n) {
    off = std::max(off, (one[n] - other[n]).norm());
    size = std::max(size, one[n].norm());
  }
  return off / size;
}

}  // namespace

TEST_CASE("A substep in parts is as many substeps of a frame whose own are that short") {
  const int parts = GENERATE(2, 8);
  FrameDynamics divided = swaying(whole, parts, always), other = swaying(whole / parts, 1, never);
  const Moments law(1e12);
  for (int n = 0; n < 12; ++n) {
    for (FrameDynamics* const frame : {&divided, &other}) {
      if (n == 2) strike(*frame, 2000);
      if (n == 5) frame->set_end_stiffness(20, 0, Vec6::Zero());
      if (n == 8) frame->set_beam_density(8, 2 * 7850);
    }
    divided.advance(&law);
    for (int part = 0; part < parts; ++part) other.advance(&law);
    // The same equations by another factor.
    CHECK(largest_difference(other.displacements(), divided.displacements()) < 1e-9);
    CHECK(largest_difference(other.velocities(), divided.velocities()) < 1e-9);
    CHECK(divided.time() == Approx(other.time()).epsilon(1e-13));
  }
  CHECK(divided.counters().divided == 12);
  CHECK(divided.substep() == whole);
  const DynamicEnergy &one = divided.energy(), &two = other.energy();
  for (const auto term : {&DynamicEnergy::kinetic, &DynamicEnergy::elastic, &DynamicEnergy::damped,
                          &DynamicEnergy::freed, &DynamicEnergy::struck, &DynamicEnergy::numerical})
    CHECK(one.*term == Approx(two.*term).margin(1e-8 * one.struck));
  CHECK(balance(one, 0) == Approx(0).margin(1e-9 * one.struck));
}

TEST_CASE("A substep that is near enough is not divided") {
  FrameDynamics careful = swaying(whole, 8, 1e-3), other = swaying(whole, 1, never);
  const Moments law(1e12);
  for (int n = 0; n < 5; ++n) {
    careful.advance(&law);
    other.advance(&law);
  }
  CHECK(careful.displacements() == other.displacements());
  CHECK(careful.energy().damped == other.energy().damped);
  CHECK(careful.counters().substeps == 5);
  CHECK(careful.counters().divided == 0);
}

TEST_CASE("An impact's substeps are divided, and whole again once what it set going has died away") {
  FrameDynamics frame = swaying(whole, 8, 0.02);
  const Moments law(2e5);
  for (int n = 0; n < 100; ++n) frame.advance(&law);
  const std::uint64_t calm = frame.counters().divided;
  strike(frame, 4000);
  frame.advance(&law);
  CHECK(frame.counters().divided == calm + 1);
  for (int n = 0; n < 200; ++n) frame.advance(&law);
  const std::uint64_t after = frame.counters().divided;
  INFO(after - calm << " substeps divided");
  CHECK(after - calm < 100);
  for (int n = 0; n < 20; ++n) frame.advance(&law);
  CHECK(frame.counters().divided == after);
  CHECK(frame.counters().breaks == 0);
}

TEST_CASE("What breaks in a divided substep is what breaks in shorter ones, at the same time") {
  FrameDynamics divided = swaying(whole, 8, always), other = swaying(whole / 8, 1, never);
  const Moments law(1.5e4);
  strike(divided, 8000);
  strike(other, 8000);
  std::size_t count = 0;
  for (int n = 0; n < 20; ++n) {
    const std::vector<JointBreak> by_parts = divided.advance(&law);
    std::vector<JointBreak> by_short;
    for (int part = 0; part < 8; ++part) {
      const std::vector<JointBreak>& now = other.advance(&law);
      by_short.insert(by_short.end(), now.begin(), now.end());
    }
    REQUIRE(by_parts.size() == by_short.size());
    for (std::size_t k = 0; k < by_parts.size(); ++k) {
      CHECK(by_parts[k].beam == by_short[k].beam);
      CHECK(by_parts[k].end == by_short[k].end);
      CHECK(by_parts[k].time == Approx(by_short[k].time).margin(1e-8));
    }
    count += by_parts.size();
  }
  CHECK(count > 0);
}

TEST_CASE("A joint that comes to its capacity divides the substep, however near that is") {
  FrameDynamics frame = swaying(whole, 8, 1e9);
  const Moments law(1.5e4);
  strike(frame, 8000);
  std::uint64_t with_breaks = 0;
  for (int n = 0; n < 20; ++n) with_breaks += frame.advance(&law).empty() ? 0 : 1;
  CHECK(with_breaks > 0);
  CHECK(frame.counters().divided >= with_breaks);
  CHECK(frame.counters().divided < 20);
}

TEST_CASE("The factor of whole substeps takes over at once what broke in the parts of one") {
  FrameDynamics frame = swaying(whole, 8, 1e9);
  const Moments law(1.5e4);
  strike(frame, 8000);
  const auto taken_over = [&] {
    return frame.reanalysis_counters().low_rank + frame.reanalysis_counters().refactorisations;
  };
  std::uint64_t most_retaken = 0;
  for (int n = 0; n < 20; ++n) {
    const std::uint64_t before = taken_over(), retaken = frame.counters().retaken;
    frame.advance(&law);
    CHECK(taken_over() - before <= 1);
    most_retaken = std::max(most_retaken, frame.counters().retaken - retaken);
  }
  CHECK(most_retaken > 1);
}

TEST_CASE("What leaves in a part of a substep leaves with what its loads gave it until the substep's end") {
  // A beam hangs on another by its upper end; the lower one bears a load, and its joint gives way.
  FrameModel model;
  model.nodes = {Vec3(0, 0, 4), Vec3(0, 0, 2), Vec3(0, 0, 0)};
  model.supports = {{0, fixed()}};
  add_beam(model, 0, 1);
  add_beam(model, 1, 2);
  for (Beam& beam : model.beams) beam.density = 7850;
  model.beams[1].end_stiffness[1] = Vec6::Zero();
  class Pull : public JointLaw {
   public:
    [[nodiscard]] double beam_utilisation(int beam, const Vec12& forces) const override {
      return end_utilisation(beam, 0, forces);
    }
    [[nodiscard]] double end_utilisation(int beam, int end, const Vec12& forces) const override {
      return beam == 1 && end == 0 ? -forces(0) / 2e4 : 0;
    }
  } law;
  const auto made = [&](double substep, int parts) {
    DynamicOptions options;
    options.substep = substep;
    options.most_parts = parts;
    options.largest_error = parts > 1 ? always : never;
    FrameDynamics frame(model, {}, options);
    BeamLoad load;
    load.beam = 1;
    load.kind = BeamLoad::Kind::distributed;
    load.to = 2;
    load.first = load.last = components(2e4, 300, 0, 0, 0, 0);  // along the beam, which hangs
    frame.set_beam_loads(1, {load});
    return frame;
  };
  constexpr double h = 1e-3;
  FrameDynamics divided = made(h, 8), other = made(h / 8, 1);
  bool left = false;
  for (int n = 0; n < 100 && !left; ++n) {
    left = !divided.advance(&law).empty();
    Vec6 with = Vec6::Zero();
    double since = 0;
    for (int part = 0; part < 8; ++part) {
      if (since > 0) since += h / 8;
      if (other.advance(&law).empty()) continue;
      with = other.beam_momentum(1);
      since = 1e-300;
    }
    if (!left) continue;
    REQUIRE(since > 0);
    const Vec3 force = 2 * Vec3(0, 0, -2e4) + 2 * (model.beams[1].axes.row(1).transpose() * 300);
    Vec6 later = with;
    later.head<3>() += since * force;
    later.tail<3>() += since * Vec3(0, 0, 1).cross(force);
    CHECK((divided.beam_momentum(1) - later).norm() < 1e-9 * later.norm());
  }
  CHECK(left);
}

TEST_CASE("What a frame foresees is of a whole substep, whatever the last one was divided into") {
  FrameDynamics divided = swaying(whole, 8, always), other = swaying(whole, 1, never);
  const Moments law(1e12);
  divided.advance(&law);
  other.set_state(divided.displacements(), divided.velocities());
  const std::vector<Vec6> foreseen = divided.foresee();
  const std::vector<Vec6> of_other = other.foresee();
  // Accelerations begin at nothing in the other one.
  CHECK(largest_difference(of_other, foreseen) < 0.2);
  divided.advance();  // without a law nothing is divided
  CHECK(divided.counters().divided == 1);
  CHECK(divided.time() == Approx(2 * whole).epsilon(1e-13));
}

TEST_CASE("Substeps that are divided take no loads that go with time, and options out of range are refused") {
  FrameDynamics frame = swaying(whole, 8, 0.02);
  CHECK_THROWS_AS(frame.add_pattern({}), std::invalid_argument);
  CHECK_THROWS_AS(frame.add_ground_acceleration(Vec3(1, 0, 0)), std::invalid_argument);
  CHECK_THROWS_AS(frame.add_holding_force(), std::invalid_argument);
  CHECK_THROWS_AS(swaying(whole, 0, 0.02), std::invalid_argument);
  CHECK_THROWS_AS(swaying(whole, 8, 0), std::invalid_argument);
}

TEST_CASE("A substep is told to be off by about what shorter ones find otherwise") {
  // A mass that swings on a post; the moment at its foot, over a capacity. The error that is told decides how many
  // parts a substep takes: it is read from the error at which the substep is no longer divided.
  const double stiffness = 3 * post().beams[0].youngs_modulus * post().beams[0].Iy / std::pow(height, 3);
  const double w = std::sqrt(stiffness / tip_mass), capacity = stiffness * height * 0.01;
  const Moments law(capacity);
  for (const double turn : {0.4, 0.2, 0.1}) {  // rad of the swing in a substep
    const auto swings = [&](double largest_error) {
      DynamicOptions options;
      options.substep = turn / w;
      options.most_parts = 64;
      options.largest_error = largest_error;
      FrameDynamics frame(post(), mass_on_post(), options);
      std::vector<Vec6> u(2, Vec6::Zero()), v(2, Vec6::Zero());
      v[1].x() = 0.01 * w;
      frame.set_state(u, v);
      // Through its place again for the fourth time, where accelerations change most. They begin at nothing, and come
      // to the motion's own in some substeps.
      while (frame.time() * w < 4 * M_PI) frame.advance();
      return frame;
    };
    FrameDynamics as_whole = swings(1e9), in_parts = swings(always);
    as_whole.advance(&law);
    in_parts.advance(&law);
    const double lacks = law.beam_utilisation(0, as_whole.beam_end_forces(0) - in_parts.beam_end_forces(0));
    INFO("turn " << turn << ": lacks " << lacks);
    const auto divides = [&](double error) {
      FrameDynamics frame = swings(error);
      frame.advance(&law);
      return frame.counters().divided == 1;
    };
    CHECK(divides(lacks / 5));
    CHECK_FALSE(divides(5 * lacks));
  }
}
