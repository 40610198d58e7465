#include "assembly/assembly_map.h"

#include <algorithm>
#include <array>
#include <limits>
#include <stdexcept>

namespace topple::solver {

AssemblyMap::AssemblyMap(const DofMap& dofs, std::vector<int> freedoms, std::vector<std::int64_t> start)
    : dofs_(dofs), freedoms_(std::move(freedoms)), start_(std::move(start)) {
  build_pattern();
}

std::span<const int> AssemblyMap::freedoms(std::size_t element) const {
  return std::span(freedoms_).subspan(static_cast<std::size_t>(start_[element]),
                                      static_cast<std::size_t>(start_[element + 1] - start_[element]));
}

void AssemblyMap::build_pattern() {
  std::vector<int> touched;
  for (std::size_t element = 0; element + 1 < start_.size(); ++element) {
    touched.clear();
    for (int freedom : freedoms(element)) {
      if (freedom < dofs_.equations) touched.push_back(dofs_.vertex_of_equation[static_cast<std::size_t>(freedom)]);
    }
    std::sort(touched.begin(), touched.end());
    touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
    for (std::size_t i = 0; i < touched.size(); ++i) {
      for (std::size_t j = i + 1; j < touched.size(); ++j) edges_.emplace_back(touched[i], touched[j]);
    }
  }
  std::sort(edges_.begin(), edges_.end());
  edges_.erase(std::unique(edges_.begin(), edges_.end()), edges_.end());

  pattern_.size = dofs_.equations;
  pattern_.start.reserve(static_cast<std::size_t>(dofs_.equations) + 1);
  pattern_.start.push_back(0);
  edge_offset_.resize(edges_.size());
  std::size_t edge = 0;
  for (int v = 0; v < dofs_.vertices(); ++v) {
    first_edge_.push_back(static_cast<std::int64_t>(edge));
    const auto size = [&](int w) {
      return dofs_.first_equation[static_cast<std::size_t>(w) + 1] - dofs_.first_equation[static_cast<std::size_t>(w)];
    };
    std::int32_t tail = 0;
    for (; edge < edges_.size() && edges_[edge].first == v; ++edge) {
      edge_offset_[edge] = tail;
      tail += size(edges_[edge].second);
    }
    for (int k = 0; k < size(v); ++k) pattern_.start.push_back(pattern_.start.back() + size(v) - k + tail);
  }
  first_edge_.push_back(static_cast<std::int64_t>(edge));

  pattern_.row.reserve(static_cast<std::size_t>(pattern_.start.back()));
  for (int e = 0; e < dofs_.equations; ++e) {
    const auto v = static_cast<std::size_t>(dofs_.vertex_of_equation[static_cast<std::size_t>(e)]);
    for (int r = e; r < dofs_.first_equation[v + 1]; ++r) pattern_.row.push_back(r);
    for (auto k = first_edge_[v]; k < first_edge_[v + 1]; ++k) {
      const auto w = static_cast<std::size_t>(edges_[static_cast<std::size_t>(k)].second);
      for (int r = dofs_.first_equation[w]; r < dofs_.first_equation[w + 1]; ++r) pattern_.row.push_back(r);
    }
  }
}

std::int32_t AssemblyMap::offset_of(int v, int w) const {
  const auto begin = edges_.begin() + first_edge_[static_cast<std::size_t>(v)];
  const auto end = edges_.begin() + first_edge_[static_cast<std::size_t>(v) + 1];
  const auto edge = std::lower_bound(begin, end, std::pair(v, w));
  if (edge == end || edge->second != w) throw std::logic_error("no element joins these equations");
  return edge_offset_[static_cast<std::size_t>(edge - edges_.begin())];
}

std::int64_t AssemblyMap::position(int equation, int other) const {
  const int column = std::min(equation, other), row = std::max(equation, other);
  const int v = dofs_.vertex_of_equation[static_cast<std::size_t>(column)];
  const int w = dofs_.vertex_of_equation[static_cast<std::size_t>(row)];
  const std::int64_t start = pattern_.start[static_cast<std::size_t>(column)];
  if (v == w) return start + row - column;
  return start + dofs_.first_equation[static_cast<std::size_t>(v) + 1] - column + offset_of(v, w) + row -
         dofs_.first_equation[static_cast<std::size_t>(w)];
}

SparseSymmetric AssemblyMap::empty_matrix() const {
  SparseSymmetric matrix = pattern_;
  matrix.value.assign(matrix.row.size(), 0.0);
  return matrix;
}

bool AssemblyMap::is_wanted(int equation, const std::vector<char>& wanted) const {
  return wanted[static_cast<std::size_t>(dofs_.vertex_of_equation[static_cast<std::size_t>(equation)])] != 0;
}

/// Calls visit(i, j, place, twice) for the element's entries that belong to the matrix and are wanted, i >= j; twice:
/// two of its freedoms are the same equation, so that the entry and its mirror image meet.
template <class Visit>
void AssemblyMap::each_entry(std::size_t element, const std::vector<char>& wanted, const Visit& visit) const {
  const auto numbers = freedoms(element);
  const std::size_t n = numbers.size();
  constexpr std::size_t most_kept = 24;  // of beams and shells; those of larger patches are looked up each time
  std::array<char, most_kept> kept{};
  const auto look_up = [&](std::size_t i) { return numbers[i] < dofs_.equations && is_wanted(numbers[i], wanted); };
  for (std::size_t i = 0; !wanted.empty() && i < std::min(n, most_kept); ++i) kept[i] = look_up(i) ? 1 : 0;
  const auto is_needed = [&](std::size_t i) { return i < most_kept ? kept[i] != 0 : look_up(i); };
  // Freedoms of a node follow each other: a neighbour is looked up once for all of them.
  int last_v = -1, last_w = -1;
  std::int32_t offset = 0;
  for (std::size_t j = 0; j < n; ++j) {
    if (numbers[j] >= dofs_.equations) continue;
    const bool all = wanted.empty() || is_needed(j);
    for (std::size_t i = j; i < n; ++i) {
      if (numbers[i] >= dofs_.equations || !(all || is_needed(i))) continue;
      const int column = std::min(numbers[i], numbers[j]), row = std::max(numbers[i], numbers[j]);
      const int v = dofs_.vertex_of_equation[static_cast<std::size_t>(column)];
      const int w = dofs_.vertex_of_equation[static_cast<std::size_t>(row)];
      std::int64_t at = pattern_.start[static_cast<std::size_t>(column)] + row - column;
      if (v != w) {
        if (v != last_v || w != last_w) {
          offset = offset_of(v, w);
          last_v = v;
          last_w = w;
        }
        at += dofs_.first_equation[static_cast<std::size_t>(v) + 1] + offset -
              dofs_.first_equation[static_cast<std::size_t>(w)];
      }
      visit(i, j, static_cast<std::size_t>(at), i != j && row == column);
    }
  }
}

void AssemblyMap::add(std::size_t element, const double* k, std::span<const double> scale,
                      const std::vector<char>& wanted, SparseSymmetric& matrix) const {
  const auto numbers = freedoms(element);
  const std::size_t n = numbers.size();
  each_entry(element, wanted, [&](std::size_t i, std::size_t j, std::size_t place, bool twice) {
    const double value =
        k[j * n + i] * scale[static_cast<std::size_t>(numbers[j])] * scale[static_cast<std::size_t>(numbers[i])];
    matrix.value[place] += twice ? 2 * value : value;
  });
}

void AssemblyMap::clear(std::size_t element, const std::vector<char>& wanted, SparseSymmetric& matrix) const {
  each_entry(element, wanted, [&](std::size_t, std::size_t, std::size_t place, bool) { matrix.value[place] = 0; });
}

}  // namespace topple::solver
