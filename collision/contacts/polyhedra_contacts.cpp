#include "contacts/polyhedra_contacts.h"

#include <algorithm>
#include <cmath>

#include "contacts/manifold_reduction.h"

namespace topple::collision {

namespace {

/// m: a face serves rather than a pair of edges that is better by no more than this, and the last axis rather than a
/// new one: points then do not flicker between features.
constexpr double kFaceFirst = 0.0005, kLastFirst = 0.0005;
/// Share of the overlap that the deepest point of the clipped face must have: else the deepest vertex is added.
constexpr double kLeftOut = 0.75;
/// Sine between two edges below which they span no normal.
constexpr double kParallel = 0.01;
/// Cosine to a contact's normal from which a face is looked at beside edges that cross: what is steeper comes no nearer
/// than the edges do.
constexpr double kLooksAlong = 0.5;
/// m: a point of the faces that is within this of the crossing's depth is the crossing.
constexpr double kSame = 1e-6;

struct Found {
  double separation = -1e300;
  SeparatingAxis axis;
};

/// m: an axis that separates by more serves rather than one that separates by this. One that proves that the two do not
/// touch does in any case: what goes past an edge comes through the plane of the face beside it.
double beaten_by(double separation) {
  const double flickers = separation + kFaceFirst;
  return separation > 0 ? flickers : std::min(flickers, kTouchDistance);
}

/// All in the first's frame.
struct Pair {
  const Polyhedron &first, &second;
  Mat3 turn;  ///< of the second in the first's frame
  Vec3 shift;
  std::vector<Vec3>& vertices;  ///< of the second

