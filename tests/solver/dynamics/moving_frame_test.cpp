// Whole frames in motion: against all modes of a shear building, and what must be kept: energy and momentum.
#include <Eigen/Eigenvalues>
#include <array>
#include <catch2/catch.hpp>

#include "frames.h"
#include "topple/solver/frame_dynamics.h"

using namespace topple::test;

namespace {

constexpr int storeys = 12;
constexpr double storey_mass = 2e4, storey_height = 3;

/// Storeys that move along x alone, on columns without mass that bend in double curvature.
FrameModel shear_building() {
  FrameModel model;
  for (int k = 0; k <= storeys; ++k) {
    model.nodes.emplace_back(0, 0, storey_height * k);
    model.supports.push_back({k, components(k == 0 ? rigid : 0, rigid, rigid, rigid, rigid, rigid)});
    if (k == 0) continue;
    add_beam(model, k - 1, k);
    Beam& column = model.beams.back();
    column.shear_area_y = column.shear_area_z = 0;
    column.Iy = column.Iz = 4e-4 * (1 + 0.05 * (storeys - k));
  }
  return model;
}

MassModel storey_masses() {
  MassModel masses;
  for (int k = 1; k <= storeys; ++k) masses.nodes.push_back({k, storey_mass * (k == storeys ? 0.7 : 1), Vec3::Zero()});
  return masses;
}

/// The same by hand: K and M of the storeys, and all modes; exact in time.
class AllModes {
 public:
  AllModes(const FrameModel& model, const MassModel& masses) {
    K = Eigen::MatrixXd::Zero(storeys, storeys);
    M = Eigen::MatrixXd::Zero(storeys, storeys);
    for (int k = 0; k < storeys; ++k) {
      const Beam& column = model.beams[static_cast<std::size_t>(k)];
      const double shear = 12 * column.youngs_modulus * column.Iy / std::pow(column.length, 3);
      storey_stiffness.push_back(shear);
      K(k, k) += shear;
      if (k > 0) {
        K(k - 1, k - 1) += shear;
        K(k - 1, k) -= shear;
        K(k, k - 1) -= shear;
      }
      M(k, k) = masses.nodes[static_cast<std::size_t>(k)].mass;
    }
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> modes(K, M);
    shapes = modes.eigenvectors();
    w = modes.eigenvalues().cwiseSqrt();
  }
  /// Under a constant load from rest at zero.
  [[nodiscard]] Eigen::VectorXd under(const Eigen::VectorXd& f, double t) const {
    const Eigen::VectorXd q = (shapes.transpose() * f).array() / w.array().square() * (1 - (w.array() * t).cos());
    return shapes * q;
  }
  [[nodiscard]] Eigen::VectorXd shears(const Eigen::VectorXd& u) const {
    Eigen::VectorXd result(storeys);
    for (int k = 0; k < storeys; ++k)
      result(k) = storey_stiffness[static_cast<std::size_t>(k)] * (u(k) - (k > 0 ? u(k - 1) : 0));
    return result;
  }
  Eigen::MatrixXd K, M, shapes;
  Eigen::VectorXd w;
  std::vector<double> storey_stiffness;
};

/// Peaks of the storeys' shears over two seconds under a load that comes at once at the top, by cubic courses.
Eigen::VectorXd computed_peaks(double h, double load) {
  DynamicOptions options;
  options.substep = h;
  options.spectral_radius = 1;
  FrameDynamics frame(shear_building(), storey_masses(), options);
  frame.set_node_load(storeys, unit(0, load));
  Eigen::VectorXd peaks = Eigen::VectorXd::Zero(storeys);
  while (frame.time() < 2 - h / 2) {
    frame.advance();
    for (int k = 0; k < storeys; ++k) {
      const SubstepCourse<Vec12> course = frame.beam_course(k);
      for (int part = 1; part <= 16; ++part) {
        const Vec12 forces = course.at(part / 16.0);
        peaks(k) = std::max(peaks(k), forces.head<3>().cwiseAbs().maxCoeff());
      }
    }
  }
  return peaks;
}

/// A bay of two columns and a beam with mass, offsets and a pinned end, in a skew place: nothing is zero by symmetry.
FrameModel portal(double density) {
  FrameModel model;
  model.nodes = {Vec3(0, 0, 0), Vec3(0.4, 0.1, 3), Vec3(4.2, 0.7, 3.3), Vec3(4.4, 0.2, 0), Vec3(7.5, 1.0, 2.9)};
  add_beam(model, 0, 1);
  add_beam(model, 1, 2);
  add_beam(model, 3, 2);
  add_beam(model, 2, 4);
  for (Beam& beam : model.beams) beam.density = density;
  model.supports = {{0, fixed()}, {3, fixed()}};
  return model;
}

/// Nothing holds it, and the method keeps its energy.
FrameDynamics free_portal() {
  FrameModel model = portal(7850);
  model.supports.clear();
  DynamicOptions options;
  options.substep = 1.0 / 2000;
  options.spectral_radius = 1;
  return {model, {}, options};
}

}  // namespace

