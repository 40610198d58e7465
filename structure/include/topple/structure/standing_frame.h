#pragma once
// All of a building that still stands: damage, statics, segmentation, failure. It knows nothing of moving bodies: what
// loses the ground is handed out, what touches the frame comes in as point loads.
//
// One solver::Reanalysis serves each connected component that the building has at the start; joints that break change
// it in place, and what detaches is dropped from it.
#include <functional>
#include <iosfwd>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "topple/solver/frame_dynamics.h"
#include "topple/solver/frame_model.h"
#include "topple/structure/building.h"
#include "topple/structure/joint_break.h"
#include "topple/structure/joint_check.h"
#include "topple/structure/scenario.h"

namespace topple::structure {

/// A connected part that lost its hold (or moves as a mechanism): it leaves the frame for good. Joints inside it that
/// held stay intact(), so that a body made of it can break further along them; the displacements of its nodes stay what
/// they were when it left. It may be a panel alone, or a node alone: a node whose members all left, with
/// whatever node_mass() it has.
struct Detached {
  std::vector<MemberId> members;  ///< of the part
  std::vector<PanelId> panels;    ///< of the part
  std::vector<NodeId> nodes;      ///< of the part
  bool mechanism = false;         ///< true: it can move without strain
  /// Joints of members by which it still hangs on what stands (`mechanism: hinge`, pieces of a post that was cut in
  /// two): free to turn in what is released, holding in the rest until the host breaks them.
  std::vector<JointId> hinges;
  /// It is one member that was cut in two at this fraction of its length from its first end: each piece hangs by the
  /// joint of its own end.
  std::optional<double> cut{};
  /// How it moved when it left.
  struct Motion {
    Vec3 momentum = Vec3::Zero();      ///< N s
    Vec3 angular = Vec3::Zero();       ///< N m s about the origin, of displacements about the unloaded place
    Vec3 displacement = Vec3::Zero();  ///< m: mean of its mass
    Vec3 turned = Vec3::Zero();        ///< rad: of its mass about that
  };
  std::optional<Motion> motion{};  ///< none: it was at rest
};

/// Where a force acts on the standing frame.
struct ContactPlace {
  MemberId member;            ///< valid: on a member ...
  PanelId panel;              ///< ... or on a panel
  Vec3 point = Vec3::Zero();  ///< m, in the undeformed building
  NodeId node{};              ///< ... or on a node
};
/// A force that something presses on the frame with.
struct ContactLoad {
  std::int64_t key = 0;        ///< chosen by the caller; a later load with the same key replaces it
  ContactPlace place;          ///< where it acts
  Vec3 force = Vec3::Zero();   ///< N, global axes
  Vec3 moment = Vec3::Zero();  ///< about the point, on members and nodes alone
};

/// What a panel that was broken in part still is.
struct PanelRemains {
  double share = 1;                      ///< of its area and mass
  std::vector<std::vector<Vec2>> holes;  ///< convex, apart from each other; panel axes from its node 1
  std::array<double, 4> edge_length{};   ///< along which it is still there, for each edge, m
};

/// Principal stresses of a panel at their largest, Pa, both positive, and where they are.
struct PanelStress {
  double tension = 0;                  ///< the largest
  double compression = 0;              ///< the largest
  Vec3 tension_at = Vec3::Zero();      ///< of `tension`, m
  Vec3 compression_at = Vec3::Zero();  ///< of `compression`, m
};

/// What was done and what was not. The first four are as in solver::ReanalysisCounters, over all components.
struct FrameCounters {
  std::uint64_t solves = 0;              ///< answers computed
  std::uint64_t low_rank = 0;            ///< by low-rank updates
  std::uint64_t refactorisations = 0;    ///< new factors
  std::uint64_t segmentations = 0;       ///< searches for connected parts
  std::uint64_t unchanged = 0;           ///< answers given without computing
  std::uint64_t selective = 0;           ///< answers that left out what could not break
  std::uint64_t background_factors = 0;  ///< as solver::ReanalysisCounters
  std::uint64_t late_factors = 0;        ///< as solver::ReanalysisCounters
  std::uint64_t vertices_searched = 0;   ///< nodes and members that segmentation looked at
};

/// Energies of the standing frame in J, in the last state of rest. The works are sums over the changes since
/// construction; each is loads times displacements, the elastic energy comes from internal forces, and what a break
/// frees from Clapeyron's theorem, so that
///   elastic - elastic_at_start = gravity_work + other_work + contact_work - freed - dissipated
/// is a check and not a definition. Where what stands moves, its kinetic energy and what is damped stand beside these,
/// the works of all loads on what moves are gravity_work until it rests, and impulses put `struck` in.
struct FrameEnergy {
  double elastic = 0;           ///< of what stands
  double elastic_at_start = 0;  ///< before the first change
  double gravity_work =
      0;  ///< of all that counts as mass, through the frame's displacements; parts that left: up to then
  double other_work = 0;    ///< of horizontal loads, moments and event loads
  double contact_work = 0;  ///< of contact loads, which are laid on slowly
  double dissipated = 0;    ///< in joints that turned while they held their capacity
  double freed = 0;         ///< by breaks, removals and suddenly changed loads: what the static path does not need
  double kinetic = 0;       ///< of what stands
  double damped = 0;        ///< in it, what was left when it came to rest included
  double numerical = 0;     ///< by the method of integration
  double struck = 0;        ///< work of impulses on it
};

/// What stands, with its damage. It is a facade: its many functions are a line or a check each, the parts in
/// structure/standing/ own the data. A function that names a part throws std::out_of_range for one that the building
/// does not have.
class StandingFrame {
 public:
  /// Solves the undamaged building under the combination's loads. Throws UnstableModel, and InputError for a
  /// combination that settles a support.
  StandingFrame(const Building& building, CombinationId combination, const FailureRules& rules, int threads = 1);
  ~StandingFrame();

