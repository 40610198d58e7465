#include "contacts/first_touch.h"

#include <BulletCollision/CollisionShapes/btPolyhedralConvexShape.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpaPenetrationDepthSolver.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkPairDetector.h>
#include <BulletCollision/NarrowPhaseCollision/btPointCollector.h>
#include <BulletCollision/NarrowPhaseCollision/btVoronoiSimplexSolver.h>

#include <algorithm>
#include <cmath>

#include "contacts/contact_area.h"
#include "contacts/manifold.h"

namespace topple::collision {

namespace {

/// No advance is shorter than it takes to close by this (m): slow pairs, such as those at rest, take few. What it
/// oversteps is taken back with the approach speed.
constexpr double kLeastClosing = 5e-4;
/// No advance is shorter than this share of the duration: bounds the work for a part that spins just above another.
constexpr double kLeastAdvance = 1.0 / 256;
/// Advances that are tried along one normal, each shorter than the one before.
constexpr int kTries = 8;

struct Closest {
  double distance = BT_LARGE_FLOAT;
  btVector3 normal{0, 0, 0};  // from the first into the second
  btVector3 point{0, 0, 0};   // on the second
};

Closest closest_points(const SolidPart& first, const btTransform& first_pose, const SolidPart& second,
                       const btTransform& second_pose) {
  btVoronoiSimplexSolver simplex;
  btGjkEpaPenetrationDepthSolver penetration;
  btGjkPairDetector detector(first.shape.get(), second.shape.get(), &simplex, &penetration);
  btGjkPairDetector::ClosestPointInput input;
  input.m_transformA = first_pose * first.local;
  input.m_transformB = second_pose * second.local;
  btPointCollector found;
  detector.getClosestPoints(input, found, nullptr);
  if (!found.m_hasResult) return {};
  return {found.m_distance, -found.m_normalOnBInWorld, found.m_pointInWorld};
}

/// No point of the part closes faster than this along n by its turning alone.
double turning_bound(const SolidPart& part, const Motion& motion, const btVector3& normal) {
  return motion.angular_velocity.cross(normal).length() * part.reach;
}

/// Largest closing speed of the origins along n from `time` on. It is linear in time, so it is at an end.
double origins_bound(const Motion& first, const Motion& second, const btVector3& normal, double time, double duration) {
  const auto closing = [&](double t) { return (first.velocity_at(t) - second.velocity_at(t)).dot(normal); };
  return std::max(closing(time), closing(duration));
}

/// What a normal turns with: what lies flat on a face that turns stays apart from it along the face's own normal.
enum class Carrier { none, first, second };

/// What advance() asks about a pair; the second may be the ground.
struct ClosingPair {
  virtual ~ClosingPair() = default;
  [[nodiscard]] virtual Closest closest(double time) const = 0;
  /// No point closes faster than this along n from `time` to the end.
  [[nodiscard]] virtual double closing_bound(const btVector3& normal, double time) const = 0;
  [[nodiscard]] virtual double approach_speed(const btVector3& normal, const btVector3& point, double time) const = 0;
  /// How far the second is beyond the first along n at this time: they are apart when it is above zero.
  [[nodiscard]] virtual double gap(const btVector3& normal, double time) const = 0;
  /// What a normal may turn with, rad/s.
  [[nodiscard]] virtual btVector3 turn(Carrier carrier) const = 0;
  /// The second derivative of no point's place along a normal against the other's is larger from `time` to the end,
  /// m/s2. The normal turns with the carrier.
  [[nodiscard]] virtual double bend(Carrier carrier, const btVector3& normal, double time) const = 0;
};

/// How far a part reaches along a unit vector: with its corners rounded by its skin, as distances are measured.
double support(const SolidPart& part, const btTransform& pose, const btVector3& normal) {
  const btTransform placed = pose * part.local;
  const btVector3 farthest = part.shape->localGetSupportVertexWithoutMarginNonVirtual(normal * placed.getBasis());
  return (placed * farthest).dot(normal) + part.shape->getMarginNonVirtual();
}

/// Points turn with a constant rate, and fall.
double turning_bend(const SolidPart& part, const Motion& motion, const btVector3& normal) {
  return motion.angular_velocity.length() * turning_bound(part, motion, normal);
}

/// From `time` on the gap, which is `now` along n, stays above `least` for so long, s; 0 where that is not known to be
/// longer than `shortest` or to the end. It is the least of functions of time that bend by B at most: between g now and
/// h after D it is above (1 - s) g + s h - s (1 - s) B D^2/2 at any share s of D.
double stays_apart(const ClosingPair& pair, Carrier carrier, const btVector3& normal, double now, double time,
                   double least, double shortest, double longest) {
  const double bend = pair.bend(carrier, normal, time);
  const btVector3 turn = pair.turn(carrier);
  const double rate = turn.length();
  double length = longest;
  for (int i = 0; i < kTries && (length > shortest || length == longest); ++i) {
    const btVector3 turned = rate > 0 ? normal.rotate(turn / rate, rate * length) : normal;
    const double then = pair.gap(turned, time + length), sag = bend * length * length / 2;
    const double share = sag > 0 ? std::clamp((sag - (then - now)) / (2 * sag), 0.0, 1.0) : then < now ? 1 : 0;
    const double lowest = (1 - share) * now + share * then - share * (1 - share) * sag;
    if (lowest >= least) return length;
    const double until = then < now ? (now - least) / (now - then) : 1;  // where a straight line would come to it
    length *= std::clamp(0.9 * until, 0.1, 0.6);
  }
  return 0;
}

/// What touches at the end of the duration has touched within it, however little it has closed: the shorter the
/// duration, the less that is.
std::optional<Touch> advance(const ClosingPair& pair, double duration) {
  for (double time = 0;;) {
    const Closest closest = pair.closest(time);
    if (closest.distance >= BT_LARGE_FLOAT) return std::nullopt;
    if (closest.distance <= kTouchDistance) {
      // What is left is gone through at that speed, so times are exact to second order.
      const double speed = pair.approach_speed(closest.normal, closest.point, time);
      if (speed > 0) {
        Touch touch;
        touch.time = std::clamp(time + closest.distance / speed, 0.0, duration);
        touch.normal = closest.normal;
        touch.point = closest.point;
        return touch;
      }
    }
    const double bound = pair.closing_bound(closest.normal, time), left = duration - time;
    // What touches and does not close yet may come a little nearer.
    const double least = closest.distance > kTouchDistance ? kTouchDistance / 2 : closest.distance - kLeastClosing;
    if (!(left > 0) || bound * left <= closest.distance - least) return std::nullopt;
    const double shortest =
        std::max({(closest.distance - kTouchDistance / 2) / bound, kLeastClosing / bound, kLeastAdvance * duration});
    const double now = pair.gap(closest.normal, time);
    double apart = shortest;
    for (const Carrier carrier : {Carrier::none, Carrier::first, Carrier::second}) {
      if (carrier != Carrier::none && pair.turn(carrier).isZero()) continue;
      const double proven = stays_apart(pair, carrier, closest.normal, now, time, least, apart, left);
      if (proven >= left) return std::nullopt;
      apart = std::max(apart, proven);
    }
    time = apart < left ? time + apart : duration;
  }
}

struct PartPair : ClosingPair {
  const SolidPart &first, &second;
  const Motion &first_motion, &second_motion;
  double duration;
  PartPair(const SolidPart& a, const Motion& a_motion, const SolidPart& b, const Motion& b_motion, double time)
      : first(a), second(b), first_motion(a_motion), second_motion(b_motion), duration(time) {}
  [[nodiscard]] Closest closest(double time) const override {
    return closest_points(first, first_motion.at(time), second, second_motion.at(time));
  }
  [[nodiscard]] double closing_bound(const btVector3& normal, double time) const override {
    return origins_bound(first_motion, second_motion, normal, time, duration) +
           turning_bound(first, first_motion, normal) + turning_bound(second, second_motion, normal);
  }
  [[nodiscard]] double approach_speed(const btVector3& normal, const btVector3& point, double time) const override {
    return (first_motion.point_velocity(point, time) - second_motion.point_velocity(point, time)).dot(normal);
  }
  [[nodiscard]] double gap(const btVector3& normal, double time) const override {
    return -support(second, second_motion.at(time), -normal) - support(first, first_motion.at(time), normal);
  }
  [[nodiscard]] btVector3 turn(Carrier carrier) const override {
    return carrier == Carrier::none    ? btVector3(0, 0, 0)
           : carrier == Carrier::first ? first_motion.angular_velocity
                                       : second_motion.angular_velocity;
  }
  [[nodiscard]] double bend(Carrier carrier, const btVector3& normal, double time) const override {
    const double falling = (first_motion.acceleration - second_motion.acceleration).length();
    if (carrier == Carrier::none)
      return falling + turning_bend(first, first_motion, normal) + turning_bend(second, second_motion, normal);
    // Of n (x - o), with o the carrier's origin and x a point of the other: n'' (x - o) + 2 n' (x - o)' + n (x - o)''.
    const bool with_first = carrier == Carrier::first;
    const SolidPart& other = with_first ? second : first;
    const Motion &carries = with_first ? first_motion : second_motion,
                 &moves = with_first ? second_motion : first_motion;
    const double rate = carries.angular_velocity.length(), others = moves.angular_velocity.length() * other.reach;
    const double speed = (carries.velocity - moves.velocity).length() + falling * duration + others;
    const double away = (carries.origin(time) - moves.origin(time)).length() + other.reach + speed * (duration - time);
    return rate * rate * away + 2 * rate * speed + falling + moves.angular_velocity.length() * others;
  }
};

struct GroundPair : ClosingPair {
  const SolidPart& part;
  const Motion& motion;
  double height, duration;
  GroundPair(const SolidPart& a, const Motion& a_motion, double ground, double time)
      : part(a), motion(a_motion), height(ground), duration(time) {}
  [[nodiscard]] Closest closest(double time) const override {
    const LowestPoints lowest = lowest_points(part, motion.at(time), 0);
    return {lowest.height - height, {0, 0, -1}, lowest.points[0]};
  }
  [[nodiscard]] double closing_bound(const btVector3& normal, double time) const override {
    return origins_bound(motion, Motion{}, normal, time, duration) + turning_bound(part, motion, normal);
  }
  [[nodiscard]] double approach_speed(const btVector3& normal, const btVector3& point, double time) const override {
    return motion.point_velocity(point, time).dot(normal);
  }
  [[nodiscard]] double gap(const btVector3&, double time) const override {
    return lowest_points(part, motion.at(time), 0).height - height;
  }
  [[nodiscard]] btVector3 turn(Carrier) const override { return {0, 0, 0}; }
  [[nodiscard]] double bend(Carrier, const btVector3& normal, double) const override {
    return motion.acceleration.length() + turning_bend(part, motion, normal);
  }
};

/// Of the corner of the area of contact that closes fastest: one edge of a part that lies across another may come down
/// on it while the other lifts.
double fastest_approach(const ClosingPair& pair, const Touch& touch) {
  if (touch.corner_count == 0) return pair.approach_speed(touch.normal, touch.point, touch.time);
  double fastest = -BT_LARGE_FLOAT;
  for (int i = 0; i < touch.corner_count; ++i)
    fastest = std::max(fastest, pair.approach_speed(touch.normal, touch.corners[i], touch.time));
  return fastest;
}

}  // namespace

btTransform Motion::at(double time) const {
  btTransform pose = start;
  const btScalar rate = angular_velocity.length();
  if (rate * time > 0)
    pose.setBasis(btMatrix3x3(btQuaternion(angular_velocity / rate, rate * time)) * start.getBasis());
  pose.setOrigin(origin(time));
  return pose;
}

btVector3 Motion::origin(double time) const {
  return start.getOrigin() + velocity * time + acceleration * (time * time / 2);
}

btVector3 Motion::point_velocity(const btVector3& point, double time) const {
  return velocity_at(time) + angular_velocity.cross(point - origin(time));
}

LowestPoints lowest_points(const SolidPart& part, const btTransform& pose, double band) {
  LowestPoints lowest;
  const btTransform placed = pose * part.local;
  if (!part.shape->isPolyhedral()) {
    lowest.points.push_back(placed.getOrigin() -
                            btVector3(0, 0, part.shape->getMargin()));  // a sphere's margin is its radius
    lowest.height = lowest.points[0].z();
    return lowest;
  }
  const auto& polyhedron = static_cast<const btPolyhedralConvexShape&>(*part.shape);
  const btScalar skin = polyhedron.getShapeType() == BOX_SHAPE_PROXYTYPE ? 0 : polyhedron.getMargin();
  btAlignedObjectArray<btVector3> vertices;
  lowest.height = BT_LARGE_FLOAT;
  for (int i = 0; i < polyhedron.getNumVertices(); ++i) {
    btVector3 vertex;
    polyhedron.getVertex(i, vertex);
    vertices.push_back(placed * vertex - btVector3(0, 0, skin));
    lowest.height = std::min<double>(lowest.height, vertices[i].z());
  }
  for (int i = 0; i < vertices.size(); ++i) {
    if (vertices[i].z() <= lowest.height + band) lowest.points.push_back(vertices[i]);
  }
  return lowest;
}

std::optional<Touch> first_touch(const SolidPart& first, const Motion& first_motion, const SolidPart& second,
                                 const Motion& second_motion, double duration) {
  const PartPair pair(first, first_motion, second, second_motion, duration);
  std::optional<Touch> touch = advance(pair, duration);
  if (!touch) return touch;
  find_contact_area(first, first_motion.at(touch->time), second, second_motion.at(touch->time), *touch);
  touch->approach_speed = fastest_approach(pair, *touch);
  return touch;
}

bool touches(const SolidPart& first, const Motion& first_motion, const SolidPart& second, const Motion& second_motion,
             double duration) {
  return advance(PartPair(first, first_motion, second, second_motion, duration), duration).has_value();
}

std::optional<Touch> first_touch_of_ground(const SolidPart& part, const Motion& motion, double height,
                                           double duration) {
  const GroundPair pair(part, motion, height, duration);
  std::optional<Touch> touch = advance(pair, duration);
  if (!touch) return touch;
  set_contact_area(lowest_points(part, motion.at(touch->time), kContactBand).points, *touch);
  touch->approach_speed = fastest_approach(pair, *touch);
  return touch;
}

double distance(const SolidPart& first, const btTransform& first_pose, const SolidPart& second,
                const btTransform& second_pose) {
  return closest_points(first, first_pose, second, second_pose).distance;
}

}  // namespace topple::collision
