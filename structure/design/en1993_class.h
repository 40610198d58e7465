#pragma once
#include "design/steel_section.h"

namespace topple::structure {

/// Cross-section class (EN 1993-1-1, table 5.2) under a compression force and bending about the strong axis, and the
/// yield strength to calculate with: for class 4 the section is treated as class 3 at a lower stress (the reduced
/// stress method, EN 1993-1-5 section 10), in which its slenderest part is just at the limit.
struct SectionClass {
  int number = 1;
  double fy = 0;
};
[[nodiscard]] SectionClass classify_en1993(const SteelSection& steel, double compression);

}  // namespace topple::structure
