#include <algorithm>
#include <cmath>

#include "simulation/debris/momentum.h"
#include "simulation/impact/first_failure.h"
#include "simulation/impact/impact_settings.h"
#include "simulation/impact/standing_impacts.h"
#include "simulation/step_clock.h"

namespace topple::structure {

namespace {
/// Speed with which a body goes on. It goes on from where it touched: where its weight did more on the way in than what
/// broke took, it does that work on the way that follows, and not twice.
double let_through(double speed_in, const Indentation& pushing) { return std::min(pushing.speed(), speed_in); }

/// The contacts from `from` on that strike with it: of the same body, on other standing parts.
std::vector<const collision::Contact*> at_one_instant(std::span<const collision::Contact> contacts, std::size_t from) {
  const collision::Contact& first = contacts[from];
  std::vector<const collision::Contact*> found{&first};
  for (std::size_t i = from + 1; i < contacts.size(); ++i) {
    const collision::Contact& next = contacts[i];
    if (next.body != first.body || next.other.kind != first.other.kind) continue;
    if ((next.time - first.time) * next.approach_speed > impact_settings.touching) continue;
    if (std::none_of(found.begin(), found.end(),
                     [&](const collision::Contact* one) { return one->other.obstacle == next.other.obstacle; }))
      found.push_back(&next);
  }
  return found;
}
}  // namespace

StandingImpacts::StandingImpacts(const Sources& sources)
    : scene_(sources.scene),
      log_(sources.log),
      sums_(sources.sums),
      debris_(sources.debris),
      panels_(sources.panels),
      fracture_(sources.fracture),
      release_impulses_(sources.release_impulses),
      struck_(sources.struck) {}

void StandingImpacts::strike_all(const std::vector<collision::Contact>& contacts) {
  if (scene_.sways()) return;  // strike_bodies.cpp: what moves is struck as bodies are
  std::vector<collision::Contact> impacts;
  for (const collision::Contact& contact : contacts) {
    if (contact.other.kind != collision::Touched::Kind::obstacle) continue;
    if (contact.approach_speed > (contact.persistent ? impact_settings.least_speed : impact_settings.lies_down))
      impacts.push_back(contact);
  }
  std::vector<char> done(impacts.size(), 0);
  for (std::size_t i = 0; i < impacts.size(); ++i) {
    if (done[i] != 0) continue;
    const std::vector<const collision::Contact*> together = at_one_instant(impacts, i);
    if (together.size() > 1 && strike_together(together)) {
      for (const collision::Contact* one : together) done[static_cast<std::size_t>(one - impacts.data())] = 1;
    } else {
      strike(impacts[i]);
    }
  }
}

void StandingImpacts::strike(const collision::Contact& contact) {
  std::optional<Strike> hit = aim(contact);
  if (!hit) return;
  run_impact(*hit);
  set_motion_after(*hit);
  fracture_.push_chunks(*hit);
  record_impact(*hit);
}

void StandingImpacts::record_impact(const Strike& hit) {
  SimulationEvent& event = log_.record(SimulationEvent::Kind::impact, part_name(scene_.building, hit.part));
  event.body = hit.body->id;
  event.body_name = hit.body->name;
  event.mass = hit.mass;
  event.peak_force = hit.peak_force;
  event.speed_in = hit.speed;
  event.speed_out = hit.speed_out;
  event.position = hit.place.point;
  for (const JointBreak& broken : hit.breaks) log_.record(broken);
}

/// Nothing when the contact is no impact any more: what it would hit has fallen, or an earlier impact of this step has
/// stopped the body.
std::optional<Strike> StandingImpacts::aim(const collision::Contact& contact) {
  const Part part = debris_.obstacles.part_of(contact.other.obstacle);
  Body* hitting = debris_.find(contact.body);
  if (!part.valid() || !hitting || !scene_.stands(part)) return std::nullopt;
  // What was swept may have been broken out since.
  if (const BrokenPanel* left = part.panel.valid() ? panels_.broken(part.panel) : nullptr)
    if (debris_.obstacles.obstacle_of(part) != contact.other.obstacle && !left->holds(contact.point))
      return std::nullopt;
  Strike hit;
  hit.body = hitting;
  hit.part = part;
  hit.place = {part.member, part.panel, contact.point};
  hit.normal = contact.normal;
  hit.swept_at = contact.time;
  hit.state = scene_.world->state(hitting->id);
  hit.state.velocity = scene_.reading().true_velocity(hit.state.velocity);

  double time = contact.time;
  if (const auto earlier = struck_.find(hitting->id.value); earlier != struck_.end()) {
    // After an impact the body is slower (or stopped where it was): the rest of its way takes as much longer.
    const Vec3 r = contact.point - hit.state.pose.position;
    const double now = (hit.state.velocity + hit.state.angular_velocity.cross(r)).dot(contact.normal);
    if (now <= 0) return std::nullopt;
    time = earlier->second.base + (contact.time - earlier->second.at) * std::max(1.0, contact.approach_speed / now);
    if (time > scene_.scenario.step) return std::nullopt;  // swept again in the next step
  }
  hit.own_time = time;
  hit.state.pose.position += hit.state.velocity * time + scene_.gravity * (time * time / 2);
  hit.state.pose.orientation = turned(hit.state.pose.orientation, hit.state.angular_velocity * time);
  hit.state.velocity += scene_.gravity * time;

  const Vec3 r = contact.point - hit.state.pose.position;
  hit.speed = (hit.state.velocity + hit.state.angular_velocity.cross(r)).dot(hit.normal);
  if (hit.speed <= 0 && !scene_.sways()) return std::nullopt;  // what moves may come upon it
  const Mat3 inverse = world_inertia(*hitting, hit.state.pose.orientation).inverse();
  hit.mass = effective_mass(hitting->rest.mass, inverse, r, hit.normal);
  return hit;
}

/// A body that is let go stays where it is: what its weight would have done further in is not its own.
double StandingImpacts::rebound(const Indentation& pushing) const {
  return -scene_.scenario.impact.restitution * pushing.elastic_rebound_speed();
}

/// Whether what is hit provably bears the push: the joints that bear it directly do not fail, and the energy is less
/// than any other joint fails at. A lower bound of the mass that takes part makes the push harder than it is, so what
/// is told of it (peak force, speed out) is a bound as well. Most impacts of debris end here, at a part of the cost.
bool StandingImpacts::breaks_nothing(Strike& hit, double weight, double punching) {
  constexpr double rounding = 1e-6;
  const StandingFrame::UnitResponse near = scene_.frame->respond_near(hit.place, hit.normal);
  const double mass = scene_.scenario.impact.structure_mass ? near.rayleigh_mass : 0;
  Indentation pushing(hit.mass, hit.speed, weight, mass);
  const FirstFailure own = first_failure(*scene_.frame, near, scene_.strength_factors, unlimited);
  if (pushing.push(near.compliance, std::min(own.force, punching)) != Indentation::Stop::stood) return false;
  if (pushing.stored(near.compliance) > (1 - rounding) * scene_.frame->critical_energy(hit.place)) return false;
  hit.structure_mass = mass;
  hit.speed_out = rebound(pushing);
  hit.peak_force = pushing.peak_force();
  ++sums_.counters.impacts_bounded;
  return true;
}

/// The pushing, break after break, until the body stops or nothing is left to push.
void StandingImpacts::run_impact(Strike& hit) {
  const double weight = hit.mass * scene_.gravity.dot(hit.normal);
  double punching = fracture_.punching_force(hit);
  // A fast impact goes through whatever the joints bear.
  if (const double left = fracture_.speed_through(hit, punching); left > 0) {
    if (fracture_.punch_at_once(hit, punching, left)) return record_loss(hit);
  } else if (breaks_nothing(hit, weight, punching)) {
    return record_loss(hit);
  }
  StandingFrame::UnitResponse response = scene_.frame->respond(hit.place, hit.normal);
  hit.structure_mass = scene_.scenario.impact.structure_mass ? response.rayleigh_mass : 0;
  Indentation pushing(hit.mass, hit.speed, weight, hit.structure_mass);
  for (;;) {
    const FirstFailure first = first_failure(*scene_.frame, response, scene_.strength_factors, unlimited);
    const bool punches = punching < unlimited && punching <= first.force;
    const Indentation::Stop stop = pushing.push(response.compliance, std::min(first.force, punching));
    if (stop != Indentation::Stop::failed) {
      hit.speed_out = stop == Indentation::Stop::missed ? std::min(pushing.speed(), hit.speed) : rebound(pushing);
      break;
    }
    if (punches) {
      if (const double plug = fracture_.break_out(hit); plug > 0) {
        hit.through = true;
        hit.speed_out =
            let_through(hit.speed, pushing) * hit.mass / (hit.mass + plug);  // it takes along what it broke out
        break;
      }
      punching = unlimited;
      continue;
    }
    const double stored = pushing.stored(response.compliance);
    const double shift = scene_.frame->break_in_impact(first.joints, hit.place, hit.normal);
    hit.through = !scene_.stands(hit.part);
    const bool ends = hit.through || std::abs(shift) > impact_settings.largest_shift;
    if (!ends) {
      pushing.shift(shift);
      response = scene_.frame->respond(hit.place, hit.normal);
    }
    const double freed = ends ? stored : std::max(0.0, stored - pushing.stored(response.compliance));
    for (JointBreak broken : first.joints) {
      broken.energy = freed / static_cast<double>(first.joints.size());
      broken.position = scene_.joint_position(broken.joint);
      hit.breaks.push_back(broken);
    }
    if (ends) {
      hit.speed_out = let_through(hit.speed, pushing);
      break;
    }
  }
  hit.peak_force = std::max(hit.peak_force, pushing.peak_force());
  record_loss(hit);
}

void StandingImpacts::record_loss(Strike& hit) {
  hit.lost = hit.mass * (hit.speed * hit.speed - hit.speed_out * hit.speed_out) / 2;
}

/// Gives the body its outgoing velocity, before the collision world moves it.
void StandingImpacts::set_motion_after(const Strike& hit) {
  const Body& one = *hit.body;
  const Vec3 impulse = hit.mass * (hit.speed_out - hit.speed) * hit.normal;  // on the body
  const Vec3 r = hit.place.point - hit.state.pose.position;
  const Mat3 inertia = world_inertia(one, hit.state.pose.orientation);
  collision::BodyState after = hit.state;
  after.velocity += impulse / one.rest.mass;
  after.angular_velocity += inertia.inverse() * r.cross(impulse);
  sums_.ledger.lost_in_impacts += hit.lost;
  if (hit.through && hit.chunks.empty()) keep_release_impulse(hit);
  const PointImpulse given{impulse, hit.place.point};
  move_on(hit, after, std::span(&given, 1));
}

/// What was hit and came off takes along its share of the momentum.
void StandingImpacts::keep_release_impulse(const Strike& hit) {
  release_impulses_.add(
      {hit.part, hit.structure_mass * hit.speed_out * hit.normal, hit.place.point, hit.speed_out, hit.body->id});
}

/// `after`: where and how it moves at the instant of the impact, true velocities; `impulses`: what made it so.
void StandingImpacts::move_on(const Strike& hit, collision::BodyState after, std::span<const PointImpulse> impulses) {
  StruckClock& clock = struck_[hit.body->id.value];
  clock.at = hit.swept_at;
  clock.base = hit.through ? hit.own_time : 0;
  if (hit.through) {
    // It flies on as if it had come with its new speed: at the instant of impact it is where it is.
    const double t = hit.own_time;
    after.velocity -= scene_.gravity * t;
    after.pose.position -= after.velocity * t + scene_.gravity * (t * t / 2);
    after.pose.orientation = turned(after.pose.orientation, -after.angular_velocity * t);
  }
  after.velocity = scene_.reading().to_world(after.velocity);
  after.asleep = false;
  scene_.world->set_state(hit.body->id, after);
  check_momentum(hit, impulses);
}

/// The momentum that the world's body has at the instant of the impact must be what it had before and the impulses.
void StandingImpacts::check_momentum(const Strike& hit, std::span<const PointImpulse> impulses) {
  Momentum given{hit.state.pose.position}, measured{hit.state.pose.position};
  given.add(*hit.body, hit.state);
  for (const PointImpulse& one : impulses) given.add_impulse(one.impulse, one.point);
  collision::BodyState now = scene_.world->state(hit.body->id);
  now.velocity = scene_.reading().true_velocity(now.velocity);
  if (hit.through) now.velocity += scene_.gravity * hit.own_time;
  now.pose = hit.state.pose;
  measured.add(*hit.body, now);
  sums_.ledger.momentum_error = std::max(sums_.ledger.momentum_error, measured.error(given));
}

}  // namespace topple::structure
