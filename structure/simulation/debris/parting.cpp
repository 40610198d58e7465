#include "simulation/debris/parting.h"

#include <algorithm>
#include <optional>
#include <vector>

namespace topple::structure {
namespace {

struct Side {
  collision::BodyId id;
  double mass = 0;
  Mat3 inverse_inertia = Mat3::Zero();
  Vec3 arm = Vec3::Zero();  ///< from its centre to the contact's point
};

Side side_of(const Debris& debris, const Body& body, const Vec3& point) {
  const collision::BodyState state = debris.scene.world->state(body.id);
  return {body.id, body.rest.mass, world_inertia(body, state.pose.orientation).inverse(), point - state.pose.position};
}

struct Parting {
  Side pushes, parts;
  Vec3 point, normal;
  double most = 0;        ///< N s that may go back
  double allowed = 0;     ///< m/s
  double given_back = 0;  ///< N s
  double mass = 0;        ///< effective, kg
};

Vec3 point_velocity(const Debris& debris, const Side& side) {
  const collision::BodyState state = debris.scene.world->state(side.id);
  return state.velocity + state.angular_velocity.cross(side.arm);
}

/// Nothing where one of the two is no body (any more).
std::optional<Parting> parting_of(const Debris& debris, const PartingContact& one, double restitution) {
  const collision::Contact& contact = one.contact;
  const double pushed = contact.impulse.dot(contact.normal);
  const std::int64_t number = debris.body_of(one.part);
  const Body* const pushes = debris.find(contact.body);
  const Body* const parts = number < 0 ? nullptr : debris.find({number});
  if (!(pushed > 0) || !pushes || !parts) return std::nullopt;
  Parting made{side_of(debris, *pushes, contact.point), side_of(debris, *parts, contact.point), contact.point,
               contact.normal, pushed};
  made.mass = 1 / (1 / effective_mass(made.pushes.mass, made.pushes.inverse_inertia, made.pushes.arm, made.normal) +
                   1 / effective_mass(made.parts.mass, made.parts.inverse_inertia, made.parts.arm, made.normal));
  // The body as it came: without what this contact did to it.
  const Vec3 turned = made.pushes.inverse_inertia * made.pushes.arm.cross(contact.impulse);
  const Vec3 came = debris.scene.reading().true_velocity(point_velocity(debris, made.pushes)) +
                    contact.impulse / made.pushes.mass + turned.cross(made.pushes.arm);
  made.allowed = restitution * std::max(0.0, (came - one.velocity).dot(made.normal));
  return made;
}

}  // namespace

double limit_parting(Debris& debris, std::span<const PartingContact> contacts, double restitution) {
  std::vector<Parting> found;
  for (const PartingContact& one : contacts)
    if (const auto made = parting_of(debris, one, restitution)) found.push_back(*made);
  double lost = 0;
  // One at a time, and again: several push one part. What is left after these is below a hundredth of what there was.
  constexpr int passes = 10;
  for (int pass = 0; pass < passes; ++pass)
    for (Parting& one : found) {
      const double apart = (point_velocity(debris, one.parts) - point_velocity(debris, one.pushes)).dot(one.normal);
      const double back = std::clamp(one.given_back + one.mass * (apart - one.allowed), 0.0, one.most);
      const double more = back - one.given_back;
      if (more == 0) continue;
      one.given_back = back;
      debris.scene.world->apply_impulse(one.parts.id, -more * one.normal, one.point);
      debris.scene.world->apply_impulse(one.pushes.id, more * one.normal, one.point);
      lost += more * apart - more * more / (2 * one.mass);
    }
  return lost;
}

}  // namespace topple::structure