  // What stands.
  /// Whether the member is still part of the frame.
  [[nodiscard]] bool stands(MemberId member) const;
  /// Whether the panel is still part of the frame.
  [[nodiscard]] bool stands(PanelId panel) const;
  /// Whether the node is still part of the frame.
  [[nodiscard]] bool stands(NodeId node) const;
  /// Whether the joint holds, in the frame or in a part that left it.
  [[nodiscard]] bool intact(JointId joint) const;
  /// In the last state of rest, in which nothing was over capacity: static states on the way of a collapse are never
  /// reached. Of a node that left: as it was then.
  [[nodiscard]] const Vec6& displacement(NodeId node) const;
  /// Static demand in the joint's axes, as solved last; zero when the joint no longer holds.
  [[nodiscard]] Vec6 demand(JointId joint) const;
  /// Of the static demand; zero value for a joint without capacity or one that no longer holds.
  [[nodiscard]] Utilisation utilisation(JointId joint) const;
  /// As solved last: what the nodes do to a member (local axes, first end then second), what all supports of a
  /// node do to the structure (global axes). Zero for what does not stand.
  [[nodiscard]] Eigen::Matrix<double, 12, 1> end_forces(MemberId member) const;
  /// What all supports of the node do to the structure, N and N m, global axes. While it moves: at the end of the last
  /// substep, forces of damping apart.
  [[nodiscard]] Vec6 reaction(NodeId node) const;
  /// Over all states that were checked, peaks of sudden losses included.
  [[nodiscard]] double largest_utilisation_so_far(JointId joint) const;
  /// Segment number of a standing member (segments are numbered from 0 in order of their least node; lone nodes are
  /// none). -1 when it does not stand.
  [[nodiscard]] int segment(MemberId member) const;
  /// How many segments stand.
  [[nodiscard]] int standing_segments() const;
  /// J, of what stands, in the last state of rest.
  [[nodiscard]] double elastic_energy() const;
  /// J, as FrameEnergy says.
  [[nodiscard]] FrameEnergy energy() const;
  /// Of a standing shell panel in either face (at the centres of its elements), or of a membrane by its mean stress, in
  /// the static state solved last. Nothing for a panel that bears no stress.
  [[nodiscard]] std::optional<PanelStress> stress(PanelId panel) const;
  /// Downward load of a part in the combination over gravity, node loads apart.
  [[nodiscard]] double mass(MemberId member) const;
  /// Of the panel, kg.
  [[nodiscard]] double mass(PanelId panel) const;
  /// Of the node's own loads, kg.
  [[nodiscard]] double node_mass(NodeId node) const;
  /// Mean downward displacement of the nodes at the greatest height.
  [[nodiscard]] double roof_sag() const;

