// Natural frequencies against closed forms, a dense eigenvalue solver, and one another.
#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>
#include <cmath>

#include "assembly/frame_system.h"
#include "assembly/mass_matrix.h"
#include "topple/solver/modes.h"
#include "topple/solver/shifted_modes.h"

using namespace topple::solver;

namespace {

constexpr double pi = 3.14159265358979323846;
const Vec6 fixed = Vec6::Constant(rigid);

Beam steel(double length) {
  Beam beam;
  beam.axes << 0, 0, 1, 0, -1, 0, 1, 0, 0;  // upright, local z along global x
  beam.length = length;
  beam.youngs_modulus = 2e11;
  beam.shear_modulus = 8e10;
  beam.area = 0.01;
  beam.Iy = 1e-4;
  beam.Iz = 3e-5;
  beam.J = 1e-6;
  beam.density = 7800;
  return beam;
}

/// An upright cantilever of equal parts.
FrameModel cantilever(double length, int parts) {
  FrameModel model;
  for (int i = 0; i <= parts; ++i) model.nodes.push_back(Vec3(0, 0, length * i / parts));
  for (int i = 0; i < parts; ++i) {
    Beam beam = steel(length / parts);
    beam.node = {i, i + 1};
    model.beams.push_back(beam);
  }
  model.supports = {{0, fixed}};
  return model;
}

std::vector<double> frequencies(const ModalAnswer& answer) {
  std::vector<double> all;
  for (const VibrationMode& mode : answer.modes) all.push_back(mode.angular_frequency);
  return all;
}

}  // namespace

TEST_CASE("a cantilever vibrates at its closed forms: bending both ways, along and about its axis") {
  const double L = 4;
  const Beam b = steel(L);
  const ModalAnswer answer = natural_modes(cantilever(L, 24), {}, 12);
  const auto bending = [&](double I, double root) {
    return root * root / (L * L) * std::sqrt(b.youngs_modulus * I / (b.density * b.area));
  };
  // Roots of cos a cosh a = -1. Cubic shapes converge as (a/parts)^4/720, linear ones as (odd pi/2/parts)^2/24.
  std::vector<double> expected;
  for (const double I : {b.Iy, b.Iz})
    for (const double root : {1.8751040687, 4.6940911330, 7.8547574382}) expected.push_back(bending(I, root));
  for (const double odd : {1.0, 3.0, 5.0, 7.0, 9.0, 11.0, 13.0, 15.0})
    expected.push_back(odd * pi / (2 * L) *
                       std::sqrt(b.shear_modulus * b.J / (b.density * (b.Iy + b.Iz))));  // polar moment by default
  expected.push_back(pi / (2 * L) * std::sqrt(b.youngs_modulus / b.density));
  std::sort(expected.begin(), expected.end());
  REQUIRE(answer.modes.size() == 12);
  for (std::size_t m = 0; m < 12; ++m) CHECK(answer.modes[m].angular_frequency == Approx(expected[m]).epsilon(0.035));
  CHECK(answer.modes[0].angular_frequency == Approx(bending(b.Iz, 1.8751040687)).epsilon(1e-6));
  // The textbooks' effective mass of a cantilever's first mode, of its whole mass. What is free to move lacks the
  // support's part of the first element.
  CHECK(answer.modes[0].mass_share[1] * answer.moving_mass.y() == Approx(0.6131 * 312).epsilon(1e-3));
  CHECK(answer.moving_mass.y() == Approx(312).epsilon(1.0 / 24));
  CHECK(std::abs(answer.modes[0].shape[24](1)) == Approx(1).epsilon(1e-12));
}

TEST_CASE("torsional mass is density times the polar moment, or times J") {
  const double L = 3;
  const Beam b = steel(L);
  FrameModel model = cantilever(L, 32);
  for (Beam& beam : model.beams) beam.Iy = beam.Iz = 1;  // so stiff in bending that torsion comes first
  MassModel by_j;
  by_j.torsional = TorsionalMass::torsion_constant;
  const double G = b.shear_modulus, rho = b.density;
  CHECK(natural_modes(model, {}, 1).modes[0].angular_frequency ==
        Approx(pi / (2 * L) * std::sqrt(G * b.J / (rho * 2))).epsilon(2e-4));
  CHECK(natural_modes(model, by_j, 8).modes[0].angular_frequency <= pi / (2 * L) * std::sqrt(G / rho) * 1.001);
}

