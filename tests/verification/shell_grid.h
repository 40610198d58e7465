#pragma once
// Grids of shells for published problems.
#include "solver/frames.h"

namespace topple::test {

struct ShellGrid {
  FrameModel model;
  int nx = 0, ny = 0;
  [[nodiscard]] int node(int i, int j) const { return j * (nx + 1) + i; }
  void hold(int i, int j, const Vec6& components) { model.supports.push_back({node(i, j), components}); }
  /// A traction, per area, on every element.
  [[nodiscard]] LoadSet traction(const Vec3& force) const {
    LoadSet loads;
    for (int s = 0; s < nx * ny; ++s) loads.shells.push_back({s, force, 0});
    return loads;
  }
  [[nodiscard]] Vec6 moved(const LoadSet& loads, int i, int j) const {
    return solve_one(model, loads).displacements[static_cast<std::size_t>(node(i, j))];
  }
};

/// nx by ny elements over the image of the unit square.
template <class Map>
ShellGrid shell_grid(int nx, int ny, double E, double nu, double thickness, bool bending, Map map) {
  ShellGrid grid{{}, nx, ny};
  for (int j = 0; j <= ny; ++j)
    for (int i = 0; i <= nx; ++i) grid.model.nodes.push_back(map(double(i) / nx, double(j) / ny));
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      Shell shell;
      shell.node = {grid.node(i, j), grid.node(i + 1, j), grid.node(i + 1, j + 1), grid.node(i, j + 1)};
      shell.youngs_modulus = E;
      shell.poisson_ratio = nu;
      shell.thickness = thickness;
      shell.bending = bending;
      grid.model.shells.push_back(shell);
    }
  return grid;
}

}  // namespace topple::test
