#pragma once
// Loads of one beam, taken together.
#include <algorithm>
#include <vector>

#include "topple/solver/frame_model.h"

namespace topple::structure {

/// One by one, to the bit.
[[nodiscard]] inline bool same_loads(const std::vector<solver::BeamLoad>& a, const std::vector<solver::BeamLoad>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const solver::BeamLoad& x, const solver::BeamLoad& y) {
    return x.kind == y.kind && x.from == y.from && x.to == y.to && x.first == y.first && x.last == y.last &&
           x.strain == y.strain && x.curvature_y == y.curvature_y && x.curvature_z == y.curvature_z;
  });
}

inline void add_scaled(const std::vector<solver::BeamLoad>& loads, double factor, std::vector<solver::BeamLoad>& sum) {
  for (solver::BeamLoad load : loads) {
    load.first *= factor;
    load.last *= factor;
    load.strain *= factor;
    load.curvature_y *= factor;
    load.curvature_z *= factor;
    sum.push_back(load);
  }
}

}  // namespace topple::structure
