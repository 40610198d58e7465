#pragma once
// A frame that moves: M a + C v + K u = f(t) about its unloaded place, while joints break. Generalized-alpha in time
// (J. Chung, G. M. Hulbert, Journal of Applied Mechanics 60 (1993), 371), consistent mass. The matrix of a substep is
// c (K + s M): it has K's graph, order and map, a joint that breaks is a low-rank change of it, and it is definite even
// where K alone is a mechanism. A freedom with neither stiffness nor mass is left out.
#include <array>
#include <cstdint>
#include <iosfwd>
#include <limits>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "topple/solver/modes.h"
#include "topple/solver/reanalysis.h"

namespace topple::solver {

/// C = mass x M + stiffness x K.
struct RayleighDamping {
  double mass = 0;       ///< a0, 1/s; its force goes with the velocity foreseen, and takes no part in the matrix
  double stiffness = 0;  ///< a1, s; acts on the stiffness as it stands: a joint that broke damps nothing
};
/// The share of critical damping `ratio` at two angular frequencies (rad/s): a0 = 2 ratio w1 w2/(w1 + w2), a1 = 2
/// ratio/(w1 + w2) (R. W. Clough, J. Penzien, Dynamics of Structures, 12-5). Throws std::invalid_argument unless ratio
/// >= 0 and both frequencies > 0.
[[nodiscard]] RayleighDamping rayleigh_damping(double ratio, double first, double second);

/// How the motion is integrated.
struct DynamicOptions {
  double substep = 1.0 / 240;  ///< s
  /// At infinite frequency, 0 to 1: what a substep leaves of motion that it cannot resolve. 1 keeps energy exactly;
  /// below it the shock of a break dies away in some substeps, and what resolved motion loses falls with the third
  /// power of the substep.
  double spectral_radius = 0.8;
  RayleighDamping damping;  ///< C of the equations of motion
  /// s. An impulse acts over a substep, and over no less than this: by (M + duration a1 K)^-1, as damping takes what it
  /// sets going within that time. With substeps below it what an impulse leaves does not hang on them.
  double shortest_impulse = 0;
  /// Joints feel what changes of the loads on their beam as the mean over 1/w, w being the first angular frequency of
  /// the beam with its ends held, by its density and for each component of the end forces. Nodes and energy have loads
  /// as they act. false: at once, whole, however short a push is.
  bool beams_vibrate = false;
  /// Axial forces act on the beams as they lie at the moment: end forces are those of the displaced beam, and the work
  /// of the geometric forces counts as external.
  bool second_order = false;
  bool keep_energy = true;  ///< false: no ledger, and a cheaper substep
  /// With a JointLaw: a substep that is off by more, in what joints bear as the largest of their uses, or in which one
  /// comes to its capacity or turns too far, is taken in parts instead. It is off by K h2 |b - 1/6| (a(n+1) - a(n)), by
  /// which the method's displacements differ from those of accelerations that change evenly (O. C. Zienkiewicz, Y. M.
  /// Xie, Earthquake Eng. Struct. Dyn. 20 (1991), 871).
  double largest_error = std::numeric_limits<double>::infinity();
  /// Of a substep, at most: as many, by powers of two, as bring the error, which falls with their third power, below
  /// that; all of them where a joint breaks. 1: none is divided. Each number has a factor of its own, which is kept.
  /// More than 1 takes no loads that go with time.
  int most_parts = 1;
  /// Per beam, s: how long a wave takes along it. Joints that reach their capacity within that time of the first one,
  /// whose beam counts, break together. Empty: its length over the speed of sound of its Young's modulus and density.
  std::vector<double> wave_times;
  AnalysisOptions analysis;  ///< threads and limits of the factorisation
};

/// Joules, since the start. kinetic + elastic + damped + numerical + dissipated + freed = external_work + struck + the
/// first kinetic + elastic, to rounding.
struct DynamicEnergy {
  double kinetic = 0;        ///< of all that moves, 1/2 v'Mv, now
  double elastic = 0;        ///< now; 1/2 u'Ku, plastic rotations apart
  double damped = 0;         ///< by C
  double numerical = 0;      ///< by the method itself; nothing at a spectral radius of 1
  double dissipated = 0;     ///< in plastic hinges: what they hold times how far they turned
  double struck = 0;         ///< work of impulses, and of what turned hinges at once
  double external_work = 0;  ///< of loads
  double freed = 0;          ///< by breaks and other changes of the structure: what left it, and what a member
                             ///< that swings from one end alone lost
};

/// A rotation at a beam's end that yields: elastic up to its capacity, which it holds while it turns further, and
/// elastic again as soon as it would turn back.
struct PlasticHinge {
  int beam = -1;            ///< index in FrameModel::beams
  int end = 0;              ///< 0 or 1
  int component = 4;        ///< of the end's force: 3 torsion, 4 and 5 moments, local axes
  double capacity = 0;      ///< N m, of either sign, above 0
  double largest_turn = 0;  ///< rad, of the plastic rotation of either sign: the joint breaks there
};

/// What joints can bear: by whatever rule, a utilisation of 1 is the capacity.
class JointLaw {
 public:
  virtual ~JointLaw() = default;
  /// The larger of the utilisations at both ends; end forces local, as StaticSolution has them. Called for every beam
  /// in every substep.
  [[nodiscard]] virtual double beam_utilisation(int beam, const Vec12& end_forces) const = 0;
  /// At one end.
  [[nodiscard]] virtual double end_utilisation(int beam, int end, const Vec12& end_forces) const = 0;
  /// What yields, in an order that stays; asked for in every substep. Uses leave these components out.
  [[nodiscard]] virtual std::span<const PlasticHinge> plastic_hinges() const { return {}; }
};

/// An end of a beam that reached its capacity, or the largest turn of its plastic hinge, within a substep.
struct JointBreak {
  int beam = -1;                 ///< index in FrameModel::beams
  int end = 0;                   ///< 0 or 1
  double time = 0;               ///< at which it reached its capacity, s
  Vec12 forces = Vec12::Zero();  ///< of its beam then
};

/// A motion in one substep as a cubic of time: values and rates at its two ends.
template <class Vector>
struct SubstepCourse {
  Vector start;       ///< value at the substep's start
  Vector start_rate;  ///< rate there, 1/s
  Vector end;         ///< value at its end
  Vector end_rate;    ///< rate there, 1/s
  double length = 0;  ///< s
  /// At a share of the substep, 0 to 1.
  [[nodiscard]] Vector at(double share) const {
    const double s = share, r = 1 - s;
    return (r * r * (1 + 2 * s)) * start + (s * s * (1 + 2 * r)) * end + (length * s * r * r) * start_rate -
           (length * s * s * r) * end_rate;
  }
  /// Its integral from the start to there, divided by the length of the whole substep.
  [[nodiscard]] Vector mean_until(double share) const {
    const double s = share, s2 = s * s, s3 = s2 * s, s4 = s3 * s;
    return (s - s3 + s4 / 2) * start + (s3 - s4 / 2) * end + length * ((s2 / 2 - 2 * s3 / 3 + s4 / 4) * start_rate) -
           length * ((s3 / 3 - s4 / 4) * end_rate);
  }
};

/// How some nodes of a frame move while all others are held: for what is faster than the frame.
struct LocalModes {
  Eigen::VectorXd squared;  ///< angular frequencies squared, (rad/s)2, ascending; 0: without strain
  /// Modes by pushes: what each push does to a mode of unit modal mass, kg^-1/2 for one newton.
  Eigen::MatrixXd pushed;
  /// Of each beam that ends at one of the nodes: its end forces (local, as StaticSolution has them) by modes, for a
  /// unit of each coordinate (m kg^1/2).
  std::vector<std::pair<int, Eigen::Matrix<double, 12, Eigen::Dynamic>>> end_forces;
  /// By numbers of equations: shapes, and what mass makes of them. For carried_over() alone.
  std::vector<int> equations;
  Eigen::MatrixXd shape;     ///< columns: modes, by the numbers in `equations`
  Eigen::MatrixXd momentum;  ///< mass times shape
};
/// The same motion in the modes of the same nodes after a change (not of damping, nor of what supports hold).
[[nodiscard]] Eigen::VectorXd carried_over(const LocalModes& from, const Eigen::VectorXd& coordinates,
                                           const LocalModes& to);

/// What was done so far.
struct DynamicCounters {
  std::uint64_t substeps = 0;   ///< taken, each counted once
  std::uint64_t divided = 0;    ///< of these, taken in parts
  std::uint64_t retaken = 0;    ///< taken again because joints broke
  std::uint64_t breaks = 0;     ///< of ends of beams
  std::uint64_t yielding = 0;   ///< substeps in which a plastic hinge turned
  std::uint64_t changes = 0;    ///< times that stiffnesses, masses or what stands became others
  std::uint64_t unsettled = 0;  ///< substeps in which a beam was pressed beyond its critical load
};

/// The motion of a frame, substep by substep. It is a facade: its many functions are a line or a check each, the parts
/// in solver/dynamics/ own the data. Functions that take a beam, shell, patch, support or node throw
/// std::invalid_argument for one that does not exist, as Reanalysis does.
class FrameDynamics {
 public:
  /// At rest at its unloaded place, all as the model has it. Consistent mass only; throws std::invalid_argument for
  /// what cannot be used, Instability where a freedom has neither stiffness nor mass or a beam can move by itself.
  FrameDynamics(FrameModel model, MassModel masses, DynamicOptions options);
  ~FrameDynamics();
  /// Moves: what is moved from may only be destroyed or assigned to.
  FrameDynamics(FrameDynamics&&) noexcept;
  /// Moves, as the constructor does.
  FrameDynamics& operator=(FrameDynamics&&) noexcept;

