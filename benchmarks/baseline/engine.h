#pragma once
// What every way of holding the scene up with Bullet can be asked.
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "scene.h"

namespace baseline {

struct Method {
  std::string solver = "si";  // si, nncg, pgs, dantzig, lemke, featherstone
  int iterations = 10;
  int substeps = 1;  // of one step
  double step = 1.0 / 60;
  double compliance = 0;  // constraint force mixing of the joints; 0: Bullet's default
};

/// What one joint did in the last step, as SceneJoint::force: mean over its substeps.
using JointForce = std::array<double, 6>;

class Engine {
 public:
  virtual ~Engine() = default;
  virtual void step() = 0;
  [[nodiscard]] virtual double mean_roof_sag() const = 0;
  /// In the order of Scene::joints.
  [[nodiscard]] virtual std::vector<JointForce> joint_forces() const = 0;
  /// Steps (substeps) in which a direct MLCP solver failed and Bullet went on with sequential impulse by itself.
  [[nodiscard]] virtual int silent_fallbacks() const { return 0; }
  /// Joints of the scene that this way cannot hold.
  [[nodiscard]] virtual int joints_left_out() const { return 0; }
  [[nodiscard]] bool finite() const { return std::isfinite(mean_roof_sag()); }
};

/// Of a push at a step, counted from 0.
[[nodiscard]] inline double push_factor(int step) { return step % 2 == 0 ? 1.5 : 0.5; }

}  // namespace baseline