TEST_CASE("a mass on a light column has the stiffness's frequency, and as many modes as it has ways to move") {
  const double L = 5, m = 900;
  FrameModel model = cantilever(L, 1);
  model.beams[0].density = 0;
  model.beams[0].Iz = model.beams[0].Iy;
  MassModel masses;
  masses.nodes = {{1, m, Vec3::Zero()}};
  const ModalAnswer answer = natural_modes(model, masses, 10);
  CHECK(natural_modes(model, masses, 100000).modes.size() == answer.modes.size());
  REQUIRE(answer.modes.size() == 3);
  const double sway = std::sqrt(3 * 2e11 * 1e-4 / (m * L * L * L));
  CHECK(answer.modes[0].angular_frequency == Approx(sway).epsilon(1e-12));
  CHECK(answer.modes[1].angular_frequency == Approx(sway).epsilon(1e-12));
  CHECK(answer.modes[2].angular_frequency == Approx(std::sqrt(2e11 * 0.01 / (m * L))).epsilon(1e-12));
  const auto& first = answer.modes[0].shape[1];
  const auto& second = answer.modes[1].shape[1];
  CHECK(std::abs(first(0) * second(1) - first(1) * second(0)) == Approx(1).epsilon(1e-9));  // two ways, not one twice
  CHECK(answer.modes[0].mass_share[0] + answer.modes[1].mass_share[0] == Approx(1).epsilon(1e-12));
  CHECK(answer.modes[2].mass_share[2] == Approx(1).epsilon(1e-12));
}

TEST_CASE("a model without mass has no modes, and a mechanism none that count") {
  FrameModel model = cantilever(3, 2);
  for (Beam& beam : model.beams) beam.density = 0;
  CHECK_THROWS_WITH(natural_modes(model, {}, 1), Catch::Contains("mass"));
  model = cantilever(3, 2);
  model.supports[0].stiffness(5) = 0;  // free to spin
  CHECK_THROWS_AS(natural_modes(model, {}, 1), Instability);
}

TEST_CASE("axial force on the column lowers its frequency as the beam-column's stiffness says") {
  const double L = 6, m = 500, EI = 2e11 * 3e-5, P = 0.5 * pi * pi * EI / (4 * L * L);
  FrameModel model = cantilever(L, 1);
  model.beams[0].density = 0;
  MassModel masses;
  masses.nodes = {{1, m, Vec3::Zero()}};
  AxialState tangent;
  tangent.mode = SecondOrder::exact;
  tangent.first_axial = {-P};
  tangent.loads.resize(1);
  const double a = L * std::sqrt(P / EI);
  const double k = P * a / (L * (std::tan(a) - a));
  CHECK(natural_modes(model, masses, 1, {}, &tangent).modes[0].angular_frequency ==
        Approx(std::sqrt(k / m)).epsilon(1e-9));
}

TEST_CASE("hinges of members and hinges of supports make the same simply supported beam") {
  FrameModel by_supports = cantilever(4, 3);
  Vec6 pin = Vec6::Zero();
  pin << rigid, rigid, rigid, 0, 0, rigid;
  Vec6 slide = pin;
  slide(2) = 0;
  slide(5) = 0;
  by_supports.supports = {{0, pin}, {3, slide}};
  FrameModel by_members = by_supports;
  by_members.supports = {{0, fixed}, {3, fixed}};
  by_members.supports[1].stiffness(2) = 0;
  by_members.supports[1].stiffness(5) = 0;
  by_members.beams[0].end_stiffness[0](4) = by_members.beams[0].end_stiffness[0](5) = 0;
  by_members.beams[2].end_stiffness[1](4) = by_members.beams[2].end_stiffness[1](5) = 0;
  // The released end's own freedom is condensed statically: the frequencies come as close as one element's shape does.
  const auto a = frequencies(natural_modes(by_supports, {}, 3)), b = frequencies(natural_modes(by_members, {}, 3));
  for (std::size_t i = 0; i < 3; ++i) CHECK(b[i] == Approx(a[i]).epsilon(2e-3));
  const double closed = pi * pi / 16 * std::sqrt(2e11 * 3e-5 / 78);
  CHECK(a[1] == Approx(closed).epsilon(1e-3));  // the first is its torsion
}

