#pragma once
// Design checks of steel members: cross-section, flexural, torsional and lateral-torsional buckling, shear and torsion,
// by EN 1993-1-1:2005 or AISC 360-16 (LRFD). Uniform moment is assumed for the moment-gradient factors (C1, Cm, Cb = 1)
// unless they are given: on the safe side. A section given as numbers without shear areas or torsion modulus has no
// clause for shear or torsion. Units: SI, always (the codes' limits hold N, m and Pa).
#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "topple/structure/building.h"

namespace topple::structure {

enum class DesignCode { en1993, aisc360 };

/// Lengths that buckling is checked over, m. The effective length factor is included.
struct BucklingLengths {
  double y = 0;        ///< flexural buckling about local y (bending in the local x-z plane)
  double z = 0;        ///< flexural buckling about local z
  double torsion = 0;  ///< torsional buckling; 0: twist is prevented all along
  double lateral = 0;  ///< between lateral restraints of the compression flange; 0: restrained all along
};

/// Factors for the shape of the moment diagram, each 1 for uniform moment.
struct MomentFactors {
  double critical_moment = 1;  ///< C1 of EN 1993-1-1 (through M_cr), Cb of AISC 360
  double equivalent_y = 1;     ///< C_my and C_mLT of EN 1993-1-1 annex B
  double equivalent_z = 1;     ///< C_mz
};

/// Internal forces at stations along the member: axial (tension positive), shear_y, shear_z, torsion, moment_y,
/// moment_z.
using SectionForces = std::array<double, 6>;

struct DesignMember {
  const Section* section = nullptr;
  const Material* material = nullptr;
  BucklingLengths lengths;
  MomentFactors factors;
};

/// One formula of the code and what it gave (1 is the limit).
struct DesignClause {
  std::string clause;
  double utilisation = 0;
};

struct DesignResult {
  double utilisation = 0;
  std::string governing;              ///< clause of the largest utilisation
  std::vector<DesignClause> clauses;  ///< all that were evaluated
};

/// Throws InputError that names the key when the section or material lacks what the check needs (`yield_strength`, a
/// section's `depth` and `width` where its moduli cannot be had otherwise).
[[nodiscard]] DesignResult check_member(DesignCode code, const DesignMember& member,
                                        std::span<const SectionForces> stations);

/// The formula of a clause in the code's own symbols; empty for an unknown clause.
[[nodiscard]] std::string_view design_formula(std::string_view clause);
/// Edition and safety factors.
[[nodiscard]] std::string_view design_code_name(DesignCode code);

}  // namespace topple::structure
