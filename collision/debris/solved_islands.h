#pragma once
// Islands in the step's solver: how they get into it, and what comes of it for their bodies, hinges and cables.
#include <span>
#include <vector>

#include "debris/moving_obstacles.h"

namespace topple::collision {

/// Those that are solved at once, with the same sub-steps.
class SolvedIslands {
 public:
  /// Shares its loops in `region`, when that is open.
  SolvedIslands(DebrisScene& scene, MovingObstacles& moving, ParallelRegion& region)
      : scene_(scene), moving_(moving), region_(region), solver_(scene.settings, region) {}

  /// `substeps` of `dt`: for which obstacles that move go on; with none they stand still as the others.
  void fill(std::span<Island* const> islands, double dt, int substeps);
  /// Moves on by `dt`; the bodies are where they were until update_bodies().
  void run(double dt, int substeps);
  void update_bodies(double dt);
  /// Adds what hinges and cables pulled with to what is told of them, as means over `dt`, s. Of the bodies that moved:
  /// what sleeps pulls as it did.
  void read_joints(std::span<Island* const> islands, double dt) const;

  [[nodiscard]] StepSolver& solver() { return solver_; }
  [[nodiscard]] const StepSolver& solver() const { return solver_; }
  /// Of a contact that the solver holds; null: no body, or one that sleeps.
  [[nodiscard]] DebrisBody* body_of(const SolverContact& solved, bool second) const;

 private:
  [[nodiscard]] SolverContact solver_contact(std::uint32_t index) const;
  void add_contacts(const Island& island);
  void add(DebrisHinge& hinge);
  void resist_rolling();
  /// Calls work(body) for all that the solver holds, side by side.
  template <class Work>
  void each_solved(const Work& work);

  DebrisScene& scene_;
  MovingObstacles& moving_;
  ParallelRegion& region_;
  StepSolver solver_;
  std::vector<DebrisBody*> solving_;  ///< bodies that the solver holds: the first is its number 1
};

}  // namespace topple::collision
