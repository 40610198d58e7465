#pragma once
// collision::World on Bullet. Its parts by file: bodies, obstacles and the step (bullet_world), contacts
// (bullet_world_contacts), rest (bullet_world_rest), sweeps and rays (bullet_world_sweep), hinges
// (bullet_world_hinges), cables (bullet_world_cables). It has more than forty functions and twenty-five data: World has
// thirty functions, and the rest stays as it was when simulations ran on it, to be compared with.
#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <BulletCollision/CollisionDispatch/btDefaultCollisionConfiguration.h>
#include <BulletCollision/CollisionShapes/btStaticPlaneShape.h>
#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <map>
#include <set>

#include "bullet/free_spin_world.h"
#include "contacts/awake_pairs.h"
#include "contacts/contact_forces.h"
#include "contacts/first_touch.h"
#include "contacts/half_space_contacts.h"
#include "contacts/polyhedron_contacts.h"
#include "solver/cable.h"
#include "solver/island_solver.h"

class btManifoldPoint;
class btPersistentManifold;

namespace topple::collision {

/// A body turns in its principal axes inside (its frame), and is seen in the caller's.
struct Body : Solid {
  std::unique_ptr<btRigidBody> rigid;
  double ball_radius = 0;  ///< of a body that is one ball; 0: any other
  int ignored = 0;         ///< pairs that it is in and that are ignored until separated
  SolverVelocities velocities;
  bool swings = false;                                  ///< on a cable, off its plumb line and touching nothing
  bool watched = false;                                 ///< since the last look, for going anywhere
  btTransform watched_at = btTransform::getIdentity();  ///< where it was then
  /// Of rest within a heap (bullet_world_rest.cpp): where it was when it was last looked at, s since then, how often in
  /// a row it had been still.
  btTransform seen_at = btTransform::getIdentity();
  double seen_for = 0;
  int times_still = 0;
  bool on_standing = false;    ///< it lies on what stands, or on what does
  bool about_to_rest = false;  ///< held still from the beginning of the next step
  bool held_still = false;
  double mass = 0;  ///< Bullet's own are zero while it is held still
  btVector3 moments{0, 0, 0};
  std::set<std::int64_t> hinges;
};

struct Obstacle : Solid {
  std::unique_ptr<btCollisionObject> fixed;
};

struct Hinge {
  std::unique_ptr<btTypedConstraint> constraint;
  btJointFeedback feedback;
  std::int64_t body = -1, other = -1;
  btVector3 point_in_body{0, 0, 0};  ///< the joint's point in the body's Bullet frame
  Mat3 axes_in_holder = Mat3::Identity();
  Eigen::Matrix<double, 6, 1> force = Eigen::Matrix<double, 6, 1>::Zero();
  double work_lost = 0;
};

struct HungCable {
  HungCable(btRigidBody& rigid, const btVector3& anchor, double length) : constraint(rigid, anchor, length) {}
  Cable constraint;
  std::int64_t body = -1;
  CablePull pull;
};

class BulletWorld final : public World {
 public:
  BulletWorld();
  ~BulletWorld() override;
  BulletWorld(const BulletWorld&) = delete;
  BulletWorld& operator=(const BulletWorld&) = delete;

  void set_gravity(const Vec3& gravity) override;
  void set_ground(double height, double friction, double restitution) override;
  BodyId add_body(const BodyDescription& description) override;
  void remove_body(BodyId body) override;
  ObstacleId add_obstacle(const ObstacleDescription& description) override;
  void remove_obstacle(ObstacleId obstacle) override;
  void move_obstacle(ObstacleId obstacle, const Pose& pose) override;
  HingeId add_hinge(const HingeDescription& description) override;
  void remove_hinge(HingeId hinge) override;
  [[nodiscard]] Eigen::Matrix<double, 6, 1> hinge_force(HingeId hinge) const override;
  [[nodiscard]] double hinge_work_lost(HingeId hinge) const override;
  CableId add_cable(const CableDescription& description) override;
  void remove_cable(CableId cable) override;
  [[nodiscard]] CablePull cable_pull(CableId cable) const override;
  [[nodiscard]] BodyState state(BodyId body) const override;
  void set_state(BodyId body, const BodyState& state) override;
  void apply_impulse(BodyId body, const Vec3& impulse, const Vec3& point) override;
  void wake(BodyId body) override;
  void ignore_until_separated(BodyId body, const Touched& other) override;
  [[nodiscard]] std::span<const BodyId> bodies() const override { return order_; }
  [[nodiscard]] std::size_t awake_count() const override;
  [[nodiscard]] std::vector<Contact> sweep(double dt, const SweepOptions& options) override;
  void step(double dt) override;
  [[nodiscard]] std::span<const Contact> contacts() const override { return contacts_; }
  [[nodiscard]] std::optional<RayHit> ray_cast(const Vec3& from, const Vec3& to) const override;
  [[nodiscard]] std::vector<ObstacleId> obstacles_in(const Vec3& low, const Vec3& high) const override;

 private:
  struct Mover;  // an awake body during a sweep

