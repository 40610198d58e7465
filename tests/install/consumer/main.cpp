// Built against an installed Topple: a cantilever's tip deflection, by the solver alone.
#include <topple/solver/static_analysis.h>
#include <cmath>
#include <cstdio>

int main() {
  using namespace topple::solver;
  FrameModel model;
  model.nodes = {Vec3(0, 0, 0), Vec3(3, 0, 0)};
  Beam beam;
  beam.node = {0, 1};
  beam.length = 3;
  beam.youngs_modulus = 210e9;
  beam.shear_modulus = 81e9;
  beam.area = 8.5e-3;
  beam.Iy = 1.6e-4;
  beam.Iz = 1.2e-5;
  beam.J = 4e-7;
  model.beams = {beam};
  model.supports = {Support{0, Vec6::Constant(rigid)}};
  LoadSet loads;
  Vec6 tip = Vec6::Zero();
  tip[2] = -1e4;
  loads.nodes = {NodeLoad{1, tip}};
  const LoadSet cases[] = {loads};
  const double sag = -StaticAnalysis(model).solve(cases)[0].displacements[1][2];
  const double expected = 1e4 * 27 / (3 * 210e9 * 1.6e-4);
  std::printf("tip deflection %.6e m, closed form %.6e m\n", sag, expected);
  return std::abs(sag - expected) < 1e-10 * expected ? 0 : 1;
}
