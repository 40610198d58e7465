#pragma once
// A component that moves, as StandingMotion keeps it.
#include <optional>

#include "archive/nested_state.h"
#include "standing/motion/moving_law.h"
#include "standing/motion/standing_motion.h"

namespace topple::structure {

struct StandingMotion::Moving {
  /// What its frame was made of when it began to move.
  struct Beginning {
    solver::FrameModel model;
    solver::MassModel masses;
    solver::RayleighDamping damping;
  };
  template <class Archive>
  friend void serialize(Archive& archive, Beginning& begun) {
    auto& [model, masses, damping] = begun;
    archive(model, masses, damping);
  }
  Beginning beginning;
  std::unique_ptr<solver::FrameDynamics> frame;
  std::unique_ptr<MovingLaw> law;
  double elastic_at_start = 0;
  double between_nodes = 0;  ///< J, at the start: strain of loads between nodes, which no motion of nodes has
  double turned = 0;         ///< rad, its largest turn a step ago
  double left_work = 0;      ///< J, at rest: of loads that have changed since, which the account of rest never sees
  double looked = 0;         ///< s of its motion, when rest was looked for last
  std::vector<double> mass;  ///< per beam, as the frame has it
  bool yields = false;       ///< a hinge turned in the last substep
  std::uint64_t yield_changes = 0;  ///< how often `yields` became another
  /// A shell panel that changed since the last substep or impulse.
  struct ChangedShell {
    Eigen::VectorXd motion;    ///< before it changed: PanelSuperelement::motion()
    Vec3 had = Vec3::Zero();   ///< N s, before it changed
    std::optional<Vec3> gave;  ///< N s, to chunks since then
    Eigen::VectorXd impulses;  ///< at its nodes: what it lacks of that motion's momentum now; empty: none
  };
  template <class Archive>
  friend void serialize(Archive& archive, ChangedShell& shell) {
    auto& [motion, had, gave, impulses] = shell;
    archive(motion, had, gave, impulses);
  }
  std::map<PanelId, ChangedShell> changed_shells;

  /// Once the frame is made, which takes the beginning. The law gets its hinges in every substep.
  template <class Archive>
  void serialize(Archive& archive) {
    auto& [begun, made, by_law, elastic, strain_between, largest_turn, work_of_left, looked_at, masses, yielding,
           changed, shells] = *this;
    NestedState state{*made};
    archive(state, elastic, strain_between, largest_turn, work_of_left, looked_at, masses, yielding, changed, shells);
  }
};

}  // namespace topple::structure
