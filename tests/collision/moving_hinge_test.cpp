// Bodies that hang at what stands and moves: at a mount of one freedom, beside which the answers are known in closed
// form.
#include <catch2/catch.hpp>

#include <cmath>
#include <tuple>
#include <utility>

#include "world_builder.h"

using namespace collision_test;

namespace {

constexpr int kParts = 8;  // of a step

/// It slides along an axis or turns about one, on a spring or without; all else holds it. Nothing touches it.
class Mount final : public MovingStructure {
 public:
  Vec3 axis = Vec3::UnitZ();
  bool turns = false;
  double inertia = 1000, stiffness = 0;                                ///< kg or kg m2, N/m or N m/rad
  double taken_lighter = 2;                                            ///< than it is, by the world
  double part = kStep / kParts;                                        ///< s, of a step
  double place = 0, speed = 0, force = 0, acceleration = 0, time = 0;  ///< force, acceleration: in the last part
  Vec3 impulse = Vec3::Zero(), moment = Vec3::Zero();  ///< of hinges so far, the moment about where it began
  double work = 0;                                     ///< of hinges

  [[nodiscard]] std::optional<ObstaclePath> path(ObstacleId) const override { return motion_now().path(); }
  [[nodiscard]] std::optional<ObstacleMotion> motion(ObstacleId) override { return motion_now(); }
  [[nodiscard]] ObstacleMotion motion_now() const {
    ObstacleMotion motion;
    motion.mass = motion.inertia(0, 0) = motion.inertia(1, 1) = motion.inertia(2, 2) = inertia / taken_lighter;
    if (turns) {
      motion.pose.orientation = Eigen::AngleAxisd(place, axis);
      motion.angular_velocity = speed * axis;
      motion.angular_acceleration = (after(part, force).second - speed) / part * axis;
      motion.last_angular_acceleration = acceleration * axis;
    } else {
      motion.pose.position = place * axis;
      motion.velocity = speed * axis;
      motion.acceleration = (after(part, force).second - speed) / part * axis;
      motion.last_acceleration = acceleration * axis;
    }
    return motion;
  }

  /// Place and speed after so long under a force that lasts.
  [[nodiscard]] std::pair<double, double> after(double dt, double pushed) const {
    if (!(stiffness > 0)) return {place + (speed + pushed * dt / inertia / 2) * dt, speed + pushed * dt / inertia};
    const double w = std::sqrt(stiffness / inertia), rest = pushed / stiffness, x = place - rest;
    return {rest + x * std::cos(w * dt) + speed / w * std::sin(w * dt),
            -x * w * std::sin(w * dt) + speed * std::cos(w * dt)};
  }

  /// Exactly, under the mean force of the part.
  void advance(double dt, std::span<const Contact>, std::span<const HingePull> pulls) override {
    force = 0;
    for (const HingePull& pull : pulls) {
      const Vec3 about = pull.moment + pull.point.cross(pull.impulse);
      impulse += pull.impulse;
      moment += about;
      force += axis.dot(turns ? about : pull.impulse) / dt;
    }
    const double before = place, was = speed;
    std::tie(place, speed) = after(dt, force);
    work += force * (place - before);
    acceleration = (speed - was) / dt;
    time += dt;
  }
};

HingeDescription held_at(BodyId body, ObstacleId holder, const std::array<bool, 6>& held) {
  HingeDescription hinge;
  hinge.body = body;
  hinge.holder = holder;
  hinge.held = held;
  return hinge;
}

/// What a body that begins at rest under gravity enters with: velocities are those of mid-step.
const Vec3 kAtRest(0, 0, kGravity* kStep / 2);

constexpr std::array<bool, 6> kBall{true, true, true, false, false, false}, kAll{true, true, true, true, true, true};

/// Largest distance of the mount from `wanted`(time) in the first second, with so many parts to a step.
template <class Wanted>
double farthest_from(const Wanted& wanted, World& world, Mount& mount, int parts) {
  double farthest = 0;
  mount.part = kStep / parts;
  for (int step = 0; step < 60; ++step) {
    world.step(kStep, parts, mount);
    farthest = std::max(farthest, std::abs(mount.place - wanted(mount.time)));
  }
  return farthest;
}

}  // namespace

