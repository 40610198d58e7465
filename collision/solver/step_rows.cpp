// Contacts as rows: their arms and effective masses.
#include <algorithm>
#include <cmath>

#include "solver/step_solver.h"

namespace topple::collision {

int StepSolver::domains_of(std::size_t contacts) const {
  return std::clamp(static_cast<int>(contacts) / settings_.contacts_of_domain, 1, settings_.most_domains);
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

void StepSolver::prepare(SolverContact& contact, double dt) {
  ContactPack& pack = pack_of(contact);
  const int lane = contact.lane;
  const bool stands = contact.first == 0 || contact.second == 0;
  const double frequency = 1 / (settings_.stiffness * h_) * (stands ? settings_.standing_stiffer : 1);
  // What sleeps bears no more and no less of an overlap than it did when it fell asleep: pushed apart from it, the
  // other would lose what it rests with, and the heap would move where one of its bodies wakes.
  const Softness soft = contact.held
                            ? Softness{0, 1, 0}
                            : softness(frequency, settings_.damping * (stands ? settings_.standing_damping : 1), h_);
  pack.bias_rate[lane] = soft.bias_rate;
  pack.mass_scale[lane] = soft.mass_scale;
  pack.impulse_scale[lane] = soft.impulse_scale;
  pack.first_root[lane] = bodies_[static_cast<std::size_t>(contact.first)].inverse_root_mass;
  pack.second_root[lane] = bodies_[static_cast<std::size_t>(contact.second)].inverse_root_mass;
  pack.restitution[lane] = contact.restitution;
  pack.friction[lane] = contact.friction;
  set(pack.normal, lane, contact.pair->manifold.normal);
  contact.find_places();
  if (!contact.first_ball && !contact.second_ball) shift_by_rolling(contact, dt);
  prepare_points(contact, pack, h_);
  prepare_friction(contact, pack, h_);
}

/// Where one body rolls on the other, the middle of the forces of a patch is ahead of its own, which brakes the roll.
/// Slow rolling is braked in proportion, and a step takes no more than a share of it.
void StepSolver::shift_by_rolling(SolverContact& contact, double dt) const {
  const SolverBody &first = bodies_[static_cast<std::size_t>(contact.first)],
                   &second = bodies_[static_cast<std::size_t>(contact.second)];
  const Manifold& manifold = contact.pair->manifold;
  double pressed = 0;
  for (int i = 0; i < manifold.count; ++i) pressed += manifold.points[static_cast<std::size_t>(i)].force;
  const Vec3 ahead = (second.spin - first.spin).cross(manifold.normal);
  const double rate = ahead.norm();
  if (!(pressed > 0 && rate > 0)) return;
  constexpr double taken = 0.25;  // of the roll, in a step
  const double lever = rolling_lever(settings_);
  const Vec3 axis = manifold.normal.cross(ahead) / rate;
  const double gives = first.scaled_moment(axis).squaredNorm() + second.scaled_moment(axis).squaredNorm(),
               braked = lever * pressed * dt * gives;
  const Vec3 shift = lever / std::max({rate, settings_.rolls_from, braked / taken}) * ahead;
  for (int i = 0; i < manifold.count; ++i) contact.places[static_cast<std::size_t>(i)] += shift;
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
    PackPoint& row = packing_.points()[pack.first_point + static_cast<std::size_t>(i)];
    const Vec3& place = contact.places[static_cast<std::size_t>(i)];
    const Vec3 a = first.scaled_moment((place - first.at.position).cross(n)),
               b = second.scaled_moment((place - second.at.position).cross(n));
    set(row.first, lane, a);
    set(row.second, lane, b);
    const bool bears = contact.held && point.force > 0 && bears_at_rest(point);
    row.separation[lane] = bears ? std::min(0.0, point.separation) : point.separation;
    row.mass[lane] = 1 / (masses + a.squaredNorm() + b.squaredNorm());
    row.impulse[lane] = point.impulse * h;
    row.approach[lane] = n.dot(across) + b.dot(second_spin) - a.dot(first_spin);
  }
}

/// At the middle of the forces of the last step; where there are none yet, by nearness.
void StepSolver::find_friction_centre(SolverContact& contact) const {
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
  contact.lever = std::max(contact.lever, spin_lever(settings_));
}

void StepSolver::prepare_friction(SolverContact& contact, ContactPack& pack, double h) {
  const SolverBody &first = bodies_[static_cast<std::size_t>(contact.first)],
                   &second = bodies_[static_cast<std::size_t>(contact.second)];
  const Manifold& manifold = contact.pair->manifold;
  const Vec3& n = manifold.normal;
  const int lane = contact.lane;
  find_friction_centre(contact);
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
  pack.spins_at[lane] = contact.lever > spin_lever(settings_) ? 0 : contact.lever;
}

}  // namespace topple::collision
