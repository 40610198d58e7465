#pragma once
// Which equation each freedom of each node belongs to. Freedoms that a support holds get a number behind the equations;
// nodes of a diaphragm share the equations x, y, rz of its reference point.
#include <array>
#include <vector>

#include "topple/solver/frame_model.h"

namespace topple::solver {

/// A support component that is held (rigid) on a node.
struct HeldFreedom {
  int node = -1, component = 0;
};

struct DofMap {
  explicit DofMap(const FrameModel& model);

  int equations = 0;
  int held = 0;  ///< numbered equations ... equations + held - 1
  /// Per node and component.
  std::vector<std::array<int, 6>> number;
  /// Per node: from the reference point of its diaphragm, in x and y; zero when it has none.
  std::vector<std::array<double, 2>> arm;
  std::vector<int> diaphragm_of_node;  ///< -1: none
  /// Vertices of the graph that is ordered: the nodes, then the diaphragms. Equations of a vertex are contiguous:
  /// first_equation[v] ... first_equation[v + 1] - 1.
  std::vector<int> first_equation;
  std::vector<int> vertex_of_equation;
  [[nodiscard]] int vertices() const { return static_cast<int>(first_equation.size()) - 1; }

  /// x, y, rz of each diaphragm's reference point.
  std::vector<std::array<int, 3>> diaphragm_number;
  std::vector<std::array<double, 2>> diaphragm_reference;

  /// Translation of a node per rotation number (rx, ry, rz): what the diaphragm adds.
  [[nodiscard]] Mat3 diaphragm_arm(int node) const;
  /// Node displacements from values of all numbered freedoms (equations, then held).
  [[nodiscard]] Vec6 node_displacement(int node, const double* freedoms) const;
  /// Adds a force on a node to the numbered freedoms.
  void add_node_force(int node, const Vec6& force, double* freedoms) const;
};

/// Per node and component: stiffness of all its supports together (rigid wins, springs add).
[[nodiscard]] std::vector<Vec6> support_stiffness(const FrameModel& model);

}  // namespace topple::solver