  [[nodiscard]] double first_face(int f) const {
    const Polyhedron::Face& face = first.faces[static_cast<std::size_t>(f)];
    double least = 1e300;
    for (const Vec3& vertex : vertices) least = std::min(least, face.normal.dot(vertex));
    return least - face.offset;
  }
  [[nodiscard]] double second_face(int f) const {
    const Polyhedron::Face& face = second.faces[static_cast<std::size_t>(f)];
    const Vec3 normal = turn * face.normal;
    double least = 1e300;
    for (const Vec3& vertex : first.vertices) least = std::min(least, normal.dot(vertex));
    return least - normal.dot(shift) - face.offset;
  }
  /// Normal from the first to the second; zero for edges that are parallel.
  [[nodiscard]] Vec3 edge_normal(const Polyhedron::Edge& a, const Polyhedron::Edge& b) const {
    const Vec3 n = a.direction.cross(turn * b.direction);
    const double length = n.norm();
    if (length < kParallel) return Vec3::Zero();
    const Vec3& from = first.vertices[static_cast<std::size_t>(a.from)];
    return n.dot(from - first.centre) < 0 ? Vec3(-n / length) : Vec3(n / length);
  }
  [[nodiscard]] double edges(int i, int j) const {
    const Polyhedron::Edge &a = first.edges[static_cast<std::size_t>(i)],
                           &b = second.edges[static_cast<std::size_t>(j)];
    const Vec3 n = edge_normal(a, b);
    if (n.isZero(0)) return -1e300;
    return n.dot(vertices[static_cast<std::size_t>(b.from)] - first.vertices[static_cast<std::size_t>(a.from)]);
  }
  [[nodiscard]] double along(const SeparatingAxis& axis) const {
    switch (axis.kind) {
      case SeparatingAxis::Kind::first_face:
        return first_face(axis.first);
      case SeparatingAxis::Kind::second_face:
        return second_face(axis.second);
      case SeparatingAxis::Kind::edges:
        return make_a_face(axis.first, axis.second) ? edges(axis.first, axis.second) : -1e300;
      case SeparatingAxis::Kind::none:
        break;
    }
    return -1e300;
  }
  /// Whether the two edges make a face of the Minkowski difference: the arcs of their Gauss maps cross.
  [[nodiscard]] bool make_a_face(int i, int j) const {
    const Polyhedron::Edge &a = first.edges[static_cast<std::size_t>(i)],
                           &b = second.edges[static_cast<std::size_t>(j)];
    const auto normal = [](const Polyhedron& of, int f) -> const Vec3& {
      return of.faces[static_cast<std::size_t>(f)].normal;
    };
    const Vec3 other = turn * b.direction;
    const double c = -a.direction.dot(turn * normal(second, b.left)),
                 d = -a.direction.dot(turn * normal(second, b.right));
    const double e = other.dot(normal(first, a.left)), f = other.dot(normal(first, a.right));
    return arcs_cross(c, d, e, f);
  }
  /// Of the second's normals (turned round) along the first's edge, and the first's along the second's edge.
  static bool arcs_cross(double c, double d, double e, double f) { return c * d < 0 && e * f < 0 && c * f > 0; }
};

/// `most`: no separation is larger along that face. What cannot be the best is not looked at.
template <class Separation, class Most>
void try_all(int count, SeparatingAxis::Kind kind, const Separation& separation, const Most& most, Found& best,
             double margin) {
  for (int f = 0; f < count; ++f) {
    if (most(f) <= best.separation) continue;
    const double now = separation(f);
    if (now <= best.separation) continue;
    best.separation = now;
    best.axis.kind = kind;
    (kind == SeparatingAxis::Kind::first_face ? best.axis.first : best.axis.second) = f;
    if (now > margin) return;
  }
}

struct Room {
  std::vector<Vec3> vertices, places;
  std::vector<double> first_faces, second_faces;  ///< each one's normals, times the other's centre, m
  std::vector<int> first_edges, second_edges;
  std::vector<Vec3> polygon, clipped;
  std::vector<ManifoldPoint> points;
};
/// Working space alone: nothing in it outlives a call.
Room& room() {
  static thread_local Room own;
  return own;
}

void project(const Polyhedron& of, const Vec3& centre, std::vector<double>& along) {
  along.resize(of.faces.size());
  for (std::size_t f = 0; f < of.faces.size(); ++f) along[f] = of.faces[f].normal.dot(centre);
}

/// Whether n x way is above `least` for any of the unit normals n between those of the edge's two faces, where way goes
/// from the edge to a place that is `left` and `right` outside of the two. Across the edge it is a sum of their
/// normals, with weights as left - cosine right and right - cosine left.
bool any_between(const Polyhedron::Edge& edge, double left, double right, double least) {
  constexpr double flat = 1e-9;
  const double squared_sine = 1 - edge.cosine * edge.cosine;
  if (least < 0 || squared_sine < flat) return true;
  if (left < edge.cosine * right || right < edge.cosine * left) return std::max(left, right) > least;
  return left * left + right * right - 2 * edge.cosine * left * right > least * least * squared_sine;
}

/// Edges of `of` that may part it by more than `least` from another, a ball in which is known: its centre by its
/// distances `along` the faces' normals, its radius. A normal on which both edges lie outermost parts the two by no
/// more than the ball is away from the edge.
void keep_edges(const Polyhedron& of, const std::vector<double>& along, double radius, double least,
                std::vector<int>& kept) {
  kept.clear();
  for (std::size_t i = 0; i < of.edges.size(); ++i) {
    const Polyhedron::Edge& edge = of.edges[i];
    const double left = along[static_cast<std::size_t>(edge.left)] - edge.left_offset,
                 right = along[static_cast<std::size_t>(edge.right)] - edge.right_offset;
    if (any_between(edge, left, right, least + radius)) kept.push_back(static_cast<int>(i));
  }
}

void try_edges(const Pair& pair, Found& best, double margin, Room& work) {
  const double least = beaten_by(best.separation);
  keep_edges(pair.first, work.first_faces, pair.second.inner, least, work.first_edges);
  if (work.first_edges.empty()) return;
  keep_edges(pair.second, work.second_faces, pair.first.inner, least, work.second_edges);
  for (const int j : work.second_edges) {
    const Polyhedron::Edge& b = pair.second.edges[static_cast<std::size_t>(j)];
    const Vec3 other = pair.turn * b.direction,
               left = pair.turn * pair.second.faces[static_cast<std::size_t>(b.left)].normal,
               right = pair.turn * pair.second.faces[static_cast<std::size_t>(b.right)].normal;
    for (const int i : work.first_edges) {
      const Polyhedron::Edge& a = pair.first.edges[static_cast<std::size_t>(i)];
      if (!Pair::arcs_cross(-a.direction.dot(left), -a.direction.dot(right),
                            other.dot(pair.first.faces[static_cast<std::size_t>(a.left)].normal),
                            other.dot(pair.first.faces[static_cast<std::size_t>(a.right)].normal)))
        continue;
      const double now = pair.edges(i, j);
      if (now <= beaten_by(best.separation)) continue;
      best.separation = now;
      best.axis = {SeparatingAxis::Kind::edges, i, j, 0};
      if (now > margin) return;
    }
  }
}

Found search(const Pair& pair, double margin, const SeparatingAxis& last, Room& work) {
  // Each one's centre, as the other sees it.
  const Vec3 second_centre = pair.shift + pair.turn * pair.second.centre,
             first_centre = pair.turn.transpose() * (pair.first.centre - pair.shift);
  project(pair.first, second_centre, work.first_faces);
  project(pair.second, first_centre, work.second_faces);
  // Nothing below what the last axis gives can be found, nor decide between what is.
  const double known = last.kind == SeparatingAxis::Kind::none ? -1e300 : last.gap - kFaceFirst;
  const auto most = [known](const Polyhedron& of, const std::vector<double>& along, double radius) {
    return [&of, &along, radius, known](int f) {
      const double most_of = along[static_cast<std::size_t>(f)] - of.faces[static_cast<std::size_t>(f)].offset - radius;
      return most_of < known ? -1e300 : most_of;
    };
  };
  Found best;
  try_all(
      static_cast<int>(pair.first.faces.size()), SeparatingAxis::Kind::first_face,
      [&](int f) { return pair.first_face(f); }, most(pair.first, work.first_faces, pair.second.inner), best, margin);
  if (best.separation > margin) return best;
  Found second;
  try_all(
      static_cast<int>(pair.second.faces.size()), SeparatingAxis::Kind::second_face,
      [&](int f) { return pair.second_face(f); }, most(pair.second, work.second_faces, pair.first.inner), second,
      margin);
  if (second.separation > beaten_by(best.separation)) best = second;
  if (best.separation > margin) return best;
  if (best.separation < known) best = {known, last};
  try_edges(pair, best, margin, work);
  if (best.separation > margin || last.kind == SeparatingAxis::Kind::none) return best;
  const bool parted = last.gap <= 0 && best.separation > kTouchDistance;
  if (!parted && last.gap >= best.separation - kLastFirst) best = {last.gap, last};
  return best;
}

/// Keeps what of the polygon is inside n x <= offset.
void clip(const Vec3& normal, double offset, std::vector<Vec3>& polygon, std::vector<Vec3>& out) {
  out.clear();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double over_a = normal.dot(a) - offset, over_b = normal.dot(b) - offset;
    if (over_a <= 0) out.push_back(a);
    if ((over_a < 0 && over_b > 0) || (over_a > 0 && over_b < 0))
      out.push_back(a + (b - a) * (over_a / (over_a - over_b)));
  }
  polygon.swap(out);
}

/// The face of the other that looks most against the normal, clipped by the sides of the reference face along it. All
/// in the reference's frame. Points come out on the incident face.
void clip_face(const Polyhedron& reference, int face_index, const Vec3& normal, const Polyhedron& other,
               const Mat3& turn, const std::vector<Vec3>& vertices, Room& work) {
  const Polyhedron::Face& face = reference.faces[static_cast<std::size_t>(face_index)];
  const Vec3 in_other = turn.transpose() * normal;
  std::size_t incident = 0;
  double least = 1e300;
  for (std::size_t f = 0; f < other.faces.size(); ++f) {
    const double facing = other.faces[f].normal.dot(in_other);
    if (facing < least) least = facing, incident = f;
  }
  work.polygon.clear();
  const Polyhedron::Face& facing = other.faces[incident];
  for (int i = 0; i < facing.count; ++i)
    work.polygon.push_back(vertices[static_cast<std::size_t>(other.loops[static_cast<std::size_t>(facing.first + i)])]);
  for (int i = 0; i < face.count && !work.polygon.empty(); ++i) {
    const auto corner = [&](int k) -> const Vec3& {
      return reference
          .vertices[static_cast<std::size_t>(reference.loops[static_cast<std::size_t>(face.first + k % face.count)])];
    };
    const Vec3 out = (corner(i + 1) - corner(i)).cross(normal).normalized();
    clip(out, out.dot(corner(i)), work.polygon, work.clipped);
  }
}

/// The vertex that is deepest along the normal (in the first's frame), where clipping has left it out: a corner beside
/// the face that it is under.
template <class Add>
void add_deepest(const Pair& pair, bool of_second, const Vec3& normal, double separation, const Add& add) {
  const std::vector<Vec3>& vertices = of_second ? pair.second.vertices : pair.first.vertices;
  const Vec3 along = of_second ? Vec3(pair.turn.transpose() * normal) : Vec3(-normal);
  const Vec3 deepest = *std::min_element(vertices.begin(), vertices.end(),
                                         [&](const Vec3& a, const Vec3& b) { return along.dot(a) < along.dot(b); });
  if (of_second) {
    const Vec3 place = pair.shift + pair.turn * deepest;
    add(place - separation * normal, place, separation);
  } else {
    add(deepest, deepest + separation * normal, separation);
  }
}

/// Where two edges cross, the faces beside them may be about to meet as well: a post that lies across the edge of a
/// slab touches with one of its edges, and rocks to the other. False when no such point is nearer than the margin.
template <class Add>
bool faces_beside(const Pair& pair, const Vec3& normal, double margin, Room& work, const Add& add) {
  int chosen = -1;
  double most = kLooksAlong;
  for (std::size_t f = 0; f < pair.first.faces.size(); ++f) {
    const double looks = normal.dot(pair.first.faces[f].normal);
    if (looks > most) most = looks, chosen = static_cast<int>(f);
  }
  double least = -kLooksAlong;
  for (const Polyhedron::Face& face : pair.second.faces) least = std::min(least, normal.dot(pair.turn * face.normal));
  if (chosen < 0 || !(least < -kLooksAlong)) return false;
  clip_face(pair.first, chosen, normal, pair.second, pair.turn, work.vertices, work);
  const Polyhedron::Face& face = pair.first.faces[static_cast<std::size_t>(chosen)];
  bool any = false;
  for (const Vec3& place : work.polygon) {
    const double separation = (face.normal.dot(place) - face.offset) / most;
    if (separation > margin) continue;
    add(place - separation * normal, place, separation);
    any = true;
  }
  return any;
}

/// Nearest points of two edges: of the lines, but no farther along than their ends.
std::pair<Vec3, Vec3> nearest_of_edges(const Vec3& a, const Vec3& a_end, const Vec3& b, const Vec3& b_end) {
  const Vec3 u = a_end - a, v = b_end - b, d = b - a;
  const double uu = u.squaredNorm(), vv = v.squaredNorm(), uv = u.dot(v), du = d.dot(u), dv = d.dot(v);
  const double denominator = uu * vv - uv * uv;
  const double s = std::clamp((du * vv - uv * dv) / denominator, 0.0, 1.0);
  const double t = std::clamp((uv * du - uu * dv) / denominator, 0.0, 1.0);
  return {a + s * u, b + t * v};
}

/// Points found so far where two of a pair touch, given in the first's frame.
struct Touching {
  const Pair& pair;
  Mat3 forth;  ///< from the first's frame to the second's
  double margin;
  Room& work;

