#pragma once
// What falls: scenes of debris in the open, as worlds of their own.
#include <memory>
#include <string>
#include <vector>

#include "convex_solid.h"
#include "topple/collision/world.h"

namespace topple::bench {

inline constexpr double kDebrisStep = 1.0 / 60, kDebrisGravity = 9.81;  // s, m/s2

/// A solid that takes part from a step on.
struct FallingSolid {
  std::size_t shape = 0;  ///< of the scene
  double density = 2500;  ///< kg/m3
  collision::Pose pose;
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero(), spin = Eigen::Vector3d::Zero();  ///< as BodyState's
  int from_step = 0;
};

/// A box that stands.
struct StandingSolid {
  std::size_t shape = 0;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  double friction = 0.6;
};

struct DebrisScene {
  std::string name, what;
  std::vector<ConvexSolid> shapes;
  std::vector<FallingSolid> falling;  ///< by from_step
  std::vector<StandingSolid> standing;
  bool ground = true;   ///< the half space below z = 0
  bool gravity = true;  ///< kDebrisGravity downwards
  double seconds = 20;
};

/// In the order in which they are measured: cheap ones first.
[[nodiscard]] std::vector<std::string> debris_scene_names();
/// Places and turns by chance follow from `seed`. Throws std::invalid_argument for a name that is none of the above.
[[nodiscard]] DebrisScene debris_scene(const std::string& name, unsigned seed);

/// The scene's bodies, added as their steps come.
class DebrisRun {
 public:
  DebrisRun(const DebrisScene& scene, std::unique_ptr<collision::World> world);
  /// Adds what begins with step `number`; true when anything did.
  bool begin_step(int number);
  void step() { world_->step(kDebrisStep); }
  [[nodiscard]] collision::World& world() { return *world_; }
  /// Those that are there, in the order of the scene's `falling`.
  [[nodiscard]] const std::vector<collision::BodyId>& bodies() const { return bodies_; }
  [[nodiscard]] bool all_there() const { return bodies_.size() == scene_.falling.size(); }

 private:
  const DebrisScene& scene_;
  std::unique_ptr<collision::World> world_;
  std::vector<collision::BodyId> bodies_;
};

}  // namespace topple::bench