TEST_CASE("Storey shears of a shear building under a sudden load peak as all modes say, to second order") {
  const AllModes exact(shear_building(), storey_masses());
  Eigen::VectorXd load = Eigen::VectorXd::Zero(storeys);
  load(storeys - 1) = 5e4;
  Eigen::VectorXd peaks = Eigen::VectorXd::Zero(storeys);
  for (double t = 0; t <= 2; t += 1e-4) peaks = peaks.cwiseMax(exact.shears(exact.under(load, t)).cwiseAbs());
  const auto error = [&](double h) {
    return ((computed_peaks(h, 5e4) - peaks).array() / peaks.array().max(peaks.maxCoeff())).abs().maxCoeff();
  };
  const double at_8 = error(1.0 / 480), at_16 = error(1.0 / 960), at_32 = error(1.0 / 1920);
  INFO("errors at 8, 16, 32 substeps of 1/60 s: " << at_8 << ", " << at_16 << ", " << at_32);
  CHECK(at_8 < 0.01);
  CHECK(at_16 < 0.01 / 3);
  CHECK(std::log2(at_8 / at_32) / 2 > 1.5);  // peaks of many modes: the order is seen through their phases
}

TEST_CASE("Energy balances to rounding, damped or not, and below a spectral radius of 1 the method takes its share") {
  for (const RayleighDamping damping : {RayleighDamping{}, RayleighDamping{0.8, 0}, RayleighDamping{0.4, 2e-4}}) {
    for (const double spectral_radius : {1.0, 0.8}) {
      DynamicOptions options;
      options.substep = 1.0 / 480;
      options.spectral_radius = spectral_radius;
      options.damping = damping;
      FrameDynamics frame(portal(7850), {}, options);
      frame.set_node_load(1, components(2e4, -1e4, -5e4, 1e3, 2e3, -1e3));
      frame.set_beam_loads(3, {uniform_load(3, frame.model().beams[3].length, components(0, 0, -3e3, 0, 0, 0))});
      const int ground = frame.add_ground_acceleration(Vec3(1, 0.3, 0));
      double size = 0, worst = 0, last = 0;
      for (int n = 0; n < 1000; ++n) {
        frame.set_pattern(ground, 3 * std::sin(0.05 * n));
        frame.advance();
        const DynamicEnergy& e = frame.energy();
        size = std::max(size, e.kinetic + e.elastic + std::abs(e.damped));
        last = e.kinetic + e.elastic + e.damped + e.freed - e.external_work;
        worst = std::max(worst, std::abs(last + e.numerical));
      }
      INFO("damping " << damping.mass << ", " << damping.stiffness << "; " << worst / size);
      CHECK(worst < 1e-10 * size);
      if (spectral_radius == 1)
        CHECK(frame.energy().numerical == 0);
      else
        CHECK(last < -1e-6 * size);
    }
  }
}

