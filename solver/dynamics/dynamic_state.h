#pragma once
// What a FrameDynamics holds. Vectors are in the scaled equations of its frame system: displacements x with u = S x,
// forces S f.
#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "assembly/element_masses.h"
#include "dynamics/changed_momentum.h"
#include "dynamics/energy_ledger.h"
#include "dynamics/generalized_alpha.h"
#include "dynamics/load_patterns.h"
#include "dynamics/motion_state.h"
#include "dynamics/node_motions.h"
#include "dynamics/plastic_kinks.h"
#include "dynamics/recent_loads.h"
#include "dynamics/settling_load.h"
#include "dynamics/substep_equation.h"
#include "reanalysis/reanalysis_state.h"
#include "topple/solver/frame_dynamics.h"

namespace topple::solver {

struct FrameDynamics::State {
  struct FollowingFactor;
  class Jumps;
  class ShorterSubsteps;

  DynamicOptions options;          ///< with the wave times of all beams
  GeneralizedAlpha whole, method;  ///< of undivided substeps, whose matrix the frame has; of the next one
  int parts = 1;                   ///< that a substep is divided into
  SystemInertia inertia;
  Reanalysis frame;
  LoadPatterns patterns;
  RecentLoads recent_loads;
  PlasticKinks kinks;
  double time = 0;

  MotionState before, now;  ///< at the start and at the end of the substep under way
  bool accepted = true;     ///< no substep is under way: `before` is the motion now, `now` that before the last substep
  std::vector<Vec6> started_at;  ///< per node: displacements at set_state(), else 0
  NodeMotions nodes;
  std::vector<Vec6> foreseen;   ///< per node: mean accelerations of the next substep; empty: not asked for yet
  std::vector<Vec6> reactions;  ///< per support, at the end of the substep; empty: not asked for yet
  EnergyLedger ledger;
  Eigen::VectorXd constant_load, collocated_load, substep_load;  ///< substep_load: of what changed in this substep
  SettlingLoad geometric;                                        ///< second order
  ChangedMomentum changed;
  std::vector<FrameDynamics::Impulse> waiting;  ///< for the next substep, or the next strike()
  std::unique_ptr<Jumps> jumps;
  std::unique_ptr<ShorterSubsteps> shorter;
  bool prepared = false;
  DynamicCounters counters;
  std::vector<JointBreak> breaks;
  SubstepEquation equation;

  State(FrameModel model, MassModel masses, DynamicOptions given);
  ~State();
  [[nodiscard]] Reanalysis::State& core() { return *frame.state_; }
  [[nodiscard]] const Reanalysis::State& core() const { return *frame.state_; }
  [[nodiscard]] const FrameSystem& system() const { return *core().system; }
  [[nodiscard]] Eigen::Index equations() const { return system().dofs().equations; }
  [[nodiscard]] const MotionState& current() const { return before; }
  /// d a1, s2: what damping of stiffness takes of an impulse, which lasts for d.
  [[nodiscard]] double damped_in_impulse() const {
    return std::max(whole.h, options.shortest_impulse) * options.damping.stiffness;
  }

  // structural_change.cpp
  /// Takes over what changed since the last substep, or within the one under way, which then begins with the motion
  /// `start`, before anything broke in it. True: the motion began anew, as more changed than loads.
  bool apply_changes(const MotionState* start = nullptr);
  void renumber();
  void clear_dropped();
  void set_method(const GeneralizedAlpha& other);
  void begin_substep();
  /// With all that came since the last one.
  void begin_changed();
  void begin_motion_anew();
  [[nodiscard]] Eigen::VectorXd velocities_that_share(const Eigen::VectorXd& impulses);
  [[nodiscard]] Eigen::VectorXd at_once(Eigen::VectorXd force);
  /// The motion at the start of the next substep is another one, or what it is read with.
  void forget_motion();

