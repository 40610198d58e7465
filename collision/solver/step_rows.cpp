// Contacts as rows: in which order they are solved, packed by four, their arms and effective masses.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "solver/step_solver.h"

namespace topple::collision {

int StepSolver::domains_of(std::size_t contacts) const {
  return std::clamp(static_cast<int>(contacts) / settings_.contacts_of_domain, 1, settings_.most_domains);
}

ContactDomains StepSolver::find_domains() const {
  const int most = domains_of(contacts_.size());
  if (most == 1) return one_domain(contacts_.size());
  std::vector<ContactEnds> ends;
  ends.reserve(contacts_.size());
  for (const SolverContact& contact : contacts_) ends.push_back({contact.first, contact.second});
  return collision::find_domains(ends, ordered_, most);
}

/// Set by set of their domains, in each colour by colour: whoever takes a set goes through its packs in this order.
void StepSolver::pack_contacts() {
  ContactDomains domains = find_domains();
  packs_.clear();
  packed_.clear();
  points_.clear();
  colours_.clear();
  sets_.clear();
  used_.assign(bodies_.size(), 0);
  for (const auto& set : domains.sets) {
    sets_.push_back(packs_.size());
    colour(set);
    if (domains.sets.size() > 1) fill_last_packs();
    for (const auto& list : by_colour_)
      if (!list.empty()) fill_packs(list);
  }
  sets_.push_back(packs_.size());
  colours_.push_back(packs_.size());
  stages_ = std::move(domains.stages);
}

/// No body twice in a colour. In the order of contacts, so that it follows from handles.
void StepSolver::colour(std::span<const std::uint32_t> set) {
  for (auto& list : by_colour_) list.clear();
  const auto word = [&](int body, std::size_t w) -> std::uint64_t {
    if (w == 0) return used_[static_cast<std::size_t>(body)];
    const auto beyond = used_beyond_.find(body);
    return beyond == used_beyond_.end() || w > beyond->second.size() ? 0 : beyond->second[w - 1];
  };
  const auto mark = [&](int body, std::size_t chosen) {
    if (body == 0) return;
    const std::size_t w = chosen / 64;
    const std::uint64_t bit = std::uint64_t{1} << (chosen % 64);
    if (w == 0) {
      used_[static_cast<std::size_t>(body)] |= bit;
      return;
    }
    auto& beyond = used_beyond_[body];
    if (beyond.size() < w) beyond.resize(w, 0);
    beyond[w - 1] |= bit;
  };
  for (const std::uint32_t i : set) {
    const SolverContact& contact = contacts_[i];
    std::size_t chosen = 0;
    for (std::size_t w = 0;; ++w) {
      const std::uint64_t taken = word(contact.first, w) | word(contact.second, w);
      if (taken == std::numeric_limits<std::uint64_t>::max()) continue;
      chosen = 64 * w + static_cast<std::size_t>(__builtin_ctzll(~taken));
      break;
    }
    mark(contact.first, chosen);
    mark(contact.second, chosen);
    if (by_colour_.size() <= chosen) by_colour_.resize(chosen + 1);
    by_colour_[chosen].push_back(i);
  }
  // Few lanes of a pack stay without a point.
  const auto points = [&](std::uint32_t i) { return contacts_[i].pair->manifold.count; };
  for (auto& list : by_colour_)
    std::stable_sort(list.begin(), list.end(), [&](std::uint32_t a, std::uint32_t b) { return points(a) > points(b); });
  for (const std::uint32_t i : set)
    for (const int body : {contacts_[i].first, contacts_[i].second}) used_[static_cast<std::size_t>(body)] = 0;
  used_beyond_.clear();
}

/// The colours of a small set are short: lanes that stay free in the last pack of one take contacts of later colours.
/// They are solved earlier then, which is no matter to one thread.
void StepSolver::fill_last_packs() {
  for (std::size_t c = 0; c + 1 < by_colour_.size(); ++c) {
    auto& list = by_colour_[c];
    const auto shares_body = [&](std::uint32_t i) {
      const SolverContact& contact = contacts_[i];
      return std::any_of(list.end() - static_cast<std::ptrdiff_t>(list.size() % kLanes), list.end(),
                         [&](std::uint32_t other) {
                           const SolverContact& of = contacts_[other];
                           return (contact.first != 0 && (contact.first == of.first || contact.first == of.second)) ||
                                  (contact.second != 0 && (contact.second == of.first || contact.second == of.second));
                         });
    };
    for (std::size_t later = by_colour_.size() - 1; later > c && list.size() % kLanes != 0; --later) {
      auto& from = by_colour_[later];
      for (std::size_t i = 0; i < from.size() && list.size() % kLanes != 0;)
        if (shares_body(from[i])) {
          ++i;
        } else {
          list.push_back(from[i]);
          from.erase(from.begin() + static_cast<std::ptrdiff_t>(i));
        }
    }
  }
}

namespace {
bool share_no_body(const ContactPack& one, const ContactPack& other) {
  const auto has = [](const int* bodies, int body) {
    return body != 0 && (bodies[0] == body || bodies[1] == body || bodies[2] == body || bodies[3] == body);
  };
  bool shared = false;
  for (const int* mine : {one.first_body, one.second_body})
    for (int lane = 0; lane < kLanes; ++lane)
      shared = shared || has(other.first_body, mine[lane]) || has(other.second_body, mine[lane]);
  return !shared;
}
}  // namespace

/// Of one colour.
void StepSolver::fill_packs(std::span<const std::uint32_t> list) {
  colours_.push_back(packs_.size());
  const auto points = [&](std::uint32_t i) { return contacts_[i].pair->manifold.count; };
  for (std::size_t begin = 0; begin < list.size(); begin += kLanes) {
    ContactPack& pack = packs_.emplace_back();
    pack.first_point = points_.size();
    for (std::size_t i = begin; i < std::min(begin + kLanes, list.size()); ++i)
      pack.point_count = std::max(pack.point_count, points(list[i]));
    points_.resize(points_.size() + static_cast<std::size_t>(pack.point_count), PackPoint{});
    packed_.resize(packed_.size() + kLanes, kNone);
    for (std::size_t lane = 0; lane < kLanes && begin + lane < list.size(); ++lane) {
      SolverContact& contact = contacts_[list[begin + lane]];
      packed_[packed_.size() - kLanes + lane] = list[begin + lane];
      contact.pack = static_cast<int>(packs_.size()) - 1;
      contact.lane = static_cast<int>(lane);
      pack.first_body[lane] = contact.first;
      pack.second_body[lane] = contact.second;
    }
    if (packs_.size() > 1) {
      ContactPack& before = packs_[packs_.size() - 2];
      before.apart_from_next = share_no_body(before, pack);
    }
  }
}

namespace {
void set(Wide* of, int lane, const Vec3& v) {
  for (int i = 0; i < 3; ++i) of[i][lane] = v[i];
}
}  // namespace

void SolverContact::find_places() {
  for (std::size_t i = 0; i < static_cast<std::size_t>(pair->manifold.count); ++i) {
    const ManifoldPoint& point = pair->manifold.points[i];
    places[i] = (*first_at * point.on_first + *second_at * point.on_second) / 2;
  }
}

void StepSolver::prepare(SolverContact& contact) {
  ContactPack& pack = packs_[static_cast<std::size_t>(contact.pack)];
  const int lane = contact.lane;
  const bool stands = contact.first == 0 || contact.second == 0;
  const double frequency = 1 / (settings_.stiffness * h_) * (stands ? settings_.standing_stiffer : 1);
  const Softness soft = softness(frequency, settings_.damping * (stands ? settings_.standing_damping : 1), h_);
  pack.bias_rate[lane] = soft.bias_rate;
  pack.mass_scale[lane] = soft.mass_scale;
  pack.impulse_scale[lane] = soft.impulse_scale;
  pack.first_root[lane] = bodies_[static_cast<std::size_t>(contact.first)].inverse_root_mass;
  pack.second_root[lane] = bodies_[static_cast<std::size_t>(contact.second)].inverse_root_mass;
  pack.restitution[lane] = contact.restitution;
  pack.friction[lane] = contact.friction;
  set(pack.normal, lane, contact.pair->manifold.normal);
  contact.find_places();
  prepare_points(contact, pack, h_);
  prepare_friction(contact, pack, h_);
}

void StepSolver::prepare_points(SolverContact& contact, ContactPack& pack, double h) {
  const SolverBody &first = bodies_[static_cast<std::size_t>(contact.first)],
                   &second = bodies_[static_cast<std::size_t>(contact.second)];
  const Manifold& manifold = contact.pair->manifold;
  const Vec3& n = manifold.normal;
  const int lane = contact.lane;
  const double masses =
      first.inverse_root_mass * first.inverse_root_mass + second.inverse_root_mass * second.inverse_root_mass;
  const Vec3 across = second.linear(velocity_[static_cast<std::size_t>(contact.second)]) -
                      first.linear(velocity_[static_cast<std::size_t>(contact.first)]);
  const auto spin = [&](int body) {
    const Motion6& v = velocity_[static_cast<std::size_t>(body)];
    return Vec3(v.angular[0], v.angular[1], v.angular[2]);
  };
  const Vec3 first_spin = spin(contact.first), second_spin = spin(contact.second);
  for (int i = 0; i < manifold.count; ++i) {
    const ManifoldPoint& point = manifold.points[static_cast<std::size_t>(i)];
    PackPoint& row = points_[pack.first_point + static_cast<std::size_t>(i)];
    const Vec3& place = contact.places[static_cast<std::size_t>(i)];
    const Vec3 a = first.scaled_moment((place - first.at.position).cross(n)),
               b = second.scaled_moment((place - second.at.position).cross(n));
    set(row.first, lane, a);
    set(row.second, lane, b);
    row.separation[lane] = point.separation;
    row.mass[lane] = 1 / (masses + a.squaredNorm() + b.squaredNorm());
    row.impulse[lane] = point.impulse * h;
    row.approach[lane] = n.dot(across) + b.dot(second_spin) - a.dot(first_spin);
  }
}

/// At the middle of the forces of the last step; where there are none yet, by nearness.
void StepSolver::place_friction(SolverContact& contact) const {
  const Manifold& manifold = contact.pair->manifold;
  std::array<double, Manifold::most> weights{};
  double sum = 0;
  for (int pass = 0; pass < 2 && !(sum > 0); ++pass)
    for (int i = 0; i < manifold.count; ++i) {
      const auto k = static_cast<std::size_t>(i);
      const ManifoldPoint& point = manifold.points[k];
      weights[k] = pass == 0 ? point.force : 1 / (1 + std::max(0.0, point.separation) / settings_.margin);
      sum += weights[k];
    }
  contact.anchor.setZero();
  contact.lever = 0;
  for (int i = 0; i < manifold.count; ++i)
    contact.anchor += weights[static_cast<std::size_t>(i)] / sum * contact.places[static_cast<std::size_t>(i)];
  for (int i = 0; i < manifold.count; ++i) {
    const Vec3 arm = contact.places[static_cast<std::size_t>(i)] - contact.anchor;
    contact.lever +=
        weights[static_cast<std::size_t>(i)] / sum * (arm - manifold.normal.dot(arm) * manifold.normal).norm();
  }
}

void StepSolver::prepare_friction(SolverContact& contact, ContactPack& pack, double h) {
  const SolverBody &first = bodies_[static_cast<std::size_t>(contact.first)],
                   &second = bodies_[static_cast<std::size_t>(contact.second)];
  const Manifold& manifold = contact.pair->manifold;
  const Vec3& n = manifold.normal;
  const int lane = contact.lane;
  place_friction(contact);
  const Vec3 aside = std::abs(n.z()) < 0.7 ? Vec3(0, 0, 1) : Vec3(1, 0, 0);
  std::array<Vec3, 2> along;
  along[0] = aside.cross(n).normalized();
  along[1] = n.cross(along[0]);
  std::array<Vec3, 2> on_first, on_second;
  for (std::size_t i = 0; i < 2; ++i) {
    on_first[i] = first.scaled_moment((contact.anchor - first.at.position).cross(along[i]));
    on_second[i] = second.scaled_moment((contact.anchor - second.at.position).cross(along[i]));
    set(pack.along[i], lane, along[i]);
    set(pack.along_first[i], lane, on_first[i]);
    set(pack.along_second[i], lane, on_second[i]);
    pack.slide[i][lane] = manifold.friction.dot(along[i]) * h;
  }
  const double masses =
      first.inverse_root_mass * first.inverse_root_mass + second.inverse_root_mass * second.inverse_root_mass;
  const double xx = masses + on_first[0].squaredNorm() + on_second[0].squaredNorm(),
               yy = masses + on_first[1].squaredNorm() + on_second[1].squaredNorm(),
               xy = on_first[0].dot(on_first[1]) + on_second[0].dot(on_second[1]), determinant = xx * yy - xy * xy;
  pack.inverse[0][lane] = yy / determinant;
  pack.inverse[1][lane] = -xy / determinant;
  pack.inverse[2][lane] = xx / determinant;
  const Vec3 twist_first = first.scaled_moment(n), twist_second = second.scaled_moment(n);
  set(pack.twist_first, lane, twist_first);
  set(pack.twist_second, lane, twist_second);
  pack.twist_mass[lane] = 1 / (twist_first.squaredNorm() + twist_second.squaredNorm());
  pack.twist[lane] = manifold.twist * h;
  pack.lever[lane] = contact.lever;
}

}  // namespace topple::collision