TEST_CASE("Reactions and loads are the change of momentum, substep for substep") {
  DynamicOptions options;
  options.substep = 1.0 / 500;
  options.spectral_radius = 1;
  FrameDynamics frame(portal(7850), {}, options);
  const Vec6 load = components(2e4, -1e4, -5e4, 1e3, 2e3, -1e3), on_support = components(300, 500, -700, 0, 0, 0);
  frame.set_node_load(1, load);
  frame.set_node_load(0, on_support);
  const auto force = [&] { return Vec3((load + on_support + frame.reaction(0) + frame.reaction(1)).head<3>()); };
  frame.advance();
  double size = 0, worst = 0;
  for (int n = 0; n < 200; ++n) {
    if (n == 100) frame.set_end_stiffness(1, 1, Vec6::Zero());  // the beam hangs on one column
    const Vec3 momentum = frame.momentum().head<3>(), before = force();
    frame.advance();
    if (n == 100) continue;  // within it the break's load acts, too
    const Vec3 gained = frame.momentum().head<3>() - momentum;
    size = std::max(size, gained.norm());
    // A spectral radius of 1 is the trapezoidal rule: equal but for rounding.
    worst = std::max(worst, (gained - options.substep / 2 * (before + force())).norm());
  }
  CHECK(worst < 1e-9 * size);
  CHECK_THROWS_WITH(frame.reaction(2), Catch::Contains("support 2 does not exist; there are 2"));
}

TEST_CASE("A frame that breaks keeps its account of energy and its momentum") {
  // No support: what acts on it are breaks alone.
  FrameDynamics frame = free_portal();
  // A spin and a translation, and a strain that a break frees.
  std::vector<Vec6> moved(5, Vec6::Zero()), velocity(5);
  moved[4] = components(0.01, -0.004, 0.02, 0.002, 0.004, -0.003);
  moved[1] = components(-0.004, 0.002, 0.001, 0.001, 0.002, 0.001);
  for (std::size_t n = 0; n < 5; ++n) {
    const Vec3 spin(0.2, -0.3, 0.5);
    velocity[n] << Vec3(1, 2, -0.5) + spin.cross(frame.model().nodes[n]), spin;
  }
  frame.set_state(moved, velocity);
  const Vec6 before = frame.momentum();
  const double stored = frame.energy().kinetic + frame.energy().elastic;
  const auto balance = [&] {
    const DynamicEnergy& e = frame.energy();
    return e.kinetic + e.elastic + e.damped + e.freed - e.external_work - stored;
  };
  for (int n = 0; n < 20; ++n) frame.advance();
  CHECK(std::abs(balance()) < 1e-10 * stored);
  frame.set_end_stiffness(3, 0, Vec6::Zero());  // its mass goes to node 4, which leaves with it
  for (int n = 0; n < 20; ++n) frame.advance();
  frame.set_end_stiffness(1, 1, Vec6::Zero());  // and this beam hangs on node 1
  for (int n = 0; n < 20; ++n) frame.advance();
  CHECK(std::abs(balance()) < 1e-10 * stored);
  CHECK(frame.energy().freed > 0);
  const Vec6 after = frame.momentum();
  // Linear, then angular; of small displacements about the unloaded place. The method's own momentum has a share of
  // the accelerations before and after, which a spectral radius of 1 leaves out.
  CHECK((after.head<3>() - before.head<3>()).norm() < 1e-10 * before.head<3>().norm());
  CHECK((after.tail<3>() - before.tail<3>()).norm() < 1e-10 * before.tail<3>().norm());
}

TEST_CASE("Impulses on a free frame give it their momentum, and a beam that leaves takes its own along") {
  FrameDynamics frame = free_portal();
  const Vec6 impulse = components(300, -200, 500, 20, 30, -40);
  const std::array<FrameDynamics::Impulse, 1> one{{{1, impulse}}};
  Vec6 given = impulse;
  given.tail<3>() += frame.model().nodes[1].cross(Vec3(impulse.head<3>()));
  const auto near = [](const Vec6& a, const Vec6& b) { return (a - b).norm() < 1e-10 * b.norm(); };
  // The work of an impulse is that of its mean velocity: J'M^-1 J / 2 from rest.
  const double work = impulse.dot(frame.velocities_of(one)[1]) / 2;
  frame.strike(one);
  CHECK(near(frame.momentum(), given));
  CHECK(frame.energy().struck == Approx(work).epsilon(1e-10));
  CHECK(frame.energy().kinetic == Approx(work).epsilon(1e-10));
  for (int n = 0; n < 10; ++n) frame.advance();
  Vec6 parts = Vec6::Zero();
  for (int b = 0; b < static_cast<int>(frame.model().beams.size()); ++b) parts += frame.beam_momentum(b);
  CHECK(near(parts, given));
  // One beam loses both ends by a change, and what is left of the frame has the rest.
  const Vec6 leaving = frame.beam_momentum(1);
  frame.set_end_stiffness(1, 0, Vec6::Zero());
  frame.set_end_stiffness(1, 1, Vec6::Zero());
  frame.advance();
  CHECK(near(frame.beam_momentum(1), leaving));
  CHECK(near(frame.momentum() + leaving, given));
  // Half of its mass less takes half of its momentum along.
  const Vec6 whole = frame.beam_momentum(2), all = frame.momentum();
  frame.set_beam_density(2, 7850.0 / 2);
  frame.advance();
  CHECK(near(frame.momentum() + whole / 2, all));
  const DynamicEnergy& e = frame.energy();
  CHECK(std::abs(e.kinetic + e.elastic + e.damped + e.freed - e.struck) < 1e-10 * work);
}