  // substep_parts.cpp
  /// A substep as a whole where that is near enough, else in parts.
  void advance_as_needed(const JointLaw& law);
  /// DynamicOptions::largest_error, of the substep that was tried.
  [[nodiscard]] double substep_error(const JointLaw& law);
  [[nodiscard]] int parts_for(double error) const;
  /// The substep that was tried did not happen.
  void put_off();
  void divide_substep(int into);
  [[nodiscard]] GeneralizedAlpha method_of_parts(int into) const;
  /// Of a divided substep, not the first; as many are left, this one included.
  void begin_part(int left);
  void require_undivided() const;

  // momentum.cpp
  [[nodiscard]] Eigen::VectorXd scaled_impulses(std::span<const Impulse> impulses) const;
  /// A column for each.
  [[nodiscard]] Eigen::MatrixXd scaled_columns(std::span<const std::vector<Impulse>> forces) const;
  void follow_jump(const Eigen::VectorXd& change);
  [[nodiscard]] std::optional<ChangedMomentum::Left> left_with(int beam) const;

  // substep.cpp
  /// What breaks in the substep that was tried breaks, and it is accepted.
  void break_all(const JointLaw* law);
  /// To its end, with what yields, joints that break apart.
  void advance_substep(const JointLaw* law);
  void advance_first_order(const JointLaw* law);
  /// Of the substep that begins now: its equation, solved, while nothing yields.
  void solve_elastic();
  void foresee();
  /// x := (K + s M)^-1 x, of the substep under way.
  void solve_substep(Eigen::VectorXd& x);
  /// The same of a substep that is one of so many parts, with s of their method.
  void solve_of_parts(int into, double s, Eigen::VectorXd& x);
  void find_end();
  void accept();
  void account_energy();
  double stored_energy();
  void evaluate_nodes();
  void evaluate_end();

  // plastic_flow.cpp
  /// At the end of the substep under way; 0 of hinges that do not yield.
  [[nodiscard]] std::vector<double> moments_at_end(std::span<const PlasticHinge> hinges);
  /// Of the substep under way, as it was tried: what yields turns, and the motion at its end follows.
  void yield(std::span<const PlasticHinge> hinges);
  /// The share of the substep at which a hinge has turned too far, or at which one that nothing resists is over.
  [[nodiscard]] std::optional<double> turned_out_at(const PlasticHinge& hinge);
  /// By how much the load of a kink in a substep's equation grows with its angle at the end: what turns is not damped.
  [[nodiscard]] double of_new_turn() const { return 1 - method.af + options.damping.stiffness / method.h; }

  // geometric_loads.cpp
  [[nodiscard]] Vec12 geometric_end_forces(int beam, const std::vector<Vec6>& displacements,
                                           const Vec12& elastic) const;
  [[nodiscard]] Eigen::VectorXd find_geometric_load(const std::vector<Vec6>& displacements, bool at_end) const;
  void advance_second_order(const JointLaw* law);

  // break_rule.cpp
  /// A joint comes to its capacity in the substep under way, or turns too far.
  [[nodiscard]] bool any_crosses(const JointLaw& law);
  [[nodiscard]] bool break_joints(const JointLaw& law);
  void record_break(const JointBreak& broken, double share, const SubstepCourse<Vec12>& course);
  [[nodiscard]] RecentLoads::Held held(int beam) const;
  [[nodiscard]] Vec12 end_forces(int beam, bool at_end) const;
  [[nodiscard]] Vec12 elastic_end_forces(int beam, const std::vector<Vec6>& displacements, bool at_end) const;
  /// Of its loads as they act, and as its joints feel them, with kinks.
  [[nodiscard]] Vec12 fixed_end_of_loads(std::size_t beam, bool at_end) const;
  [[nodiscard]] Vec12 fixed_end_forces(int beam, bool at_end) const;
  [[nodiscard]] Vec12 end_force_rates(int beam, bool at_end) const;
  [[nodiscard]] SubstepCourse<Vec12> course(int beam) const;
};

}  // namespace topple::solver
