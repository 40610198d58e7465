#pragma once
// Design checks of a whole analysed building: every steel member by a code's formulas, and the drift of its storeys.
#include "topple/structure/analysis.h"
#include "topple/structure/design_check.h"

namespace topple::structure {

/// Stations along each member at which the formulas are evaluated, beside both sides of every place where a load
/// begins, ends or acts and the places of the extremes of every internal force: ask analyse() for at least this many,
/// and for the critical sections, before check_design().
inline constexpr int design_stations = 20;

/// Limit on the storey drift where none is given: height/300 (UK National Annex to EN 1993-1-1, NA.2.24; codes leave it
/// to the project).
inline constexpr double usual_drift_limit = 1.0 / 300;

/// How lengths for flexural buckling are found where a member does not give them.
enum class EffectiveLengths {
  automatic,  ///< charts; with buckling modes in the result, from these for the members that take part in them
  charts,    ///< alignment charts for posts, braced or free to sway as the model has it; others between what holds them
  assumed,   ///< twice the length of posts, which may sway; others between what holds them
  unbraced,  ///< K = 1 for all, between what holds them: for a direct analysis (direct_analysis.h)
};

/// What a model does not say of its members.
struct DesignInput {
  EffectiveLengths lengths = EffectiveLengths::automatic;  ///< where the model gives none
  /// Spacing of transverse stiffeners of webs, m, by member, pattern or group; of several that match the last.
  std::vector<std::pair<std::string, double>> stiffeners;
  bool rigid_end_posts = false;  ///< EN 1993-1-5 9.3: tension fields of webs are anchored at the members' ends
  /// Whether warping is held at either end of every member; none: not known, the worst of both is taken.
  std::optional<std::array<bool, 2>> warping_held;
  /// Per member, of a direct analysis with tau_b (direct_analysis.h); else empty.
  std::vector<YieldedStiffness> yielded;
};

/// The members of a building as a check of one combination takes them; `section` is null for one that is not checked.
class DesignMembers {
 public:
  /// Throws InputError for stiffeners of what is not there.
  DesignMembers(const Building& building, const DesignInput& input);
  /// What a combination's lengths hang on: how much its buckling modes bend members, and how much more the posts of a
  /// storey have to bear than their own load, where others lean on them.
  struct State {
    std::vector<double> bends;                                       ///< per mode
    std::map<std::pair<long, long>, std::array<double, 2>> leaning;  ///< by levels: about y, about z
  };
  /// Of one combination; for member().
  [[nodiscard]] State state(const CombinationResult& combination) const;
  /// `at` is left empty.
  [[nodiscard]] DesignMember member(MemberId id, const CombinationResult& combination, const State& state) const;

 private:
  const Building& building_;
  EffectiveLengths method_;
  std::vector<DesignMember> members_;
};

/// Forces of a member at the stations and at the critical sections, in order along it, with their places.
struct PlacedForces {
  std::vector<double> at;             ///< m from the first end, ascending
  std::vector<SectionForces> forces;  ///< one for each place
};
[[nodiscard]] PlacedForces forces_along(const Member& member, const MemberResult& result);

/// Fills `designs` of every combination and `design_code`, `drift_limit` of the result, and warns of combinations whose
/// factors look as if their loads had none. Throws InputError that names the member and the key when something is
/// missing, and for a building in "consistent" units (the codes' formulas have units). Throws std::invalid_argument
/// when the result has no stations or no critical sections.
void check_design(const Building& building, DesignCode code, double drift_limit, AnalysisResult& result,
                  const DesignInput& input = {});

/// The check of one member with every intermediate value.
[[nodiscard]] DesignAudit audit_design(const DesignMembers& members, DesignCode code, MemberId member,
                                       const Building& building, const CombinationResult& combination);

}  // namespace topple::structure
