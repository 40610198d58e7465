#pragma once
// Progressive collapse by statics, from one state of rest to the next: solve, break what is over capacity, release what
// that sets free, and again. One round is a generation: the joints that break in one state, before the next is
// solved.
#include <optional>
#include <utility>
#include <vector>

#include "failure/buckling_bracing.h"
#include "standing/damage/standing_release.h"

namespace topple::structure {

class Generations {
 public:
  /// What it changes; all of it must outlive it.
  struct Parts {
    StructuralState& state;
    YieldingWay& yielding;
    BreakLog& breaks;
    JointAnswers& answers;
    StandingDamage& damage;
    StandingRelease& release;
  };
  explicit Generations(const Parts& parts);

  /// Solves the undamaged building. True when joints of it are over capacity: they break in the first generation.
  /// Throws UnstableModel.
  [[nodiscard]] bool start();
  /// What has lost its hold leaves, and what remains is solved.
  void bring_up_to_date();
  /// Generations until nothing breaks, or this many. True when more would break.
  [[nodiscard]] bool run(int generations);
  /// The static answer is borne: R becomes R0.
  void come_to_rest(int component);
  /// A post of the component that gives way sideways in the static answer breaks.
  void snap_what_buckles(int component);

  template <class Archive>
  void serialize(Archive& archive) {
    auto& [to, buckling, buckled] = *this;
    if (buckling) archive(*buckling);  // the rules say whether it is there
    archive(buckled);
  }

 private:
  [[nodiscard]] bool solve_changed();
  void solved(int component, const std::optional<FrameMechanism>& mechanism);
  [[nodiscard]] std::vector<JointId> next();
  void find_overloads(int component, std::vector<JointId>& breaking);
  void accept(int component, const std::vector<double>& largest);
  void rest(int component);
  [[nodiscard]] bool buckles(int component);
  void snap_buckled();
  void require_anchored();

  Parts to_;
  std::optional<BucklingBracing> buckling_;
  std::vector<BuckledPost> buckled_;  ///< to break next
};

}  // namespace topple::structure
