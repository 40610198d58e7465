#pragma once
// Operators of shell elements (loads of a unit traction, mass, stress resultants), computed once for each shape of
// element: all are linear, and the elements of a mesh are mostly alike.
#include <array>
#include <map>
#include <vector>

#include "topple/solver/frame_model.h"
#include "topple/structure/building.h"

namespace topple::structure {

class ShellOperators {
 public:
  /// In the axes of the nodes that the element was given by.
  struct Element {
    Eigen::Matrix<double, 24, 3> loads;       ///< at its nodes, of a unit traction along each axis
    Eigen::Matrix<double, 24, 24> mass;       ///< of a unit of mass per area, as solver::shell_mass() has it
    double area = 0;                          ///< m2
    Eigen::Matrix<double, 6, 24> resultants;  ///< nx, ny, nxy, mx, my, mxy at its centre, of its nodes' displacements
  };
  /// Stays where it is. Elements are alike when material, thickness and their nodes seen from the first are equal to
  /// the bit.
  [[nodiscard]] const Element& of(const solver::Shell& shell, const std::vector<Vec3>& nodes);

 private:
  std::map<std::array<double, 13>, Element> elements_;
};

}  // namespace topple::structure