TEST_CASE("a box that hangs at a mount on a spring sways with it as one mass", "[moving][hinge]") {
  const double mass = GENERATE(100.0, 1000.0, 10000.0), lighter = GENERATE(1.0, 2.0, 10.0);
  CAPTURE(mass, lighter);
  const double w = 2 * M_PI * 2;
  const auto off = [&](int parts) {
    Mount mount;
    mount.taken_lighter = lighter;
    mount.stiffness = (mount.inertia + mass) * w * w;
    const double sag = mass * kGravity / mount.stiffness;
    const auto world = world_with_gravity();
    const ObstacleId holder = world->add_obstacle({});
    BodyDescription hung = box_body({0.5, 0.4, 0.2}, mass, {0, 0, -1});
    hung.velocity = kAtRest;
    const BodyId box = world->add_body(hung);
    world->add_hinge(held_at(box, holder, kBall));
    double apart = 0;
    const auto wanted = [&](double time) {
      apart = std::max(apart, std::abs(world->state(box).pose.position.z() + 1 - mount.place));
      return -sag * (1 - std::cos(w * time));
    };
    const double farthest = farthest_from(wanted, *world, mount, parts);
    CHECK(apart < 0.002);
    return farthest / sag;
  };
  const double coarse = off(kParts), fine = off(4 * kParts);
  CHECK(coarse < 0.1);
  CHECK(fine == Approx(coarse / 4).epsilon(0.1));  // of first order in the part
}

TEST_CASE("a pendulum at a free trolley shares its momentum with it, and swings faster by the trolley's way",
          "[moving][hinge]") {
  const double mass = GENERATE(100.0, 1000.0, 4000.0);
  CAPTURE(mass);
  const double arm = 1, small = 0.02;
  const BodyDescription bob = box_body({0.3, 0.3, 0.3}, mass, {arm * std::sin(small), 0, -arm * std::cos(small)});
  Mount trolley;
  trolley.axis = Vec3::UnitX();
  const double both = mass + trolley.inertia, about = bob.inertia(1, 1) + mass * arm * arm;
  const double w = std::sqrt(mass * kGravity * arm * both / (about * both - mass * mass * arm * arm));
  const auto world = world_with_gravity();
  const ObstacleId holder = world->add_obstacle({});
  const BodyId body = world->add_body(bob);
  world->add_hinge(held_at(body, holder, kBall));
  const double period = 2 * M_PI / w, farthest = -2 * mass * arm * std::sin(small) / both;
  double most = 0;
  while (trolley.time < 0.75 * period) {
    world->step(kStep, kParts, trolley);
    const BodyState now = world->state(body);
    CHECK(mass * now.velocity.x() + trolley.inertia * trolley.speed == Approx(0).margin(1e-9 * mass));
    CHECK(trolley.impulse.x() == Approx(-mass * now.velocity.x()).margin(1e-9 * mass));
    // It goes by as much the other way as it came, and is there after half a period.
    const double wanted = -farthest / 2 * (std::cos(w * trolley.time) - 1);
    CHECK(trolley.place == Approx(-wanted).margin(0.05 * std::abs(farthest)));
    most = std::max(most, std::abs(trolley.place));
  }
  CHECK(most == Approx(std::abs(farthest)).epsilon(0.03));
}

TEST_CASE("a bar held in all six components at a mount that turns on a spring turns with it as one",
          "[moving][hinge]") {
  const double mass = GENERATE(30.0, 300.0, 3000.0);
  CAPTURE(mass);
  const double half = 1.5, turned = 0.02, w = 2 * M_PI * 1.5;
  const auto off = [&](int parts) {
    BodyDescription bar = box_body({half, 0.1, 0.1}, mass, {half, 0, 0});
    Mount mount;
    mount.turns = true;
    mount.inertia = 500;
    const double of_bar = bar.inertia(2, 2) + mass * half * half;
    mount.stiffness = (mount.inertia + of_bar) * w * w;
    // Both turn at the start, about the mount.
    mount.speed = turned * w;
    bar.velocity = Vec3(0, mount.speed * half, 0);
    bar.angular_velocity = Vec3(0, 0, mount.speed);
    const auto world = world_with_gravity();
    world->set_gravity(Vec3::Zero());
    const ObstacleId holder = world->add_obstacle({});
    const BodyId body = world->add_body(bar);
    world->add_hinge(held_at(body, holder, kAll));
    const auto wanted = [&](double time) { return turned * std::sin(w * time); };
    const double farthest = farthest_from(wanted, *world, mount, parts);
    const BodyState now = world->state(body);
    CHECK((now.pose.orientation * Vec3::UnitX()).y() == Approx(std::sin(mount.place)).margin(0.02 * turned));
    // What the bar has lost of its momentum about the mount, the mount has got.
    const double has = bar.inertia(2, 2) * now.angular_velocity.z() + mass * now.pose.position.cross(now.velocity).z(),
                 had = of_bar * turned * w;
    CHECK(mount.moment.z() == Approx(had - has).margin(1e-3 * had));
    return farthest / turned;
  };
  const double coarse = off(kParts), fine = off(4 * kParts);
  CHECK(coarse < 0.1);
  CHECK(fine < 0.3 * coarse);
}

