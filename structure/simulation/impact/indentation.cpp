#include "simulation/impact/indentation.h"
#include "simulation/impact/impact_settings.h"

#include <algorithm>
#include <cmath>

namespace topple::structure {

Indentation::Indentation(double body_mass, double approach_speed, double weight, double structure_mass)
    : mass_(body_mass + structure_mass),
      weight_(weight),
      speed_(approach_speed * body_mass / (body_mass + structure_mass)),
      lost_at_contact_(body_mass * structure_mass / (body_mass + structure_mass) * approach_speed * approach_speed /
                       2) {}

Indentation::Stop Indentation::push(double compliance, double failure_force) {
  compliance_ = compliance;
  force_ = 0;
  if (depth_ < unloaded_) {
    if (unloaded_ > impact_settings.largest_depth) return Stop::missed;
    const double squared = speed_ * speed_ + 2 * weight_ * (unloaded_ - depth_) / mass_;
    if (squared < 0) return Stop::missed;
    speed_ = std::sqrt(squared);
    depth_ = unloaded_;
  }
  force_ = (depth_ - unloaded_) / compliance_;
  if (force_ >= failure_force) return Stop::failed;

  const double excess = force_ - weight_;
  const double stopping_force = weight_ + std::sqrt(excess * excess + mass_ * speed_ * speed_ / compliance_);
  const double deepest_force = std::max(force_, (impact_settings.largest_depth - unloaded_) / compliance);
  const double end_force = std::min({stopping_force, failure_force, deepest_force});
  const double travel = (end_force - force_) * compliance_;
  const double squared =
      speed_ * speed_ + (2 * weight_ * travel - (end_force * end_force - force_ * force_) * compliance_) / mass_;
  depth_ += travel;
  force_ = end_force;
  peak_force_ = std::max(peak_force_, force_);
  if (end_force < std::min(stopping_force, failure_force)) {
    speed_ = std::sqrt(std::max(0.0, squared));
    return Stop::missed;
  }
  if (failure_force <= stopping_force) {
    speed_ = std::sqrt(std::max(0.0, squared));
    return Stop::failed;
  }
  speed_ = 0;
  return Stop::stood;
}

double Indentation::stored(double compliance) const {
  const double pressed = std::max(0.0, depth_ - unloaded_);
  return pressed * pressed / (2 * compliance);
}

double Indentation::elastic_rebound_speed() const {
  const double squared = (force_ * force_ - 2 * weight_ * force_) * compliance_ / mass_;
  return squared > 0 ? std::sqrt(squared) : 0;
}

}  // namespace topple::structure
