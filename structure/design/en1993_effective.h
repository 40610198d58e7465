#pragma once
// EN 1993-1-5 section 4: what plate buckling leaves of a section of class 4.
#include "design/steel_section.h"

namespace topple::structure {

/// Area under uniform compression, and the smaller elastic modulus under bending about y and about z alone, each of
/// the effective section of its own stress (EN 1993-1-5 4.3(3), (4)). Those of the whole section where nothing buckles.
struct EffectiveSection {
  double area = 0, modulus_y = 0, modulus_z = 0;
  double web = 1, flange = 1;    ///< rho under uniform compression
  double web_in_bending = 1;     ///< rho of the web under bending about y
  double web_stress_ratio = -1;  ///< psi of the web under bending about y, the flange being effective already
};

/// Of I sections and boxes, which are symmetric about both axes: the centroid stays under compression (e_N = 0).
/// Clear widths are those of the classes: inside the fillets of an I, between the corners of a box.
[[nodiscard]] EffectiveSection effective_section(const SteelSection& steel);
void trace_effective(const EffectiveSection& effective, const Trail& trail);

}  // namespace topple::structure