TEST_CASE("the hinge of a falling body stops a free mount and the body at their common speed", "[moving][hinge]") {
  const double mass = GENERATE(100.0, 1000.0, 10000.0);
  CAPTURE(mass);
  Mount mount;
  const auto world = world_with_gravity();
  world->set_gravity(Vec3::Zero());
  const ObstacleId holder = world->add_obstacle({});
  BodyDescription box = box_body({0.5, 0.4, 0.2}, mass, {0, 0, -1});
  box.velocity = Vec3(0, 0, -0.9);
  const BodyId body = world->add_body(box);
  const HingeId hinge = world->add_hinge(held_at(body, holder, kBall));
  double lost = 0;
  for (int step = 0; step < 30; ++step) {
    world->step(kStep, kParts, mount);
    lost += world->hinge_work_lost(hinge);
    // Mean of the step, of the body on what holds it.
    CHECK(mass * world->state(body).velocity.z() + mount.impulse.z() == Approx(-0.9 * mass).epsilon(1e-12));
  }
  const double both = -0.9 * mass / (mass + mount.inertia), reduced = mass * mount.inertia / (mass + mount.inertia);
  CHECK(mount.speed == Approx(both).epsilon(0.02));
  CHECK(world->state(body).velocity.z() == Approx(both).epsilon(0.02));
  CHECK(lost - mount.work == Approx(reduced * 0.9 * 0.9 / 2).epsilon(0.02));
}

namespace {

/// A free mount that gives way by a mobility of its own: a tip of a post, light across and heavy along, which turns as
/// it is pushed.
class Tip final : public MovingStructure {
 public:
  Mat6 mobility = Mat6::Zero();
  Vec3 impulse = Vec3::Zero();  ///< of hinges so far
  ObstacleMotion now;

  Tip() {
    mobility.diagonal() << 1 / 80.0, 1 / 120.0, 1 / 3000.0, 1 / 40.0, 1 / 60.0, 1 / 5.0;
    mobility(0, 4) = mobility(4, 0) = 0.8 * std::sqrt(mobility(0, 0) * mobility(4, 4));
    mobility(1, 3) = mobility(3, 1) = -0.8 * std::sqrt(mobility(1, 1) * mobility(3, 3));
  }
  [[nodiscard]] std::optional<ObstaclePath> path(ObstacleId) const override { return now.path(); }
  [[nodiscard]] std::optional<ObstacleMotion> motion(ObstacleId) override {
    now.mobility = mobility;
    return now;
  }
  void advance(double dt, std::span<const Contact>, std::span<const HingePull> pulls) override {
    Eigen::Matrix<double, 6, 1> given = Eigen::Matrix<double, 6, 1>::Zero();
    for (const HingePull& pull : pulls) {
      given.head<3>() += pull.impulse;
      given.tail<3>() += pull.moment + Vec3(pull.point - now.pose.position).cross(pull.impulse);
      impulse += pull.impulse;
    }
    const Eigen::Matrix<double, 6, 1> change = mobility * given;
    now.acceleration = change.head<3>() / dt;
    now.angular_acceleration = change.tail<3>() / dt;
    now.pose.position += (now.velocity + change.head<3>() / 2) * dt;
    now.velocity += change.head<3>();
    now.angular_velocity += change.tail<3>();  // what it turns by is small
  }
  [[nodiscard]] double kinetic() const {
    Eigen::Matrix<double, 6, 1> motion;
    motion << now.velocity, now.angular_velocity;
    return motion.dot(mobility.ldlt().solve(motion)) / 2;
  }
};

}  // namespace

