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

bool warm_start(ContactPack* packs, PackPoint* points, std::size_t begin, std::size_t end, Motion6* velocity,
                const Motion6*, const SubStep&) {
  for (std::size_t k = begin; k < end; ++k) {
    const ContactPack& pack = packs[k];
    Both now;
    load(pack, velocity, now);
    for (int i = 0; i < pack.point_count; ++i) {
      const PackPoint& point = points[pack.first_point + static_cast<std::size_t>(i)];
      push(pack, pack.normal, point.first, point.second, point.impulse, now);
    }
    for (int i = 0; i < 2; ++i)
      push(pack, pack.along[i], pack.along_first[i], pack.along_second[i], pack.slide[i], now);
    turn(pack, pack.twist, now);
    store(pack, now, velocity);
  }
  return false;
}

TOPPLE_INLINE Wide magnitude(const Wide& a) { return a > all(0) ? a : -a; }
TOPPLE_INLINE bool any(const Wide& a) { return a[0] > 0 || a[1] > 0 || a[2] > 0 || a[3] > 0; }

/// How far the points of a pack are apart now.
TOPPLE_INLINE void measure(const ContactPack& pack, PackPoint* own, const Motion6* displacement) {
  Both moved;
  load(pack, displacement, moved);
  for (int i = 0; i < pack.point_count; ++i)
    own[i].apart = own[i].separation + relative(pack, pack.normal, own[i].first, own[i].second, moved);
}

/// The normal impulse with which a point closes no faster than it comes to touch.
TOPPLE_INLINE Wide stopping(const ContactPack& pack, const PackPoint& point, const Both& now, const Wide& rate) {
  const Wide none = all(0);
  const Wide bias = point.apart > none ? point.apart * rate : none;
  const Wide speed = relative(pack, pack.normal, point.first, point.second, now);
  return larger(point.impulse - point.mass * (speed + bias), none);
}

bool solve(ContactPack* packs, PackPoint* points, std::size_t begin, std::size_t end, Motion6* velocity,
           const Motion6* displacement, const SubStep& step) {
  const Wide rate = all(1 / step.length), none = all(0), one = all(1);
  const Wide settled = all(step.again->settled);
  Wide over = none;
  Wide* const changes = step.again->change;
  for (std::size_t k = begin; k < end; ++k) {
    ContactPack& pack = packs[k];
    if (step.first) measure(pack, points + pack.first_point, displacement);
    Both now;
    load(pack, velocity, now);
    for (int i = 0; i < pack.point_count; ++i) {
      PackPoint& point = points[pack.first_point + static_cast<std::size_t>(i)];
      const Wide impulse = stopping(pack, point, now, rate), change = impulse - point.impulse;
      point.impulse = impulse;
      const Wide excess = magnitude(change) - settled * point.mass;
      over = larger(over, excess);
      if (changes) {
        const std::size_t number = pack.first_point + static_cast<std::size_t>(i);
        changes[number] = change;
        step.again->energy[number] =
            point.mass > none ? change * change / (point.mass > none ? point.mass : one) : none;
      }
      push(pack, pack.normal, point.first, point.second, change, now);
    }
    store(pack, now, velocity);
  }
  return any(over);
}

/// Farther the way that passes have gone.
bool go_on(ContactPack* packs, PackPoint* points, std::size_t begin, std::size_t end, Motion6* velocity, const Motion6*,
           const SubStep& step) {
  const Wide share = all(step.again->share), none = all(0);
  for (std::size_t k = begin; k < end; ++k) {
    const ContactPack& pack = packs[k];
    Both now;
    load(pack, velocity, now);
    for (int i = 0; i < pack.point_count; ++i) {
      const std::size_t number = pack.first_point + static_cast<std::size_t>(i);
      PackPoint& point = points[number];
      Wide& way = step.again->way[number];
      const Wide farther = share * way, impulse = larger(point.impulse + farther, none),
                 change = impulse - point.impulse;
      way = farther + step.again->change[number];
      point.impulse = impulse;
      push(pack, pack.normal, point.first, point.second, change, now);
    }
    store(pack, now, velocity);
  }
  return false;
}

/// The patch slides and twists as one: both together are bounded by what presses it.
/// Returns by how much its impulses have changed.
TOPPLE_INLINE Wide rub(ContactPack& pack, const PackPoint* points, Both& now) {
  Wide pressed = all(0);
  for (int i = 0; i < pack.point_count; ++i) pressed += points[i].impulse;
  const Wide none = all(0), one = all(1);
  const Lanes grips = pack.lever > none;
  const Wide lever = grips ? pack.lever : one;
  const Wide turning = dot(pack.twist_second, now.second.angular) - dot(pack.twist_first, now.first.angular);
  const Wide held = grips ? pack.twist - pack.twist_mass * turning : none;
  turn(pack, held - pack.twist, now);
  const Wide x = relative(pack, pack.along[0], pack.along_first[0], pack.along_second[0], now),
             y = relative(pack, pack.along[1], pack.along_first[1], pack.along_second[1], now);
  Wide a = pack.slide[0] - (pack.inverse[0] * x + pack.inverse[1] * y),
       b = pack.slide[1] - (pack.inverse[1] * x + pack.inverse[2] * y);
  const Wide c = held / lever;
  const Wide bound = pack.friction * pressed, size = root(a * a + b * b + c * c);
  const Wide share = size > bound ? bound / (size > none ? size : one) : one;
  a *= share;
  b *= share;
  const Wide twist = held * share;
  turn(pack, twist - held, now);
  const Wide change[2] = {a - pack.slide[0], b - pack.slide[1]};
  push(pack, pack.along[0], pack.along_first[0], pack.along_second[0], change[0], now);
  push(pack, pack.along[1], pack.along_first[1], pack.along_second[1], change[1], now);
  pack.slide[0] = a;
  pack.slide[1] = b;
  pack.twist = twist;
  return larger(magnitude(change[0]), magnitude(change[1]));
}