  // Changes take effect with the next substep, from its beginning, as in Reanalysis. When a beam's end breaks, its mass
  // goes to the end still held: the momentum is kept, as an impulse at once, and the loss counted as freed. Wherever
  // more than loads changes, accelerations are found anew from what acts on what stands then.
  /// Stiffness between a beam's end (0 or 1) and its node, local components; zero breaks the joint.
  void set_end_stiffness(int beam, int end, const Vec6& stiffness);
  /// The beam is no longer there: stiffness, mass and loads go.
  void remove_beam(int beam);
  /// The shell is no longer there: stiffness, mass and loads go.
  void remove_shell(int shell);
  /// Stiffness of a patch in the global freedoms of its nodes; zero takes it away.
  void set_patch_stiffness(int patch, Eigen::MatrixXd stiffness);
  /// Mass of a patch, as Patch::mass has it: it comes or goes with the velocities of the nodes, and what it takes along
  /// is counted as freed.
  void set_patch_mass(int patch, Eigen::MatrixXd mass);
  /// Factor on the beam's E and G, above 0.
  void set_beam_stiffness_factor(int beam, double factor);
  /// Stiffness of a shell in the global freedoms of its four nodes, condensed elsewhere.
  void set_shell_stiffness(int shell, const Eigen::Matrix<double, 24, 24>& stiffness);
  /// Mass comes or goes with the velocity of the beam, and what it takes along is counted as freed.
  void set_beam_density(int beam, double density);
  /// Stiffness of the support at its index in FrameModel::supports, global axes; 0: free.
  void set_support_stiffness(int support, const Vec6& stiffness);
  /// These nodes, and all that reaches them, are no longer part of the frame.
  void drop_nodes(std::span<const int> nodes);
  /// How far a beam's end has turned for good (rad, local axes, of the node against the beam's own end), as part of the
  /// state: 0 unless set here or turned by advance(). `component`: 3 torsion, 4 and 5 bending.
  void set_plastic_rotation(int beam, int end, int component, double rotation);
  /// A beam's end turns further for good at once, as something fast makes it (rad, signs and components as there).
  /// `dissipated`: what its hinge took, J. That and the change of the elastic energy, less what loads on the beam did,
  /// count as `struck`.
  void turn_at_once(int beam, int end, int component, double turn, double dissipated);
  /// Replaces the load on a node: N and N m, global axes.
  void set_node_load(int node, const Vec6& load);
  /// Replaces the loads on a beam, local axes.
  void set_beam_loads(int beam, std::vector<BeamLoad> loads);
  /// From now on; a1 stays as it is.
  void set_mass_damping(double a0);
  /// From now on. Another a1 is a new factor. Throws std::invalid_argument for what is negative or not finite.
  void set_damping(const RayleighDamping& damping);

