// The shell element by itself: patch tests, motions without energy, bending in its plane, thin plates.
#include "elements/shell.h"

#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>
#include <functional>

#include "frames.h"
#include "topple/solver/shell_resultants.h"

using namespace topple::test;

namespace {

Shell make_shell(std::array<int, 4> nodes, double E, double nu, double thickness, bool bending) {
  Shell shell;
  shell.node = nodes;
  shell.youngs_modulus = E;
  shell.poisson_ratio = nu;
  shell.thickness = thickness;
  shell.bending = bending;
  return shell;
}

/// MacNeal and Harder 1985, figure 1: five distorted quadrilaterals in a rectangle 0.24 x 0.12.
FrameModel patch(bool bending) {
  FrameModel model;
  for (const auto& [x, y] :
       {std::pair(0.0, 0.0), std::pair(0.24, 0.0), std::pair(0.24, 0.12), std::pair(0.0, 0.12), std::pair(0.04, 0.02),
        std::pair(0.18, 0.03), std::pair(0.16, 0.08), std::pair(0.08, 0.08)}) {
    model.nodes.emplace_back(x, y, 0);
  }
  for (const auto& nodes : {std::array{0, 1, 5, 4}, std::array{1, 2, 6, 5}, std::array{2, 3, 7, 6},
                            std::array{3, 0, 4, 7}, std::array{4, 5, 6, 7}}) {
    model.shells.push_back(make_shell(nodes, 1e6, 0.25, 0.001, bending));
  }
  return model;
}

/// Largest difference at the inner nodes to the field that is imposed on the outer ones, relative to the field.
double patch_error(FrameModel model, const std::function<Vec6(const Vec3&)>& field,
                   StaticSolution* solution = nullptr) {
  LoadSet loads;
  for (int n = 0; n < 4; ++n) {
    model.supports.push_back({n, fixed()});
    const Vec6 u = field(model.nodes[static_cast<std::size_t>(n)]);
    for (int c = 0; c < 6; ++c) loads.settlements.push_back({n, c, u(c)});
  }
  if (!model.shells[0].bending) {
    for (int n = 4; n < 8; ++n) model.supports.push_back({n, components(0, 0, rigid, rigid, rigid, 0)});
  }
  const StaticSolution s = solve_one(model, loads);
  double error = 0, size = 0;
  for (std::size_t n = 4; n < 8; ++n) {
    error = std::max(error, (s.displacements[n] - field(model.nodes[n])).cwiseAbs().maxCoeff());
    size = std::max(size, field(model.nodes[n]).cwiseAbs().maxCoeff());
  }
  if (solution) *solution = s;
  return error / size;
}

int zero_modes(const Eigen::MatrixXd& K, double& least) {
  const Eigen::VectorXd values = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(K).eigenvalues();
  int zero = 0;
  while (zero < values.size() && values(zero) < 1e-10 * values(values.size() - 1)) ++zero;
  least = values(zero) / values(values.size() - 1);
  return zero;
}

const std::array<std::array<Vec3, 4>, 4> shapes{{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)},
                                                 {Vec3(0, 0, 0), Vec3(6, 0, 0), Vec3(6, 1, 0), Vec3(0, 1, 0)},
                                                 {Vec3(0, 0, 0), Vec3(3, 0.5, 0), Vec3(2.4, 2, 0), Vec3(-0.4, 1.2, 0)},
                                                 {Vec3(0, 0, 0), Vec3(2, 0, 0), Vec3(1.2, 0.9, 0), Vec3(0.1, 2, 0)}}};

}  // namespace

TEST_CASE(
    "the membrane passes the patch test on distorted quadrilaterals to rounding, drilling rotations and forces too") {
  StaticSolution s;
  const auto stretch = [](const Vec3& p) {
    return components(1e-3 * (p.x() + p.y() / 2), 1e-3 * (p.y() + p.x() / 2), 0, 0, 0, 0);
  };
  CHECK(patch_error(patch(false), stretch, &s) < 1e-13);
  // Stress 1333 and 400 (MacNeal and Harder), times the thickness.
  const FrameModel model = patch(false);
  for (int i = 0; i < 5; ++i) {
    const Vec3 n = shell_resultants(model, i, s.displacements).membrane;
    // The axes turn with the first edge; the first element's lies along x.
    if (i == 0) CHECK((n - Vec3(4.0 / 3, 4.0 / 3, 0.4)).norm() < 1e-12);
    CHECK(n.x() + n.y() == Approx(8.0 / 3).epsilon(1e-12));
  }
  // Shear with rotation: the drilling rotation is half the curl.
  const auto shear = [](const Vec3& p) { return components(2e-3 * p.y(), -5e-3 * p.x(), 0, 0, 0, -3.5e-3); };
  CHECK(patch_error(patch(false), shear) < 1e-13);
}

