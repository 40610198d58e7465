#pragma once
// What stands and is not at rest: each component that moves has a solver::FrameDynamics of its own, which begins at its
// static state and takes every change that its statics take. At rest there is none, and it costs nothing.
#include <map>
#include <memory>
#include <span>
#include <vector>

#include "standing/motion/component_damping.h"
#include "standing/motion/motion_masses.h"
#include "standing/motion/motion_model.h"
#include "standing/motion/motion_momentum.h"
#include "standing/motion/motion_settings.h"
#include "standing/motion/motion_sources.h"
#include "topple/solver/frame_dynamics.h"

namespace topple::structure {

/// Joules, of all that moved so far. While a component moves, what its elastic energy is beyond that at its start.
struct MotionEnergy {
  double kinetic = 0, elastic_change = 0;
  double damped = 0, numerical = 0;  ///< by damping; by the method
  double external_work = 0;          ///< of loads, on what moves now
  double struck = 0, freed = 0, dissipated = 0;
};
template <class Archive>
void serialize(Archive& archive, MotionEnergy& energy) {
  auto& [kinetic, elastic_change, damped, numerical, external_work, struck, freed, dissipated] = energy;
  archive(kinetic, elastic_change, damped, numerical, external_work, struck, freed, dissipated);
}

class StandingMotion {
 public:
  StandingMotion(const MotionSources& sources, const MotionSettings& settings);
  ~StandingMotion();

  [[nodiscard]] bool any() const { return !moving_.empty(); }
  [[nodiscard]] bool moves(int component) const { return moving_.contains(component); }
  [[nodiscard]] std::vector<int> moving() const;
  /// Components that have begun to move, ever.
  [[nodiscard]] std::uint64_t starts() const { return starts_; }
  /// Counts up when a component begins or ceases to move, or gets other stiffnesses or masses: mobilities are others.
  [[nodiscard]] std::uint64_t changes() const;

  /// The length of substeps from now on: as few to a step of `dt` as the settings allow. Returns their number.
  int set_step(double dt);
  /// From the static state solved last; nothing of the component may have changed since. No effect on one that moves.
  void start(int component);
  /// It rests: what it still has beyond its static state, as solved now, is accounted as damped.
  void settle(int component);
  /// Nothing of it stands any more.
  void stop(int component);
  /// Masses as panels hand on their weight now, for all that moves.
  void update_masses();
  /// Of a shell panel of which less is there, or that lets go of an edge. What is left of it has the motion that it had
  /// at remember_motion(), and shares it inelastically with what it hangs on: of shapes that it can move by now, the
  /// nearest.
  void update_mass(PanelId shell);
  /// Before a shell panel changes.
  void remember_motion(PanelId shell);
  /// Chunks of a panel that is about to change leave it with this momentum (N s). What the panel gives up beside it, or
  /// less, goes to what is left of it, and to what bears that: linear momentum is kept.
  void give_to_chunks(PanelId panel, const Vec3& momentum);
  /// What is left of panels that changed takes over its motion now: no later than with the next substep or impulse.
  void pass_on_motion(int component);

  /// A joint that broke within a substep, and what its member bore then.
  struct Break {
    JointId joint;
    Vec6 demand = Vec6::Zero();
    double time = 0;   ///< of the component's motion, s
    double freed = 0;  ///< J, shared equally by those of one substep
  };
  /// One substep of a component that moves.
  [[nodiscard]] std::vector<Break> advance(int component);

  // Of what moves; a part of a component at rest has no velocity.
  [[nodiscard]] const Vec6& displacement(NodeId node) const;
  [[nodiscard]] Vec6 velocity(NodeId node) const;
  [[nodiscard]] solver::Vec12 end_forces(MemberId member) const;
  /// Displacements of its own ends, global axes (solver::FrameDynamics::beam_ends()).
  [[nodiscard]] solver::Vec12 ends(MemberId member) const;
  /// Of a support of the node, by its place among the building's.
  [[nodiscard]] Vec6 reaction(NodeId node, std::size_t support) const;
  [[nodiscard]] std::array<Vec6, 4> corner_forces(PanelId membrane) const;
  [[nodiscard]] const MotionMomentum& momentum() const { return momentum_; }
  /// Null: the component is at rest.
  [[nodiscard]] const solver::FrameDynamics* frame(int component) const;