/// Whether the pass before has changed a body of the pack.
TOPPLE_INLINE bool concerned(const ContactPack& pack, const unsigned char* moved) {
  if (!moved) return true;
  unsigned char one = 0;
  for (int lane = 0; lane < kLanes; ++lane) one |= moved[pack.first_body[lane]] | moved[pack.second_body[lane]];
  return one != 0;
}

bool relax(ContactPack* packs, PackPoint* points, std::size_t begin, std::size_t end, Motion6* velocity, const Motion6*,
           const SubStep& step) {
  const Wide rate = all(1 / step.length), settled = all(step.again->settled), none = all(0);
  bool unsettled = false;
  for (std::size_t k = begin; k < end; ++k) {
    ContactPack& pack = packs[k];
    if (!concerned(pack, step.again->moved)) continue;
    Wide over = none;
    PackPoint* const own = points + pack.first_point;
    Both now;
    load(pack, velocity, now);
    for (int i = 0; i < pack.point_count; ++i) {
      PackPoint& point = own[i];
      const Wide impulse = stopping(pack, point, now, rate), change = impulse - point.impulse;
      point.impulse = impulse;
      over = larger(over, magnitude(change) - settled * point.mass);
      push(pack, pack.normal, point.first, point.second, change, now);
    }
    // Last, so that friction is bounded by the normal impulses that are told.
    over = larger(over, rub(pack, own, now) - settled * smaller(pack.inverse[0], pack.inverse[2]));
    store(pack, now, velocity);
    for (int lane = 0; lane < kLanes; ++lane) {
      if (!(over[lane] > 0)) continue;
      unsettled = true;
      if (const int first = pack.first_body[lane]; first != 0) step.again->moves[first] = 1;
      if (const int second = pack.second_body[lane]; second != 0) step.again->moves[second] = 1;
    }
  }
  return unsettled;
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

bool separate(ContactPack* packs, PackPoint* points, std::size_t begin, std::size_t end, Motion6* velocity,
              const Motion6*, const SubStep& step) {
  const Wide rate = all(1 / step.length), none = all(0), one = all(1), fastest = all(-step.pushed_apart);
  for (std::size_t k = begin; k < end; ++k) {
    ContactPack& pack = packs[k];
    if (step.first) add_up(pack, points + pack.first_point);
    Both now;
    load(pack, velocity, now);
    for (int i = 0; i < pack.point_count; ++i) {
      PackPoint& point = points[pack.first_point + static_cast<std::size_t>(i)];
      const Wide& separation = point.apart;
      const Lanes apart = separation > none;
      const Wide bias = apart ? separation * rate : larger(pack.mass_scale * pack.bias_rate * separation, fastest);
      const Wide scale = apart ? one : pack.mass_scale, given_back = apart ? none : pack.impulse_scale;
      const Wide speed = relative(pack, pack.normal, point.first, point.second, now);
      const Wide wanted = point.parting - point.mass * (scale * speed + bias) - given_back * point.parting;
      const Wide impulse = larger(wanted, none), change = impulse - point.parting;
      point.parting = impulse;
      pack.carried += change;
      push(pack, pack.normal, point.first, point.second, change, now);
    }
    store(pack, now, velocity);
  }
  return false;
}

bool restitute(ContactPack* packs, PackPoint* points, std::size_t begin, std::size_t end, Motion6* velocity,
               const Motion6*, const SubStep& step) {
  const Wide none = all(0), from = all(-step.restitution_from);
  for (std::size_t k = begin; k < end; ++k) {
    ContactPack& pack = packs[k];
    PackPoint* const own = points + pack.first_point;
    Both now;
    load(pack, velocity, now);
    for (int i = 0; i < pack.point_count; ++i) {
      PackPoint& point = own[i];
      const Lanes bounces = (point.approach < from) & (point.total > none);
      const Wide speed = relative(pack, pack.normal, point.first, point.second, now);
      const Wide wanted = larger(point.total - point.mass * (speed + pack.restitution * point.approach), none);
      const Wide change = bounces ? wanted - point.total : none;
      point.total += change;
      push(pack, pack.normal, point.first, point.second, change, now);
    }
    store(pack, now, velocity);
  }
  return false;
}

}  // namespace

extern const ContactKernels kernels;
const ContactKernels kernels{warm_start, solve, go_on, relax, separate, restitute};

}  // namespace TOPPLE_KERNELS
}  // namespace topple::collision