  // What acts and what bears, for drawings. All of the statics as solved last; empty or zero for what stands no more.
  /// Along a standing member at `intervals` + 1 even places from its first end, in the order of
  /// solver::BeamDiagram::Quantity (N, N m, m; member axes). Of one that moves: by what it bears now (end_forces()).
  [[nodiscard]] std::vector<std::array<double, 8>> internal_forces(MemberId member, int intervals) const;
  /// Loads of the combination, what panels hand on, events and contacts: member axes.
  [[nodiscard]] std::vector<solver::BeamLoad> member_loads(MemberId member) const;
  [[nodiscard]] Vec6 node_load(NodeId node) const;  ///< global axes, loads of members apart
  /// What the support at this index of Building::supports does to its node, global axes.
  [[nodiscard]] Vec6 reaction(std::size_t support) const;
  [[nodiscard]] std::vector<ContactLoad> contact_loads() const;  ///< in order of key

  // Changes by tools and contacts: they take effect in the next generations.
  /// From outside: the cause is told in the event.
  void break_joint(JointId joint, BreakCause cause);
  /// Takes the member away, at once.
  void remove(MemberId member);
  /// Takes the panel away, at once.
  void remove(PanelId panel);
  /// Takes every support of the node away.
  void remove_support(NodeId node);
  void set_strength_factor(JointId joint, double factor);  ///< on top of the capacity
  /// The owner of the building changed this joint's capacity in place: its utilisation follows at once (no statics are
  /// solved), and if it is over capacity it breaks in the next generations.
  void capacity_changed(JointId joint);
  /// Factor on E and G, above 0 and at most 1 (else std::invalid_argument), from now on instead of the one before. It
  /// comes on slowly, as in a fire: no sudden-loss factor acts on it.
  void set_stiffness_factor(MemberId member, double factor);
  /// m/s2, global axes.
  void set_gravity(const Vec3& gravity);
  /// N and N m, global axes, on top of what acts there.
  void add_load(NodeId node, const Vec6& load);
  /// Replaces the load with the same key.
  void set_contact_load(const ContactLoad& load);
  /// The load with this key no longer acts.
  void remove_contact_load(std::int64_t key);

  /// While joints break, components of at least this many nodes are brought up to date only where a joint may break
  /// next (bounded by strain energy); what is asked for afterwards is whole. The joints that break are the same,
  /// numbers differ by rounding; what a joint bore in between, where it could not break, may be missing from its
  /// largest_utilisation_so_far(). Below, telling the two apart costs more than a whole answer.
  void restrict_answers_from(int nodes);
  static constexpr int default_selective_from = 1000;  ///< nodes; below, a whole answer is cheaper