  /// Mobility of nodal forces (1/kg for unit forces), and what an impulse of them does.
  using NodalForces = std::vector<std::pair<NodeId, Vec6>>;
  /// g_i' M^-1 g_j of forces on one component that moves.
  [[nodiscard]] Eigen::MatrixXd mobility(int component, std::span<const NodalForces> forces) const;
  /// The same of forces that act through a substep, per length of it (solver::FrameDynamics::substep_mobility()).
  /// Where something yields, which gives way more, as mobility().
  [[nodiscard]] Eigen::MatrixXd substep_mobility(int component, std::span<const NodalForces> forces) const;
  /// Of a node: in the mean through the next substep, if what loads it now goes on to (solver::FrameDynamics::foresee).
  [[nodiscard]] const Vec6& foreseen_acceleration(NodeId node);
  /// The nodes that forces of one component act on, others held (solver::FrameDynamics::local_modes()), and what joints
  /// at these nodes bear for a unit of each coordinate.
  struct LocalMotion {
    solver::LocalModes modes;
    std::vector<std::pair<JointId, Eigen::Matrix<double, 6, Eigen::Dynamic>>> demands;
  };
  [[nodiscard]] LocalMotion local_motion(int component, std::span<const NodalForces> forces) const;
  /// Returns the work of the impulses, J. What changed before is taken over first.
  double strike(int component, const NodalForces& impulses);
  /// A hinge, by its place among the component's, turns at once: rad, J. Returns what the frame took, J.
  double turn_at_once(int component, std::size_t hinge, double turn, double dissipated);

  /// Largest turn of a chord in the component, rad.
  [[nodiscard]] double largest_turn(int component) const;
  /// Mass damps nothing while a component whose chords have turned by MotionSettings::falling_turn turns further: it
  /// would brake what falls. `turn`: largest_turn() now, once a step.
  void damp_by_mass(int component, double turn);
  /// What damp_by_mass() was told last, 0 before.
  [[nodiscard]] double last_turn(int component) const;
  /// Its statics were solved: where joints have broken since its damping was found, but none since the last look for
  /// rest, it is found anew, as it stands.
  void update_damping(int component);
  /// Its statics were solved: whether every joint is at rest there, as the settings have it.
  [[nodiscard]] bool rests(int component);
  /// It is time to look.
  [[nodiscard]] bool check_rest(int component) const;

  [[nodiscard]] MotionEnergy energy() const;

  [[nodiscard]] const MotionSettings& settings() const { return settings_; }
  // motion_archive.h
  template <class Archive>
  void save(Archive& archive) const;
  /// The statics are by now what they were.
  template <class Archive>
  void load(Archive& archive);

 private:
  struct Moving;
  /// The frame and its law, by its beginning.
  void make_frame(int component, Moving& moving) const;
  void forget_all();
  void store_plastic_rotations(int component, const Moving& moving) const;

  MotionSources from_;
  MotionSettings settings_;
  MotionMasses masses_;
  MotionModel model_;
  ComponentDamping damping_;
  MotionMomentum momentum_;
  double substep_ = 0;
  std::map<int, std::unique_ptr<Moving>> moving_;
  std::map<PanelId, Vec3> to_chunks_;  ///< N s, since update_masses(); of panels that are no shells
  MotionEnergy past_;                  ///< of motions that have ended
  std::uint64_t starts_ = 0;
  std::uint64_t past_changes_ = 0;  ///< of components that move no more
};

}  // namespace topple::structure
