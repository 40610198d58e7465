#pragma once
// What lies in each block of a factor: elements and nodes belong to the block of the first of their equations that is
// eliminated; when that is up to date, so are all of them.
#include <span>
#include <vector>

#include "assembly/frame_system.h"
#include "factor/triangular.h"

namespace topple::solver {

class BlockContents {
 public:
  BlockContents(const FrameSystem& system, const TriangularSolver& solver);

  /// Blocks above it up to the root.
  [[nodiscard]] int depth(int block) const { return depth_[static_cast<std::size_t>(block)]; }
  [[nodiscard]] std::span<const int> children(int block) const { return children_.in(block); }
  [[nodiscard]] std::span<const int> beams(int block) const { return beams_.in(block); }
  [[nodiscard]] std::span<const int> shells(int block) const { return shells_.in(block); }
  [[nodiscard]] std::span<const int> nodes(int block) const { return nodes_.in(block); }
  /// -1: it has no equation.
  [[nodiscard]] int block_of_beam(int beam) const { return beams_.of(beam); }
  [[nodiscard]] int block_of_shell(int shell) const { return shells_.of(shell); }
  [[nodiscard]] int block_of_node(int node) const { return nodes_.of(node); }
  /// Without any equation.
  [[nodiscard]] const std::vector<int>& held_beams() const { return held_beams_; }
  [[nodiscard]] const std::vector<int>& held_shells() const { return held_shells_; }

 private:
  /// Things by the block that each belongs to, and the things of each block in order.
  struct Lists {
    std::vector<int> block, start, list;
    void sort(std::size_t blocks);
    [[nodiscard]] int of(int thing) const { return block[static_cast<std::size_t>(thing)]; }
    [[nodiscard]] std::span<const int> in(int of) const {
      const auto b = static_cast<std::size_t>(of);
      return std::span(list).subspan(static_cast<std::size_t>(start[b]),
                                     static_cast<std::size_t>(start[b + 1] - start[b]));
    }
  };

  std::vector<int> depth_;
  Lists children_, beams_, shells_, nodes_;
  std::vector<int> held_beams_, held_shells_;
};

}  // namespace topple::solver