  /// True when a load or joint changed and the answer is not yet settled.
  [[nodiscard]] bool pending() const;
  /// Brings the state up to date: solve, break what is over capacity, one generation after the other until nothing is,
  /// sudden loss and bracing by the rules, mechanisms released. Returns what broke, in order. To look at a state
  /// in between, give a number of `generations` to stop after: pending() then stays true.
  std::vector<JointBreak> settle(int generations = std::numeric_limits<int>::max());
  /// From now on what stands moves, and sudden losses are followed in time (docs/dynamics.md): move() takes the place
  /// of settle(), and pending() holds until all is at rest. Rules must have `sudden` 1. Throws InputError where
  /// why_it_stays_at_rest() names a reason.
  void let_move(double dt, const MotionRules& rules = {});
  /// Changes act, and all that is not at rest moves on by the time of let_move(). Joints break as they
  /// are reached, those of members within substeps, those of panels at their ends. `after_substep` is called at the end
  /// of each, and may call fracture(). Returns what broke, in order.
  std::vector<JointBreak> move(const std::function<void()>& after_substep = {});
  // move() in parts, for what moves together with it.
  /// Changes act. Returns what broke with them.
  std::vector<JointBreak> begin_move();
  /// Anything moves.
  [[nodiscard]] bool in_motion() const;
  /// Substeps of a step.
  [[nodiscard]] int substeps() const;
  /// One substep, under the contact loads of the moment. `after_substep` may call fracture().
  void move_on(const std::function<void()>& after_substep = {});
  /// Between two substeps: what changed acts now on what moves, and not with the next substep: it is gone, and its
  /// momentum and mass are with what bears them. What that breaks is told by extract_breaks().
  void take_changes();
  /// Counts up when substep_mobility() becomes another.
  [[nodiscard]] std::uint64_t mobility_changes() const;
  /// What broke since it was last told, in order.
  std::vector<JointBreak> extract_breaks();
  /// Between two substeps: what joints of what moves bear now. Without it demand() and utilisation() tell what they
  /// bore at the end of the last step.
  void read_demands();
  /// After the last substep. Returns what extract_breaks() would.
  std::vector<JointBreak> end_move();
  /// What the place is on stands and is not at rest.
  [[nodiscard]] bool moves(const ContactPlace& place) const;
  /// m/s and rad/s, global axes; 0 at rest.
  [[nodiscard]] Vec6 velocity(NodeId node) const;
  /// By how much faster a node is at the end of a substep for a unit of force along and of moment about each global
  /// axis through it, per length of it (1/kg, 1/(kg m), 1/(kg m2)). Where something yields, which gives way more: for a
  /// unit impulse. Zero at rest.
  [[nodiscard]] Eigen::Matrix<double, 6, 6> substep_mobility(NodeId node) const;
  /// Of a node in the mean through the next substep, if what loads it now goes on to and nothing breaks: m/s2 and
  /// rad/s2, global axes; 0 at rest. What changed since the last substep acts at once.
  [[nodiscard]] Vec6 foreseen_acceleration(NodeId node);
  /// Something has left that extract_detached() has not handed out.
  [[nodiscard]] bool has_detached() const;
  /// How what stands takes unit pushes at places on different parts, each along its direction, that are faster than its
  /// motion (the law of impact, simulation/impact/impact.h): the struck part gives way with its nodes held, its own
  /// joints bear it, and the mass that shares at first touch is that of its nodes, g'M^-1 g. The joints of whatever
  /// meets it there bear what these nodes move while it lasts.
  struct HeldResponse {
    Eigen::MatrixXd compliance;  ///< m/N, of struck parts alone
    Eigen::MatrixXd mobility;    ///< 1/kg: acceleration of place i under a unit force at place j
    Eigen::VectorXd speed;       ///< m/s of each place along its direction, now
    std::vector<std::pair<JointId, Eigen::Matrix<double, 6, Eigen::Dynamic>>> demands;  ///< for each newton at each
    std::vector<std::vector<std::pair<NodeId, Vec6>>> at_nodes;  ///< per place: what its unit push hands to nodes
    /// The nodes of the struck parts while all others are held: what gives way next, while the push lasts. Rows of
    /// `pushed` and columns of `node_demands` are modes of unit modal mass, component after component.
    std::vector<std::pair<int, solver::LocalModes>> local;  ///< with the number of its component
    Eigen::VectorXd squared;  ///< angular frequencies squared, (rad/s)2; 0: without strain
    Eigen::MatrixXd pushed;   ///< by a unit force at each place, kg^-1/2
    /// Of joints at those nodes, for a unit of each coordinate.
    std::vector<std::pair<JointId, Eigen::Matrix<double, 6, Eigen::Dynamic>>> node_demands;
    /// A sense of one of those joints that holds its capacity while it turns, and then breaks.
    struct Hinge {
      JointId joint;                ///< of a member's end
      int axis = 4;                 ///< component of the demand: 3 torsion, 4 and 5 moments
      double capacity = 0;          ///< N m, of either sign, as strong as the joint is now
      double limit = 0;             ///< rad, of its plastic rotation of either sign
      double plastic_rotation = 0;  ///< rad, now
      double stiffness = 0;         ///< N m/rad: by how much its moment falls for 1 rad more, nodes held
      std::vector<std::pair<JointId, Vec6>> demands;  ///< of both joints of its member for that
    };
    std::vector<Hinge> hinges;  ///< but for a joint that alone holds its member
  };
  /// A component at rest begins to move.
  [[nodiscard]] HeldResponse respond_held(std::span<const ContactPlace> places, std::span<const Vec3> directions);
  /// Impulses along the directions of `pushed`, N s, act now. Returns their work, J.
  double strike(const HeldResponse& pushed, const Eigen::VectorXd& impulses);
  /// What a joint bore in an impact that it survived, for largest_utilisation_so_far().
  void remember_utilisation(JointId joint, double value);
  /// By how much a joint's hinge turned in an impact, of the sign of the moment that it held, and what it took.
  struct ImpactTurn {
    JointId joint;          ///< of a member's end
    int axis = 4;           ///< as HeldResponse::Hinge has it
    double turned = 0;      ///< rad
    double dissipated = 0;  ///< J
  };
  /// Joints of what moves have turned by so much, for good, with their nodes where they are. Those that stand no more
  /// are passed over. Returns what the frame took, J: dissipated, and more elastic energy.
  double turn_in_impact(std::span<const ImpactTurn> turns);
  /// The capacity of a joint in the senses that break at once.
  [[nodiscard]] const JointCapacity& brittle_capacity(JointId joint) const;
  /// Joints of what moves break now, at an impact. What snaps with them is told by the next move().
  void break_in_impact(std::span<const JointBreak> breaks);

