#pragma once
// What a FrameDynamics holds. Vectors are in the scaled equations of its frame system: displacements x with u = S x,
// forces S f.
#include <Eigen/SparseCore>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "assembly/element_masses.h"
#include "dynamics/generalized_alpha.h"
#include "dynamics/products.h"
#include "reanalysis/reanalysis_state.h"
#include "topple/solver/frame_dynamics.h"

namespace topple::solver {

/// Motion of the equations at one time.
struct MotionState {
  Eigen::VectorXd u, v, a;
};

/// The same by nodes, global.
struct NodeMotion {
  std::vector<Vec6> u, v;
};

/// A load that goes with time.
struct LoadPattern {
  enum class Kind { loads, ground, holding } kind = Kind::loads;
  LoadSet loads;
  Vec3 direction = Vec3::Zero();
  std::map<int, Vec12> fixed_end;  ///< per loaded beam, local, for a value of 1
  Eigen::VectorXd force;           ///< scaled; empty: to be found
  double current = 0, next = 0;    ///< values now, and at the end of the next substep
  double before = 0, now = 0;      ///< at both ends of the substep under way, or the last one
};

/// A joint that broke within the present substep: until then its force acted (mean over the substep, local).
struct BrokenJoint {
  int beam = -1;
  std::size_t end = 0;
  Vec6 mean_force = Vec6::Zero();
};

/// A plastic rotation of a beam's end: a kink, whose loads on the nodes of its beam follow its angle.
struct Kink {
  int beam = -1;
  std::size_t end = 0;
  int component = 4;
  double before = 0, now = 0;  ///< rad, at both ends of the substep under way, or the last one
  double current = 0;          ///< now
  double started_at = 0;       ///< rad, at set_state()
  double held = 0;     ///< N m, where it turned in the substep under way, or the last one: of the sign of its turn
  double tried = 0;    ///< N m, at the end of that substep had nothing turned
  bool known = false;  ///< what follows, for the structure as it stands
  Vec12 fixed_end = Vec12::Zero();    ///< of its beam, local, for 1 rad
  Eigen::SparseVector<double> force;  ///< of its beam on the nodes, scaled, for 1 rad
  Eigen::VectorXd response;           ///< of w in a substep to 1 rad more at its end; empty: to be found
  [[nodiscard]] Eigen::Index place() const { return static_cast<Eigen::Index>(6 * end) + component; }
};

/// A beam whose ends changed at the start of the present substep: how its ends followed its nodes before, and its
/// momentum then, as FrameDynamics::momentum().
struct ChangedBeam {
  int beam = -1;
  Mat12 followed;
  Vec6 momentum = Vec6::Zero();
};

struct FrameDynamics::State {
  struct ImpulseFactor;

  DynamicOptions options;
  GeneralizedAlpha method;
  SystemInertia inertia;
  Reanalysis frame;
  std::vector<double> wave_times;
  std::vector<LoadPattern> patterns;
  std::vector<Kink> kinks;
  std::vector<std::vector<std::size_t>> kinks_of_beam;  ///< empty while there is none
  double time = 0;

  MotionState before, now;  ///< at the start and at the end of the substep under way
  bool accepted = true;     ///< no substep is under way: `before` is the motion now, `now` that before the last substep
  std::vector<Vec6> started_at;                 ///< per node: displacements at set_state(), else 0
  NodeMotion nodes_before, nodes_now;           ///< at both ends of the substep under way, or the last one
  bool nodes_known = false, end_known = false;  ///< all of them, the displacements at the end
  std::vector<Vec6> reactions;                  ///< per support, with those displacements; empty: not asked for yet
  [[nodiscard]] const MotionState& current() const { return before; }
  /// Of `before`, with the structure as it stands: M u, M v, M a, and (K + s M) u, (K + s M) v.
  SideBySide<4> mass_products;
  SideBySide<2> matrix_products;
  bool products_known = false;
  Eigen::VectorXd constant_load, collocated_load, substep_load;  ///< substep_load: of what broke in this substep
  Eigen::VectorXd geometric_before, geometric_now;  ///< second order: at both ends of the substep under way
  std::vector<BrokenJoint> broken;
  std::vector<ChangedBeam> changed;
  std::map<int, Vec6> brought;                   ///< add_momentum(), per beam
  std::vector<FrameDynamics::Impulse> impulses;  ///< that wait
  std::unique_ptr<ImpulseFactor> impulses_by;    ///< none: not asked for yet
  std::map<int, Vec12> substep_fixed_end;        ///< of beams that bear the force of their broken end, local
  bool prepared = false;
  DynamicEnergy energy;
  DynamicCounters counters;
  std::vector<JointBreak> breaks;
  // Scratch.
  SideBySide<4> motion_columns;
  SideBySide<2> moved_columns;
  SideBySide<1> z, mass_z;
  SideBySide<2> old_products;  ///< M a and K u at the start of the substep that was accounted last
  Eigen::VectorXd q, w, moved;