TEST_CASE("what gives way along one axis alone takes along what hangs there at once, and gets no energy",
          "[moving][hinge]") {
  const double mass = GENERATE(30.0, 300.0, 3000.0);
  CAPTURE(mass);
  Tip tip;
  const auto world = world_with_gravity();
  world->set_gravity(Vec3::Zero());
  const ObstacleId holder = world->add_obstacle({});
  BodyDescription bar = box_body({1.5, 0.1, 0.1}, mass, {1.5, 0, 0});
  bar.velocity = Vec3(-0.3, 0.2, -0.5);  // mostly along the heavy axis first, and then across
  const BodyId body = world->add_body(bar);
  (void)world->add_hinge(held_at(body, holder, kBall));
  const double had = mass * bar.velocity.squaredNorm() / 2;
  for (int step = 0; step < 20; ++step) {
    world->step(kStep, kParts, tip);
    const BodyState is = world->state(body);
    const Mat3 turn = is.pose.orientation.toRotationMatrix();
    const Vec3 spin = turn.transpose() * is.angular_velocity;
    const double has = mass * is.velocity.squaredNorm() / 2 + spin.dot(bar.inertia * spin) / 2 + tip.kinetic();
    CHECK(has < 1.01 * had);
    CHECK((mass * (is.velocity - bar.velocity) + tip.impulse).norm() < 1e-9 * mass);
    const Vec3 at_hinge = is.pose * Vec3(-1.5, 0, 0);
    CHECK((at_hinge - tip.now.pose.position).norm() < 2e-3);
  }
}

namespace {

/// A mount that goes up and down on a spring far stiffer than a part of a step resolves, integrated backwards.
class StiffMount final : public MovingStructure {
 public:
  double mass = 2, stiffness = 1e9;  ///< kg, N/m: a part of a step is some hundred of its radians
  bool tells_mobility = true;        ///< for a part, else that of its mass
  double place = 0, speed = 0, force = 0, acceleration = 0;

  [[nodiscard]] std::optional<ObstaclePath> path(ObstacleId) const override { return motion_now().path(); }
  [[nodiscard]] std::optional<ObstacleMotion> motion(ObstacleId) override { return motion_now(); }
  [[nodiscard]] ObstacleMotion motion_now() const {
    ObstacleMotion motion;
    motion.pose.position = Vec3(0, 0, place);
    motion.velocity = Vec3(0, 0, speed);
    motion.acceleration = Vec3(0, 0, (speed_after(force) - speed) / part);
    motion.last_acceleration = Vec3(0, 0, acceleration);
    Mat6 mobility = 1e-6 * Mat6::Identity();  // held in all else
    mobility(2, 2) = tells_mobility ? 1 / (mass + stiffness * part * part) : 1 / mass;
    motion.mobility = mobility;
    return motion;
  }
  void advance(double, std::span<const Contact>, std::span<const HingePull> pulls) override {
    force = 0;
    for (const HingePull& pull : pulls) force += pull.impulse.z() / part;
    const double before = std::exchange(speed, speed_after(force));
    acceleration = (speed - before) / part;
    place += speed * part;
  }

 private:
  static constexpr double part = kStep / kParts;
  [[nodiscard]] double speed_after(double pushed) const {
    return (mass * speed + part * (pushed - stiffness * place)) / (mass + stiffness * part * part);
  }
};

/// N, in each part of the first steps: what a box that is hung there at rest pulls with.
std::vector<double> pulls_of_hung_box(StiffMount& mount, double mass) {
  const auto world = world_with_gravity();
  const ObstacleId holder = world->add_obstacle({});
  BodyDescription hung = box_body({0.5, 0.4, 0.2}, mass, {0, 0, -1});
  hung.velocity = kAtRest;
  (void)world->add_hinge(held_at(world->add_body(hung), holder, kBall));
  std::vector<double> pulls;
  for (int step = 0; step < 8; ++step) {
    world->step(kStep, kParts, mount);
    pulls.push_back(-mount.force);
  }
  return pulls;
}

}  // namespace

TEST_CASE("what is stiffer than a part of a step resolves bears what hangs there at once, by its mobility for the part",
          "[moving][hinge]") {
  constexpr double mass = 1000, borne = mass * kGravity;
  StiffMount told, taken_light;
  taken_light.tells_mobility = false;
  const std::vector<double> soon = pulls_of_hung_box(told, mass), late = pulls_of_hung_box(taken_light, mass);
  for (const double pull : soon) CHECK(pull == Approx(borne).epsilon(0.02));
  CHECK(std::abs(told.place) < 2 * borne / told.stiffness);
  CHECK_FALSE(late.front() == Approx(borne).epsilon(0.1));
}

