#pragma once
#include <span>
#include <utility>
#include <vector>

namespace topple::solver {

/// Fill-reducing order of the *nodes* by nested dissection (METIS) of the graph whose vertices are nodes, weighted with
/// their numbers of freedoms: several times smaller than the graph of freedoms, with the same fill. Returns the nodes
/// in the order of elimination. Throws std::runtime_error, in words, when METIS fails or a size exceeds its integers.
[[nodiscard]] std::vector<int> order_nodes(int node_count, std::span<const std::pair<int, int>> edges,
                                           std::span<const int> freedoms);

}  // namespace topple::solver
