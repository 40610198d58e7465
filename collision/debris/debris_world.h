#pragma once
// collision::World with a contact solver of its own. Its parts by file: bodies, obstacles, queries of state
// (debris_world), the step (debris_world_step), what touches and what is told of it (debris_world_contacts), rest
// (debris_world_rest), what stands and moves (debris_world_moving), sweeps and rays (debris_world_sweep), hinges and
// cables (debris_world_joints), copies (debris_world_copy).
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <utility>

#include "contacts/contact_forces.h"
#include "contacts/first_touch.h"
#include "contacts/near_pairs.h"
#include "contacts/pair_contacts.h"
#include "debris/debris_parts.h"
#include "debris/islands.h"
#include "solver/step_solver.h"

namespace topple::collision {

class DebrisWorld final : public World {
 public:
  explicit DebrisWorld(const SolverSettings& settings);
  ~DebrisWorld() override;
  DebrisWorld& operator=(const DebrisWorld&) = delete;
  [[nodiscard]] std::unique_ptr<World> copy() const override;
  void set_parallel_for(ParallelFor parallel_for, int threads) override {
    region_ = {std::move(parallel_for), threads};
  }

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
  [[nodiscard]] bool fell_asleep(BodyId body) const override { return this->body(body.value).slept_now; }
  void ignore_until_separated(BodyId body, const Touched& other) override;
  [[nodiscard]] std::span<const BodyId> bodies() const override { return order_; }
  [[nodiscard]] std::size_t awake_count() const override { return awake_count_; }
  [[nodiscard]] std::vector<Contact> sweep(double dt, Sweep what, double least_speed) override;
  void step(double dt) override;
  void step(double dt, int parts, MovingStructure& structure) override;
  [[nodiscard]] std::span<const Contact> contacts() const override { return contacts_; }
  [[nodiscard]] std::optional<RayHit> ray_cast(const Vec3& from, const Vec3& to) const override;
  [[nodiscard]] std::vector<ObstacleId> obstacles_in(const Vec3& low, const Vec3& high) const override;

 private:
  DebrisWorld(const DebrisWorld& of);
  struct Mover;  // an awake body during a sweep
  /// Awake bodies that touch or hang together.
  [[nodiscard]] DebrisBody& body(std::int64_t id) const;
  [[nodiscard]] DebrisObstacle& obstacle(std::int64_t id) const;
  [[nodiscard]] DebrisHinge& hinge(std::int64_t id) const;
  [[nodiscard]] DebrisCable& cable(std::int64_t id) const;
  [[nodiscard]] const Solid& solid(const SolidPair& pair) const;

  // Bodies.
  static void place(DebrisBody& body, const Pose& pose);
  void fall_asleep(DebrisBody& body);
  void wake_up(DebrisBody& body);
  void wake_all();
  void wake_touching(const Solid& solid);
  [[nodiscard]] static Box3 bounds_of(const PartShape& shape, const Placement& at);

  // The step.
  void advance(double dt, int parts, MovingStructure* structure);
  void begin_step(double dt);
  [[nodiscard]] int parts_of_step(double dt) const;
  void read_velocities_by(const Vec3& more);
  void fall_asleep_where_held(double dt);
  void move_on(double dt);
  void update_bounds(double dt);
  void note_ways(double dt);
  void find_touching();
  void find_contacts(double dt);
  void seek_contacts();
  [[nodiscard]] double margin_of(const Collider& a, const Collider& b) const;
  [[nodiscard]] bool is_due(const PairEnds& ends) const;
  void seek(std::uint32_t index);
  void wake_struck(double dt);
  void wake_hinged();
  void wake_round(DebrisBody& struck, double momentum);
  [[nodiscard]] bool awake(const NearPair& pair) const;
  void gather_islands();
  [[nodiscard]] int substeps(const Island& island, double dt) const;
  void solve(std::span<Island* const> islands, int substeps, double dt);
  /// Calls work(body) for all that the solver holds, side by side.
  template <class Work>
  void each_solved(const Work& work);
  static void order_in_space(std::vector<DebrisBody*>& bodies);
  void fill_solver(std::span<Island* const> islands, double dt, int substeps);
  [[nodiscard]] SolverContact solver_contact(std::uint32_t index);
  void add_contacts(const Island& island);
  void fly(DebrisBody& body, double dt) const;
  void take_results(double dt);
  void turn(DebrisBody& body, const Vec3& turned, double dt) const;
  void resist_rolling();

  // What stands and moves.
  void place_moving(double dt, MovingStructure& structure);
  void place(DebrisObstacle& obstacle, const ObstacleMotion& motion, double dt);
  void learn(DebrisObstacle& obstacle, const ObstacleMotion& now, const Vec3& force, const Vec3& moment) const;
  void hand_over(double dt, std::size_t told, MovingStructure& structure);
  void stand_still(DebrisObstacle& obstacle);
  void add_moving(const Island& island, double dt, double substep);
  void press_moving(double dt);
  void wake_carried();