TEST_CASE("Mass that comes to a beam brings its momentum, with the next substep or with an impulse before it") {
  const Vec6 brought = components(300, -200, 500, 20, 30, -40);
  for (const bool at_once : {false, true}) {
    FrameDynamics frame = free_portal();
    frame.add_momentum(1, brought);
    CHECK((frame.beam_momentum(1) - brought).norm() < 1e-12 * brought.norm());
    if (at_once)
      frame.strike({});
    else
      frame.advance();
    CHECK((frame.momentum() - brought).norm() < 1e-10 * brought.norm());
    frame.advance();  // it came once
    CHECK((frame.momentum() - brought).norm() < 1e-10 * brought.norm());
    const DynamicEnergy& e = frame.energy();
    CHECK(e.kinetic + e.elastic > 0);
    CHECK(e.struck == 0);
    CHECK(std::abs(e.kinetic + e.elastic + e.damped + e.freed) < 1e-10 * (e.kinetic + e.elastic));
  }
}

TEST_CASE("A beam that leaves takes along the momentum that has just come to it") {
  FrameDynamics frame = free_portal();
  const std::array<FrameDynamics::Impulse, 1> one{{{1, components(300, -200, 500, 20, 30, -40)}}};
  frame.strike(one);
  frame.advance();
  const Vec6 given = frame.momentum(), own = frame.beam_momentum(1), brought = components(-50, 70, 20, 10, -20, 15);
  frame.add_momentum(1, brought);
  frame.set_end_stiffness(1, 0, Vec6::Zero());
  frame.set_end_stiffness(1, 1, Vec6::Zero());
  frame.advance();
  CHECK((frame.beam_momentum(1) - own - brought).norm() < 1e-10 * given.norm());
  CHECK((frame.momentum() + own - given).norm() < 1e-10 * given.norm());
}

TEST_CASE("A correction that substep after substep goes over gives way to a new factor") {
  FrameModel model = tower(5, 8);
  for (Beam& beam : model.beams) beam.density = 7850;
  const Vec6 softer = components(1e8, 1e8, 1e8, 1e6, 1e6, 1e6);
  const int beam = 20, node = model.beams[20].node[1];
  DynamicOptions options;
  options.substep = 1.0 / 480;
  FrameDynamics frame(model, {}, options);
  frame.advance();  // at rest, with the factor that is corrected
  frame.set_end_stiffness(beam, 0, softer);
  frame.advance();
  frame.set_node_load(node, components(1000, 0, -500, 0, 0, 0));
  REQUIRE(frame.reanalysis_counters().low_rank == 1);
  CHECK(frame.reanalysis_counters().refactorisations == 0);
  for (int n = 0; n < 3000; ++n) frame.advance();
  CHECK(frame.reanalysis_counters().refactorisations == 1);
  // Softer from the start: no correction, and the same motion.
  model.beams[static_cast<std::size_t>(beam)].end_stiffness[0] = softer;
  FrameDynamics other(model, {}, options);
  other.advance();
  other.set_node_load(node, components(1000, 0, -500, 0, 0, 0));
  for (int n = 0; n < 3000; ++n) other.advance();
  CHECK(other.reanalysis_counters().refactorisations == 0);
  const Vec6 moved = other.displacements()[static_cast<std::size_t>(node)];
  CHECK((frame.displacements()[static_cast<std::size_t>(node)] - moved).norm() < 1e-8 * moved.norm());
}

