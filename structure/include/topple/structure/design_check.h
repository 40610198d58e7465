#pragma once
// Design checks of steel members: cross-section, shear buckling of webs, flexural, torsional and lateral-torsional
// buckling, torsion with warping, by EN 1993-1-1:2005 with EN 1993-1-5:2006 or AISC 360-16 (LRFD). Which clauses are
// checked, which are not, and what is said then: docs/design-checks.md. Units: SI, always (the codes' limits hold N, m
// and Pa).
#include <array>
#include <optional>
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
  double critical_moment = 1;  ///< C1 of EN 1993-1-1 (through M_cr), Cb of AISC 360; 0: found for each stretch
  double equivalent_y = 1;     ///< C_my and C_mLT of EN 1993-1-1 annex B
  double equivalent_z = 1;     ///< C_mz
};

/// A stretch of the compression flange between lateral restraints.
struct LateralStretch {
  double from = 0;                ///< m from the member's first end
  double to = 0;                  ///< m from the member's first end
  double length = 0;              ///< that lateral-torsional buckling is checked over, m
  bool moments_are_known = true;  ///< false: it goes on beyond the member, or has a free end: uniform moment is taken
};

/// Internal forces at stations along the member: axial (tension positive), shear_y, shear_z, torsion, moment_y,
/// moment_z.
using SectionForces = std::array<double, 6>;

/// Where an effective length comes from.
enum class LengthSource {
  given,              ///< by the member's `design`
  own,                ///< between the nodes that hold it: factor 1
  cantilever,         ///< an end that nothing holds: factor 2
  assumed_sway,       ///< of a post, factor 2
  chart_braced,       ///< alignment chart, sidesway inhibited
  chart_sway,         ///< alignment chart, sidesway uninhibited; with what leans on it
  leaning,            ///< pinned at both ends: factor 1, the others of its storey hold it up
  buckling_analysis,  ///< from the lowest buckling factor in whose shape the member takes part
  lowest_factor,      ///< from the lowest buckling factor, though it takes no part: shorter than what was found else
};
[[nodiscard]] std::string_view length_source_name(LengthSource source);

/// What a member does in the buckling modes that were found, so that they say something of its effective length or not.
enum class ModePart {
  not_asked,     ///< no modes were found, or its length is given
  takes_part,    ///< in one of them
  not_pressed,   ///< no compression
  hardly_bends,  ///< in all of them it bends too little beside those that buckle
  is_bent,       ///< its compression does too little of the work that bends it: it holds others, or goes along
};
/// Why the member's length does not come from a mode, in words; empty for not_asked and takes_part.
[[nodiscard]] std::string_view mode_part_reason(ModePart part);

/// AISC 360 C2.3(b): what yielding under compression leaves of a member's flexural stiffness.
struct YieldedStiffness {
  double ratio = 0;  ///< alpha P_r/P_ns, alpha = 1: the largest compression over the cross section's strength
  double tau_b = 1;  ///< the factor on its flexural stiffness, 0 to 1
};

/// One member as its check takes it. Pointers are not owned and must outlive the check.
struct DesignMember {
  const Section* section = nullptr;             ///< its dimensions and properties
  const Material* material = nullptr;           ///< with a yield strength
  BucklingLengths lengths{};                    ///< the effective length factors included
  std::array<LengthSource, 2> length_source{};  ///< of those about y and z
  std::array<ModePart, 2> mode_part{};          ///< likewise
  MomentFactors factors{};                      ///< of moment diagrams
  double stiffener_spacing = 0;                 ///< of transverse stiffeners of the web, m; 0: at the supports alone
  bool rigid_end_post = false;                  ///< EN 1993-1-5 9.3
  std::optional<std::array<bool, 2>> warping_held{};  ///< at either end; none: not known, the worst of both is taken
  /// Distance of each station from the first end, m, in order (two of the same place are its two sides). Empty: not
  /// known, then torsion of open sections is refused and the moment's shape is taken as uniform.
  std::vector<double> at{};
  std::vector<LateralStretch> stretches{};    ///< with `at` and critical_moment 0; empty: lengths.lateral alone
  std::optional<YieldedStiffness> yielded{};  ///< where the forces are those of an analysis with it
};

/// One formula of the code and what it gave (1 is the limit).
struct DesignClause {
  std::string clause;      ///< as the code numbers it
  double utilisation = 0;  ///< demand over resistance
};

/// What the check of one member found.
struct DesignResult {
  double utilisation = 0;                       ///< the largest of all clauses
  std::string governing;                        ///< clause of the largest utilisation
  std::vector<DesignClause> clauses;            ///< all that were evaluated
  BucklingLengths lengths;                      ///< that it was checked with
  std::array<LengthSource, 2> length_source{};  ///< of those for buckling about y and z
  std::array<ModePart, 2> mode_part{};          ///< likewise
  std::optional<YieldedStiffness> yielded;      ///< that the analysis had
  std::string refusal;  ///< why the member cannot be said to pass whatever its utilisation; else empty
  /// Nothing was refused and no clause is above 1.
  [[nodiscard]] bool passes() const { return refusal.empty() && utilisation <= 1; }
};

/// A value on the way to a clause. Its unit is force^`force` length^`length`.
struct DesignStep {
  std::string clause;   ///< as the code numbers it
  std::string symbol;   ///< in the code's notation
  std::string formula;  ///< with its numbers, or empty
  double value = 0;     ///< in SI
  int force = 0;        ///< power of force in the unit
  int length = 0;       ///< power of length in the unit
};

/// A check with all that lies between the section and the clauses.
struct DesignAudit {
  DesignResult result;            ///< as check_member() gives it
  std::vector<DesignStep> steps;  ///< in the order in which they are needed
};

/// Throws InputError that names the key when the section or material lacks what the check needs (`yield_strength`, a
/// section's `depth` and `width` where its moduli cannot be had otherwise).
[[nodiscard]] DesignResult check_member(DesignCode code, const DesignMember& member,
                                        std::span<const SectionForces> stations);
/// The same, with every intermediate value.
[[nodiscard]] DesignAudit audit_member(DesignCode code, const DesignMember& member,
                                       std::span<const SectionForces> stations);

/// The formula of a clause in the code's own symbols; empty for an unknown clause.
[[nodiscard]] std::string_view design_formula(std::string_view clause);
/// Edition and safety factors.
[[nodiscard]] std::string_view design_code_name(DesignCode code);
/// What the code asks for and is not checked for any member, one sentence each.
[[nodiscard]] std::span<const std::string_view> design_not_checked(DesignCode code);

}  // namespace topple::structure
