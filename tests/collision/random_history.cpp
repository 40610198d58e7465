#include "random_history.h"

#include <sstream>

#include "same_world.h"

namespace collision_test {

namespace {

/// Points about an ellipsoid: no prism.
BodyDescription chunk(const std::vector<Vec3>& directions, const Vec3& half, double mass) {
  BodyDescription body = box_body(half, mass, Vec3::Zero());
  ConvexPart part;
  part.kind = ConvexPart::Kind::hull;
  part.tag = 7;
  for (const Vec3& direction : directions) part.points.push_back(half.cwiseProduct(direction.normalized()));
  body.parts = {part};
  body.inertia(0, 1) = body.inertia(1, 0) = 0.05 * body.inertia(0, 0);
  return body;
}

/// Those of a joint whose end has gone went with it.
template <class Id, class Ask>
void forget_gone(std::vector<Id>& ids, const Ask& ask) {
  std::erase_if(ids, [&](Id id) {
    try {
      ask(id);
      return false;
    } catch (const std::out_of_range&) {
      return true;
    }
  });
}

void require_same_found(const std::vector<Contact>& a, const std::vector<Contact>& b) {
  REQUIRE(a.size() == b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    REQUIRE(a[i].body == b[i].body);
    REQUIRE(same_touched(a[i].other, b[i].other));
    REQUIRE(a[i].time == b[i].time);
    REQUIRE(a[i].point == b[i].point);
    REQUIRE(a[i].normal == b[i].normal);
    REQUIRE(a[i].approach_speed == b[i].approach_speed);
    REQUIRE(a[i].persistent == b[i].persistent);
    REQUIRE(a[i].corners == b[i].corners);
  }
}

}  // namespace

std::string saved(const World& world) {
  std::ostringstream bytes;
  world.save_state(bytes);
  return bytes.str();
}

/// Gives what the first gives.
template <class Call>
auto RandomHistory::each(const Call& call) {
  const auto given = call(all_.front());
  for (std::size_t i = 1; i < all_.size(); ++i) REQUIRE(call(all_[i]) == given);
  return given;
}

RandomHistory::RandomHistory(unsigned seed) : random_(seed) {
  all_.push_back({world_with_ground(0.6, 0.1), {}});
  for (int i = 0; i < 6; ++i) change_obstacles();
  for (int i = 0; i < 22; ++i) {
    const BodyDescription body = any_description();
    each([&](Beside& one) { return one.world->add_body(body); });
  }
}

double RandomHistory::between(double low, double high) { return low + (high - low) * double(random_() % 4096) / 4096; }

BodyId RandomHistory::any_body() { return first().bodies()[random_() % first().bodies().size()]; }

BodyDescription RandomHistory::any_description() {
  const Vec3 half(between(0.15, 0.4), between(0.15, 0.4), between(0.06, 0.3));
  const double mass = 2000 * half.prod();
  BodyDescription body = box_body(half, mass, Vec3::Zero());
  switch (random_() % 6) {
    case 0:
      body = ball_body(half.x(), mass, Vec3::Zero());
      break;
    case 1:
      body = extruded({{-half.x(), -half.z()}, {half.x(), -half.z()}, {0.3 * half.x(), half.z()}}, half.y(), mass, 0.5);
      break;
    case 2: {
      std::vector<Vec3> directions;
      for (int i = 0; i < 11; ++i) directions.push_back(point(-1, 1));
      for (const double side : {-1.0, 1.0})
        for (int axis = 0; axis < 3; ++axis) directions.push_back(side * Vec3::Unit(axis));
      body = chunk(directions, half, mass);
      break;
    }
    case 3:  // of two boxes
      body.parts.push_back(box_part(half / 2, 3, {half.x(), 0, half.z()}));
      body.parts.back().pose.orientation = Eigen::AngleAxisd(between(0, 1), Vec3::UnitZ());
      break;
    default:
      break;
  }
  body.pose.position = Vec3(between(-1.2, 1.2), between(-1.2, 1.2), between(0.5, 3.5));
  body.pose.orientation = Eigen::Quaterniond(Eigen::AngleAxisd(between(0, 3), point(-1, 1).normalized()));
  body.velocity = point(-1, 1);
  body.angular_velocity = point(-4, 4);
  body.friction = between(0.4, 0.8);
  body.restitution = between(0, 0.3);
  return body;
}

void RandomHistory::change_bodies() {
  const BodyId one = any_body();
  switch (random_() % 6) {
    case 0:
    case 1: {
      const BodyDescription body = any_description();
      each([&](Beside& of) { return of.world->add_body(body); });
      break;
    }
    case 2:
      if (first().bodies().size() < 16) break;
      each([&](Beside& of) { return of.world->remove_body(one), true; });
      break;
    case 3: {
      const Vec3 impulse = 200 * point(-1, 1), at = first().state(one).pose.position + point(-0.1, 0.1);
      each([&](Beside& of) { return of.world->apply_impulse(one, impulse, at), true; });
      break;
    }
    case 4: {
      BodyState state = first().state(one);
      state.asleep = random_() % 3 == 0;
      state.velocity = state.asleep ? Vec3::Zero() : point(-2, 2);
      state.pose.position.z() += 0.2;
      each([&](Beside& of) { return of.world->set_state(one, state), true; });
      break;
    }
    default:
      each([&](Beside& of) { return of.world->wake(one), true; });
  }
}

void RandomHistory::change_obstacles() {
  const bool made = obstacles_.size() < 4 || random_() % 3 == 0;
  if (made) {
    ObstacleDescription obstacle =
        box_obstacle({between(0.2, 0.6), between(0.2, 0.6), between(0.1, 0.5)},
                     {between(-1.2, 1.2), between(-1.2, 1.2), between(0.1, 0.6)}, std::int64_t(random_() % 4));
    if (random_() % 3 == 0) obstacle.parts.push_back(box_part({0.1, 0.1, 0.8}, 5, {0.2, 0, 0.3}));
    obstacle.friction = between(0.4, 0.8);
    obstacle.pose.orientation = Eigen::Quaterniond(Eigen::AngleAxisd(between(0, 1), Vec3::UnitZ()));
    obstacles_.push_back(each([&](Beside& of) {
      const ObstacleId id = of.world->add_obstacle(obstacle);
      of.structure.hold(id, obstacle.pose);
      return id;
    }));
    return;
  }
  const std::size_t at = random_() % obstacles_.size();
  const ObstacleId id = obstacles_[at];
  if (random_() % 2 == 0) {
    each([&](Beside& of) { return of.structure.let_go(id), of.world->remove_obstacle(id), true; });
    obstacles_.erase(obstacles_.begin() + static_cast<std::ptrdiff_t>(at));
    return;
  }
  Pose pose;
  pose.position = Vec3(between(-1.2, 1.2), between(-1.2, 1.2), between(0.1, 0.6));
  each([&](Beside& of) { return of.structure.hold(id, pose), of.world->move_obstacle(id, pose), true; });
}

void RandomHistory::add_hinge() {
  HingeDescription hinge;
  hinge.body = any_body();
  const BodyId other = any_body();
  const Vec3 at = first().state(hinge.body).pose.position;
  if (random_() % 2 == 0)
    hinge.holder = obstacles_[random_() % obstacles_.size()];
  else if (other != hinge.body && (first().state(other).pose.position - at).norm() < 1)
    hinge.other = other;
  hinge.point = at + point(-0.2, 0.2);
  const int free = static_cast<int>(random_() % 3);
  for (int i = 0; i < free; ++i) hinge.held[static_cast<std::size_t>(3 + i)] = false;
  hinges_.push_back(each([&](Beside& of) { return of.world->add_hinge(hinge); }));
}

void RandomHistory::forget_gone_joints() {
  forget_gone(hinges_, [&](HingeId id) { (void)first().hinge_force(id); });
  forget_gone(cables_, [&](CableId id) { (void)first().cable_pull(id); });
}

void RandomHistory::change_joints() {
  forget_gone_joints();
  const auto take = [&](auto& ids) {
    const std::size_t at = random_() % ids.size();
    const auto id = ids[at];
    ids.erase(ids.begin() + static_cast<std::ptrdiff_t>(at));
    return id;
  };
  switch (random_() % 4) {
    case 0: {
      if (cables_.size() > 3) break;
      CableDescription cable;
      cable.body = any_body();
      cable.anchor = first().state(cable.body).pose.position + Vec3(0.3, 0, between(0.5, 2));
      cable.length = between(2.1, 2.5);
      cables_.push_back(each([&](Beside& of) { return of.world->add_cable(cable); }));
      break;
    }
    case 1:
      if (hinges_.size() < 3) break;
      each([&, id = take(hinges_)](Beside& of) { return of.world->remove_hinge(id), true; });
      break;
    case 2:
      if (cables_.size() < 2) break;
      each([&, id = take(cables_)](Beside& of) { return of.world->remove_cable(id), true; });
      break;
    default:
      if (hinges_.size() < 8) add_hinge();
  }
}

void RandomHistory::change() {
  switch (random_() % 8) {
    case 0:
    case 1:
    case 2:
      change_bodies();
      break;
    case 3:
      change_obstacles();
      break;
    case 4:
    case 5:
      change_joints();
      break;
    case 6: {
      Touched other;
      const BodyId one = any_body();
      other.kind = random_() % 2 == 0 ? Touched::Kind::body : Touched::Kind::obstacle;
      other.body = any_body();
      other.obstacle = obstacles_[random_() % obstacles_.size()];
      if (other.kind == Touched::Kind::body && other.body == one) break;
      each([&](Beside& of) { return of.world->ignore_until_separated(one, other), true; });
      break;
    }
    default: {
      if (random_() % 4 != 0) break;
      const Vec3 gravity = Vec3(0, 0, -kGravity) + point(-0.5, 0.5);
      const double height = between(-0.1, 0.05);
      each([&](Beside& of) { return of.world->set_gravity(gravity), true; });
      if (random_() % 2 == 0) each([&](Beside& of) { return of.world->set_ground(height, 0.6, 0.1), true; });
    }
  }
}

void RandomHistory::ask() {
  const double dt = between(0.005, 0.02), least = random_() % 2 == 0 ? 0 : 0.5;
  const Sweep what = random_() % 3 == 0 ? Sweep::obstacles : Sweep::everything;
  const Vec3 from = point(-2, 2) + Vec3(0, 0, 2), to = point(-2, 2) - Vec3(0, 0, 1);
  const std::vector<Contact> found = first().sweep(dt, {what, least});
  const std::optional<RayHit> hit = first().ray_cast(from, to);
  for (const Beside& of : std::span(all_).subspan(1)) {
    require_same_found(found, of.world->sweep(dt, {what, least}));
    const std::optional<RayHit> other = of.world->ray_cast(from, to);
    REQUIRE(hit.has_value() == other.has_value());
    if (hit) REQUIRE((same_touched(hit->what, other->what) && hit->point == other->point));
    REQUIRE(first().obstacles_in(to, from) == of.world->obstacles_in(to, from));
  }
}

void RandomHistory::step() {
  const double dt = random_() % 8 == 0 ? between(0.004, 0.02) : kStep;
  const int parts = 1 + static_cast<int>(random_() % 4), way = static_cast<int>(random_() % 4);
  const bool goes = random_() % 16 == 0 && first().bodies().size() > 16;
  const BodyId gone = any_body();
  for (Beside& of : all_) {
    of.structure.sways = steps_ / 150 % 2 == 0;
    if (goes) of.structure.within_step = [&of, gone] { of.world->remove_body(gone); };
    if (way == 0 && !goes)
      of.world->step(dt);
    else
      of.world->step(dt, parts, of.structure);
  }
  ++steps_;
}

void RandomHistory::require_alike() {
  forget_gone_joints();
  const Beside& one = all_.front();
  const std::string state = all_.size() > 1 ? saved(*one.world) : std::string();
  for (const Beside& other : std::span(all_).subspan(1)) {
    require_same(*one.world, *other.world);
    REQUIRE(one.structure.told == other.structure.told);
    for (const HingeId id : hinges_) {
      REQUIRE(one.world->hinge_force(id) == other.world->hinge_force(id));
      REQUIRE(one.world->hinge_work_lost(id) == other.world->hinge_work_lost(id));
    }
    for (const CableId id : cables_) {
      REQUIRE(one.world->cable_pull(id).tension == other.world->cable_pull(id).tension);
      REQUIRE(one.world->cable_pull(id).work_lost == other.world->cable_pull(id).work_lost);
    }
    REQUIRE((state == saved(*other.world)));
  }
}

void RandomHistory::go_on() {
  // Half of the time nothing is done to what falls, so that it comes to rest.
  if (steps_ / 75 % 2 == 0 || random_() % 40 == 0) change();
  if (random_() % 3 == 0) ask();
  step();
  require_alike();
}

}  // namespace collision_test