  // Loads that go with time, beside those: a distribution in space times a value that changes linearly within each
  // substep. Each returns the pattern's number; its value is 0.
  /// See above. The loads are held for the whole motion; only their value changes.
  [[nodiscard]] int add_pattern(const LoadSet& loads);
  /// The inertia of the frame against a ground that accelerates along `direction`: -M times a rigid translation, of
  /// what stands at the time. The frame's motion is then relative to the ground.
  [[nodiscard]] int add_ground_acceleration(const Vec3& direction);
  /// The force that keeps the frame where it is now, with the structure and loads that it will have in the next substep
  /// (second order counts). It stays with the nodes: a freedom that a support holds or lets go later takes none of it.
  [[nodiscard]] int add_holding_force();
  void set_pattern(int pattern, double value_at_end);  ///< of the next substep, and from then on
  void jump_pattern(int pattern, double value);        ///< at once

  /// Per node, global: displacements, velocities. Accelerations begin at 0; they have no part in the motion at a
  /// spectral radius of 1, and little below.
  void set_state(const std::vector<Vec6>& displacements, const std::vector<Vec6>& velocities);

  /// An impulse at a node: N s along the axes, N m s about them, global.
  struct Impulse {
    int node = -1;                ///< that is struck
    Vec6 impulse = Vec6::Zero();  ///< x y z rx ry rz, global axes
  };
  /// (M + h a1 K)^-1 J: by how much impulses change the velocities of the frame, per node, changes since the last
  /// substep apart. That is M^-1 J but for modes that damp away within a substep: they take as much less as an implicit
  /// step of their damping leaves, so that no impulse creates energy there. Freedoms without mass take none. To 1e-12
  /// of J, by a factor of M + h a1 K that the first impulse makes; without damping by conjugate gradients on M.
  [[nodiscard]] std::vector<Vec6> velocities_of(std::span<const Impulse> impulses) const;
  /// By how much a unit of each of these forces' impulses changes the speed along each (1/kg for unit forces): f_i'
  /// velocities_of(f_j), symmetric, as many rows as forces. With damping only what joins them in the factor is gone
  /// through.
  [[nodiscard]] Eigen::MatrixXd mobility(std::span<const std::vector<Impulse>> forces) const;
  /// The same of forces that act through a substep, per length of it: by how much faster each of their places is at its
  /// end, with all that resists them meanwhile. What couples with the frame from substep to substep gives way to them
  /// so (A. Gravouil, A. Combescure, Int. J. Numer. Meth. Eng. 50 (2001), 199).
  [[nodiscard]] Eigen::MatrixXd substep_mobility(std::span<const std::vector<Impulse>> forces) const;
  /// Per node: its mean acceleration through the next substep (m/s2 and rad/s2, global axes) if loads go on as they
  /// are, nothing breaks and nothing yields. What changed since the last substep acts at once, as with strike().
  [[nodiscard]] const std::vector<Vec6>& foresee();
  /// Of these nodes, with all others held, changes since the last substep apart: K and M as they stand. Freedoms
  /// without mass follow the others.
  [[nodiscard]] LocalModes local_modes(std::span<const int> nodes, std::span<const std::vector<Impulse>> pushes) const;
  /// They act now, at once, on the frame with all that changed.
  void strike(std::span<const Impulse> impulses);
  /// They act with the next strike(), or when the next substep begins. They come from within, with what changes: their
  /// work is counted as freed, with its sign turned.
  void add_impulses(std::span<const Impulse> impulses);
  /// Momentum (N s, and N m s about the origin, global) that mass brings along which the beam bears from now on. It
  /// acts at once as the next substep begins, or with strike(), on the ends that hold the beam then, as the momentum
  /// does that a broken end leaves, and is counted as that is. A beam that leaves before takes it along.
  void add_momentum(int beam, const Vec6& momentum);