  /// Joints whose moment or torsion came to its capacity, and that have turned since, as they did; each sense of a
  /// joint once. Handed out once.
  std::vector<JointBreak> extract_yielded();
  /// What joints that hold and stand have turned by, in order of joint and sense; those that never yielded are left
  /// out.
  [[nodiscard]] std::vector<PlasticRotation> plastic_rotations() const;
  /// What has left since the last call, each connected part apart.
  std::vector<Detached> extract_detached();

  // Impact support. All answers are for the structure as it stands now.
  /// Response to a unit force at a place: how far the place gives way along it (compliance, m/N), the demand that it
  /// adds to each joint (sparse: only joints that change), and the Rayleigh mass of the static shape.
  struct UnitResponse {
    double compliance = 0;                          ///< m/N
    double rayleigh_mass = 0;                       ///< kg; a lower bound where the answer is a partial one
    std::vector<std::pair<JointId, Vec6>> demands;  ///< N and N m for one newton, in the joints' axes
  };
  /// The place must stand. A place on a member is taken at the nearest point of its axis, on a panel at the nearest
  /// point of its plane; a panel hands the force by the lever rule to two opposite edges along its shorter span.
  [[nodiscard]] UnitResponse respond(const ContactPlace& place, const Vec3& direction) const;
  /// Response to unit forces at several places on different parts, each along its direction.
  struct CoupledResponse {
    std::vector<UnitResponse> places;  ///< of each place by itself
    Eigen::MatrixXd compliance;        ///< m/N: by how much place i gives way under a unit force at place j; symmetric
    /// kg (m/N)2: the product of the static shapes under unit forces at i and j, integrated over the structure's mass;
    /// between the places Rayleigh's masses are compliance^-1 inertia compliance^-1.
    Eigen::MatrixXd inertia;
  };
  /// The directions are unit vectors.
  [[nodiscard]] CoupledResponse respond(std::span<const ContactPlace> places, std::span<const Vec3> directions) const;
  /// The same as far as it is known at a part of the cost: the compliance, a lower bound of the Rayleigh mass, and the
  /// demands of the joints at the members and the panel that bear the force directly.
  [[nodiscard]] UnitResponse respond_near(const ContactPlace& place, const Vec3& direction) const;
  /// The same for several places: the inertia is a lower bound under any forces there, and the demands are those of the
  /// joints at the members that bear any of the forces.
  [[nodiscard]] CoupledResponse respond_near(std::span<const ContactPlace> places,
                                             std::span<const Vec3> directions) const;
  /// J: a push there that adds less strain energy than this to the structure breaks no joint, those of the members and
  /// the panel that bear it directly aside. Joints over capacity already are left to the generations.
  [[nodiscard]] double critical_energy(const ContactPlace& place) const;
  /// Breaks these joints now, at an impact (uses up no generation): re-segments and solves. What snaps with them
  /// (bracing, mechanisms) is told by the next settle(). Returns how far the unloaded contact place moved along
  /// `direction` (the shift D of the impact law). Ask stands() of the place's part afterwards: when it left, the shift
  /// is 0 and there is nothing left to push.
  double break_in_impact(std::span<const JointBreak> breaks, const ContactPlace& place, const Vec3& direction);
  /// The same where several places are pushed at once: the shift of each.
  Eigen::VectorXd break_in_impact(std::span<const JointBreak> breaks, std::span<const ContactPlace> places,
                                  std::span<const Vec3> directions);

