#pragma once
// The interactive demolition of a building: what a host (command line, viewer, game) embeds. One step finds what
// bodies will touch, loads what stands, breaks what is over capacity, releases what lost its hold, moves what is awake
// and keeps accounts; what does not change costs nothing.
//
// Calls that name a node, member, panel or joint throw std::out_of_range for one that the building does not have; those
// that take numbers throw InputError for what physics has no use for (number_range.h). A call that throws has done and
// recorded nothing.
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <functional>
#include <iosfwd>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "topple/collision/overlap_watch.h"
#include "topple/collision/world.h"
#include "topple/fracture/mesh.h"
#include "topple/structure/building.h"
#include "topple/structure/host_contact.h"
#include "topple/structure/piece_kind.h"
#include "topple/structure/scenario.h"
#include "topple/structure/snapshot.h"
#include "topple/structure/standing_frame.h"

namespace topple::structure {

/// A line of events.jsonl.
struct SimulationEvent {
  /// What happened.
  enum class Kind {
    tool,
    impact,
    joint_yielded,
    joint_broke,
    panel_fractured,
    mechanism,
    detached,
    split,
    at_rest,
    limited,
    done
  };
  double time = 0;         ///< s
  std::int64_t step = 0;   ///< in which it happened, from 0
  Kind kind = Kind::tool;  ///< which of the members below count
  std::string name;        ///< of the joint, member, panel or tool
  JointBreak joint;        ///< joint_broke
  // detached, split
  std::vector<MemberId> members;  ///< of the part
  std::vector<PanelId> panels;    ///< of the part
  double mass = 0;                ///< kg, of the part
  // impact
  std::string body_name;         ///< of the body that hit; `name` is what it hit
  collision::BodyId body;        ///< that hit
  collision::BodyId other_body;  ///< that was hit, when it was a body
  double peak_force = 0;         ///< N
  double speed_in = 0;           ///< closing before, m/s
  double speed_out = 0;          ///< closing afterwards, m/s
  Vec3 position = Vec3::Zero();  ///< m
};

enum class Stage { sweep, load, break_, release, move, account };
inline constexpr std::array<const char*, 6> stage_names{"sense", "load", "break", "release", "move", "book"};

/// Energies in J, each measured on its own, so that the residual is a check (docs/rooms/simulation.md).
struct Ledger {
  double gravity_work = 0;          ///< of gravity on all that moved
  double work_put_in = 0;           ///< by tools and hosts
  double elastic = 0;               ///< in what stands
  double freed_by_breaks = 0;       ///< by breaking joints
  double dissipated_in_joints = 0;  ///< by joints that yield
  double kinetic_translation = 0;   ///< of bodies
  double kinetic_rotation = 0;      ///< of bodies
  double lost_in_impacts = 0;       ///< by the law of impact
  double lost_in_contacts = 0;      ///< by contacts, friction included
  double removed = 0;               ///< that bodies took along when they were removed
  /// Of what stands: that it has, what was damped in it, and what the integration of its motion took.
  double kinetic_standing = 0;
  double damped = 0;               ///< see above
  double lost_in_integration = 0;  ///< see above
  double momentum_error = 0;       ///< largest relative error with which a break, split or impact handed momentum on
  /// What is left over, relative to the work of gravity plus the work put in.
  [[nodiscard]] double residual() const;
};

/// What was done, and what was not.
struct SimulationCounters {
  std::uint64_t steps_idle = 0;        ///< steps that had nothing to do
  std::uint64_t solves = 0;            ///< of the statics
  std::uint64_t low_rank = 0;          ///< by low-rank updates
  std::uint64_t refactorisations = 0;  ///< new factors
  std::uint64_t segmentations = 0;     ///< searches for connected parts
  std::uint64_t collision_steps = 0;   ///< steps of the collision engine
  std::uint64_t contacts_ignored = 0;  ///< resting contacts whose load was not passed on
  std::uint64_t impacts_bounded = 0;   ///< borne by a bound alone, without a solve
  std::uint64_t impacts_together = 0;  ///< of one body on several parts at one instant
  std::uint64_t selective = 0;         ///< answers that left out what could not break
  /// Factors made on another thread while the old one served; those of them that had to be waited for (it depends on
  /// the machine, and changes nothing else).
  std::uint64_t background_factors = 0;
  std::uint64_t late_factors = 0;  ///< see above
};

/// What the collision engine did not keep apart: pieces that stayed inside each other, which is where a heavy one lies
/// on a light one (from a hundred times its mass on). Drawn, they show; a load path through them is right in its sum
/// only.
struct BodyOverlaps {
  std::uint64_t deep = 0;  ///< how often two parts lay inside each other by more than OverlapWatch::deep_share
  // The deepest of all, if `depth` is above zero.
  double depth = 0;      ///< m, all through OverlapWatch::lasting
  double thickness = 0;  ///< of the thinner of the two, m
  double time = 0;       ///< when it had lasted, s
  std::string body;      ///< part, chunk or ball by name
  std::string with;      ///< what it was inside of, by name; "ground"
};

/// A moving body: debris of the building, or a projectile.
struct BodyView {
  collision::BodyId id;             ///< as long as the piece lives
  std::string_view name;            ///< of its first member, else panel, chunk, ball; until the next step
  collision::Pose pose;             ///< of its centre of mass, now
  Vec3 rest_centre = Vec3::Zero();  ///< where the centre of mass was in the undeformed building: a point p of a member
                                    ///< moves to pose.position + pose.orientation * (p - rest_centre)
  double mass = 0;                  ///< kg
  double radius = 0;                ///< above zero: a projectile (sphere)
  bool asleep = false;              ///< not moving; nothing is computed for it
  std::span<const MemberId> members;  ///< that it is made of; until the next step
  std::span<const PanelId> panels;    ///< that it is made of; until the next step
  std::shared_ptr<const fracture::Mesh>
      chunk;  ///< of a broken panel, or of a member cut in two: about its centre of mass, turned by the pose alone
  PieceKind chunk_of = PieceKind::slab;  ///< what it is a piece of
  std::optional<Vec3> cable_anchor;      ///< a wrecking ball: where its cable hangs
};

/// What happened to the moving pieces in a step, by handles (BodyId::value) that are never used again.
struct PieceChanges {
  std::vector<std::int64_t> made;   ///< in order
  std::vector<std::int64_t> gone;   ///< in order
  std::vector<std::int64_t> moved;  ///< in order; awake at the step's end
  /// A piece that came apart.
  struct Split {
    std::int64_t from;  ///< handle of the piece that is gone
    std::int64_t to;    ///< handle of a piece that it became
  };
  std::vector<Split> split;  ///< a piece that is gone, and one that it became
};

/// A joint through which part of a load goes.
struct Carrier {
  JointId joint;     ///< by its id in Building::joints
  double share = 0;  ///< of a vertical force in the middle of what is carried
};

/// What a host may choose. None of it changes a result.
struct SimulationOptions {
  int threads = 1;                                                ///< of the statics, and of debris
  std::function<std::unique_ptr<collision::World>()> make_world;  ///< none: collision::make_bullet_world()
};

/// A demolition: building, scenario, and all that moves and stands.
class Simulation {
 public:
  /// Throws UnstableModel; InputError for a part whose mass is not above zero, a combination that is not named, and
  /// rules, times or events that mean nothing.
  Simulation(Building building, Scenario scenario, SimulationOptions options = {});
  ~Simulation();
  /// Moves: what is moved from may only be destroyed or assigned to.
  Simulation(Simulation&&) noexcept;
  /// Moves, as the constructor does.
  Simulation& operator=(Simulation&&) noexcept;

