// The two sides of an impact between bodies: where each is and how it moves at that instant, how it gives way, and what
// its joints bear.
#include <algorithm>

#include "simulation/impact/body_impacts.h"

namespace topple::structure {

/// What has struck something standing in this step has a state from there on (strike.cpp).
double BodyImpacts::time_since_state(collision::BodyId id, double swept_at) const {
  const auto earlier = struck_.find(id.value);
  return earlier == struck_.end() ? swept_at : earlier->second.base + std::max(0.0, swept_at - earlier->second.at);
}

/// Where it is and how it moves `time` after the step began.
ImpactSide BodyImpacts::side_at(collision::BodyId id, double time) const {
  ImpactSide side;
  side.id = id;
  if (id.value < 0) return side;
  const collision::BodyState state = scene_.world->state(id);
  const Body& one = debris_.bodies.at(id.value);
  side.slept = state.asleep;
  side.time = state.asleep ? 0 : time;
  side.pose = state.pose;
  side.motion.inverse_mass = 1 / one.rest.mass;
  if (!state.asleep) {
    side.motion.velocity = scene_.reading().true_velocity(state.velocity);
    side.motion.spin = state.angular_velocity;
    side.pose.position += side.motion.velocity * time + scene_.gravity * (time * time / 2);
    side.pose.orientation = turned(state.pose.orientation, side.motion.spin * time);
    side.motion.velocity += scene_.gravity * time;
  }
  side.motion.centre = side.pose.position;
  side.motion.inverse_inertia = world_inertia(one, side.pose.orientation).inverse();
  return side;
}

/// The same places and the same instant, on a body as the world has it now.
ImpactSide BodyImpacts::side_again(const ImpactSide& side, collision::BodyId id) const {
  ImpactSide now = side_at(id, side.time);
  now.tags = side.tags;
  now.flexibility = side.flexibility;
  now.borne = side.borne;
  return now;
}

/// The body from the step's start on, so that it comes through that instant as it is now.
void BodyImpacts::set_side(const ImpactSide& side) {
  if (side.id.value < 0) return;
  collision::BodyState state;
  const double t = side.time;
  state.velocity = side.motion.velocity - scene_.gravity * t;
  state.angular_velocity = side.motion.spin;
  state.pose.position = side.pose.position - state.velocity * t - scene_.gravity * (t * t / 2);
  state.pose.orientation = turned(side.pose.orientation, -side.motion.spin * t);
  BodyMotion& motion = debris_.bodies.motion(side.id.value);
  // The weight has done its work on the way to the instant, wherever the body is said to come from.
  sums_.body_gravity_work += motion.mass * scene_.gravity.dot(state.pose.position - motion.step_start);
  motion.step_start = state.pose.position;
  state.velocity = scene_.reading().to_world(state.velocity);
  scene_.world->set_state(side.id, state);
}

/// How a side gives way at the places, what its joints bear of it, and what they bear without it.
void BodyImpacts::find_flexibility(ImpactSide& side, const std::vector<ImpactPlace>& places, double sign) {
  const auto n = static_cast<Eigen::Index>(places.size());
  side.flexibility = {};
  side.flexibility.compliance = Eigen::MatrixXd::Zero(n, n);
  side.borne.clear();
  if (side.held) return find_held(side, places);
  if (side.standing.valid()) {
    // It holds, as strike.cpp found; each place gives way by itself.
    for (Eigen::Index i = 0; i < n; ++i) {
      const ImpactPlace& place = places[static_cast<std::size_t>(i)];
      side.flexibility.compliance(i, i) =
          scene_.frame->respond_near({side.standing.member, side.standing.panel, place.point}, place.normal).compliance;
    }
    return;
  }
  const Body* one = debris_.find(side.id);
  if (!one || (one->members.empty() && one->panels.empty())) return;
  const Mat3 back = side.pose.orientation.toRotationMatrix().transpose();
  std::vector<FreePush> pushes;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Part part = part_of_number(scene_.building, side.tags[i]);
    pushes.push_back({part.member, part.panel, one->rest.centre + back * (places[i].point - side.pose.position),
                      sign * (back * places[i].normal)});
  }
  FreeSegment& segment = break_up_.free_segment_of(*one);
  side.flexibility = segment.flexibility(pushes);
  if (segment.can_break()) side.borne = segment.bear({}, back * side.motion.spin, Vec3::Zero()).demands;
}

/// What stands gives way by the struck parts alone, with its nodes' mass.
void BodyImpacts::find_held(ImpactSide& side, const std::vector<ImpactPlace>& places) {
  std::vector<ContactPlace> at;
  std::vector<Vec3> along;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Part part = part_of_number(scene_.building, side.tags[i]);
    at.push_back({part.member, part.panel, places[i].point});
    along.push_back(places[i].normal);
  }
  side.response = scene_.frame->respond_held(at, along);
  side.flexibility.compliance = side.response.compliance;
  side.flexibility.demands = side.response.demands;
  for (const auto& [joint, modes] : side.response.node_demands) {
    const auto same = [id = joint](const auto& one) { return one.first == id; };
    auto& demands = side.flexibility.demands;
    if (std::none_of(demands.begin(), demands.end(), same))
      demands.emplace_back(joint, Eigen::Matrix<double, 6, Eigen::Dynamic>::Zero(6, side.response.compliance.cols()));
  }
  for (const auto& [joint, columns] : side.flexibility.demands)
    side.borne.emplace_back(joint, scene_.frame->demand(joint));
}

/// Both sides' flexibility, and the places that are left of it. False: nothing gives way, or nothing closes.
bool BodyImpacts::prepare_push(BodyImpact& impact) {
  find_flexibility(impact.sides[0], impact.places, -1);
  find_flexibility(impact.sides[1], impact.places, 1);
  impact.compliance = impact.sides[0].flexibility.compliance + impact.sides[1].flexibility.compliance;
  if (!(impact.compliance.diagonal().minCoeff() > 0)) return false;
  if (impact.sides[1].held) impact.follow();
  return true;
}

}  // namespace topple::structure
