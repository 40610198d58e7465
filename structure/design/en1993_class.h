#pragma once
#include "design/en1993_effective.h"

namespace topple::structure {

/// Cross-section class (EN 1993-1-1, table 5.2) under a compression force and bending about the strong axis, and what
/// of the section counts elastically: in class 4 the effective section of EN 1993-1-5 section 4. A tube of class 4 is
/// a shell: it has the stress at which it would be at the limit of class 3.
struct SectionClass {
  int number = 1;
  int about_z = 1;  ///< under the compression and bending about the weak axis: a box's webs are then compressed flanges
  double fy = 0;
  EffectiveSection counts;
  double pressed_area = 0;  ///< what counts under compression alone, which may be less than under both together
};
[[nodiscard]] SectionClass classify_en1993(const SteelSection& steel, double compression);

}  // namespace topple::structure