  /// One step of Scenario::step.
  void step();
  /// Passes over the steps before the next event (or the end) while nothing is awake or pending: they keep their
  /// numbers and count as idle, as if each had been stepped through. Returns how many were passed over.
  std::int64_t skip_idle();
  /// True when the scenario's duration is over, or all is at rest and nothing is to come (`until_rest`).
  [[nodiscard]] bool finished() const;
  /// s since the start.
  [[nodiscard]] double time() const;
  /// Steps since the start, idle ones included.
  [[nodiscard]] std::int64_t steps() const;
  /// True when nothing moves and nothing is to be computed.
  [[nodiscard]] bool at_rest() const;

  /// A tool used now (by a person): acts in the next step.
  void apply(const Tool& tool);
  /// Gives joints other capacities, at once: utilisations follow without solving anything, and what is then over
  /// capacity breaks in the next step. Part of the run: the same calls before the same steps give the same bits.
  void set_capacities(std::span<const std::pair<JointId, JointCapacity>> capacities);

  /// The moment as it is now (snapshot.h).
  [[nodiscard]] Snapshot save() const;
  /// Comes back to a moment of a simulation of the same building and scenario; listeners stay and are not called on the
  /// way. Throws InputError when the way does not lead there, and is then as it was before.
  void restore(const Snapshot& snapshot);
  /// All of it as it is between two steps, as bytes for load_state() of the same program: what took a snapshot the way
  /// there takes a state no more than its size. Changes nothing. Throws std::logic_error where the collision world of
  /// SimulationOptions::make_world cannot (World::save_state()).
  void save_state(std::ostream& to) const;
  /// Goes on from a state of a simulation of the same building, scenario and world, as that one does: every step, event
  /// and account is the same to the bit. `duration` and `until_rest` of the scenario, and the threads, may be others.
  /// Listeners stay, and hear what happens from then on; what was seen by handles and views before is of the past.
  /// Throws InputError for a state of another scene and std::runtime_error where bytes are missing, and is then as it
  /// was before.
  void load_state(std::istream& from);
  /// A body of the host comes to touch something: acts in the next step. Throws InputError for a contact that is not
  /// sound; one with what stands no more does nothing.
  void touch(const HostContact& contact);
  /// What those of the last step felt, in the order of touch().
  [[nodiscard]] std::span<const HostImpulse> host_impulses() const;
  /// The listener is called for every event, in order, within step(); so are those given before.
  void on_event(std::function<void(const SimulationEvent&)> listener);
  /// All so far, in order.
  [[nodiscard]] std::span<const SimulationEvent> events() const;