  void operator()(const Vec3& on_first, const Vec3& on_second, double separation) const {
    ManifoldPoint point;
    point.on_first = on_first;
    point.on_second = forth * (on_second - pair.shift);
    point.separation = separation;
    work.points.push_back(point);
    work.places.push_back(on_first);
  }
};

// Each adds the points by the axis that was found, and returns the normal in the first's frame.

Vec3 touch_on_first_face(const Touching& add, const SeparatingAxis& axis, Manifold& manifold) {
  const Pair& pair = add.pair;
  const Polyhedron::Face& face = pair.first.faces[static_cast<std::size_t>(axis.first)];
  const Vec3 normal = face.normal;
  clip_face(pair.first, axis.first, normal, pair.second, pair.turn, add.work.vertices, add.work);
  for (const Vec3& place : add.work.polygon) {
    const double separation = normal.dot(place) - face.offset;
    if (separation <= add.margin) add(place - separation * normal, place, separation);
  }
  manifold.normal_on_first = true;
  manifold.local_normal = normal;
  return normal;
}

Vec3 touch_on_second_face(const Touching& add, const SeparatingAxis& axis, Manifold& manifold) {
  const Pair& pair = add.pair;
  const Polyhedron::Face& face = pair.second.faces[static_cast<std::size_t>(axis.second)];
  const Vec3 normal = -(pair.turn * face.normal);
  std::vector<Vec3>& in_second = add.work.vertices;
  in_second.resize(pair.first.vertices.size());
  for (std::size_t i = 0; i < pair.first.vertices.size(); ++i)
    in_second[i] = add.forth * (pair.first.vertices[i] - pair.shift);
  clip_face(pair.second, axis.second, face.normal, pair.first, add.forth, in_second, add.work);
  for (const Vec3& place : add.work.polygon) {
    const double separation = face.normal.dot(place) - face.offset;
    if (separation > add.margin) continue;
    const Vec3 on_first = pair.shift + pair.turn * place;
    add(on_first, on_first + separation * normal, separation);
  }
  manifold.normal_on_first = false;
  manifold.local_normal = -face.normal;
  return normal;
}

Vec3 touch_on_edges(const Touching& add, const SeparatingAxis& axis, double separation, Manifold& manifold) {
  const Pair& pair = add.pair;
  const Polyhedron::Edge &a = pair.first.edges[static_cast<std::size_t>(axis.first)],
                         &b = pair.second.edges[static_cast<std::size_t>(axis.second)];
  const Vec3 normal = pair.edge_normal(a, b);
  const auto corner = [](const std::vector<Vec3>& vertices, int i) { return vertices[static_cast<std::size_t>(i)]; };
  const auto [near_first, near_second] =
      nearest_of_edges(corner(pair.first.vertices, a.from), corner(pair.first.vertices, a.to),
                       corner(add.work.vertices, b.from), corner(add.work.vertices, b.to));
  const bool beside = faces_beside(pair, normal, add.margin, add.work, add);
  const auto deepest = std::min_element(
      add.work.points.begin(), add.work.points.end(),
      [](const ManifoldPoint& one, const ManifoldPoint& other) { return one.separation < other.separation; });
  if (!beside || deepest->separation > separation + kSame) {
    // Both on one line along the normal, as far apart as the axis says.
    const Vec3 middle = (near_first + near_second) / 2;
    add(middle - separation / 2 * normal, middle + separation / 2 * normal, separation);
  }
  manifold.normal_on_first = true;
  manifold.local_normal = normal;
  return normal;
}

}  // namespace

