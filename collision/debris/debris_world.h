#pragma once
// collision::World with a contact solver of its own: a facade over the scene (DebrisScene) and the parts that work on
// it, in the order of a step: what stands and moves (MovingObstacles), what touches (PairSearch), what is woken
// (Waking) or falls asleep (DebrisRest), islands in the solver (SolvedIslands), what is reported of contacts
// (ContactReport); and over first touches to come (body_sweep.h) and rays (scene_queries.h). It has more than forty
// functions, as World has thirty; each of those is a few lines.
#include <memory>
#include <optional>
#include <utility>

#include "debris/debris_rest.h"
#include "debris/waking.h"
#include "shapes/polyhedron_store.h"

namespace topple::collision {

class DebrisWorld final : public World {
 public:
  explicit DebrisWorld(const SolverSettings& settings);
  ~DebrisWorld() override;
  DebrisWorld& operator=(const DebrisWorld&) = delete;
  [[nodiscard]] std::unique_ptr<World> copy() const override;
  void save_state(std::ostream& to) const override;
  void load_state(std::istream& from) override;
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
  [[nodiscard]] Vec3 velocity_when_woken(BodyId body) const override { return scene_.body(body.value).wakes_with; }
  void ignore_until_separated(BodyId body, const Touched& other) override;
  [[nodiscard]] std::span<const BodyId> bodies() const override { return scene_.order; }
  [[nodiscard]] std::size_t awake_count() const override { return scene_.awake_count; }
  [[nodiscard]] std::vector<Contact> sweep(double dt, const SweepOptions& options) override;
  void step(double dt) override;
  void step(double dt, int parts, MovingStructure& structure) override;
  [[nodiscard]] bool steps_in_parts() const override { return true; }
  [[nodiscard]] std::span<const Contact> contacts() const override { return report_.all(); }
  [[nodiscard]] std::optional<RayHit> ray_cast(const Vec3& from, const Vec3& to) const override;
  [[nodiscard]] std::vector<ObstacleId> obstacles_in(const Vec3& low, const Vec3& high) const override;

 private:
  DebrisWorld(const DebrisWorld& of);

  void advance(double dt, int parts, MovingStructure* structure);
  void begin_step(double dt);
  [[nodiscard]] int parts_for_spins(double dt) const;
  void read_velocities_by(const Vec3& more);
  void find_contacts(double dt);
  void gather_islands();
  void move_on(double dt);
  void solve(std::span<Island* const> islands, int substeps, double dt);
  void update_moving(double dt, MovingStructure& structure);
  void advance_structure(double dt, std::size_t told, MovingStructure& structure);
  void remove_contacts_of(Touched::Kind kind, std::int64_t id);
  void wake_hung_at(const DebrisObstacle& holder);
  void let_go_of(const DebrisObstacle& holder);
  std::int64_t next_obstacle_ = 0, next_hinge_ = 0, next_cable_ = 0;
  PolyhedronStore polyhedra_;

  DebrisScene scene_;
  IgnoredPairs ignored_;
  ParallelRegion region_;
  PairSearch search_;
  Waking waking_;
  MovingObstacles moving_;
  SolvedIslands solved_;
  ContactReport report_;
  DebrisRest rest_;
  std::vector<Island> islands_;
  std::vector<Waking::Push> pushes_;  ///< of the last part of a step, where any body sleeps
  int parts_ = 1;                     ///< of this step
  bool stepping_ = false;             ///< a structure moves on between two parts of a step
};

}  // namespace topple::collision