  // State, for drawing and queries.
  /// Its joints' capacities are those that set_capacities() gave.
  [[nodiscard]] const Building& building() const;
  /// As it was given.
  [[nodiscard]] const Scenario& scenario() const;
  /// All that stands.
  [[nodiscard]] const StandingFrame& frame() const;
  /// In order of handle; until the next step.
  [[nodiscard]] std::span<const BodyView> bodies() const;
  /// Of all bodies in their order, seven numbers each: position x y z, orientation as a quaternion x y z w.
  [[nodiscard]] std::span<const double> poses() const;
  /// The same numbers, to be kept: as long as somebody holds them they stay what they are, and a step writes new ones
  /// elsewhere. Nothing is copied.
  [[nodiscard]] std::shared_ptr<const std::vector<double>> held_poses() const;
  /// Of the last step.
  [[nodiscard]] const PieceChanges& changes() const;
  /// Body that a member (panel) is part of; value -1: it stands, -2: it is gone.
  [[nodiscard]] collision::BodyId body_of(MemberId member) const;
  /// The same for a panel.
  [[nodiscard]] collision::BodyId body_of(PanelId panel) const;
  /// What remains of a panel that is broken in part, where it stood undeformed; null while it is whole.
  [[nodiscard]] std::shared_ptr<const fracture::Mesh> broken_panel(PanelId panel) const;
  /// Nearest thing along a ray: standing member or panel, body, ground.
  struct RayHit {
    MemberId member;            ///< valid: a standing member
    PanelId panel;              ///< valid: a standing panel
    collision::BodyId body;     ///< a body; -1: not one
    Vec3 point = Vec3::Zero();  ///< m
    double distance = 0;        ///< m from `from`
  };
  /// `direction` of any length but zero. None: nothing is hit, or the ray has no direction.
  [[nodiscard]] std::optional<RayHit> ray_cast(const Vec3& from, const Vec3& direction) const;

  /// What carries this? Joints with a capacity through which at least 1 % of its load goes, the largest share first;
  /// empty for what does not stand.
  [[nodiscard]] std::vector<Carrier> what_carries(MemberId member) const;
  /// The same for a panel.
  [[nodiscard]] std::vector<Carrier> what_carries(PanelId panel) const;
  /// What would break next? Joints nearest to their capacity under the loads as they are, the nearest first.
  [[nodiscard]] std::vector<std::pair<JointId, Utilisation>> next_to_break(std::size_t count) const;

  // Accounts.
  /// Energies so far.
  [[nodiscard]] const Ledger& ledger() const;
  /// Counters so far.
  [[nodiscard]] const SimulationCounters& counters() const;
  /// What stayed inside each other so far.
  [[nodiscard]] const BodyOverlaps& overlaps() const;
  /// Seconds of the last step by stage, and of these in the collision engine itself.
  [[nodiscard]] const std::array<double, 6>& stage_seconds() const;
  /// Seconds of the last step within the collision engine.
  [[nodiscard]] double collision_engine_seconds() const;
  /// Covers, as raw bits in order of name: broken joints, displacements of what stands, pose and velocity of each body.
  [[nodiscard]] std::uint64_t hash() const;

 private:
  std::int64_t skip_idle_before(std::int64_t last);
  void run_to(std::int64_t last);

  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace topple::structure
