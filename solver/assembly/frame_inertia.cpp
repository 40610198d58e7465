// The inertia of a frame system that moves: what it adds to the matrix, and M itself beside it.
#include <cmath>

#include "assembly/frame_system.h"

namespace topple::solver {

Vec6 FrameSystem::own_springs(int node) const {
  const auto n = static_cast<std::size_t>(node);
  Vec6 k = support_[n];
  for (int c = 0; c < 6; ++c) k(c) = std::isinf(k(c)) ? 0 : k(c);
  if (inertia != nullptr) k += inertia->factor * inertia->at_node[n];
  return k;
}

/// A diagonal matrix in the six components of a node, scaled, in its equations.
void FrameSystem::add_diagonal(int node, const Vec6& diagonal, SparseSymmetric& matrix) const {
  const auto n = static_cast<std::size_t>(node);
  if ((diagonal.array() == 0).all()) return;
  Mat6 G = Mat6::Identity();
  G.topRightCorner<3, 3>() = dofs().diaphragm_arm(node);
  const Mat6 K = G.transpose() * diagonal.asDiagonal() * G;
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j <= i; ++j) {
      const int row = dofs().number[n][static_cast<std::size_t>(i)],
                column = dofs().number[n][static_cast<std::size_t>(j)];
      if (K(i, j) == 0 || row >= dofs().equations || column >= dofs().equations) continue;
      matrix.value[static_cast<std::size_t>(assembly_map_.position(row, column))] +=
          K(i, j) * scale_[static_cast<std::size_t>(row)] * scale_[static_cast<std::size_t>(column)];
    }
  }
}

void FrameSystem::add_element_mass(std::size_t element, const std::vector<char>& wanted) {
  const std::size_t beams = model.beams.size();
  if (element < beams) {
    if (beam_stands[element] == 0 || model.beams[element].density == 0) return;
    const Mat12 M = beam_mass(*this, inertia->masses, static_cast<int>(element));
    assembly_map_.add(element, M.data(), scale_, wanted, mass_);
  } else if (element < beams + model.shells.size() && shell_stands[element - beams] != 0) {
    const Shell& shell = model.shells[element - beams];
    if (shell.density == 0) return;
    Mat24 M = shell_mass(*this, inertia->masses, static_cast<int>(element - beams));
    add_diaphragm_arms(shell.node, M);
    assembly_map_.add(element, M.data(), scale_, wanted, mass_);
  } else if (element >= element_of_patch(0) && element < element_of_patch(0) + model.patches.size()) {
    const std::size_t patch = element - element_of_patch(0);
    if (model.patches[patch].mass.size() == 0) return;
    const Eigen::MatrixXd M = patch_mass(patch);
    assembly_map_.add(element, M.data(), scale_, wanted, mass_);
  }
}

void FrameSystem::clear_mass(std::span<const int> nodes, std::span<const int> elements) {
  for (const int n : nodes) {
    const auto node = static_cast<std::size_t>(n);
    for (int e = dofs().first_equation[node]; e < dofs().first_equation[node + 1]; ++e)
      for (int f = dofs().first_equation[node]; f <= e; ++f)
        mass_.value[static_cast<std::size_t>(assembly_map_.position(e, f))] = 0;
  }
  for (const int element : elements) assembly_map_.clear(static_cast<std::size_t>(element), wanted_, mass_);
}

void FrameSystem::scale_mass() {
  if (inertia == nullptr) return;
  for (int column = 0; column < dofs().equations; ++column) {
    const auto c = static_cast<std::size_t>(column);
    for (auto k = mass_.start[c]; k < mass_.start[c + 1]; ++k) {
      const auto i = static_cast<std::size_t>(k);
      mass_.value[i] *= scale_[c] * scale_[static_cast<std::size_t>(mass_.row[i])];
    }
  }
}

}  // namespace topple::solver