  State(FrameModel model, MassModel masses, DynamicOptions given);
  ~State();
  [[nodiscard]] Reanalysis::State& core() { return *frame.state_; }
  [[nodiscard]] const Reanalysis::State& core() const { return *frame.state_; }
  [[nodiscard]] const FrameSystem& system() const { return *core().system; }
  [[nodiscard]] Eigen::Index equations() const { return system().dofs().equations; }

  // structural_change.cpp
  /// Takes over what changed since the last substep, or within it.
  void apply_changes();
  void take_changes();
  void remember_changing_beams();
  void drop_bare_nodes();
  [[nodiscard]] std::vector<int> bare_part(int start);
  [[nodiscard]] bool shell_holds(int shell, int node);
  [[nodiscard]] bool patch_holds(int patch, int node);
  [[nodiscard]] bool patch_weighs(int patch);
  void clear_dropped();
  void set_method(const GeneralizedAlpha& other);
  void find_substep_load();
  void begin_substep();
  void begin_changed();
  /// Momentum of a beam that its nodes' velocities leave out now (local node impulses), since its ends changed.
  [[nodiscard]] Vec12 missing_momentum(const ChangedBeam& change);
  void add_brought(Eigen::VectorXd& force) const;
  void add_on_rigid_ends(int beam, const Vec12& local, Eigen::VectorXd& force) const;
  double stored_energy();

  // momentum.cpp
  [[nodiscard]] Vec6 momentum_of(int beam, const Mat12& follows, const Eigen::VectorXd& velocities) const;
  [[nodiscard]] Vec6 brought_to(int beam) const;
  [[nodiscard]] Vec6 momentum_left_with(const ChangedBeam& gone) const;
  [[nodiscard]] Eigen::VectorXd scaled_impulses(std::span<const Impulse> impulses) const;
  [[nodiscard]] Eigen::VectorXd on_mass(Eigen::VectorXd impulses) const;
  [[nodiscard]] Eigen::VectorXd velocities_of(const Eigen::VectorXd& impulses);
  [[nodiscard]] Eigen::VectorXd velocities_by_mass(Eigen::VectorXd left) const;
  [[nodiscard]] bool damps_jumps() const;
  [[nodiscard]] ImpulseFactor& impulse_factor();
  void follow_jump(const Eigen::VectorXd& change);

  // substep.cpp
  /// To its end, with what yields, joints that break apart.
  void take_substep(const JointLaw* law);
  void take_first_order_substep(const JointLaw* law);
  void find_end();
  void accept();
  void book();
  void account_numerical();
  void find_products();
  void find_collocated_load();
  void know_nodes();
  void know_end();

  // load_patterns.cpp
  void find_pattern(LoadPattern& pattern);
  void find_patterns();
  [[nodiscard]] Eigen::VectorXd scaled_equations(const std::vector<Vec6>& per_node) const;
  [[nodiscard]] Eigen::VectorXd scaled(const Eigen::VectorXd& force) const;

  // plastic_flow.cpp
  [[nodiscard]] std::size_t kink_of(int beam, std::size_t end, int component);
  void find_kink(Kink& kink);
  void begin_kinks();
  void forget_kinks();
  [[nodiscard]] bool yields(const PlasticHinge& hinge) const;
  /// Of the substep under way, as it was tried: what yields turns, and the motion at its end follows.
  void yield(std::span<const PlasticHinge> hinges);
  [[nodiscard]] double resistance(const Kink& of, const Kink& by) const;
  [[nodiscard]] double elastic_of_kinks() const;
  void account_kinks();
  /// The share of the substep at which a hinge has turned too far, or at which one that nothing resists is over.
  [[nodiscard]] std::optional<double> turned_out_at(const PlasticHinge& hinge);
  /// By how much the load of a kink in a substep's equation grows with its angle at the end: what turns is not damped.
  [[nodiscard]] double of_new_turn() const { return 1 - method.af + options.damping.stiffness / method.h; }

  // geometric_loads.cpp
  [[nodiscard]] Vec12 geometric_end_forces(int beam, const std::vector<Vec6>& displacements,
                                           const Vec12& elastic) const;
  [[nodiscard]] Eigen::VectorXd find_geometric_load(const std::vector<Vec6>& displacements, bool at_end) const;
  void take_second_order_substep(const JointLaw* law);

  // break_rule.cpp
  [[nodiscard]] bool break_joints(const JointLaw& law);
  [[nodiscard]] bool is_broken(const JointBreak& joint) const;
  [[nodiscard]] static double reached_at(const JointLaw& law, int beam, int end, const SubstepCourse<Vec12>& course);
  void record_break(const JointBreak& broken, double share, const SubstepCourse<Vec12>& course);
  [[nodiscard]] Vec12 end_forces(int beam, bool at_end) const;
  [[nodiscard]] Vec12 elastic_end_forces(int beam, const std::vector<Vec6>& displacements, bool at_end) const;
  [[nodiscard]] Vec12 fixed_end_forces(int beam, bool at_end) const;
  /// Of loads that go with time, which change linearly within a substep.
  [[nodiscard]] Vec12 fixed_end_rate(int beam) const;
  [[nodiscard]] Vec12 end_force_rates(int beam, bool at_end) const;
  [[nodiscard]] SubstepCourse<Vec12> course(int beam) const;
};

}  // namespace topple::solver