TEST_CASE("the plate passes the patch test for constant curvature") {
  const auto field = [](const Vec3& p) {
    return components(0, 0, 1e-3 * (p.x() * p.x() + p.x() * p.y() + p.y() * p.y()) / 2, 1e-3 * (p.y() + p.x() / 2),
                      -1e-3 * (p.x() + p.y() / 2), 0);
  };
  StaticSolution s;
  CHECK(patch_error(patch(true), field, &s) < 1e-10);
  // Moments 1.111e-7, 1.111e-7, 3.333e-8 (MacNeal and Harder); here tension at +z is positive and w curves up.
  const ShellResultants r = shell_resultants(patch(true), 0, s.displacements);
  CHECK((r.moments - Vec3(-1e-6 / 9, -1e-6 / 9, -1e-7 / 3)).norm() < 1e-15);
  CHECK(r.shears.norm() < 1e-11);
}

TEST_CASE("only rigid motions cost no energy: three for the membrane, six for the shell, whatever the shape") {
  for (const auto& shape : shapes) {
    for (bool bending : {false, true}) {
      const Shell shell = make_shell({0, 1, 2, 3}, 30e9, 0.2, 0.2, bending);
      const Mat24 K = ShellElement(shell, shape).stiffness();
      // Rotations are scaled by the size of the shape, so that stiffnesses compare.
      Mat24 scaled = K;
      for (int i = 0; i < 24; ++i) {
        for (int j = 0; j < 24; ++j) scaled(i, j) /= (i % 6 > 2 ? 2.0 : 1.0) * (j % 6 > 2 ? 2.0 : 1.0);
      }
      double least = 0;
      // Without bending w, rx and ry of the four nodes are not there: twelve zeros beside the three.
      CHECK(zero_modes(scaled, least) == (bending ? 6 : 15));
      CHECK(least > 1e-5);
      CHECK((K - K.transpose()).norm() < 1e-12 * K.norm());
    }
  }
}

TEST_CASE("a rigid motion of a warped shell, turned in space, strains nothing and its loads balance") {
  std::array<Vec3, 4> shape = shapes[2];
  shape[0].z() += 0.05;
  shape[2].z() += 0.04;
  const Mat3 R = Eigen::AngleAxisd(0.8, Vec3(1, -2, 0.5).normalized()).toRotationMatrix();
  for (Vec3& p : shape) p = R * p;
  const ShellElement element(make_shell({0, 1, 2, 3}, 30e9, 0.2, 0.2, true), shape);
  const Vec3 translation(0.3, -0.7, 0.2), rotation(0.5, 0.4, -0.9);
  Vec24 u;
  for (int n = 0; n < 4; ++n) {
    u.segment<6>(6 * n) << translation + rotation.cross(shape[static_cast<std::size_t>(n)]), rotation;
  }
  const Mat24 K = element.stiffness();
  CHECK((K * u).norm() < 1e-13 * K.norm() * u.norm());
  const Vec24 fixed = element.fixed_forces(Vec3(1, 2, 3), 1e-4);
  Vec3 force = Vec3::Zero();
  for (int n = 0; n < 4; ++n) force += fixed.segment<3>(6 * n);
  const double area = (shape[2] - shape[0]).cross(shape[3] - shape[1]).norm() / 2;
  CHECK((force + area * Vec3(1, 2, 3)).norm() < 1e-12 * area * 4 + 1e-13 * fixed.norm());
}

TEST_CASE("numbering the corners from another node gives the same element") {
  const auto& shape = shapes[3];
  const Mat24 K = ShellElement(make_shell({0, 1, 2, 3}, 30e9, 0.2, 0.2, true), shape).stiffness();
  const Mat24 turned =
      ShellElement(make_shell({0, 1, 2, 3}, 30e9, 0.2, 0.2, true), {shape[1], shape[2], shape[3], shape[0]})
          .stiffness();
  for (int a = 0; a < 4; ++a) {
    for (int b = 0; b < 4; ++b) {
      CHECK((turned.block<6, 6>(6 * a, 6 * b) - K.block<6, 6>(6 * ((a + 1) % 4), 6 * ((b + 1) % 4))).norm() <
            1e-12 * K.norm());
    }
  }
}

TEST_CASE("free growth with temperature costs no force, held growth E t strain/(1 - nu)") {
  const Shell shell = make_shell({0, 1, 2, 3}, 30e9, 0.2, 0.2, false);
  const ShellElement element(shell, shapes[2]);
  const double strain = 3e-4;
  Vec24 grown = Vec24::Zero();
  for (int n = 0; n < 4; ++n) grown.segment<3>(6 * n) = strain * shapes[2][static_cast<std::size_t>(n)];
  const Vec24 fixed = element.fixed_forces(Vec3::Zero(), strain);
  CHECK((element.stiffness() * grown + fixed).norm() < 1e-12 * fixed.norm());
  const double n = -30e9 * 0.2 * strain / 0.8;
  CHECK((element.resultants(Vec24::Zero(), strain, Vec2::Zero()).head<3>() - Vec3(n, n, 0)).norm() <
        1e-12 * std::abs(n));
}
