#pragma once
// Obstacles that move with a structure. Such an obstacle is a body of the solver for the length of one part of a step,
// and then the structure says where it is and how fast.
//
// Within a part it goes on as the structure foresees, if what touched it in the last one goes on to; where what touches
// it does otherwise it gives way as it would by itself, or as the structure says that it does. The force between a body
// and the structure then goes to its true value by a factor sqrt(1 - q) for each part, q being the mobility of both
// over what was taken for it; it grows where q is above 4/3, and with the structure's own mobility for a part of a step
// there is no error (A. Gravouil, A. Combescure, Int. J. Numer. Meth. Eng. 50 (2001), 199). By how much the structure
// gives way what it did beside what was foreseen tells, where the force on it changed by enough.
#include <span>
#include <vector>

#include "debris/debris_scene.h"
#include "debris/islands.h"
#include "solver/step_solver.h"

namespace topple::collision {

/// Obstacles of the scene that move in this step.
class MovingObstacles {
 public:
  explicit MovingObstacles(DebrisScene& scene) : scene_(scene) {}

  /// As a part of a step begins: those near bodies, and those at which bodies hang, are asked for; what moved before
  /// and is near none any more is left where it is. Pairs are those of now.
  void update(double dt, MovingStructure& structure);
  void stand_still(DebrisObstacle& obstacle);
  /// Those that the island touches or hangs at, as bodies of the solver.
  void add_to(StepSolver& solver, const Island& island, double dt, double substep);
  /// After a part of a step, in which these islands were solved.
  void read_motion(const StepSolver& solver, std::span<Island* const> islands, double dt);
  void wake_carried();
  /// What hinges did to them since they were told last.
  [[nodiscard]] std::vector<HingePull> extract_pulls();

 private:
  void update(DebrisObstacle& obstacle, const ObstacleMotion& motion, double dt);
  static void add(DebrisObstacle& obstacle, StepSolver& solver, double dt, double substep);
  void estimate_compliance(DebrisObstacle& obstacle, const ObstacleMotion& now, const Vec3& force,
                           const Vec3& moment) const;

  DebrisScene& scene_;
};

}  // namespace topple::collision