  /// This panel may be broken in part later: what all panels of its shape have in common is found now.
  void expect_fracture(PanelId panel);
  /// A standing panel is broken in part, now: it hands on what remains of its weight by where that lies, its edge
  /// joints bear over what remains of their length (told as broken by settle() or move() when nothing does), and it
  /// is as stiff as what remains. Holes are all since it was whole. `taken`: linear momentum (N s) that what breaks out
  /// of a panel that moves leaves with, by its motion(): what the panel gives up beside that goes to what remains.
  /// None: what goes takes along what the panel gives up.
  void fracture(PanelId panel, const PanelRemains& remains, const std::optional<Vec3>& taken = {});
  /// A panel's motion where it stands and moves, global axes; 0 at rest.
  struct PanelMotion {
    Vec3 velocity = Vec3::Zero();  ///< of its mass in the mean, m/s
    Vec3 spin = Vec3::Zero();      ///< as its corners turn about each other, rad/s
  };
  [[nodiscard]] PanelMotion motion(PanelId panel) const;  ///< At the end of the last step.
  /// Of a shell panel as it is, or was when it left: in the freedoms of its nodes (Panel::all_nodes()), global.
  [[nodiscard]] Eigen::MatrixXd shell_stiffness(PanelId shell) const;

  /// What was done since construction.
  [[nodiscard]] const FrameCounters& counters() const;
  /// As it was given.
  [[nodiscard]] const Building& building() const;

  /// All that has happened to it, changes that wait and what has not been handed out included, for load_state() of this
  /// very program. Between two calls, in motion as at rest; changes nothing.
  void save_state(std::ostream& to) const;
  /// From then on this frame answers as the one that was saved, to the bit. It was made with the same arguments, has
  /// lost nothing yet, and its building is by now what that of the other one was then (capacities, see
  /// capacity_changed()). Throws std::runtime_error where bytes are missing: it may then be destroyed only.
  void load_state(std::istream& from);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// What keeps this building from moving in a collapse, in words; nothing when it can.
[[nodiscard]] std::optional<std::string> why_it_stays_at_rest(const Building& building);

}  // namespace topple::structure
