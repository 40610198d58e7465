// A hit that punches a hole in a panel that stands and moves. The law of impact for one contact (impact.h), with the
// panel's own bending and its nodes' mass; the force that punches it (standing_fracture.h) ends the push where no joint
// of it fails before. What the push gave until then goes to the panel's nodes; what breaks out is taken along.
#include <algorithm>
#include <cmath>

#include "model/index_of.h"
#include "simulation/impact/standing_impacts.h"

namespace topple::structure {

/// Whether a joint of the struck part fails before the push comes to this force.
bool StandingImpacts::joint_fails_below(const StandingFrame::HeldResponse& response, double force) const {
  for (const auto& [joint, columns] : response.demands) {
    const JointCapacity& capacity = scene_.building[joint].capacity;
    if (!capacity.breakable || !scene_.frame->intact(joint)) continue;
    const Vec6 demand = scene_.frame->demand(joint) + force * columns.col(0);
    if (utilisation(capacity, demand, scene_.strength_factors[index_of(joint)]).value >= 1) return true;
  }
  return false;
}

bool StandingImpacts::punch_moving(const collision::Contact& contact) {
  std::optional<Strike> hit = aim(contact);
  if (!hit) return false;
  const double punching = fracture_.punching_force(*hit);
  if (punching == unlimited) return false;
  const StandingFrame::HeldResponse response = scene_.frame->respond_held({&hit->place, 1}, {&hit->normal, 1});
  const double makes_way = response.speed(0);
  const double came = hit->speed, closing = came - makes_way;
  if (!(closing > 0)) return false;

  hit->speed = closing;
  double left = fracture_.speed_through(*hit, punching);  // against the panel; one that fast feels nothing else
  if (!(left > 0)) {
    const double mass = 1 / (1 / hit->mass + response.mobility(0, 0)), compliance = response.compliance(0, 0);
    const double weight = mass * scene_.gravity.dot(hit->normal);
    if (!(compliance > 0) || weight + std::sqrt(weight * weight + mass * closing * closing / compliance) < punching ||
        joint_fails_below(response, punching))
      return false;
    left = std::sqrt(std::max(0.0, closing * closing - (punching - 2 * weight) * punching * compliance / mass));
    left = std::min(left, closing);  // its weight does its work on the way that follows, and not twice
    // Of both sides together: the body keeps its share of what the panel's nodes take.
    left = closing - (closing - left) * mass / hit->mass;
  }
  const double impulse = hit->mass * (closing - left);
  const double given = scene_.frame->strike(response, Eigen::VectorXd::Constant(1, impulse));
  const double plug = fracture_.break_out(*hit);
  hit->through = plug > 0;
  hit->peak_force = punching;
  hit->speed = came;
  const double alone = makes_way + left;
  hit->speed_out = plug > 0 ? (alone * hit->mass + hit->chunk_speed * plug) / (hit->mass + plug) : alone;
  record_loss(*hit);
  hit->lost -= given;
  set_motion_after(*hit);
  fracture_.push_chunks(*hit);
  record_impact(*hit);
  return true;
}

}  // namespace topple::structure
