// The inner loops over packs of contacts; compiled once for each set of instructions, in a namespace of its own.
// Nothing here may include Eigen: its inline functions would be compiled for those instructions everywhere.
#include "solver/contact_packs.h"

namespace topple::collision {
namespace TOPPLE_KERNELS {
namespace {

#define TOPPLE_INLINE __attribute__((always_inline)) inline

typedef long long Lanes __attribute__((vector_size(kLanes * sizeof(double))));

TOPPLE_INLINE Wide all(double x) { return Wide{x, x, x, x}; }
TOPPLE_INLINE Wide larger(const Wide& a, const Wide& b) { return a > b ? a : b; }
TOPPLE_INLINE Wide smaller(const Wide& a, const Wide& b) { return a < b ? a : b; }
TOPPLE_INLINE Wide dot(const Wide* a, const Wide* b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
TOPPLE_INLINE Wide root(const Wide& a) {
  return Wide{__builtin_sqrt(a[0]), __builtin_sqrt(a[1]), __builtin_sqrt(a[2]), __builtin_sqrt(a[3])};
}

struct Gathered {
  Wide linear[3], angular[3];
};

/// Rows of four become columns.
TOPPLE_INLINE void transpose(Wide& a, Wide& b, Wide& c, Wide& d) {
  const Wide ab_low = __builtin_shufflevector(a, b, 0, 4, 2, 6), ab_high = __builtin_shufflevector(a, b, 1, 5, 3, 7);
  const Wide cd_low = __builtin_shufflevector(c, d, 0, 4, 2, 6), cd_high = __builtin_shufflevector(c, d, 1, 5, 3, 7);
  a = __builtin_shufflevector(ab_low, cd_low, 0, 1, 4, 5);
  b = __builtin_shufflevector(ab_high, cd_high, 0, 1, 4, 5);
  c = __builtin_shufflevector(ab_low, cd_low, 2, 3, 6, 7);
  d = __builtin_shufflevector(ab_high, cd_high, 2, 3, 6, 7);
}

/// The two rows of four that a motion is.
TOPPLE_INLINE const Wide* rows_of(const Motion6& motion) { return reinterpret_cast<const Wide*>(&motion); }
TOPPLE_INLINE Wide* rows_of(Motion6& motion) { return reinterpret_cast<Wide*>(&motion); }

TOPPLE_INLINE void gather(const Motion6* from, const int* index, Gathered& to) {
  const Wide *a = rows_of(from[index[0]]), *b = rows_of(from[index[1]]), *c = rows_of(from[index[2]]),
             *d = rows_of(from[index[3]]);
  to.linear[0] = a[0], to.linear[1] = b[0], to.linear[2] = c[0], to.angular[0] = d[0];
  transpose(to.linear[0], to.linear[1], to.linear[2], to.angular[0]);
  Wide unused = d[1];
  to.angular[1] = a[1], to.angular[2] = b[1];
  Wide third = c[1];
  transpose(to.angular[1], to.angular[2], third, unused);
}

TOPPLE_INLINE void scatter(const Gathered& from, const int* index, Motion6* to) {
  Wide rows[4] = {from.linear[0], from.linear[1], from.linear[2], from.angular[0]};
  Wide rest[4] = {from.angular[1], from.angular[2], all(0), all(0)};
  transpose(rows[0], rows[1], rows[2], rows[3]);
  transpose(rest[0], rest[1], rest[2], rest[3]);
  for (int lane = 0; lane < kLanes; ++lane) {
    if (index[lane] == 0) continue;
    Wide* row = rows_of(to[index[lane]]);
    row[0] = rows[lane], row[1] = rest[lane];
  }
}

/// Both bodies of each lane.
struct Both {
  Gathered first, second;
};

TOPPLE_INLINE Wide relative(const ContactPack& pack, const Wide* direction, const Wide* on_first, const Wide* on_second,
                            const Both& of) {
  const Wide across[3] = {of.second.linear[0] * pack.second_root - of.first.linear[0] * pack.first_root,
                          of.second.linear[1] * pack.second_root - of.first.linear[1] * pack.first_root,
                          of.second.linear[2] * pack.second_root - of.first.linear[2] * pack.first_root};
  return dot(direction, across) + (dot(on_second, of.second.angular) - dot(on_first, of.first.angular));
}

TOPPLE_INLINE void push(const ContactPack& pack, const Wide* direction, const Wide* on_first, const Wide* on_second,
                        const Wide& impulse, Both& velocity) {
  const Wide first = impulse * pack.first_root, second = impulse * pack.second_root;
  for (int i = 0; i < 3; ++i) {
    velocity.first.linear[i] -= direction[i] * first;
    velocity.second.linear[i] += direction[i] * second;
    velocity.first.angular[i] -= on_first[i] * impulse;
    velocity.second.angular[i] += on_second[i] * impulse;
  }
}

/// The points of a patch share their normal: along it two bodies come apart with one speed, which all their points see,
/// and what points push is put on the bodies at once when the last has been done.
struct AlongNormal {
  Wide speed;   ///< of the second's centre from the first's
  Wide masses;  ///< 1/m of both together: so much faster by a unit impulse
  Wide pushed;  ///< by all points since
};

TOPPLE_INLINE AlongNormal project_on_normal(const ContactPack& pack, const Both& of) {
  Wide across[3];
  for (int i = 0; i < 3; ++i)
    across[i] = of.second.linear[i] * pack.second_root - of.first.linear[i] * pack.first_root;
  return {dot(pack.normal, across), pack.first_root * pack.first_root + pack.second_root * pack.second_root, all(0)};
}

TOPPLE_INLINE Wide relative(const PackPoint& point, const AlongNormal& along, const Both& of) {
  return along.speed + (dot(point.second, of.second.angular) - dot(point.first, of.first.angular));
}

TOPPLE_INLINE void push(const PackPoint& point, const Wide& impulse, AlongNormal& along, Both& velocity) {
  along.speed += along.masses * impulse;
  along.pushed += impulse;
  for (int i = 0; i < 3; ++i) {
    velocity.first.angular[i] -= point.first[i] * impulse;
    velocity.second.angular[i] += point.second[i] * impulse;
  }
}

TOPPLE_INLINE void push_centres(const ContactPack& pack, const AlongNormal& along, Both& velocity) {
  const Wide first = along.pushed * pack.first_root, second = along.pushed * pack.second_root;
  for (int i = 0; i < 3; ++i) {
    velocity.first.linear[i] -= pack.normal[i] * first;
    velocity.second.linear[i] += pack.normal[i] * second;
  }
}

TOPPLE_INLINE void turn(const ContactPack& pack, const Wide& impulse, Both& velocity) {
  for (int i = 0; i < 3; ++i) {
    velocity.first.angular[i] -= pack.twist_first[i] * impulse;
    velocity.second.angular[i] += pack.twist_second[i] * impulse;
  }
}

TOPPLE_INLINE void load(const ContactPack& pack, const Motion6* from, Both& to) {
  gather(from, pack.first_body, to.first);
  gather(from, pack.second_body, to.second);
}

TOPPLE_INLINE void store(const ContactPack& pack, const Both& from, Motion6* to) {
  scatter(from.first, pack.first_body, to);
  scatter(from.second, pack.second_body, to);
}

/// A pack while a pass is at it.
struct Open {
  ContactPack& pack;
  PackPoint* points;
  Both now;
  AlongNormal along;
  Wide over;  ///< by how much a point has changed beyond what counts as settled
};

template <class Work>
TOPPLE_INLINE Open open(ContactPack& pack, PackPoint* points, const Motion6* velocity, Work& work) {
  Open one{pack, points + pack.first_point, {}, {}, all(0)};
  work.begin(pack, one.points);
  load(pack, velocity, one.now);
  one.along = project_on_normal(pack, one.now);
  return one;
}

template <class Work>
TOPPLE_INLINE void close(Open& one, Motion6* velocity, Work& work) {
  push_centres(one.pack, one.along, one.now);
  work.end(one);
  store(one.pack, one.now, velocity);
}

/// Each point waits for what the one before it did. Two packs that share no body are taken in turns, so that one is
/// worked on while the other waits: no result depends on it.
/// Work: takes(pack) whether it is looked at at all; begin(pack, points) before it is; point(open, i) for each; and
/// end(open) once they are done.
template <class Work>
TOPPLE_INLINE void each_pack(ContactPack* packs, PackPoint* points, std::size_t begin, std::size_t end,
                             Motion6* velocity, Work& work) {
  for (std::size_t k = begin; k < end; ++k) {
    if (!work.takes(packs[k])) continue;
    Open one = open(packs[k], points, velocity, work);
    if (packs[k].apart_from_next && k + 1 < end && work.takes(packs[k + 1])) {
      ++k;
      Open other = open(packs[k], points, velocity, work);
      const int fewer = one.pack.point_count < other.pack.point_count ? one.pack.point_count : other.pack.point_count;
      for (int i = 0; i < fewer; ++i) {
        work.point(one, i);
        work.point(other, i);
      }
      for (int i = fewer; i < one.pack.point_count; ++i) work.point(one, i);
      for (int i = fewer; i < other.pack.point_count; ++i) work.point(other, i);
      close(one, velocity, work);
      close(other, velocity, work);
      continue;
    }
    for (int i = 0; i < one.pack.point_count; ++i) work.point(one, i);
    close(one, velocity, work);
  }
}

struct WholePack {
  TOPPLE_INLINE bool takes(const ContactPack&) const { return true; }
  TOPPLE_INLINE void begin(ContactPack&, PackPoint*) const {}
  TOPPLE_INLINE void end(Open&) const {}
};

struct WarmStart : WholePack {
  TOPPLE_INLINE void point(Open& one, int i) const { push(one.points[i], one.points[i].impulse, one.along, one.now); }
  TOPPLE_INLINE void end(Open& one) const {
    const ContactPack& pack = one.pack;
    for (int i = 0; i < 2; ++i)
      push(pack, pack.along[i], pack.along_first[i], pack.along_second[i], pack.slide[i], one.now);
    turn(pack, pack.twist, one.now);
  }
};

bool warm_start(ContactPack* packs, PackPoint* points, std::size_t begin, std::size_t end, Motion6* velocity,
                const Motion6*, const SubStep&) {
  WarmStart work;
  each_pack(packs, points, begin, end, velocity, work);
  return false;
}

TOPPLE_INLINE Wide magnitude(const Wide& a) { return a > all(0) ? a : -a; }
TOPPLE_INLINE bool any(const Wide& a) { return a[0] > 0 || a[1] > 0 || a[2] > 0 || a[3] > 0; }

/// How far the points of a pack are apart now.
TOPPLE_INLINE void measure(const ContactPack& pack, PackPoint* own, const Motion6* displacement) {
  Both moved;
  load(pack, displacement, moved);
  const AlongNormal along = project_on_normal(pack, moved);
  for (int i = 0; i < pack.point_count; ++i) own[i].apart = own[i].separation + relative(own[i], along, moved);
}

/// The normal impulse with which a point closes no faster than it comes to touch.
TOPPLE_INLINE Wide stopping(const PackPoint& point, const AlongNormal& along, const Both& now, const Wide& rate) {
  const Wide none = all(0);
  const Wide bias = point.apart > none ? point.apart * rate : none;
  return larger(point.impulse - point.mass * (relative(point, along, now) + bias), none);
}

/// Returns by how much the impulse of a point changes so that it comes no nearer than to touch.
TOPPLE_INLINE Wide stop(Open& one, int i, const Wide& rate, const Wide& settled) {
  PackPoint& point = one.points[i];
  const Wide impulse = stopping(point, one.along, one.now, rate), change = impulse - point.impulse;
  point.impulse = impulse;
  one.over = larger(one.over, magnitude(change) - settled * point.mass);
  push(point, change, one.along, one.now);
  return change;
}

struct Solve : WholePack {
  const Motion6* displacement;  ///< null: how far points are apart is known
  Wide rate, settled, over;
  Wide *changes, *energies;  ///< or null

  TOPPLE_INLINE void begin(ContactPack& pack, PackPoint* own) const {
    if (displacement) measure(pack, own, displacement);
  }
  TOPPLE_INLINE void point(Open& one, int i) const {
    const Wide change = stop(one, i, rate, settled);
    if (!changes) return;
    const Wide none = all(0), mass = one.points[i].mass;
    const std::size_t number = one.pack.first_point + static_cast<std::size_t>(i);
    changes[number] = change;
    energies[number] = mass > none ? change * change / (mass > none ? mass : all(1)) : none;
  }
  TOPPLE_INLINE void end(Open& one) { over = larger(over, one.over); }
};

bool solve(ContactPack* packs, PackPoint* points, std::size_t begin, std::size_t end, Motion6* velocity,
           const Motion6* displacement, const SubStep& step) {
  Solve work;
  work.displacement = step.first ? displacement : nullptr;
  work.rate = all(1 / step.length);
  work.settled = all(step.again->settled);
  work.over = all(0);
  work.changes = step.again->change;
  work.energies = step.again->energy;
  each_pack(packs, points, begin, end, velocity, work);
  return any(work.over);
}

struct GoOn : WholePack {
  Wide share;
  Wide *changes, *ways;

  TOPPLE_INLINE void point(Open& one, int i) const {
    const std::size_t number = one.pack.first_point + static_cast<std::size_t>(i);
    PackPoint& point = one.points[i];
    Wide& way = ways[number];
    const Wide farther = share * way, impulse = larger(point.impulse + farther, all(0)),
               change = impulse - point.impulse;
    way = farther + changes[number];
    point.impulse = impulse;
    push(point, change, one.along, one.now);
  }
};

/// Farther the way that passes have gone.
bool go_on(ContactPack* packs, PackPoint* points, std::size_t begin, std::size_t end, Motion6* velocity, const Motion6*,
           const SubStep& step) {
  GoOn work;
  work.share = all(step.again->share);
  work.changes = step.again->change;
  work.ways = step.again->way;
  each_pack(packs, points, begin, end, velocity, work);
  return false;
}

/// Impulses of friction of a patch.
struct Rub {
  Wide slide[2], twist;
};

/// The patch slides and twists as one: both together are bounded by what presses it. What touches at a point slides as
/// if it did not spin, and spins as if it did not slide.
/// Changes the impulses; returns by how much.
TOPPLE_INLINE Wide rub(const ContactPack& pack, const Wide& pressed, Rub& of, Both& now) {
  const Wide none = all(0), one = all(1);
  const Lanes grips = pack.lever > none;
  const Wide lever = grips ? pack.lever : one;
  const Wide turning = dot(pack.twist_second, now.second.angular) - dot(pack.twist_first, now.first.angular);
  const Wide bound = pack.friction * pressed, most = pack.spins_at * bound;
  const Lanes alone = pack.spins_at > none;
  const Wide wanted = grips ? of.twist - pack.twist_mass * turning : none;
  const Wide held = alone ? larger(smaller(wanted, most), -most) : wanted;
  turn(pack, held - of.twist, now);
  const Wide x = relative(pack, pack.along[0], pack.along_first[0], pack.along_second[0], now),
             y = relative(pack, pack.along[1], pack.along_first[1], pack.along_second[1], now);
  Wide a = of.slide[0] - (pack.inverse[0] * x + pack.inverse[1] * y),
       b = of.slide[1] - (pack.inverse[1] * x + pack.inverse[2] * y);
  const Wide c = alone ? none : held / lever;
  const Wide size = root(a * a + b * b + c * c);
  const Wide share = size > bound ? bound / (size > none ? size : one) : one;
  a *= share;
  b *= share;
  const Wide twist = alone ? held : held * share;
  turn(pack, twist - held, now);
  const Wide change[2] = {a - of.slide[0], b - of.slide[1]};
  push(pack, pack.along[0], pack.along_first[0], pack.along_second[0], change[0], now);
  push(pack, pack.along[1], pack.along_first[1], pack.along_second[1], change[1], now);
  of = {{a, b}, twist};
  return larger(magnitude(change[0]), magnitude(change[1]));
}

/// Whether the pass before has changed a body of the pack.
TOPPLE_INLINE bool concerned(const ContactPack& pack, const unsigned char* moved) {
  if (!moved) return true;
  unsigned char one = 0;
  for (int lane = 0; lane < kLanes; ++lane) one |= moved[pack.first_body[lane]] | moved[pack.second_body[lane]];
  return one != 0;
}

/// Where the impulses have changed by more than what counts as settled, both bodies. True: anywhere.
TOPPLE_INLINE bool note_moved(const Open& one, const Wide& over, unsigned char* moves) {
  if (!any(over)) return false;
  for (int lane = 0; lane < kLanes; ++lane) {
    if (!(over[lane] > 0)) continue;
    if (const int first = one.pack.first_body[lane]; first != 0) moves[first] = 1;
    if (const int second = one.pack.second_body[lane]; second != 0) moves[second] = 1;
  }
  return true;
}

struct Relax {
  Wide rate, settled;
  const unsigned char* moved;
  unsigned char* moves;
  bool unsettled = false;

  TOPPLE_INLINE bool takes(const ContactPack& pack) const { return concerned(pack, moved); }
  TOPPLE_INLINE void begin(ContactPack&, PackPoint*) const {}
  TOPPLE_INLINE void point(Open& one, int i) const { stop(one, i, rate, settled); }
  /// Friction last, so that it is bounded by the normal impulses that are told.
  TOPPLE_INLINE void end(Open& one) {
    Wide pressed = all(0);
    for (int i = 0; i < one.pack.point_count; ++i) pressed += one.points[i].impulse;
    ContactPack& pack = one.pack;
    Rub friction{{pack.slide[0], pack.slide[1]}, pack.twist};
    const Wide rubbed = rub(pack, pressed, friction, one.now);
    pack.slide[0] = friction.slide[0];
    pack.slide[1] = friction.slide[1];
    pack.twist = friction.twist;
    const Wide over = larger(one.over, rubbed - settled * smaller(one.pack.inverse[0], one.pack.inverse[2]));
    unsettled = note_moved(one, over, moves) || unsettled;
  }
};

bool relax(ContactPack* packs, PackPoint* points, std::size_t begin, std::size_t end, Motion6* velocity, const Motion6*,
           const SubStep& step) {
  Relax work;
  work.rate = all(1 / step.length);
  work.settled = all(step.again->settled);
  work.moved = step.again->moved;
  work.moves = step.again->moves;
  each_pack(packs, points, begin, end, velocity, work);
  return work.unsettled;
}

TOPPLE_INLINE void add_up(ContactPack& pack, PackPoint* own) {
  for (int i = 0; i < pack.point_count; ++i) {
    own[i].parting = own[i].impulse;
    own[i].total += own[i].impulse;
    pack.carried += own[i].total;
  }
  for (int i = 0; i < 2; ++i) {
    pack.slide_total[i] += pack.slide[i];
    pack.slide_carried[i] += pack.slide_total[i];
  }
  pack.twist_total += pack.twist;
}

struct Separate {
  bool first;
  Wide rate, fastest, settled;
  const unsigned char* moved;
  unsigned char* moves;
  bool unsettled = false;

  TOPPLE_INLINE bool takes(const ContactPack& pack) const { return concerned(pack, moved); }
  TOPPLE_INLINE void begin(ContactPack& pack, PackPoint* own) const {
    if (first) add_up(pack, own);
  }
  TOPPLE_INLINE void point(Open& one, int i) const {
    const ContactPack& pack = one.pack;
    const Wide none = all(0), whole = all(1);
    PackPoint& point = one.points[i];
    const Wide& separation = point.apart;
    const Lanes apart = separation > none;
    const Wide bias = apart ? separation * rate : larger(pack.mass_scale * pack.bias_rate * separation, fastest);
    const Wide scale = apart ? whole : pack.mass_scale, given_back = apart ? none : pack.impulse_scale;
    const Wide speed = relative(point, one.along, one.now);
    const Wide wanted = point.parting - point.mass * (scale * speed + bias) - given_back * point.parting;
    const Wide impulse = larger(wanted, none), change = impulse - point.parting;
    point.parting = impulse;
    one.over = larger(one.over, magnitude(change) - settled * point.mass);
    push(point, change, one.along, one.now);
  }
  TOPPLE_INLINE void end(Open& one) {
    one.pack.carried += one.along.pushed;
    unsettled = note_moved(one, one.over, moves) || unsettled;
  }
};

bool separate(ContactPack* packs, PackPoint* points, std::size_t begin, std::size_t end, Motion6* velocity,
              const Motion6*, const SubStep& step) {
  Separate work;
  work.first = step.first;
  work.rate = all(1 / step.length);
  work.fastest = all(-step.pushed_apart);
  work.settled = all(step.again->settled);
  work.moved = step.again->moved;
  work.moves = step.again->moves;
  each_pack(packs, points, begin, end, velocity, work);
  return work.unsettled;
}

/// What came to touch in the last sub-step has been slowed by then so that it just comes there, and is stopped here: it
/// rubs by that as by any other impulse.
struct Restitute : WholePack {
  Wide from;

  TOPPLE_INLINE void point(Open& one, int i) const {
    const Wide none = all(0);
    PackPoint& point = one.points[i];
    const Lanes bounces = (point.approach < from) & (point.total > none);
    const Wide speed = relative(point, one.along, one.now);
    const Wide wanted = larger(point.total - point.mass * (speed + one.pack.restitution * point.approach), none);
    const Wide change = bounces ? wanted - point.total : none;
    point.total += change;
    push(point, change, one.along, one.now);
  }
  TOPPLE_INLINE void end(Open& one) const {
    ContactPack& pack = one.pack;
    Rub friction{{all(0), all(0)}, all(0)};
    rub(pack, larger(one.along.pushed, all(0)), friction, one.now);
    for (int i = 0; i < 2; ++i) pack.slide_total[i] += friction.slide[i];
    pack.twist_total += friction.twist;
  }
};

bool restitute(ContactPack* packs, PackPoint* points, std::size_t begin, std::size_t end, Motion6* velocity,
               const Motion6*, const SubStep& step) {
  Restitute work;
  work.from = all(-step.restitution_from);
  each_pack(packs, points, begin, end, velocity, work);
  return false;
}

}  // namespace

extern const ContactKernels kernels;
const ContactKernels kernels{warm_start, solve, go_on, relax, separate, restitute};

}  // namespace TOPPLE_KERNELS
}  // namespace topple::collision
