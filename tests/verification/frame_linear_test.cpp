// Frames of first order against structures texts: a Timoshenko element is exact at its nodes and along its length.
#include <catch2/catch.hpp>

#include "solver/frames.h"
#include "topple/solver/beam_diagram.h"
#include "verification/table.h"

using namespace topple::test;

namespace {

constexpr double rounding = 1e-10;
const char* const texts = "structures texts";

/// Components held besides what a planar problem in x and z needs.
Vec6 simple(bool along) { return components(along ? rigid : 0, rigid, rigid, rigid, 0, 0); }

Beam plain(Beam beam) {
  beam.shear_area_y = beam.shear_area_z = 0;
  return beam;
}

}  // namespace

TEST_CASE("cantilevers by closed form, with shear") {
  const double L = 4, P = 1000, q = 300;
  FrameModel model = single_beam(L, fixed(), Vec6::Zero());
  const Beam& b = model.beams[0];
  const double EI = b.youngs_modulus * b.Iy, GA = b.shear_modulus * b.shear_area_z;
  LoadSet point, even;
  point.nodes = {{1, unit(2, -P)}};
  even.beams = {uniform_load(0, L, unit(2, -q))};
  judge({"cantilever, end load, tip", texts, P * L * L * L / (3 * EI) + P * L / GA,
         -solve_one(model, point).displacements[1](2)},
        rounding);
  judge({"cantilever, uniform load, tip", texts, q * L * L * L * L / (8 * EI) + q * L * L / (2 * GA),
         -solve_one(model, even).displacements[1](2)},
        rounding);
}

TEST_CASE("built-in and propped beams by closed form") {
  const double L = 5, q = 700;
  FrameModel model = single_beam(L, fixed(), fixed());
  LoadSet even;
  even.beams = {uniform_load(0, L, unit(2, -q))};
  StaticSolution s = solve_one(model, even);
  judge({"fixed-fixed beam, uniform load, end moment", texts, q * L * L / 12, std::abs(s.reactions[0](4))}, rounding);
  const BeamDiagram diagram(model.beams[0], s.beam_end_forces[0], even.beams);
  judge({"fixed-fixed beam, uniform load, mid moment", texts, q * L * L / 24,
         std::abs(diagram.value(BeamDiagram::moment_y, L / 2))},
        rounding);
  model = single_beam(L, fixed(), simple(false));
  model.beams[0] = plain(model.beams[0]);
  s = solve_one(model, even);
  judge({"propped cantilever, uniform load, fixed end's force", texts, 5 * q * L / 8, s.reactions[0](2)}, rounding);
  judge({"propped cantilever, uniform load, prop's force", texts, 3 * q * L / 8, s.reactions[1](2)}, rounding);
  judge({"propped cantilever, uniform load, fixed end's moment", texts, q * L * L / 8, std::abs(s.reactions[0](4))},
        rounding);
  // The same by a release of the far end of a beam between fixed nodes.
  model = single_beam(L, fixed(), fixed());
  model.beams[0] = plain(model.beams[0]);
  model.beams[0].end_stiffness[1](4) = 0;
  s = solve_one(model, even);
  judge({"end release, uniform load, fixed end's moment", texts, q * L * L / 8, std::abs(s.reactions[0](4))}, rounding);
}

TEST_CASE("an elastic end spring, a settlement and temperature by closed form") {
  const double L = 5, q = 700, k = 3e6;
  FrameModel model = single_beam(L, fixed(), fixed());
  model.beams[0] = plain(model.beams[0]);
  const double EI = model.beams[0].youngs_modulus * model.beams[0].Iy;
  LoadSet even;
  even.beams = {uniform_load(0, L, unit(2, -q))};
  for (auto& end : model.beams[0].end_stiffness) end(4) = k;
  // Both ends turn by M/k: q L2/12 = M (1 + 2 EI/(k L)).
  judge({"beam with rotational springs, end moment", texts, q * L * L / 12 / (1 + 2 * EI / (k * L)),
         std::abs(solve_one(model, even).reactions[0](4))},
        rounding);
  model = single_beam(L, fixed(), fixed());
  model.beams[0] = plain(model.beams[0]);
  LoadSet settled;
  settled.settlements = {{1, 2, -0.01}};
  judge({"settlement of one end, end moment", texts, 6 * EI * 0.01 / (L * L),
         std::abs(solve_one(model, settled).reactions[0](4))},
        rounding);
  LoadSet heat;
  BeamLoad warm;
  warm.beam = 0;
  warm.kind = BeamLoad::Kind::temperature;
  warm.strain = 1.2e-5 * 30;
  warm.curvature_z = 1.2e-5 * 40;
  heat.beams = {warm};
  const StaticSolution s = solve_one(model, heat);
  judge({"held beam, temperature, axial force", texts,
         model.beams[0].youngs_modulus * model.beams[0].area * warm.strain, s.reactions[0](0)},
        rounding);
  judge({"held beam, temperature gradient, moment", texts, EI * warm.curvature_z, std::abs(s.reactions[0](4))},
        rounding);
}

