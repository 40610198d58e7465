#pragma once
// From elements to the entries of the sparse lower triangle: the pattern is found once; adding an element looks up
// where each pair of its nodes meets, and the rest follows by counting.
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "assembly/dof_map.h"
#include "assembly/sparse.h"

namespace topple::solver {

class AssemblyMap {
 public:
  /// `freedoms[start[e]] ... freedoms[start[e + 1] - 1]` are the numbers of element e's freedoms; numbers from
  /// dofs.equations on are held and left out.
  AssemblyMap(const DofMap& dofs, std::vector<int> freedoms, std::vector<std::int64_t> start);

  /// The pattern, with values 0.
  [[nodiscard]] SparseSymmetric empty_matrix() const;
  /// Pairs of vertices that share an element, smaller first, sorted.
  [[nodiscard]] const std::vector<std::pair<int, int>>& edges() const { return edges_; }
  [[nodiscard]] std::span<const int> freedoms(std::size_t element) const;
  /// Place of an entry's lower-triangle position within the pattern; row and column in any order.
  [[nodiscard]] std::int64_t position(int equation, int other) const;

  /// Adds scale[i] * k(i, j) * scale[j] to the matrix; `k` is the element's full matrix by columns. Only entries for
  /// which `wanted` (per vertex; empty: all) holds for the row's or the column's vertex.
  void add(std::size_t element, const double* k, std::span<const double> scale, const std::vector<char>& wanted,
           SparseSymmetric& matrix) const;

  /// Sets to zero what add() would add to.
  void clear(std::size_t element, const std::vector<char>& wanted, SparseSymmetric& matrix) const;

 private:
  /// Rows between the triangle of vertex v and the rows of its neighbour w > v.
  [[nodiscard]] std::int32_t offset_of(int v, int w) const;
  [[nodiscard]] bool is_wanted(int equation, const std::vector<char>& wanted) const;
  template <class Visit>
  void each_entry(std::size_t element, const std::vector<char>& wanted, const Visit& visit) const;
  void build_pattern();

  const DofMap& dofs_;
  std::vector<int> freedoms_;
  std::vector<std::int64_t> start_;
  std::vector<std::pair<int, int>> edges_;
  std::vector<std::int64_t> first_edge_;   ///< per vertex, into edges_
  std::vector<std::int32_t> edge_offset_;  ///< rows between the vertex's own triangle and the neighbour's rows
  SparseSymmetric pattern_;                ///< without values
};

}  // namespace topple::solver
