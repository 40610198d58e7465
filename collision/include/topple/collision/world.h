#pragma once
// Rigid debris as the structure sees it: bodies, standing parts as obstacles, contacts, sweeps, hinges. An interface:
// a contact solver of our own (small_steps.h) stands behind it, on Bullet's shapes; a game can put its own engine here,
// a test a recording one. SI units, global z up.
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <iosfwd>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace topple::collision {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Mat6 = Eigen::Matrix<double, 6, 6>;

/// Where something is: a point p of it lies at position + orientation p.
struct Pose {
  Vec3 position = Vec3::Zero();                                     ///< m, global axes
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  ///< unit
  /// A point or pose in its frame, in global axes.
  [[nodiscard]] Vec3 operator*(const Vec3& local) const { return position + orientation * local; }
};

/// Handles live as long as the thing they name and are never used again in one world.
struct BodyId {
  std::int64_t value = -1;  ///< counts up from 0; -1: none
  /// In the order in which they were made.
  auto operator<=>(const BodyId&) const = default;
};
/// See BodyId.
struct ObstacleId {
  std::int64_t value = -1;  ///< as BodyId's
  /// As BodyId's.
  auto operator<=>(const ObstacleId&) const = default;
};
/// See BodyId.
struct HingeId {
  std::int64_t value = -1;  ///< as BodyId's
  /// As BodyId's.
  auto operator<=>(const HingeId&) const = default;
};

/// See BodyId.
struct CableId {
  std::int64_t value = -1;  ///< as BodyId's
  /// As BodyId's.
  auto operator<=>(const CableId&) const = default;
};

/// One convex piece of a shape, in the frame of the body.
struct ConvexPart {
  /// Which shape; hull: the convex hull of `points`.
  enum class Kind { box, sphere, hull };
  Kind kind = Kind::box;             ///< which of the members below count
  Pose pose;                         ///< of the part in the body (box and sphere: its centre)
  Vec3 half_extents = Vec3::Zero();  ///< box; sphere: x is the radius
  std::vector<Vec3> points;          ///< hull: vertices
  std::int64_t tag = -1;             ///< given back in contacts: which part of the body was touched
};

/// A rigid body that moves. SI.
struct BodyDescription {
  std::vector<ConvexPart> parts;         ///< at least one
  double mass = 0;                       ///< above zero
  Mat3 inertia = Mat3::Zero();           ///< about the centre of mass, body axes; need not be diagonal
  Pose pose;                             ///< of the centre of mass; parts are relative to it
  Vec3 velocity = Vec3::Zero();          ///< of the centre of mass
  Vec3 angular_velocity = Vec3::Zero();  ///< global axes
  double friction = 0.6;                 ///< coefficient; a pair has the geometric mean of its two
  double restitution = 0.1;              ///< a pair has the geometric mean of its two
};

/// A part of what stands: it does not move in the world, whatever pushes it.
struct ObstacleDescription {
  std::vector<ConvexPart> parts;  ///< none: nothing touches it; hinges hold to it
  Pose pose;                      ///< of the obstacle in space; parts are relative to it
  double friction = 0.6;          ///< as BodyDescription's
  double restitution = 0.1;       ///< as BodyDescription's
};

/// What a body touches.
struct Touched {
  /// What it is.
  enum class Kind { body, obstacle, ground };
  Kind kind = Kind::ground;    ///< which of the handles below counts
  BodyId body;                 ///< of a body
  ObstacleId obstacle;         ///< of an obstacle
  std::int64_t part_tag = -1;  ///< ConvexPart::tag of the touched part
};

/// A contact found by sweep() (about to happen) or left by step() (it happened).
struct Contact {
  BodyId body;                 ///< with the lower id, where two bodies meet
  std::int64_t part_tag = -1;  ///< ConvexPart::tag of the body's touched part
  Touched other;               ///< what it touches
  Vec3 point = Vec3::Zero();   ///< centre of the area of contact (sweep), of its impulses (step); global
  Vec3 normal = Vec3::Zero();  ///< unit, from the body into what it touches
  /// Relative speed along the normal, rotation included, positive when closing: at the point (step), at the corner that
  /// closes fastest (sweep).
  double approach_speed = 0;
  double time = 0;              ///< sweep: time of impact from now; step: 0
  Vec3 impulse = Vec3::Zero();  ///< step: what the body did to the other during the last step, friction included, N s
  Vec3 moment = Vec3::Zero();   ///< step: the same about the point, N m s. With both, what is told of a body makes up
                                ///< its change of angular momentum about any point that is fixed in space
  double work_lost = 0;  ///< step: energy, of motion (velocities read at mid-step) and of height, that it took out of
                         ///< the bodies, J
  double depth = 0;      ///< step: how far the two were inside each other when it began (m; a hull's skin counts)
  double thickness = 0;  ///< step: of the thinner of the two parts (the ground has none), m
  bool persistent = false;  ///< it was there in the step before as well
  int corner_count = 0;     ///< corners of the area of contact, 1 to 4: a slab that falls flat has 4
  std::array<Vec3, 4> corners{Vec3::Zero(), Vec3::Zero(), Vec3::Zero(),
                              Vec3::Zero()};  ///< the first corner_count of them, m, global
};

/// What a sweep looks at.
enum class Sweep { everything, obstacles };

/// Velocities are those of semi-implicit Euler as they stand: v(k+1) = v(k) + g dt, x(k+1) = x(k) + v(k+1) dt. Read as
/// speeds at mid-step they make free flight exact: a body that flies with v now enters with v - g dt/2, and one whose
/// state says v flies with v + g dt/2. set_state() and state() pass them on unchanged; sweep(dt) reads them that way.
struct BodyState {
  Pose pose;                             ///< of the centre of mass
  Vec3 velocity = Vec3::Zero();          ///< of the centre of mass, m/s
  Vec3 angular_velocity = Vec3::Zero();  ///< rad/s, global axes
  bool asleep = false;                   ///< nothing is computed for it until something wakes it
};

/// Where an obstacle that moves is, and how fast. Global axes.
struct ObstaclePath {
  Pose pose;                             ///< now
  Vec3 velocity = Vec3::Zero();          ///< of the pose's position, now, m/s
  Vec3 angular_velocity = Vec3::Zero();  ///< now, rad/s
};

/// How an obstacle moves with the structure that it is part of, as a rigid body about its pose's position. Global axes.
struct ObstacleMotion {
  Pose pose;                             ///< now
  Vec3 velocity = Vec3::Zero();          ///< of the pose's position, now, m/s
  Vec3 angular_velocity = Vec3::Zero();  ///< now, rad/s
  /// m/s2, mean of the part of a step that begins, if what touched it in the one before goes on to.
  Vec3 acceleration = Vec3::Zero();
  Vec3 angular_acceleration = Vec3::Zero();  ///< rad/s2, as the acceleration
  /// m/s2, mean of the part of a step before, as it was.
  Vec3 last_acceleration = Vec3::Zero();
  Vec3 last_angular_acceleration = Vec3::Zero();  ///< rad/s2, as that
  /// What it has by itself, or less: kg. Where it is touched otherwise than in the part of a step before, it gives way
  /// by no more than a body of that.
  double mass = 0;
  Mat3 inertia = Mat3::Zero();  ///< as the mass: kg m2, about the pose's position
  /// Instead of mass and inertia, for what nothing but hinges holds to: how fast it gets, m/s and rad/s, for N s and
  /// N m s at the pose's position through a part of a step; symmetric, positive definite. That of what gives way along
  /// one axis far more than along others.
  std::optional<Mat6> mobility;
  /// Held otherwise than in the part of a step before, as something broke: how it gave way then tells nothing.
  bool held_anew = false;

  /// Where it is, and how fast.
  [[nodiscard]] ObstaclePath path() const { return {pose, velocity, angular_velocity}; }
};

/// What a body did to an obstacle by a hinge, in a part of a step.
struct HingePull {
  HingeId hinge;                ///< whose `holder` it is
  ObstacleId holder;            ///< that moves
  Vec3 point = Vec3::Zero();    ///< of the holder, where the hinge was when the part began; m, global
  Vec3 impulse = Vec3::Zero();  ///< on the holder, N s
  Vec3 moment = Vec3::Zero();   ///< on the holder about the point, N m s
};

/// A structure that moves beside the bodies of a world, and shares the parts of a step with them.
class MovingStructure {
 public:
  virtual ~MovingStructure() = default;
  /// Nothing for an obstacle that stands still. Asked at the start of each part of a step, of those near bodies and
  /// those that hinges hold to.
  [[nodiscard]] virtual std::optional<ObstacleMotion> motion(ObstacleId obstacle) = 0;
  /// As motion() has it by now; nothing for an obstacle that stands still. Asked in a sweep.
  [[nodiscard]] virtual std::optional<ObstaclePath> path(ObstacleId obstacle) const = 0;
  /// It moves on by `dt` (s) under what the bodies did to it meanwhile: contacts of this part of the step, not merged,
  /// those of bodies that fell asleep apart; and what awake bodies pulled with on hinges whose holders move (none in
  /// worlds where no holder does). Bodies, obstacles and hinges may come and go in this call; contacts() tells after
  /// the step of those that are gone as well.
  virtual void advance(double dt, std::span<const Contact> contacts, std::span<const HingePull> pulls) = 0;
};

/// What a sweep is to find.
struct SweepOptions {
  /// Sweep::obstacles leaves out bodies and ground, and with them most of the cost when debris lies in a pile.
  Sweep what = Sweep::everything;
  /// m/s: pairs of bodies, and bodies and ground, no points of which can close faster may be left out.
  double least_speed = 0;
  /// By rising id: pairs of bodies of which none is one of these are left out, as is the ground of others. None given:
  /// all are swept.
  std::optional<std::span<const BodyId>> among = {};
  /// Obstacles that it moves go on from where it has them, with the velocity that they have there; for nullptr all
  /// stand still where the world has them. It must outlive the call.
  const MovingStructure* structure = nullptr;
};

/// Where a ray first hits.
struct RayHit {
  Touched what;                ///< that is hit
  Vec3 point = Vec3::Zero();   ///< m
  Vec3 normal = Vec3::Zero();  ///< against the ray
  double distance = 0;         ///< m from the ray's start
};

/// A joint between a body and the standing structure (fixed in space, or an obstacle) or another body, by the
/// components that it holds. One or two free rotations leave the held ones no more than a right angle from where they
/// began.
struct HingeDescription {
  BodyId body;                  ///< that is held
  std::optional<BodyId> other;  ///< none: what stands
  /// Of what stands (no `other` then): the hinge's place goes with it, and where it moves (MovingStructure) it gets the
  /// hinge's impulses. None, or one that has been removed: fixed in space. Worlds that know no obstacles that move may
  /// ignore it.
  std::optional<ObstacleId> holder;
  Vec3 point = Vec3::Zero();                                     ///< global, now
  std::array<bool, 6> held{true, true, true, true, true, true};  ///< components x y z rx ry rz in `axes`
  Mat3 axes = Mat3::Identity();                                  ///< rows: joint axes in global components, now
};

/// A cable without weight from a point in space to a body's centre of mass. It does not stretch, and pulls only.
struct CableDescription {
  BodyId body;                 ///< that hangs on it
  Vec3 anchor = Vec3::Zero();  ///< m, global
  double length = 0;           ///< above zero
};
/// Of the last step.
struct CablePull {
  double tension = 0;    ///< mean over the step, N
  double work_lost = 0;  ///< energy that it took out of the body where it came taut (velocities read at mid-step), J
};

/// A host's way to use its threads: calls work(0) ... work(count - 1), in any order and side by side where it can, and
/// returns when all have ended.
using ParallelFor = std::function<void(std::size_t count, const std::function<void(std::size_t)>& work)>;

/// Bodies, obstacles, ground, hinges and cables, and their contacts over time. Every function throws std::out_of_range
/// for a handle that is not in the world. Functions that take a description throw std::invalid_argument, naming the
/// part, for one without mass, with an inertia that is not positive definite, or with a part of no volume.
class World {
 public:
  virtual ~World() = default;

  /// The same world once more, with its handles and all that its next steps depend on: under the same calls both go on
  /// alike, to the bit. Null where an engine has no such copy.
  [[nodiscard]] virtual std::unique_ptr<World> copy() const { return nullptr; }
  /// All that copy() takes along, as bytes for the same program, between two steps. Throws std::logic_error where an
  /// engine cannot, which then has no copy either, and within a step.
  virtual void save_state(std::ostream& to) const;
  /// Of a world that was made alike (by the same function): this one goes on as that one, to the bit, and what it held
  /// before is gone; set_parallel_for() stays. Throws std::runtime_error where bytes are missing: it may be destroyed
  /// only then.
  virtual void load_state(std::istream& from);

  /// Steps may spread over `threads` threads: those of as many calls in one `parallel_for`, each of which lasts as long
  /// as the part of the step that is shared, and none of which waits for another to begin. It changes no bit. None (an
  /// empty function, or one thread): the caller's alone, as from the beginning. Copies share alike. Worlds that cannot
  /// share ignore it.
  virtual void set_parallel_for(ParallelFor parallel_for, int threads);
  /// m/s2. Wakes every body.
  virtual void set_gravity(const Vec3& gravity) = 0;
  /// A half space below z = height; replaces the one before. Wakes every body.
  virtual void set_ground(double height, double friction, double restitution) = 0;

  /// The body is awake from the beginning.
  virtual BodyId add_body(const BodyDescription& description) = 0;
  /// Its hinges and cables go with it; what touched it wakes.
  virtual void remove_body(BodyId body) = 0;
  /// It takes part from the next sweep or step on.
  virtual ObstacleId add_obstacle(const ObstacleDescription& description) = 0;
  /// Bodies that lay on it or hung at it wake; hinges hold on where they were.
  virtual void remove_obstacle(ObstacleId obstacle) = 0;
  /// Bodies that touched it or hang at it wake.
  virtual void move_obstacle(ObstacleId obstacle, const Pose& pose) = 0;
  /// It holds from the next step on.
  virtual HingeId add_hinge(const HingeDescription& description) = 0;
  /// Both sides wake.
  virtual void remove_hinge(HingeId hinge) = 0;
  /// Force and moment about the point (joint axes, mean of the last step) that the body exerts on what holds it.
  [[nodiscard]] virtual Eigen::Matrix<double, 6, 1> hinge_force(HingeId hinge) const = 0;
  /// Energy that it took out of the bodies that it joins in the last step (velocities read at mid-step), J; what a
  /// holder that moves got of it is in there.
  [[nodiscard]] virtual double hinge_work_lost(HingeId hinge) const = 0;

  /// Throws std::invalid_argument when its length is not above zero or the body is farther away than that.
  virtual CableId add_cable(const CableDescription& description) = 0;
  /// The body wakes.
  virtual void remove_cable(CableId cable) = 0;
  /// Mean over the last step; zero before the first.
  [[nodiscard]] virtual CablePull cable_pull(CableId cable) const = 0;

  /// As it is now.
  [[nodiscard]] virtual BodyState state(BodyId body) const = 0;
  /// Wakes the body, unless the state says asleep.
  virtual void set_state(BodyId body, const BodyState& state) = 0;
  /// N s at a global point. Wakes the body.
  virtual void apply_impulse(BodyId body, const Vec3& impulse, const Vec3& point) = 0;
  /// It takes part in the next step.
  virtual void wake(BodyId body) = 0;
  /// m/s: of a body that sleeps, what state() will tell of it when it is woken; of one that is awake, what it told when
  /// it last was. -g dt/2, which is rest when read at mid-step; zero in worlds that wake bodies without that.
  [[nodiscard]] virtual Vec3 velocity_when_woken(BodyId) const { return Vec3::Zero(); }
  /// Contacts between this body and that other (body or obstacle) are left out of sweeps and steps until they have come
  /// apart and are not about to meet as an impact: a body that goes through what it broke, or is born inside what it
  /// was joined to.
  virtual void ignore_until_separated(BodyId body, const Touched& other) = 0;
  /// Live bodies in order of id.
  [[nodiscard]] virtual std::span<const BodyId> bodies() const = 0;
  /// How many bodies are awake.
  [[nodiscard]] virtual std::size_t awake_count() const = 0;

  /// Contacts that awake bodies make with obstacles, ground or bodies within dt on their ballistic paths, each as if
  /// the others were not there, in order of time, then of body id. One for each pair of parts, the body with the lower
  /// id first. Those that were there in the last step are flagged persistent. Nothing moves. An engine that cannot
  /// step in parts takes obstacles as standing still.
  [[nodiscard]] virtual std::vector<Contact> sweep(double dt, const SweepOptions& options = {}) = 0;
  /// The same of all speeds, past obstacles that stand still.
  [[nodiscard]] std::vector<Contact> sweep(double dt, Sweep what) { return sweep(dt, SweepOptions{.what = what}); }
  /// Integrates awake bodies by dt > 0 (one internal step, semi-implicit Euler; rotation keeps angular momentum).
  virtual void step(double dt) = 0;
  /// The same in `parts` equal parts, after each of which the structure moves on: obstacles that move touch bodies with
  /// their velocity, give way as bodies do, and are where the structure has them. An engine that cannot do this takes
  /// one step past obstacles that stand still, and hands on its mean forces.
  virtual void step(double dt, int parts, MovingStructure& structure);
  /// It can: between two parts bodies are where they are by then, and sweep() looks at the next part.
  [[nodiscard]] virtual bool steps_in_parts() const { return false; }
  /// Contacts of awake bodies in the last step, one for each pair of parts, in order of ids and tags. What a sleeping
  /// body pressed with when it fell asleep, it presses with still.
  [[nodiscard]] virtual std::span<const Contact> contacts() const = 0;
  /// The nearest body, obstacle or ground between the two points; none where there is none.
  [[nodiscard]] virtual std::optional<RayHit> ray_cast(const Vec3& from, const Vec3& to) const = 0;
  /// Obstacles whose bounds meet the box.
  [[nodiscard]] virtual std::vector<ObstacleId> obstacles_in(const Vec3& low, const Vec3& high) const = 0;
};

/// Today the same as make_small_steps_world(): shapes and distances are Bullet's, in double precision. Throws
/// std::runtime_error when the Bullet library that was linked is not the one whose headers were compiled (single
/// precision). Simulations whose host gives no world run on it.
[[nodiscard]] std::unique_ptr<World> make_bullet_world();

}  // namespace topple::collision
