#include "simulation/debris/release_impulses.h"

namespace topple::structure {

bool ReleaseImpulses::struck(const ReleaseImpulse& given, const Body& one) {
  return given.part.member.valid()
             ? std::binary_search(one.members.begin(), one.members.end(), given.part.member)
             : std::find(one.panels.begin(), one.panels.end(), given.part.panel) != one.panels.end();
}

const ReleaseImpulse* ReleaseImpulses::first_on(const Body& one) const {
  const auto found =
      std::find_if(all_.begin(), all_.end(), [&](const ReleaseImpulse& given) { return struck(given, one); });
  return found == all_.end() ? nullptr : &*found;
}

std::vector<collision::BodyId> ReleaseImpulses::breakers_of(const Body& one, const Bodies& bodies) const {
  std::vector<collision::BodyId> passing;
  for (const ReleaseImpulse& given : all_)
    if (struck(given, one) && bodies.contains(given.by.value)) passing.push_back(given.by);
  return passing;
}

void ReleaseImpulses::apply(const Body& one, Vec3& velocity, Vec3& spin, Ledger& ledger) const {
  for (const ReleaseImpulse& given : all_) {
    if (!struck(given, one)) continue;
    const Vec3 r = given.point - one.rest.centre;
    const Mat3 inverse = one.rest.inertia.inverse();
    const double size = given.impulse.norm();
    if (size == 0) continue;
    const Vec3 n = given.impulse / size;
    const double mass = effective_mass(one.rest.mass, inverse, r, n);
    const Vec3 impulse = std::min(size, mass * given.speed) * n;
    velocity += impulse / one.rest.mass;
    spin += inverse * r.cross(impulse);
    ledger.lost_in_impacts -= impulse.squaredNorm() / mass / 2;
  }
}

void ReleaseImpulses::add_to(Momentum& sum, const Body& one, const Vec3& centre) const {
  const Mat3 inverse = one.rest.inertia.inverse();
  for (const ReleaseImpulse& given : all_) {
    const double size = given.impulse.norm();
    if (!struck(given, one) || size == 0) continue;
    const Vec3 r = given.point - one.rest.centre, n = given.impulse / size;
    const Vec3 impulse = std::min(size, effective_mass(one.rest.mass, inverse, r, n) * given.speed) * n;
    sum.add_impulse(impulse, centre + r);
  }
}

}  // namespace topple::structure