  /// One substep. What yields turns within it as far as it must to hold no more than its capacity at the end. Of the
  /// joints over capacity then, or turned too far, the one that was first breaks, with those that follow within a
  /// wave's time, and the substep is taken again without them, their forces until then acting as loads (their mean over
  /// the substep), until none is over. DynamicOptions::most_parts: in parts, where it has to be. Returns the breaks in
  /// order.
  const std::vector<JointBreak>& advance(const JointLaw* law = nullptr);

  /// s since the start.
  [[nodiscard]] double time() const;
  /// Length of a substep, s: the whole.
  [[nodiscard]] double substep() const;
  /// Per node, global axes, from the unloaded place, now: m and rad.
  [[nodiscard]] const std::vector<Vec6>& displacements() const;
  /// Per node, global axes, now: m/s and rad/s.
  [[nodiscard]] const std::vector<Vec6>& velocities() const;
  /// Per node, global axes, now: m/s2 and rad/s2.
  [[nodiscard]] std::vector<Vec6> accelerations() const;
  /// In the last substep, or in its last part.
  [[nodiscard]] SubstepCourse<Vec6> node_course(int node) const;
  /// End forces as Reanalysis has them: elastic, those of damping and of the beam's own inertia apart.
  [[nodiscard]] Vec12 beam_end_forces(int beam) const;
  [[nodiscard]] Vec12 beam_end_force_rates(int beam) const;  ///< now, by time
  /// Of a beam's end forces in the last substep, or in its last part, as beam_end_forces() has them.
  [[nodiscard]] SubstepCourse<Vec12> beam_course(int beam) const;
  /// Of both ends, by the components of end forces, as set_plastic_rotation() has them.
  [[nodiscard]] Vec12 plastic_rotations(int beam) const;
  /// Global; `rates`: by time.
  [[nodiscard]] std::array<Vec6, 4> shell_corner_forces(int shell, bool rates = false) const;
  /// Of a support, by its number in the model: global axes, N and N m, as Reanalysis::reaction() has it. What holds it
  /// against elastic end forces and the loads on its node; forces of damping and of mass at held nodes apart. So sums
  /// of reactions and loads are the change of momentum(), but for damping. Throws std::invalid_argument for a support
  /// that does not exist.
  [[nodiscard]] Vec6 reaction(int support) const;
  /// Linear and angular momentum about the origin, of what is free to move.
  [[nodiscard]] Vec6 momentum() const;
  /// The same of one beam. Of one whose last joint broke in the last substep: what it left with, from its motion at the
  /// start of that substep and the forces and loads on it since.
  [[nodiscard]] Vec6 beam_momentum(int beam) const;
  /// Displacements of the beam's own ends, m and rad, global axes: an end that broke goes with the beam, not with its
  /// node. Of one whose last joint broke in the last substep: as its ends went on then.
  [[nodiscard]] Vec12 beam_ends(int beam) const;
  /// Of the mass at a node.
  [[nodiscard]] Vec6 node_momentum(int node) const;
  /// Of the mass of a patch, changes since the last substep apart.
  [[nodiscard]] Vec6 patch_momentum(int patch) const;
  /// Since the start; not kept where DynamicOptions::keep_energy is false.
  [[nodiscard]] const DynamicEnergy& energy() const;
  /// What the loads that act now would have done along the whole displacement since set_state(), J: external_work, but
  /// for what loads did that have changed since. Patterns apart.
  [[nodiscard]] double work_of_present_loads();
  /// What the geometric forces would do on the straight way from here to these displacements (per node), J: by their
  /// mean at both ends. 0 without second order.
  [[nodiscard]] double geometric_work_to(const std::vector<Vec6>& displacements);
  /// a0 of the Rayleigh damping, 1/s.
  [[nodiscard]] double mass_damping() const;
  /// Rayleigh's quotient u'Ku/u'Mu of a displacement, (rad/s)2; 0 when it moves no mass.
  [[nodiscard]] double rayleigh_quotient(const std::vector<Vec6>& displacements) const;
  /// As it stands now, with all changes.
  [[nodiscard]] const FrameModel& model() const;
  /// Substeps and breaks so far.
  [[nodiscard]] const DynamicCounters& counters() const;
  /// How the equations were solved.
  [[nodiscard]] const ReanalysisCounters& reanalysis_counters() const;

  /// Writes all that the motion from here on depends on, changes and impulses that wait for the next substep included;
  /// nothing here changes. Bytes are for the same program alone.
  void save_state(std::ostream& to) const;
  /// Takes what was saved from one made with the same arguments, whatever this one has been through: both then go on
  /// alike, to the bit. Throws std::runtime_error where bytes are missing; after that this may be destroyed only.
  void load_state(std::istream& from);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace topple::solver
