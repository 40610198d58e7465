#include "contacts/apart.h"

#include <algorithm>
#include <cmath>

namespace topple::collision {

namespace {

/// m: a face that the other is farther behind proves nothing of how the two meet: their edges may cross beside it.
constexpr double kBehind = 0.002;

/// What all faces share: how far paths leave the straight lines between their ends, how long they take, and what is
/// slow.
struct Passage {
  double bend, duration, least_speed;
};

struct Farthest {
  double gap = -1e300;
  bool slow = false;
};

struct Way {
  Vec3 now, then;
};

/// Places of the other's corners in the frame of the one, at both ends.
void corners_of(const MovingPart& one, const MovingPart& other, const Polyhedron& polyhedron, std::vector<Way>& ways) {
  const Placement &now = one.solid.at, &then = one.end;
  const Mat3 turn = now.turn.transpose() * other.solid.at.turn, turn_then = then.turn.transpose() * other.end.turn;
  const Vec3 shift = now.turn.transpose() * (other.solid.at.position - now.position),
             shift_then = then.turn.transpose() * (other.end.position - then.position);
  ways.clear();
  for (const Vec3& corner : polyhedron.vertices)
    ways.push_back({shift + turn * corner, shift_then + turn_then * corner});
}

/// Looks at the faces of the one; true when the other stays outside of one of them.
bool kept_apart(const MovingPart& one, const Polyhedron& faced, const MovingPart& other, const Polyhedron& polyhedron,
                const Passage& passage, Farthest& farthest) {
  static thread_local std::vector<Way> ways;
  corners_of(one, other, polyhedron, ways);
  for (const Polyhedron::Face& face : faced.faces) {
    const double surface = face.offset + 2 * kSkin;  // shapes that are cast may wear a skin
    double gap = 1e300;
    bool slow = true, apart = true;
    for (const Way& way : ways) {
      const double now = face.normal.dot(way.now) - surface, then = face.normal.dot(way.then) - surface;
      gap = std::min(gap, now);
      if (std::min(now, then) > passage.bend) continue;
      apart = false;
      slow = slow && now - then + 4 * passage.bend < passage.least_speed * passage.duration;
    }
    if (apart) return true;
    if (gap > farthest.gap) farthest = {gap, slow};
  }
  return false;
}

/// Of a path of points in the frame of one of them: its curvature times the squared duration over eight is how far it
/// leaves its chord; its slope differs from the chord's by four times that over the duration.
double bend(const MovingPart& first, const MovingPart& second, double duration) {
  const double spin = first.motion.angular_velocity.length() + second.motion.angular_velocity.length();
  const double speed = (first.motion.velocity - second.motion.velocity).length(),
               acceleration = (first.motion.acceleration - second.motion.acceleration).length();
  const double reach = first.solid.parts[first.part].reach + second.solid.parts[second.part].reach + speed * duration;
  return duration * duration / 8 * (acceleration + 2 * spin * (speed + acceleration * duration) + spin * spin * reach);
}

}  // namespace

Meeting meeting_of(const MovingPart& first, const MovingPart& second, double duration, double least_speed) {
  const PartShape &a = first.solid.shapes[first.part], &b = second.solid.shapes[second.part];
  if (!a.polyhedron || !b.polyhedron) return Meeting::unknown;
  const Passage passage{bend(first, second, duration), duration, least_speed};
  Farthest farthest;
  if (kept_apart(first, *a.polyhedron, second, *b.polyhedron, passage, farthest) ||
      kept_apart(second, *b.polyhedron, first, *a.polyhedron, passage, farthest))
    return Meeting::never;
  return farthest.slow && farthest.gap > -2 * kSkin - kBehind ? Meeting::slow : Meeting::unknown;
}

}  // namespace topple::collision
