#include "reanalysis/block_contents.h"

#include <algorithm>

namespace topple::solver {
namespace {

int lowest_block(const FrameSystem& system, const TriangularSolver& solver, std::span<const int> equations) {
  int lowest = solver.size();
  for (const int e : equations)
    if (e >= 0 && e < system.dofs().equations) lowest = std::min(lowest, solver.position(e));
  return lowest < solver.size() ? solver.block_of(solver.row_at(lowest)) : -1;
}

}  // namespace

/// Lists by `block` (-1: none) what belongs to each.
void BlockContents::Lists::sort(std::size_t blocks) {
  start.assign(blocks + 1, 0);
  for (const int one : block)
    if (one >= 0) ++start[static_cast<std::size_t>(one) + 1];
  for (std::size_t b = 0; b < blocks; ++b) start[b + 1] += start[b];
  list.resize(static_cast<std::size_t>(start[blocks]));
  std::vector<int> next(start.begin(), start.end() - 1);
  for (std::size_t i = 0; i < block.size(); ++i)
    if (block[i] >= 0) list[static_cast<std::size_t>(next[static_cast<std::size_t>(block[i])]++)] = static_cast<int>(i);
}

BlockContents::BlockContents(const FrameSystem& system, const TriangularSolver& solver) {
  const auto blocks = static_cast<std::size_t>(solver.blocks());
  for (std::size_t b = 0; b < blocks; ++b) children_.block.push_back(solver.parent(static_cast<int>(b)));
  depth_.assign(blocks, 0);
  for (std::size_t b = blocks; b-- > 0;)
    if (const int parent = children_.block[b]; parent >= 0) depth_[b] = depth(parent) + 1;
  const std::size_t beams = system.model.beams.size(), shells = system.model.shells.size();
  for (std::size_t i = 0; i < beams + shells; ++i) {
    const int block = lowest_block(system, solver, system.assembly_map().freedoms(i));
    (i < beams ? beams_ : shells_).block.push_back(block);
    if (block < 0) (i < beams ? held_beams_ : held_shells_).push_back(static_cast<int>(i < beams ? i : i - beams));
  }
  for (const auto& numbers : system.dofs().number) nodes_.block.push_back(lowest_block(system, solver, numbers));
  for (Lists* lists : {&children_, &beams_, &shells_, &nodes_}) lists->sort(blocks);
}

}  // namespace topple::solver
