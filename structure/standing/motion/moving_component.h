#pragma once
// A component that moves, as StandingMotion keeps it.
#include <optional>

#include "standing/motion/moving_law.h"
#include "standing/motion/standing_motion.h"

namespace topple::structure {

struct StandingMotion::Moving {
  std::unique_ptr<solver::FrameDynamics> frame;
  std::unique_ptr<MovingLaw> law;
  double elastic_at_start = 0;
  double between_nodes = 0;  ///< J, at the start: strain of loads between nodes, which no motion of nodes has
  double turned = 0;         ///< rad, its largest turn a step ago
  double left_work = 0;      ///< J, at rest: of loads that have changed since, which the account of rest never sees
  double looked = 0;         ///< s of its motion, when rest was looked for last
  std::vector<double> mass;  ///< per beam, as the frame has it
  /// A shell panel that changed since the last substep or impulse.
  struct ChangedShell {
    Eigen::VectorXd motion;    ///< before it changed: PanelSuperelement::motion()
    Vec3 had = Vec3::Zero();   ///< N s, before it changed
    std::optional<Vec3> gave;  ///< N s, to chunks since then
    Eigen::VectorXd impulses;  ///< at its nodes: what it lacks of that motion's momentum now; empty: none
  };
  std::map<PanelId, ChangedShell> changed_shells;
};

}  // namespace topple::structure