TEST_CASE("a hinge holds at an obstacle that stands still as in space, to the bit, and goes with it when it is moved",
          "[moving][hinge]") {
  const auto at_obstacle = world_with_gravity(), in_space = world_with_gravity();
  const ObstacleId holder = at_obstacle->add_obstacle({});
  const BodyDescription bar = box_body({1, 0.1, 0.1}, 50, {1, 0, 0});
  const BodyId body = at_obstacle->add_body(bar);
  const HingeId hinge = at_obstacle->add_hinge(held_at(body, holder, kBall));
  HingeDescription fixed;
  fixed.body = in_space->add_body(bar);
  fixed.held = kBall;
  const HingeId other = in_space->add_hinge(fixed);
  for (int step = 0; step < 60; ++step) {
    at_obstacle->step(kStep);
    in_space->step(kStep);
    const BodyState a = at_obstacle->state(body), b = in_space->state(fixed.body);
    REQUIRE(a.pose.position == b.pose.position);
    REQUIRE(a.angular_velocity == b.angular_velocity);
    REQUIRE(at_obstacle->hinge_force(hinge) == in_space->hinge_force(other));
  }
  Pose moved;
  moved.position = Vec3(0, 0, 0.01);
  at_obstacle->move_obstacle(holder, moved);
  run(*at_obstacle, 60);
  const auto place = [&] { return Vec3(at_obstacle->state(body).pose * Vec3(-1, 0, 0)); };
  CHECK((place() - moved.position).norm() < 0.002);
  at_obstacle->remove_obstacle(holder);
  run(*at_obstacle, 60);
  CHECK((place() - moved.position).norm() < 0.002);
}

TEST_CASE("what hangs at a mount and sleeps goes along awake when that moves", "[moving][hinge]") {
  const auto world = world_with_gravity();
  Mount mount;
  mount.inertia = 1e9;
  const ObstacleId holder = world->add_obstacle({});
  const BodyId box = world->add_body(box_body({0.5, 0.4, 0.2}, 500, {0, 0, -1}));
  world->add_hinge(held_at(box, holder, kBall));
  for (int step = 0; step < 120; ++step) world->step(kStep, kParts, mount);
  REQUIRE(world->state(box).asleep);
  mount.impulse.setZero();
  world->step(kStep, kParts, mount);
  CHECK(mount.impulse.isZero(0));  // it pulls as it did
  mount.speed = 0.5;
  for (int step = 0; step < 60; ++step) world->step(kStep, kParts, mount);
  CHECK_FALSE(world->state(box).asleep);
  CHECK(world->state(box).pose.position.z() == Approx(mount.place - 1).margin(0.005));
}

TEST_CASE("two bodies that hang at one mount are solved with it together", "[moving][hinge]") {
  Mount mount;
  const double w = 2 * M_PI * 2, mass = 400;
  mount.stiffness = (mount.inertia + 2 * mass) * w * w;
  const double sag = 2 * mass * kGravity / mount.stiffness;
  const auto world = world_with_gravity();
  const ObstacleId holder = world->add_obstacle({});
  for (const double side : {-2.0, 2.0}) {
    BodyDescription hung = box_body({0.5, 0.4, 0.2}, mass, {side, 0, -1});
    hung.velocity = kAtRest;
    const BodyId box = world->add_body(hung);
    HingeDescription hinge = held_at(box, holder, kBall);
    hinge.point = Vec3(side, 0, 0);
    world->add_hinge(hinge);
  }
  const auto wanted = [&](double time) { return -sag * (1 - std::cos(w * time)); };
  CHECK(farthest_from(wanted, *world, mount, kParts) < 0.1 * sag);
}

TEST_CASE("a hinge holds to a body or to an obstacle, not to both", "[hinge]") {
  const auto world = world_with_gravity();
  const BodyId body = world->add_body(box_body({1, 0.1, 0.1}, 50, {1, 0, 0})),
               other = world->add_body(box_body({1, 0.1, 0.1}, 50, {-1.1, 0, 0}));
  HingeDescription both = held_at(body, world->add_obstacle({}), kBall);
  both.other = other;
  CHECK_THROWS_AS(world->add_hinge(both), std::invalid_argument);
  both.other.reset();
  both.holder = ObstacleId{7};
  CHECK_THROWS_AS(world->add_hinge(both), std::out_of_range);
}
