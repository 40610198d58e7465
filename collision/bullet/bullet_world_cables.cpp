// Cables from a point in space to a body.
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "bullet/bullet_world.h"

namespace topple::collision {

namespace {
/// Share of its length by which a body may be given farther away than its cable reaches: what a decimal number rounds.
constexpr double rounded_off = 1e-3;
/// A ball this near to its plumb line (m) may come to rest.
constexpr double plumb = 0.02;
}  // namespace

CableId BulletWorld::add_cable(const CableDescription& description) {
  const std::string name = "cable " + std::to_string(next_cable_);
  Body& hung = body(description.body.value);
  if (!description.anchor.allFinite() || !(description.length > 0) || !std::isfinite(description.length))
    throw std::invalid_argument(name + ": its anchor must be finite and its length above zero");
  const double away = (from_bullet(hung.rigid->getCenterOfMassPosition()) - description.anchor).norm();
  if (away > (1 + rounded_off) * description.length)
    throw std::invalid_argument(name + ": the body is " + std::to_string(away) + " m from its anchor; it is " +
                                std::to_string(description.length) + " m long");
  auto cable = std::make_unique<HungCable>(*hung.rigid, to_bullet(description.anchor), description.length);
  cable->body = hung.id;
  world_.addConstraint(&cable->constraint, false);
  world_.hold_after_solving(&cable->constraint);
  wake(description.body);
  cables_.emplace(next_cable_, std::move(cable));
  return {next_cable_++};
}

HungCable& BulletWorld::cable(std::int64_t id) const {
  const auto found = cables_.find(id);
  if (found == cables_.end()) throw std::out_of_range("cable " + std::to_string(id) + " is not in the world");
  return *found->second;
}

void BulletWorld::remove_cable(CableId id) {
  HungCable& gone = cable(id.value);
  world_.removeConstraint(&gone.constraint);
  world_.let_go(&gone.constraint);
  wake({gone.body});
  cables_.erase(id.value);
}

CablePull BulletWorld::cable_pull(CableId id) const { return cable(id.value).pull; }

/// A ball at the end of its swing is slow and seems to go nowhere, but does not rest.
void BulletWorld::keep_swinging() {
  for (auto& [id, cable] : cables_) {
    Body& hung = body(cable->body);
    const bool touches = std::any_of(contacts_.begin(), contacts_.end(), [&](const Contact& contact) {
      return contact.body.value == hung.id || contact.other.body.value == hung.id;
    });
    const btVector3 down = world_.getGravity().length2() > 0 ? world_.getGravity().normalized() : btVector3(0, 0, -1);
    const btVector3 arm = hung.rigid->getCenterOfMassPosition() - cable->constraint.anchor();
    hung.swings = !touches && (arm - down * down.dot(arm)).length() > plumb;
    if (hung.swings) hung.rigid->setDeactivationTime(0);
  }
}

void BulletWorld::read_cables(double dt) {
  for (auto& [id, cable] : cables_) {
    const Body& hung = body(cable->body);
    if (!hung.rigid->isActive()) {  // asleep: it hangs as it did
      cable->pull.work_lost = 0;
      continue;
    }
    const SolverVelocities& velocities = hung.velocities;
    const btVector3 mean = (velocities.linear_before + velocities.linear_after) / 2;
    cable->pull.tension = cable->constraint.impulse() / dt;
    cable->pull.work_lost = cable->constraint.impulse() * cable->constraint.direction().dot(mean);
  }
}

}  // namespace topple::collision
