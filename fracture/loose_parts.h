#pragma once
// Parts of what remains of a panel that no held edge of its outline holds.
#include <vector>

#include "half_edges.h"

namespace topple::fracture {

class LooseParts {
 public:
  /// Triangles with the label `intact` remain. `held`: for each edge of the outline, the tag of its half-edges. All
  /// must outlive it.
  LooseParts(const HalfEdges& triangles, const std::vector<bool>& held, int intact)
      : triangles_(triangles), held_(held), intact_(intact) {}

  /// Around these triangles, which remain: each part's triangles, in the order in which they are reached. A part that
  /// is held is searched no further than to where it is.
  [[nodiscard]] std::vector<std::vector<int>> around(const std::vector<int>& starts) const;
  /// Beside triangles that were removed.
  [[nodiscard]] std::vector<std::vector<int>> beside(const std::vector<int>& removed) const;

 private:
  [[nodiscard]] bool is_held(int triangle) const;
  /// The triangle on the other side, or `none` where that does not remain.
  [[nodiscard]] int neighbour(int edge) const;

  const HalfEdges& triangles_;
  const std::vector<bool>& held_;
  int intact_;
};

}  // namespace topple::fracture
