#include "factor/ordering.h"

#include <metis.h>

#include <algorithm>
#include <limits>
#include <mutex>
#include <stdexcept>
#include <string>

namespace topple::solver {

namespace {

/// Adjacency lists of an undirected graph in METIS's compressed form, each list sorted and without repetitions.
struct Graph {
  std::vector<idx_t> start, neighbour;
};

Graph make_graph(int node_count, std::span<const std::pair<int, int>> edges) {
  if (2 * edges.size() > static_cast<std::size_t>(std::numeric_limits<idx_t>::max()))
    throw std::runtime_error("ordering: the model has " + std::to_string(edges.size()) +
                             " connections, more than METIS can index");
  const auto count = static_cast<std::size_t>(node_count);
  std::vector<idx_t> start(count + 1, 0);
  for (const auto& [a, b] : edges)
    if (a != b) {
      ++start[static_cast<std::size_t>(a) + 1];
      ++start[static_cast<std::size_t>(b) + 1];
    }
  for (std::size_t i = 0; i < count; ++i) start[i + 1] += start[i];
  std::vector<idx_t> fill(start.begin(), start.end() - 1), all(static_cast<std::size_t>(start.back()));
  for (const auto& [a, b] : edges)
    if (a != b) {
      all[static_cast<std::size_t>(fill[static_cast<std::size_t>(a)]++)] = b;
      all[static_cast<std::size_t>(fill[static_cast<std::size_t>(b)]++)] = a;
    }
  Graph graph;
  graph.start.reserve(count + 1);
  graph.start.push_back(0);
  graph.neighbour.reserve(all.size());
  for (std::size_t i = 0; i < count; ++i) {
    const auto first = all.begin() + start[i], last = all.begin() + start[i + 1];
    std::sort(first, last);
    graph.neighbour.insert(graph.neighbour.end(), first, std::unique(first, last));
    graph.start.push_back(static_cast<idx_t>(graph.neighbour.size()));
  }
  return graph;
}

/// How hard METIS tries, by the number of nodes; measured on regular frames of 500 to 190,000 freedoms. Small graphs
/// are ordered in no time. In the middle the order costs as much as it saves: one refinement pass a level is enough
/// (the same fill, 1/4 less time). Beyond, the factor dominates: separators may be less balanced, and are up to 1/8
/// thinner for it.
constexpr int middle_graph = 500, large_graph = 8000;

void choose_effort(int node_count, idx_t* options) {
  options[METIS_OPTION_NUMBERING] = 0;
  options[METIS_OPTION_SEED] = 1;  // fixed: the same order in every run
  if (node_count < middle_graph) return;
  options[METIS_OPTION_COMPRESS] = 0;  // a vertex is a node already: there is nothing alike to merge
  if (node_count < large_graph) {
    options[METIS_OPTION_NITER] = 1;
    options[METIS_OPTION_UFACTOR] = 230;
    options[METIS_OPTION_SEED] = 7;
  } else {
    options[METIS_OPTION_UFACTOR] = 400;
  }
}

}  // namespace

std::vector<int> order_nodes(int node_count, std::span<const std::pair<int, int>> edges,
                             std::span<const int> freedoms) {
  std::vector<int> order(static_cast<std::size_t>(node_count));
  for (int i = 0; i < node_count; ++i) order[static_cast<std::size_t>(i)] = i;
  Graph graph = make_graph(node_count, edges);
  if (graph.neighbour.empty()) return order;  // METIS wants at least one edge; without any, every order is as good

  idx_t count = node_count, options[METIS_NOPTIONS];
  METIS_SetDefaultOptions(options);
  choose_effort(node_count, options);
  std::vector<idx_t> weight(freedoms.begin(), freedoms.end());
  for (idx_t& w : weight) w = std::max<idx_t>(w, 1);
  const bool uniform = node_count >= middle_graph &&
                       std::all_of(weight.begin(), weight.end(), [&](idx_t w) { return w == weight.front(); });
  std::vector<idx_t> permutation(order.size()), inverse(order.size());
  // METIS draws numbers from the C library's rand(), which it seeds at each call: of two at once each would take some
  // of the other's, and the order would hang on the clock.
  static std::mutex one_at_a_time;
  const std::lock_guard lock(one_at_a_time);
  const int status = METIS_NodeND(&count, graph.start.data(), graph.neighbour.data(), uniform ? nullptr : weight.data(),
                                  options, permutation.data(), inverse.data());
  if (status == METIS_ERROR_MEMORY) throw std::runtime_error("ordering: METIS ran out of memory");
  if (status != METIS_OK)
    throw std::runtime_error("ordering: METIS refused the graph (status " + std::to_string(status) + ")");
  std::copy(permutation.begin(), permutation.end(), order.begin());
  return order;
}

}  // namespace topple::solver