TEST_CASE("a rigid floor on four columns sways and twists as its mass and stiffness say") {
  const double h = 4, ax = 3, ay = 2, m = 40000;
  FrameModel model;
  MassModel masses;
  Diaphragm floor;
  for (const Vec3& corner : {Vec3(-ax, -ay, 0), Vec3(ax, -ay, 0), Vec3(ax, ay, 0), Vec3(-ax, ay, 0)}) {
    const int foot = static_cast<int>(model.nodes.size());
    model.nodes.push_back(corner);
    model.nodes.push_back(corner + Vec3(0, 0, h));
    Beam beam = steel(h);
    beam.node = {foot, foot + 1};
    beam.density = 0;
    beam.J = 1e-12;  // the columns' own torsion apart
    model.beams.push_back(beam);
    model.supports.push_back({foot, fixed});
    Vec6 head = Vec6::Zero();
    head(2) = head(3) = head(4) = rigid;
    model.supports.push_back({foot + 1, head});
    floor.nodes.push_back(foot + 1);
    masses.nodes.push_back({foot + 1, m / 4, Vec3::Zero()});
  }
  model.diaphragms = {floor};
  const double kx = 4 * 12 * 2e11 * 1e-4 / (h * h * h), ky = 4 * 12 * 2e11 * 3e-5 / (h * h * h);
  const double twist = (kx * ay * ay + ky * ax * ax) / (m * (ax * ax + ay * ay));
  std::vector<double> expected{std::sqrt(kx / m), std::sqrt(ky / m), std::sqrt(twist)};
  std::sort(expected.begin(), expected.end());
  const ModalAnswer answer = natural_modes(model, masses, 5);
  REQUIRE(answer.modes.size() == 3);
  for (std::size_t i = 0; i < 3; ++i) CHECK(answer.modes[i].angular_frequency == Approx(expected[i]).epsilon(1e-8));
  CHECK(answer.modes[0].mass_share[1] == Approx(1).epsilon(1e-10));  // weak way first
  CHECK(answer.modes[1].mass_share[5] == Approx(1).epsilon(1e-10));
}

TEST_CASE("a simply supported plate vibrates at its closed form") {
  const int n = 12;
  const double a = 2, b = 1.5, t = 0.01, E = 2e11, nu = 0.3, rho = 7800;
  FrameModel model;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      const int node = static_cast<int>(model.nodes.size());
      model.nodes.push_back(Vec3(a * i / n, b * j / n, 0));
      Vec6 k = Vec6::Zero();
      k(0) = k(1) = k(5) = rigid;
      if (i == 0 || i == n || j == 0 || j == n) k(2) = rigid;
      model.supports.push_back({node, k});
    }
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int first = j * (n + 1) + i;
      model.shells.push_back({{first, first + 1, first + n + 2, first + n + 1}, E, nu, t, rho, true});
    }
  const double D = E * t * t * t / (12 * (1 - nu * nu));
  const auto closed = [&](int p, int q) {
    return pi * pi * (p * p / (a * a) + q * q / (b * b)) * std::sqrt(D / (rho * t));
  };
  const auto found = frequencies(natural_modes(model, {}, 3));
  // Elements of a twelfth of the side: (pi/12)^2/12 for the bilinear shapes of the first mode, four times for the next.
  CHECK(found[0] == Approx(closed(1, 1)).epsilon(0.012));
  CHECK(found[1] == Approx(closed(2, 1)).epsilon(0.04));
  CHECK(found[2] == Approx(closed(1, 2)).epsilon(0.04));
  MassModel lumped;
  lumped.distribution = MassDistribution::lumped;
  const auto from_below = frequencies(natural_modes(model, lumped, 1));
  CHECK(from_below[0] == Approx(closed(1, 1)).epsilon(0.012));
  CHECK(from_below[0] < found[0]);
}

