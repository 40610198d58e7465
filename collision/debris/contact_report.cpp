#include "debris/contact_report.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "contacts/contact_order.h"
#include "debris/body_motion.h"

namespace topple::collision {

namespace {

/// Points that are farther apart than this (m) and carried nothing are only near.
constexpr double kTouching = 0.001;
/// N s: what a contact counts for beside its impulse where energy is shared. One may have pushed two apart and told
/// none.
constexpr double kLeastPush = 1e-12;

/// For which a piece of a loop is worth being handed on.
constexpr std::size_t kContacts = 32;

/// Two parts that share their tags with others of their bodies are told as one.
void merge(const Contact& more, Contact& sum) {
  const double a = sum.impulse.norm(), b = more.impulse.norm(), share = a + b > 0 ? b / (a + b) : 0.5;
  const Vec3 point = (1 - share) * sum.point + share * more.point;
  sum.moment += more.moment + (sum.point - point).cross(sum.impulse) + (more.point - point).cross(more.impulse);
  sum.point = point;
  const Vec3 normal = (1 - share) * sum.normal + share * more.normal;
  if (normal.norm() > 1e-9) sum.normal = normal.normalized();  // else squeezed from both sides
  sum.approach_speed += share * (more.approach_speed - sum.approach_speed);
  sum.impulse += more.impulse;
  sum.work_lost += more.work_lost;
  sum.depth = std::max(sum.depth, more.depth);
  sum.persistent = sum.persistent || more.persistent;
  for (int i = 0; i < more.corner_count && sum.corner_count < 4; ++i)
    sum.corners[static_cast<std::size_t>(sum.corner_count++)] = more.corners[static_cast<std::size_t>(i)];
}

}  // namespace

/// Where its impulse acted, in the mean over the step: the two have moved on since the step began.
void ContactReport::locate(const SolverContact& solved, double dt, Contact& contact) const {
  contact.point = solved.centre;
  contact.moment = solved.moment + solved.carried;
  const double squared = solved.impulse.squaredNorm();
  if (!(squared > 0)) return;
  Vec3 velocity = Vec3::Zero();
  int count = 0;
  for (const int number : {solved.first, solved.second})
    if (number != 0) velocity += solved_.solver().body(number).velocity, ++count;
  const double time = std::clamp(solved.late.dot(solved.impulse) / squared, 0.0, dt);
  const Vec3 way = time / count * velocity;
  contact.point += way;
  contact.moment -= way.cross(solved.impulse);
}

/// Whether it pushed or lay close, as its pair will know from now on.
bool ContactReport::touches(const SolverContact& solved) const {
  NearPair& pair = *solved.pair;
  if (pair.told_in != scene_.step_number) pair.persistent = pair.touches;
  pair.told_in = scene_.step_number;
  pair.touches = !solved.impulse.isZero(0) || pair.manifold.nearest() <= kTouching;
  return pair.touches;
}

void ContactReport::fill(const SolverContact& solved, double dt, Contact& contact) const {
  const NearPair& pair = *solved.pair;
  const Manifold& manifold = pair.manifold;
  const Collider &a = scene_.pairs.collider(pair.first), &b = scene_.pairs.collider(pair.second);
  const SolidPart& part = a.solid->parts[static_cast<std::size_t>(a.part)];
  const SolidPart* other =
      pair.second == NearPairs::ground ? nullptr : &b.solid->parts[static_cast<std::size_t>(b.part)];
  contact.body.value = a.solid->id;
  contact.part_tag = part.tag;
  contact.other = touched(*b.solid, other ? other->tag : -1);
  contact.normal = manifold.normal;
  contact.impulse = solved.impulse;
  locate(solved, dt, contact);
  contact.depth = std::max(0.0, -manifold.nearest());
  contact.thickness = other ? std::min(part.thickness, other->thickness) : part.thickness;
  contact.persistent = pair.persistent;
  for (int i = 0; i < manifold.count; ++i) {
    const ManifoldPoint& point = manifold.points[static_cast<std::size_t>(i)];
    if (point.separation > kTouching && !(point.force > 0)) continue;
    contact.corners[static_cast<std::size_t>(contact.corner_count++)] = *solved.second_at * point.on_second;
  }
  const auto velocity_at = [&](bool second) -> Vec3 {
    const int number = second ? solved.second : solved.first;
    if (number == 0) return Vec3::Zero();
    const SolverBody& moves = solved_.solver().body(number);
    return moves.velocity + moves.acceleration * (dt / 2) + moves.spin.cross(solved.centre - moves.at.position);
  };
  contact.approach_speed = (velocity_at(false) - velocity_at(true)).dot(contact.normal);
}

void ContactReport::add(std::span<SolverContact> solved, double dt, std::span<const char> left_out) {
  const auto is_left_out = [&](int number) { return !left_out.empty() && left_out[static_cast<std::size_t>(number)]; };
  const auto each = [&](const auto& work) {
    region_.each(solved.size(), kContacts, [&](std::size_t i) {
      if (i + kAhead < solved.size()) prefetch_lines(*solved[i + kAhead].pair);
      work(solved[i]);
    });
  };
  each([&](SolverContact& one) {
    const bool told = !is_left_out(one.first) && !is_left_out(one.second) && touches(one);
    one.told = told ? 0 : -1;
  });
  std::size_t count = contacts_.size();
  for (SolverContact& one : solved)
    if (one.told == 0) one.told = static_cast<int>(count++);
  contacts_.resize(count);
  each([&](const SolverContact& one) {
    if (one.told >= 0) fill(one, dt, contacts_[static_cast<std::size_t>(one.told)]);
  });
}

/// Impulses times the mean of the velocities before and after them, and what is missing to a body's change of energy in
/// proportion to their sizes: velocities change within the step.
void ContactReport::account_work(std::span<Island* const> islands, double dt) {
  for (const Island* island : islands)
    for (DebrisBody* one : island->bodies) one->pushed = one->accounted = 0;
  const Vec3 half_kick = scene_.gravity * (dt / 2);
  const auto work = [&](DebrisBody& on, const Vec3& impulse, const Vec3& moment) {  // taken out
    const double taken =
        -impulse.dot((on.velocity_before + on.velocity) / 2 + half_kick) - moment.dot((on.spin_before + on.spin) / 2);
    on.accounted += taken;
    on.pushed += impulse.norm() + kLeastPush;
    return taken;
  };
  for (const SolverContact& solved : solved_.solver().contacts()) {
    if (solved.told < 0) continue;
    for (const bool second : {false, true})
      if (DebrisBody* on = solved_.body_of(solved, second)) {
        const Vec3 impulse = second ? solved.impulse : Vec3(-solved.impulse);
        const SolverBody& moves = solved_.solver().body(second ? solved.second : solved.first);
        const Vec3 moment =
            (solved.centre - moves.at.position).cross(impulse) + (second ? solved.moment : Vec3(-solved.moment));
        contacts_[static_cast<std::size_t>(solved.told)].work_lost += work(*on, impulse, moment);
      }
  }
  for (const Island* island : islands) {
    for (DebrisHinge* hinge : island->hinges) {
      hinge->work_lost += work(scene_.body(hinge->body), hinge->rows.force_total, hinge->rows.body_moment);
      if (hinge->other >= 0)
        hinge->work_lost += work(scene_.body(hinge->other), -hinge->rows.force_total, hinge->rows.holder_moment);
    }
    for (DebrisCable* cable : island->cables)
      cable->pull.work_lost += work(scene_.body(cable->body), cable->row.impulse, Vec3::Zero());
  }
  for (const Island* island : islands)
    for (DebrisBody* one : island->bodies)
      if (one->pushed > 0)
        one->missing = one->energy_before - (energy(*one, scene_.gravity, dt) - one->swung) - one->accounted;
  const auto share = [](const DebrisBody& on, double size) {
    return on.pushed > 0 ? size / on.pushed * on.missing : 0.0;
  };
  for (const SolverContact& solved : solved_.solver().contacts())
    for (const bool second : {false, true})
      if (const DebrisBody* on = solved_.body_of(solved, second); on && solved.told >= 0)
        contacts_[static_cast<std::size_t>(solved.told)].work_lost += share(*on, solved.impulse.norm() + kLeastPush);
  for (const Island* island : islands) {
    for (DebrisHinge* hinge : island->hinges) {
      const double size = hinge->rows.force_total.norm() + kLeastPush;
      hinge->work_lost += share(scene_.body(hinge->body), size);
      if (hinge->other >= 0) hinge->work_lost += share(scene_.body(hinge->other), size);
    }
    for (DebrisCable* cable : island->cables)
      cable->pull.work_lost += share(scene_.body(cable->body), cable->row.impulse.norm() + kLeastPush);
  }
}

void ContactReport::merge_parts() {
  const auto not_before = [](const Contact& a, const Contact& b) { return !before_by_parts(a, b); };
  if (std::adjacent_find(contacts_.begin(), contacts_.end(), not_before) == contacts_.end()) return;
  std::vector<std::uint32_t> order(contacts_.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return parts_of(contacts_[a]) < parts_of(contacts_[b]); });
  std::vector<Contact> merged;
  merged.reserve(contacts_.size());
  for (const std::uint32_t i : order) {
    if (!merged.empty() && parts_of(merged.back()) == parts_of(contacts_[i]))
      merge(contacts_[i], merged.back());
    else
      merged.push_back(contacts_[i]);
  }
  contacts_.swap(merged);
}