  [[nodiscard]] Body& body(std::int64_t id);
  [[nodiscard]] const Body& body(std::int64_t id) const;
  [[nodiscard]] Obstacle& obstacle(std::int64_t id);
  [[nodiscard]] Hinge& hinge(std::int64_t id);
  [[nodiscard]] const Hinge& hinge(std::int64_t id) const;
  [[nodiscard]] const Solid& solid(const SolidPair& pair) const;
  [[nodiscard]] HungCable& cable(std::int64_t id) const;
  void read_cables(double dt);
  void keep_swinging();
  void remove_ground();
  void wake_all();
  void wake_touching(const btCollisionObject& object);
  [[nodiscard]] std::vector<btPersistentManifold*> manifolds_of(const btCollisionObject& object,
                                                                const btCollisionObject* other = nullptr);
  void set_continuous(Body& body);
  [[nodiscard]] static BodyState read(const Body& body);
  void read_moved();

  void ignore(const SolidPair& pair, bool ignored);
  void forget_ignored_of(Touched::Kind kind, std::int64_t id);
  [[nodiscard]] bool still_to_pass(const Body& first, const Solid& other, bool other_moves, double dt) const;
  void release_separated(double dt);

  void gather_contacts();
  void account_pushes(std::span<const std::pair<BodyId, Vec3>> before, double dt);
  void resist_rolling();
  void let_settled_sleep(double dt);
  void hold_still();
  void let_go(Body& body);
  void let_go_struck(double dt);
  void let_go_unbalanced();
  void find_still(double dt);
  [[nodiscard]] std::vector<char> still_bodies();
  void read_forces(double dt);
  /// A body, and one that holds it up.
  struct Bearing {
    std::int64_t borne, bearer;
  };
  [[nodiscard]] std::vector<Bearing> bearings(std::vector<std::int64_t>& on_standing) const;
  void forget_contacts_of(Touched::Kind kind, std::int64_t id);
  [[nodiscard]] bool is_awake(const Contact& contact) const;

  [[nodiscard]] Motion motion_of(const Body& body, double dt) const;
  [[nodiscard]] static Mover mover_of(const Body& body, const Motion& motion, double duration);
  [[nodiscard]] std::vector<Mover> movers(double dt) const;
  static void find_touches(const Mover& mover, const Solid& other, const Motion& other_motion, double dt,
                           std::vector<Contact>& found);
  void sweep_pair(const Mover& mover, const Solid& other, const Motion& other_motion, double dt,
                  std::vector<Contact>& found) const;
  void sweep_ground(const Mover& mover, double dt, double least_speed, std::vector<Contact>& found) const;
  struct SweepRange {
    Sweep what;
    double dt, least_speed;
  };
  void sweep_standing(const Mover& mover, const SweepRange& range, std::vector<Contact>& found) const;
  void sweep_movers(const std::vector<Mover>& movers, const SweepRange& range, std::vector<Contact>& found) const;

  void read_hinge(Hinge& hinge, double dt) const;
  std::unique_ptr<btTypedConstraint> make_constraint(const HingeDescription& description, Body& body,
                                                     Body* other) const;

  // Order of destruction: solids leave before the world, the world before what it stands on.
  HalfSpaceContactsFactory polyhedron_first_{false}, plane_first_{true};
  PolyhedronContactsFactory polyhedra_contacts_;
  btDefaultCollisionConfiguration configuration_;
  AwakePairsDispatcher dispatcher_;
  btDbvtBroadphase broadphase_;
  IslandSolver solver_;
  FreeSpinWorld world_;

  std::vector<std::unique_ptr<Body>> bodies_;  ///< by id, which is never used again: null where one is gone
  std::map<std::int64_t, std::unique_ptr<Obstacle>> obstacles_;
  std::map<std::int64_t, std::unique_ptr<Hinge>> hinges_;
  std::map<std::int64_t, std::unique_ptr<HungCable>> cables_;
  std::vector<BodyId> order_;  ///< of the bodies that are there, ascending
  /// By id: as it was read last, and whether it is so still.
  struct Seen {
    BodyState state;
    bool holds = false;
  };
  mutable std::vector<Seen> seen_;
  mutable std::optional<std::size_t> awake_count_;  ///< none: to be counted
  double watched_for_ = 0;                          ///< s since the last look
  double looked_for_ = 0;                           ///< the same, for bodies that are still alone
  std::size_t held_count_ = 0;
  ContactForces forces_;
  std::int64_t next_obstacle_ = 0, next_hinge_ = 0, next_cable_ = 0;

  Solid ground_;
  PolyhedronStore polyhedra_;
  std::unique_ptr<btStaticPlaneShape> ground_shape_;
  std::unique_ptr<btCollisionObject> ground_object_;
  double ground_height_ = 0;

  std::set<SolidPair> ignored_;
  std::vector<Contact> touching_;       ///< of the last step; of two that sleep, of the last in which one was awake
  std::vector<Contact> contacts_;       ///< those of awake bodies
  std::vector<Contact> points_, next_;  ///< room that gather_contacts() works in
};

}  // namespace topple::collision