  // Contacts.
  void tell_contacts(double dt, std::span<const char> left_out = {});
  [[nodiscard]] bool touches(const SolverContact& solved);
  void tell(const SolverContact& solved, double dt, Contact& contact) const;
  void place(const SolverContact& solved, double dt, Contact& contact) const;
  void account_work(std::span<Island* const> islands, double dt);
  [[nodiscard]] DebrisBody* moving(const SolverContact& solved, bool second) const;
  void merge_contacts();
  [[nodiscard]] double energy(const DebrisBody& body, double dt) const;
  void forget_contacts_of(Touched::Kind kind, std::int64_t id);
  void mark_persistent(std::vector<Contact>& found) const;
  void ignore(const SolidPair& pair, bool ignored);
  void forget_ignored_of(Touched::Kind kind, std::int64_t id);
  [[nodiscard]] bool ignores(const Solid& first, const Solid& second) const;
  [[nodiscard]] bool still_to_pass(const DebrisBody& first, const Solid& other, bool other_moves, double dt) const;
  void release_separated(double dt, bool about_to_step);
  [[nodiscard]] static bool separated(const Solid& first, const Solid& second);

  // Rest.
  void look_for_rest(double dt);
  [[nodiscard]] bool come_to_rest(Island& island, double dt);
  [[nodiscard]] Island quiet_part(const Island& island) const;
  [[nodiscard]] Island with_sleeping(const Island& island) const;
  [[nodiscard]] Island awake_on(const Island& whole) const;
  void wake_changed(double dt);
  [[nodiscard]] bool swings(const DebrisBody& body) const;

  // Sweeps.
  [[nodiscard]] Motion motion_of(const DebrisBody& body, double dt) const;
  [[nodiscard]] std::vector<Mover> movers(double dt) const;
  [[nodiscard]] static Mover mover_of(const DebrisBody& body, const Motion& motion, double duration);
  struct SweepRange {
    Sweep what;
    double dt, least_speed;
  };
  struct Met;
  static void find_touches(const Mover& mover, const Met& other, const SweepRange& range, std::vector<Contact>& found);
  void sweep_pair(const Mover& mover, const Met& other, const SweepRange& range, std::vector<Contact>& found) const;
  void sweep_ground(const Mover& mover, const SweepRange& range, std::vector<Contact>& found) const;
  void sweep_standing(const Mover& mover, const SweepRange& range, std::vector<Contact>& found) const;
  void sweep_movers(const std::vector<Mover>& movers, const SweepRange& range, std::vector<Contact>& found) const;

  void read_joints(std::span<Island* const> islands, double dt);

  SolverSettings settings_;
  Vec3 gravity_ = Vec3::Zero();
  std::vector<std::unique_ptr<DebrisBody>> bodies_;  ///< by id, which is never used again: null where one is gone
  std::map<std::int64_t, std::unique_ptr<DebrisObstacle>> obstacles_;
  std::map<std::int64_t, std::unique_ptr<DebrisHinge>> hinges_;
  std::map<std::int64_t, std::unique_ptr<DebrisCable>> cables_;
  std::vector<std::int64_t> moving_obstacles_;  ///< ascending
  std::vector<BodyId> order_;                   ///< of the bodies that are there, ascending
  std::size_t awake_count_ = 0;
  std::int64_t next_obstacle_ = 0, next_hinge_ = 0, next_cable_ = 0;

  Solid ground_;
  bool has_ground_ = false;
  double ground_height_ = 0, ground_friction_ = 0, ground_restitution_ = 0;
  PolyhedronStore polyhedra_;
  NearPairs pairs_;
  std::map<SolidPair, bool> ignored_;            ///< true: told again since the last step, and for the next in any case
  std::map<SolidPair, std::uint64_t> released_;  ///< after which step

  ParallelRegion region_;
  StepSolver solver_;
  std::vector<DebrisBody*> solving_;     ///< bodies that the solver holds: the first is its number 1
  std::vector<std::uint32_t> touching_;  ///< pairs that have contacts, in order
  std::vector<std::uint32_t> due_;       ///< pairs to be looked at in this step, in order
  std::vector<Island> islands_;
  std::vector<std::int64_t> slept_now_;               ///< bodies that fell asleep in this step
  std::vector<std::pair<NearPair*, Vec3>> impulses_;  ///< of the last part of a step, N s, where any body sleeps
  std::uint64_t step_number_ = 0;
  int parts_ = 1;                ///< of this step
  Vec3 reading_ = Vec3::Zero();  ///< by which velocities are read otherwise than between steps
  bool stepping_ = false;        ///< a structure moves on between two parts of a step
  std::vector<Contact> contacts_;
};

}  // namespace topple::collision