void ContactReport::mark_persistent(std::vector<Contact>& found) const {
  if (found.empty()) return;
  std::vector<decltype(parts_of(found[0]))> known;
  for (const std::uint32_t index : scene_.pairs.order()) {
    const NearPair& pair = scene_.pairs.pair(index);
    if (!pair.touches || pair.manifold.count == 0) continue;
    const Collider &a = scene_.pairs.collider(pair.first), &b = scene_.pairs.collider(pair.second);
    Contact contact;
    contact.body.value = a.solid->id;
    contact.part_tag = a.solid->parts[static_cast<std::size_t>(a.part)].tag;
    contact.other =
        touched(*b.solid, pair.second == NearPairs::ground ? -1 : b.solid->parts[static_cast<std::size_t>(b.part)].tag);
    known.push_back(parts_of(contact));
  }
  std::sort(known.begin(), known.end());
  for (Contact& contact : found) contact.persistent = std::binary_search(known.begin(), known.end(), parts_of(contact));
}

void ContactReport::forget(Touched::Kind kind, std::int64_t id) {
  std::erase_if(contacts_, [&](const Contact& contact) {
    if (kind == Touched::Kind::obstacle) return contact.other.obstacle.value == id;
    return contact.body.value == id || contact.other.body.value == id;
  });
}

}  // namespace topple::collision