void collide(const Polyhedron& first, const Placement& first_at, const Polyhedron& second, const Placement& second_at,
             double margin, SeparatingAxis& axis, Manifold& manifold) {
  Room& work = room();
  manifold.count = 0;
  const Mat3 back = first_at.turn.transpose();
  work.vertices.resize(second.vertices.size());
  const Pair pair{first, second, back * second_at.turn, back * (second_at.position - first_at.position), work.vertices};
  for (std::size_t i = 0; i < second.vertices.size(); ++i)
    work.vertices[i] = pair.shift + pair.turn * second.vertices[i];
  if (axis.kind != SeparatingAxis::Kind::none && (axis.gap = pair.along(axis)) > margin) return;
  const Found found = search(pair, margin, axis, work);
  axis = found.axis;
  axis.gap = found.separation;
  if (found.separation > margin) return;

  work.points.clear();
  work.places.clear();
  const Touching add{pair, pair.turn.transpose(), margin, work};
  const Vec3 normal = axis.kind == SeparatingAxis::Kind::first_face ? touch_on_first_face(add, axis, manifold)
                      : axis.kind == SeparatingAxis::Kind::second_face
                          ? touch_on_second_face(add, axis, manifold)
                          : touch_on_edges(add, axis, found.separation, manifold);
  manifold.normal = first_at.turn * normal;
  double nearest = 1e300;
  for (const ManifoldPoint& point : work.points) nearest = std::min(nearest, point.separation);
  if (found.separation < 0 && nearest > kLeftOut * found.separation)
    add_deepest(pair, axis.kind == SeparatingAxis::Kind::first_face, normal, found.separation, add);
  reduce_to_four(normal, work.points, work.places, manifold);
}

}  // namespace topple::collision