TEST_CASE("every mode of a frame with many equal ones is that of a dense solver, and the shares add up to 1") {
  // Six equal cantilevers that touch nothing: every frequency six times.
  FrameModel model;
  for (int k = 0; k < 6; ++k) {
    const FrameModel one = cantilever(4, 2);
    const int first = static_cast<int>(model.nodes.size());
    for (const Vec3& node : one.nodes) model.nodes.push_back(node + Vec3(10.0 * k, 0, 0));
    for (Beam beam : one.beams) {
      for (int& node : beam.node) node += first;
      model.beams.push_back(beam);
    }
    model.supports.push_back({first, fixed});
  }
  FrameSystem system(model);
  system.assemble();
  const MassMatrix mass(system, {});
  const auto dense = [](const SparseSymmetric& A) {
    Eigen::MatrixXd full = Eigen::MatrixXd::Zero(A.size, A.size);
    for (int c = 0; c < A.size; ++c)
      for (auto k = A.start[static_cast<std::size_t>(c)]; k < A.start[static_cast<std::size_t>(c) + 1]; ++k) {
        const int r = A.row[static_cast<std::size_t>(k)];
        full(r, c) = full(c, r) = A.value[static_cast<std::size_t>(k)];
      }
    return full;
  };
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> exact(dense(system.matrix()), dense(mass.matrix()));
  for (const int count : {1, 5, 6, 13, 72}) {
    const ModalAnswer answer = natural_modes(model, {}, count);
    REQUIRE(static_cast<int>(answer.modes.size()) == count);
    double along = 0, about = 0;
    for (int m = 0; m < count; ++m) {
      const auto i = static_cast<std::size_t>(m);
      CHECK(answer.modes[i].angular_frequency == Approx(std::sqrt(exact.eigenvalues()(m))).epsilon(1e-8));
      along += answer.modes[i].mass_share[0];
      about += answer.modes[i].mass_share[5];
    }
    if (count != 72) continue;
    CHECK(along == Approx(1).epsilon(1e-9));
    CHECK(about == Approx(1).epsilon(1e-9));
  }
}

TEST_CASE("a beam that floats has six frequencies of zero, then those of free ends") {
  const double L = 4;
  const Beam b = steel(L);
  FrameModel model = cantilever(L, 24);
  model.supports.clear();
  CHECK_THROWS_AS(natural_modes(model, {}, 8), Instability);
  const ModalAnswer answer = shifted_modes(model, {}, 14, 1e4);
  REQUIRE(answer.modes.size() == 14);
  for (std::size_t m = 0; m < 6; ++m) CHECK(answer.modes[m].angular_frequency == 0);
  // Roots of cos a cosh a = 1 (Blevins, table 8-1), both ways; along and about the axis n pi. Cubic shapes converge as
  // (a/parts)^4/720, linear ones as (n pi/parts)^2/24.
  constexpr double parts = 24;
  std::vector<std::pair<double, double>> expected;  // and what the parts leave of the error
  for (const double root : {4.730040744862704, 7.853204624095838, 10.995607838001671})
    for (const double I : {b.Iy, b.Iz})
      expected.emplace_back(root * root / (L * L) * std::sqrt(b.youngs_modulus * I / (b.density * b.area)),
                            std::pow(root / parts, 4) / 720);
  for (int n = 1; n <= 6; ++n)
    for (const double speed :
         {std::sqrt(b.youngs_modulus / b.density), std::sqrt(b.shear_modulus * b.J / (b.density * (b.Iy + b.Iz)))})
      expected.emplace_back(n * pi / L * speed, std::pow(n * pi / parts, 2) / 24);
  std::sort(expected.begin(), expected.end());
  for (std::size_t m = 6; m < 14; ++m) {
    const auto [frequency, error] = expected[m - 6];
    CHECK(answer.modes[m].angular_frequency >= frequency * (1 - 1e-9));  // a Ritz answer lies above
    CHECK(answer.modes[m].angular_frequency <= frequency * (1 + 1.1 * error + 1e-9));
  }
  // The rigid motions take all of the mass, the elastic ones none.
  for (std::size_t c = 0; c < 6; ++c) {
    double rigid_share = 0;
    for (std::size_t m = 0; m < 6; ++m) rigid_share += answer.modes[m].mass_share[c];
    CHECK(rigid_share == Approx(1).epsilon(1e-9));
  }
}

TEST_CASE("a shift changes no frequency of a structure that stands") {
  const FrameModel model = cantilever(4, 6);
  const auto plain = frequencies(natural_modes(model, {}, 6)), shifted = frequencies(shifted_modes(model, {}, 6, 5000));
  for (std::size_t m = 0; m < 6; ++m) CHECK(shifted[m] == Approx(plain[m]).epsilon(1e-10));
}

TEST_CASE("a motion without mass and stiffness is told whatever the shift") {
  FrameModel model = cantilever(4, 2);
  model.nodes.push_back(Vec3(1, 0, 0));  // nothing reaches it
  CHECK_THROWS_AS(shifted_modes(model, {}, 3, 1e4), Instability);
  CHECK_THROWS_WITH(shifted_modes(model, {}, 3, 0), Catch::Contains("above 0"));
}