TEST_CASE("a portal frame by slope deflection") {
  // Kleinlogel, frame 1: fixed feet, equal members, k = h/l. Members are 1e9 times stiffer along than in a building,
  // which leaves the closed form right to 1e-8.
  const double h = 3, l = 5, H = 1000, k = h / l;
  FrameModel model;
  model.nodes = {Vec3(0, 0, 0), Vec3(0, 0, h), Vec3(l, 0, h), Vec3(l, 0, 0)};
  add_beam(model, 0, 1);
  add_beam(model, 1, 2);
  add_beam(model, 3, 2);
  for (Beam& b : model.beams) {
    b = plain(b);
    b.area = 1e4;
    b.Iz = b.Iy;
  }
  model.supports = {{0, fixed()}, {3, fixed()}};
  LoadSet loads;
  loads.nodes = {{1, unit(0, H / 2)}, {2, unit(0, H / 2)}};
  const StaticSolution s = solve_one(model, loads);
  judge({"portal under a lateral load, foot moment", "Kleinlogel", H * h * (3 * k + 1) / (2 * (6 * k + 1)),
         std::abs(s.reactions[0](4))},
        1e-7);
  judge({"portal under a lateral load, corner moment", "Kleinlogel", H * h * 3 * k / (2 * (6 * k + 1)),
         std::abs(s.beam_end_forces[1](4))},
        1e-7);
}

TEST_CASE("a space frame turned at random has turned answers") {
  FrameModel model;
  model.nodes = {Vec3(0, 0, 0), Vec3(0.3, -0.2, 3), Vec3(4, 1, 3.4), Vec3(4.2, 0.5, 0), Vec3(2, 3, 2.5)};
  for (const auto& [a, b] : {std::pair(0, 1), std::pair(1, 2), std::pair(3, 2), std::pair(1, 4), std::pair(2, 4)})
    add_beam(model, a, b);
  model.beams[1].offset[0] = Vec3(0.1, 0.05, -0.1);
  const Vec3 along =
      model.nodes[2] - model.nodes[1] - model.beams[1].offset[0];  // the arm moves the end: axes are made anew
  model.beams[1].length = along.norm();
  const Vec3 x = along.normalized(), y = Vec3(Vec3::UnitZ()).cross(x).normalized();
  model.beams[1].axes << x.transpose(), y.transpose(), x.cross(y).transpose();
  model.supports = {{0, fixed()}, {3, fixed()}};
  LoadSet loads;
  loads.nodes = {{1, components(1000, 200, -3000, 50, -70, 20)}, {4, components(-100, 900, -2000, 0, 40, 90)}};
  const Mat3 R =
      (Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()) * Eigen::AngleAxisd(1.9, Vec3(-2, 0.3, 1).normalized()))
          .toRotationMatrix();
  LoadSet turned = loads;
  for (NodeLoad& load : turned.nodes) load.load = rotated(load.load, R);
  const StaticSolution a = solve_one(model, loads), b = solve_one(rotated(model, R), turned);
  double size = 0, off = 0;
  for (std::size_t n = 0; n < model.nodes.size(); ++n) {
    size = std::max(size, a.displacements[n].norm());
    off = std::max(off, (rotated(a.displacements[n], R) - b.displacements[n]).norm());
  }
  judge({"skewed space frame, turned at random, displacements", "the same frame", 0, off / size}, rounding);
}
