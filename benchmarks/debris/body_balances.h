#pragma once
// Whether the forces that a world tells are true: of each body, what its contacts and its weight come to beside what
// its momentum did; and of what sleeps, the last that it was told to press with beside its weight. In shares of its
// weight, moments in shares of weight times the distance of its farthest corner.
#include <array>
#include <map>
#include <optional>
#include <vector>

#include "scenes.h"

namespace topple::bench {

/// Over bodies, and while they are awake over times of half a second.
struct Residuals {
  double worst_force = 0, worst_moment = 0;
  double squares_force = 0, squares_moment = 0;
  std::size_t count = 0;
  void add(double force, double moment);
  [[nodiscard]] double rms_force() const;
  [[nodiscard]] double rms_moment() const;
};

class BodyBalances {
 public:
  explicit BodyBalances(const DebrisScene& scene) : scene_(scene) {}
  /// Before and after each step, with the bodies that are there.
  void begin_step(const DebrisRun& run, const collision::World& world);
  void end_step(const DebrisRun& run, const collision::World& world);
  /// Of bodies that stayed awake for half a second on end.
  [[nodiscard]] const Residuals& awake() const { return awake_; }
  /// Of bodies that sleep now.
  [[nodiscard]] Residuals asleep(const DebrisRun& run, const collision::World& world) const;
  /// kg m/s: the largest sum, over bodies awake, of momentum that no told impulse accounts for. Between two of them
  /// impulses cancel.
  [[nodiscard]] double lost_momentum() const { return lost_momentum_; }
  /// Where no gravity acts and nothing stands: the largest change of angular momentum about the origin, as a share of
  /// the sum of mass, speed and distance at the beginning.
  [[nodiscard]] double lost_angular_momentum() const { return lost_angular_; }
  /// kg m/s: the largest sum of mass times speed.
  [[nodiscard]] double most_motion() const { return most_motion_; }

 private:
  static constexpr int kWindow = 30;  // steps: half a second
  struct Body {
    double mass = 0, weight = 0, reach = 0;
    Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
    bool was_awake = false;
    int steps = 0;  ///< of the window that have passed
    Eigen::Vector3d momentum = Eigen::Vector3d::Zero(), spin_momentum = Eigen::Vector3d::Zero(),
                    position = Eigen::Vector3d::Zero();                                 ///< when the step began
    Eigen::Vector3d force = Eigen::Vector3d::Zero(), moment = Eigen::Vector3d::Zero();  ///< unaccounted for, N s, N m s
    Eigen::Vector3d told = Eigen::Vector3d::Zero(), told_moment = Eigen::Vector3d::Zero();  ///< of this step
  };
  using Key = std::array<std::int64_t, 5>;  ///< body, its part; kind, number and part of what it touches
  void add_told(const collision::Contact& contact, std::vector<Body>& bodies) const;
  void follow_angular_momentum();
  void keep(const collision::Contact& contact);
  void keep_pressing(const collision::World& world);

  const DebrisScene& scene_;
  std::vector<Body> bodies_;
  std::map<Key, collision::Contact> pressing_;  ///< between what sleeps and what sleeps or stands
  std::vector<collision::Contact> before_;      ///< told in the last step
  Residuals awake_;
  Eigen::Vector3d unaccounted_ = Eigen::Vector3d::Zero();
  std::optional<Eigen::Vector3d> angular_begun_;
  double angular_scale_ = 0;
  double lost_momentum_ = 0, lost_angular_ = 0, most_motion_ = 0;
};

}  // namespace topple::bench