TEST_CASE("With damping impulses go by a factor of their own, through all that changes") {
  FrameModel model = tower(4, 3);
  for (Beam& beam : model.beams) beam.density = 7850;
  DynamicOptions options;
  options.substep = 1.0 / 480;
  options.damping = {0.3, 2e-3};
  FrameDynamics frame(model, {}, options);
  const std::vector<std::vector<FrameDynamics::Impulse>> forces = {
      {{17, components(300, -200, 500, 20, 30, -40)}},
      {{21, components(0, 0, -1, 0, 0, 0)}, {22, components(1, 0, 0, 0, 0, 0)}}};
  const auto agree = [&] {
    const Eigen::MatrixXd mobility = frame.mobility(forces);
    Eigen::MatrixXd by_velocities(2, 2);
    for (std::size_t j = 0; j < 2; ++j) {
      const std::vector<Vec6> v = frame.velocities_of(forces[j]);
      for (std::size_t i = 0; i < 2; ++i) {
        by_velocities(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = 0;
        for (const FrameDynamics::Impulse& one : forces[i])
          by_velocities(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) +=
              one.impulse.dot(v[static_cast<std::size_t>(one.node)]);
      }
    }
    CHECK((mobility - by_velocities).norm() < 1e-10 * mobility.norm());
    // One that stands so from the start has no changes to follow.
    CHECK((FrameDynamics(frame.model(), {}, options).mobility(forces) - mobility).norm() < 1e-10 * mobility.norm());
  };
  agree();
  frame.set_end_stiffness(20, 0, components(1e8, 1e8, 1e8, 1e6, 1e6, 1e6));
  frame.advance();
  agree();
  frame.set_beam_density(8, 2 * 7850);
  frame.set_end_stiffness(30, 1, Vec6::Zero());
  frame.advance();
  agree();
  frame.set_end_stiffness(30, 0, Vec6::Zero());
  frame.set_damping({0.3, 1e-3});
  options.damping.stiffness = 1e-3;
  frame.advance();
  agree();
}

TEST_CASE("A beam that breaks off within a substep leaves with the momentum that its joints left it") {
  class First : public JointLaw {
   public:
    [[nodiscard]] double beam_utilisation(int beam, const Vec12& forces) const override {
      return std::max(end_utilisation(beam, 0, forces), end_utilisation(beam, 1, forces));
    }
    [[nodiscard]] double end_utilisation(int beam, int end, const Vec12& forces) const override {
      return beam == 1 ? forces.segment<3>(6 * end).norm() / 200.0 : 0;
    }
  };
  FrameDynamics frame = free_portal();
  const std::array<FrameDynamics::Impulse, 1> one{{{1, components(300, -200, 500, 20, 30, -40)}}};
  frame.strike(one);
  Vec6 given = frame.momentum();
  const Vec6 brought = components(-5, 7, 2, 1, -2, 1.5);
  const First law;
  int broken = 0, substeps = 0;
  Vec6 left = Vec6::Zero();
  while (broken < 2 && ++substeps < 1000) {
    frame.add_momentum(1, brought);  // some more comes with each substep
    given += brought;
    broken += static_cast<int>(frame.advance(&law).size());
    if (broken == 2) left = frame.beam_momentum(1);
  }
  REQUIRE(broken == 2);
  CHECK((frame.momentum() + left - given).norm() < 1e-10 * given.norm());
}

TEST_CASE("What hangs on nothing falls freely, though its stiffness alone is singular") {
  FrameModel model = portal(7850);
  DynamicOptions options;
  options.substep = 1.0 / 240;
  FrameDynamics frame(model, {}, options);
  frame.set_end_stiffness(3, 0, Vec6::Zero());
  const Beam& beam = model.beams[3];
  const double mass = beam.density * beam.area * beam.length;
  const int end = 4;
  const Vec3 down = beam.axes * Vec3(0, 0, -9.81 * mass / beam.length);
  frame.set_beam_loads(3, {uniform_load(3, beam.length, components(down.x(), down.y(), down.z(), 0, 0, 0))});
  for (int n = 0; n < 240; ++n) frame.advance();
  // From rest with accelerations that begin at 0: the velocity lags by (1/2 - af) h g.
  CHECK(frame.velocities()[end].z() == Approx(-9.81).epsilon(1e-3));
  CHECK(frame.displacements()[end].z() == Approx(-9.81 / 2).epsilon(1e-3));
  CHECK(frame.velocities()[end].tail<3>().norm() < 1e-6);
}
