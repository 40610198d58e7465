#pragma once
// Six components in other axes.
#include "topple/structure/building.h"

namespace topple::structure {

/// `turn`: rows are the other axes, in components of the present ones.
[[nodiscard]] inline Vec6 turned(const Mat3& turn, const Vec6& v) {
  Vec6 result;
  result << turn * v.head<3>(), turn * v.tail<3>();
  return result;
}

}  // namespace topple::structure
