#pragma once
// The direct analysis method of AISC 360-16 chapter C: required strengths by a second-order analysis of a structure
// that leans (notional loads, C2.2b) and has yielded in part (reduced stiffness, C2.3), and no effective lengths beyond
// the members' unbraced ones (C3: EffectiveLengths::unbraced).
#include <vector>

#include "topple/structure/analysis.h"
#include "topple/structure/building.h"

namespace topple::structure {

/// C2.2b: initial out-of-plumbness of 1/500.
inline constexpr double out_of_plumb = 0.002;
/// C2.3(c): 1/1000 more in the place of tau_b, which is then 1 for all.
inline constexpr double in_place_of_tau_b = 0.001;
/// C2.3(a).
inline constexpr double stiffness_share = 0.8;

/// The building with these combinations alone, each four times: NAME +x, NAME -x, NAME +y, NAME -y. In each the
/// downward loads of every case (self weight, nodes, members, panels by their area at the corners) act sideways as
/// well, times `share`, where they act. Throws InputError where a combination would have a name that is taken.
[[nodiscard]] Building with_notional_loads(const Building& building, const std::vector<CombinationId>& combinations,
                                           double share = out_of_plumb + in_place_of_tau_b);

/// The same building with `stiffness_share` of Young's and shear moduli; joints and supports keep their springs.
/// `yielded`: per member, whose tau_b multiplies its flexural stiffness alone; empty: 1 for all.
[[nodiscard]] Building with_reduced_stiffness(Building building, const std::vector<YieldedStiffness>& yielded = {});

/// tau_b (C2-2a, C2-2b) by alpha P_r/P_ns, which is below 1.
[[nodiscard]] double tau_b(double ratio);
/// Of every member, by its largest compression over the combinations; ratio 0 and tau_b 1 for those that are not
/// checked. Throws InputError for one whose cross section yields as a whole: no stiffness is left.
[[nodiscard]] std::vector<YieldedStiffness> yielded_stiffness(const Building& building, const AnalysisResult& result);
/// What analyse_directly() found, and with what stiffness.
struct DirectAnalysis {
  AnalysisResult result;                  ///< of the members with their reduced stiffness
  std::vector<YieldedStiffness> yielded;  ///< that the result was found with
  int rounds = 0;                         ///< of analyses, until tau_b of no member changed by more than 1e-3
};
/// Analyses with the stiffness that its own axial forces leave (C2.3(b)). One stiffness serves all combinations: that
/// of the largest compression, on the safe side for the others. `building` has the notional loads. Throws as analyse()
/// does, and std::runtime_error where tau_b does not settle in 30 rounds.
[[nodiscard]] DirectAnalysis analyse_directly(const Building& building, const AnalysisRequest& request);

}  // namespace topple::structure
