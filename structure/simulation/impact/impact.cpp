#include "simulation/impact/impact.h"
#include "simulation/impact/shared_push.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace topple::structure {

namespace {

using shared_push::first_time;
using shared_push::free_motion;
using shared_push::no_force;
using shared_push::passes_zero;
using shared_push::pi;
using shared_push::samples_per_period;
/// What is bound may swing more slowly than what pushes it: a push that has not ended after so many periods of its own,
/// with nothing moving behind the place, is left to the motion of what stands.
constexpr double most_periods = 4;
constexpr double never = std::numeric_limits<double>::infinity();

/// Least t > 0 with gap + speed t + acceleration t^2/2 = 0 on the way up, gap below zero; `never` when there is none.
double closes_after(double gap, double speed, double acceleration) {
  const double squared = speed * speed - 2 * acceleration * gap;
  if (squared < 0) return never;
  const double root = std::sqrt(squared);
  // Written so that no digits are lost: gap = -t (speed + root)/2.
  const double t = speed + root > 0 ? -2 * gap / (speed + root) : never;
  return t > 0 ? t : never;
}

}  // namespace

/// The places that touch in modal coordinates, from now on.
struct Impact::Modes {
  std::vector<int> touching, apart;
  Eigen::MatrixXd forces;     ///< of the places that touch, by unit coordinates, N
  Eigen::MatrixXd pressed;    ///< by how much they are pressed likewise, m
  Eigen::VectorXd frequency;  ///< circular, 1/s; 0: a free motion
  Eigen::VectorXd place, speed, push;
  Eigen::VectorXd rest;  ///< where it swings about

  [[nodiscard]] double fastest() const { return frequency.maxCoeff(); }
  [[nodiscard]] double slowest() const {
    double least = fastest();
    for (const double one : frequency)
      if (one > 0) least = std::min(least, one);
    return least;
  }
  /// Of order -1: velocities, 0: coordinates, 1 and 2: their integrals from now.
  [[nodiscard]] Eigen::VectorXd coordinates(double t, int order) const;
  /// Forces of the places that touch (order 0), their rates (-1) and integrals (1, 2).
  [[nodiscard]] Eigen::VectorXd force(double t, int order = 0) const { return forces * coordinates(t, order); }
  [[nodiscard]] double force_of(Eigen::Index i, double t, int order) const {
    return forces.row(i).dot(coordinates(t, order));
  }
  [[nodiscard]] Eigen::VectorXd pressed_at(double t) const { return pressed * coordinates(t, 0); }
};

/// All that a swing asks for at one time.
struct Impact::Sample {
  double time = 0;
  Eigen::VectorXd force, rate, pressed;  ///< N, N/s, m

  Sample(const Modes& m, double t) : time(t), rate(m.force(t, -1)) {
    const Eigen::VectorXd in_modes = m.coordinates(t, 0);
    force = m.forces * in_modes;
    pressed = m.pressed * in_modes;
  }
};

Eigen::VectorXd Impact::Modes::coordinates(double t, int order) const {
  Eigen::VectorXd at(place.size());
  for (Eigen::Index i = 0; i < at.size(); ++i) {
    const double q = place(i), v = speed(i), p = push(i), w = frequency(i), r = rest(i);
    if (w == 0) {
      at(i) = order == -1  ? v + p * t
              : order == 0 ? q + v * t + p * t * t / 2
              : order == 1 ? q * t + v * t * t / 2 + p * t * t * t / 6
                           : q * t * t / 2 + v * t * t * t / 6 + p * t * t * t * t / 24;
      continue;
    }
    const double c = std::cos(w * t), s = std::sin(w * t);
    at(i) = order == -1  ? (r - q) * w * s + v * c
            : order == 0 ? r + (q - r) * c + v / w * s
            : order == 1 ? r * t + (q - r) * s / w + v / (w * w) * (1 - c)
                         : r * t * t / 2 + (q - r) * (1 - c) / (w * w) + v / (w * w) * (t - s / w);
  }
  return at;
}

Impact::Impact(Eigen::MatrixXd mobility, Eigen::MatrixXd compliance, Eigen::VectorXd closing_speed,
               Eigen::VectorXd acceleration, int bound)
    : mobility_(std::move(mobility)),
      compliance_(std::move(compliance)),
      depth_(Eigen::VectorXd::Zero(closing_speed.size())),
      speed_(std::move(closing_speed)),
      acceleration_(std::move(acceleration)),
      unloaded_(depth_),
      impulse_(depth_),
      peak_(depth_),
      state_(static_cast<std::size_t>(speed_.size()), Touch::touching),
      bound_(bound) {
  elastic_ = compliance_.diagonal();
  check();
}

void Impact::check() const {
  const Eigen::Index n = speed_.size();
  if (bound_ < 0 || n <= bound_ || mobility_.rows() != n || mobility_.cols() != n || compliance_.rows() != n ||
      compliance_.cols() != n || acceleration_.size() != n)
    throw std::invalid_argument(
        "an impact needs a place, and for each a row of mobility and compliance, a speed and an acceleration");
  if (!mobility_.allFinite() || !compliance_.allFinite() || !speed_.allFinite() || !acceleration_.allFinite())
    throw std::invalid_argument("an impact needs finite numbers");
  if (!(mobility_.diagonal().minCoeff() > 0))
    throw std::invalid_argument("at an impact's places one side at least must be able to move");
  if (Eigen::LLT<Eigen::MatrixXd>(compliance_).info() != Eigen::Success)
    throw std::invalid_argument("the compliance of an impact is not positive definite");
}

bool Impact::any(Touch state) const {
  const auto end = state_.begin() + place_count();
  return std::find(state_.begin(), end, state) != end;
}
bool Impact::goes_on() const { return any(Touch::touching) || any(Touch::behind); }

void Impact::change(Eigen::MatrixXd mobility, Eigen::MatrixXd compliance, const Eigen::VectorXd& shift) {
  mobility_ = std::move(mobility);
  elastic_ = compliance.diagonal();
  yield(std::move(compliance), shift);
}

void Impact::yield(Eigen::MatrixXd compliance, const Eigen::VectorXd& shift) {
  compliance_ = std::move(compliance);
  unloaded_ += shift;
  check();
  for (Eigen::Index i = 0; i < place_count(); ++i) {
    Touch& state = state_[static_cast<std::size_t>(i)];
    if (state == Touch::touching && depth_(i) < unloaded_(i)) state = Touch::behind;
  }
}

void Impact::bind(Eigen::MatrixXd mobility, Eigen::MatrixXd compliance, const Eigen::VectorXd& coordinates,
                  const Eigen::VectorXd& rates) {
  mobility_ = std::move(mobility);
  compliance_ = std::move(compliance);
  elastic_ = compliance_.diagonal();
  bound_ = coordinates.size();
  const Eigen::Index n = depth_.size();
  for (Eigen::VectorXd* each : {&acceleration_, &unloaded_, &impulse_, &peak_, &depth_, &speed_}) {
    each->conservativeResize(n + bound_);
    each->tail(bound_).setZero();
  }
  depth_.tail(bound_) = coordinates;
  speed_.tail(bound_) = rates;
  state_.resize(static_cast<std::size_t>(n + bound_), Touch::touching);
  check();
}

void Impact::keep(const std::vector<int>& places) {
  bound_ = 0;
  mobility_ = Eigen::MatrixXd(mobility_(places, places));
  compliance_ = Eigen::MatrixXd(compliance_(places, places));
  elastic_ = Eigen::VectorXd(elastic_(places));
  for (Eigen::VectorXd* each : {&depth_, &speed_, &acceleration_, &unloaded_, &impulse_, &peak_})
    *each = Eigen::VectorXd((*each)(places));
  std::vector<Touch> state;
  for (const int place : places) state.push_back(state_[static_cast<std::size_t>(place)]);
  state_ = std::move(state);
}

Impact::Modes Impact::modes() const {
  Modes m;
  for (std::size_t i = 0; i < state_.size(); ++i)
    (state_[i] == Touch::touching ? m.touching : m.apart).push_back(static_cast<int>(i));
  const Eigen::MatrixXd C = compliance_(m.touching, m.touching), L = mobility_(m.touching, m.touching);
  // With C = G G' and y = G^-1 d: y'' = G^-1 a - (G^-1 L G^-T) y, f = G^-T y.
  const Eigen::LLT<Eigen::MatrixXd> factor(C);
  const auto root = factor.matrixL();
  Eigen::MatrixXd scaled = root.solve(L);
  scaled = root.solve(scaled.transpose().eval());
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scaled);
  m.pressed = root * eigen.eigenvectors();
  m.forces = factor.matrixU().solve(eigen.eigenvectors());
  m.frequency = eigen.eigenvalues();
  const double least = free_motion * m.frequency.maxCoeff();
  const Eigen::VectorXd pressed = depth_ - unloaded_;
  m.place = m.forces.transpose() * pressed(m.touching);
  m.speed = m.forces.transpose() * speed_(m.touching);
  m.push = m.forces.transpose() * acceleration_(m.touching);
  m.rest = Eigen::VectorXd::Zero(m.push.size());
  for (Eigen::Index i = 0; i < m.frequency.size(); ++i) {
    double& one = m.frequency(i);
    if (one > least) m.rest(i) = m.push(i) / one;
    one = one > least ? std::sqrt(one) : 0;
  }
  return m;
}

/// s: as long as any swing is followed.
double Impact::longest_swing(const Modes& m) const {
  const double whole = 2 * pi / m.slowest();
  if (bound_ == 0) return whole;
  double own = 0;
  for (Eigen::Index i = 0; i < place_count(); ++i)
    if (state_[static_cast<std::size_t>(i)] != Touch::gone)
      own = std::max(own, 2 * pi * std::sqrt(elastic_(i) / mobility_(i, i)));
  return std::min(whole, most_periods * own);
}

double Impact::fastest_over_slowest() const {
  if (!any(Touch::touching)) return 1;
  const Modes m = modes();
  return m.fastest() / m.slowest();
}

Eigen::VectorXd Impact::force() const {
  Eigen::VectorXd all = Eigen::VectorXd::Zero(depth_.size());
  if (bound_ == 0 && !any(Touch::touching)) return all;
  const Modes m = modes();
  all(m.touching) = m.force(0);
  return all;
}

Eigen::VectorXd Impact::force_rate() const {
  Eigen::VectorXd all = Eigen::VectorXd::Zero(depth_.size());
  if (bound_ == 0 && !any(Touch::touching)) return all;
  const Modes m = modes();
  all(m.touching) = m.force(0, -1);
  return all;
}

double Impact::stored() const {
  const Eigen::VectorXd f = force();
  return f.dot(compliance_ * f) / 2;
}

/// Everything as it is `time` later, the same places touching all the while.
void Impact::advance(const Modes& m, double time) {
  const Eigen::VectorXd given = m.force(time, 1), travelled = m.force(time, 2);
  Eigen::VectorXd impulse = Eigen::VectorXd::Zero(depth_.size()), twice = impulse;
  impulse(m.touching) = given;
  twice(m.touching) = travelled;
  depth_ += speed_ * time + acceleration_ * (time * time / 2) - mobility_ * twice;
  speed_ += acceleration_ * time - mobility_ * impulse;
  // The places that touch by their modes: what cancels there would be lost in the sums above.
  depth_(m.touching) = unloaded_(m.touching) + m.pressed_at(time);
  impulse_ += impulse;
  time_ += time;
}

/// The peak of each force between two samples: where its rate passes through zero.
void Impact::note_peaks(const Modes& m, const Sample& from, const Sample& to) {
  for (std::size_t k = 0; k < m.touching.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    double& peak = peak_(m.touching[k]);
    // What is bound peaks either way.
    for (int sign = 1; sign >= (m.touching[k] < place_count() ? 1 : -1); sign -= 2) {
      peak = std::max(peak, sign * to.force(i));
      if (!(sign * from.rate(i) > 0 && sign * to.rate(i) < 0)) continue;
      const double at = passes_zero(from.time, to.time, sign * from.rate(i), sign * to.rate(i),
                                    [&](double t) { return sign * m.force_of(i, t, -1); });
      peak = std::max(peak, sign * m.force_of(i, at, 0));
    }
  }
}

/// Nothing touches: on to where the first place that was left behind is met. False: none will be.
bool Impact::fly_to_next_touch() {
  double next = never;
  Eigen::Index met = -1;
  for (Eigen::Index i = 0; i < depth_.size(); ++i) {
    if (state_[static_cast<std::size_t>(i)] != Touch::behind) continue;
    const double t = closes_after(depth_(i) - unloaded_(i), speed_(i), acceleration_(i));
    if (t >= next) continue;
    next = t;
    met = i;
  }
  if (met < 0) return false;
  depth_ += speed_ * next + acceleration_ * (next * next / 2);
  speed_ += acceleration_ * next;
  depth_(met) = unloaded_(met);
  time_ += next;
  state_[static_cast<std::size_t>(met)] = Touch::touching;
  return true;
}

/// Of the places left behind, the largest overlap with the surface as the other forces move it: above zero they touch.
double Impact::largest_overlap(const Modes& m, double t, Eigen::Index* which) const {
  double most = -never;
  if (std::find(state_.begin(), state_.end(), Touch::behind) == state_.end()) return most;
  const Eigen::VectorXd force = m.force(t), twice = m.force(t, 2);
  for (const int i : m.apart) {
    if (state_[static_cast<std::size_t>(i)] != Touch::behind) continue;
    double overlap = depth_(i) + speed_(i) * t + acceleration_(i) * t * t / 2 - unloaded_(i);
    for (std::size_t k = 0; k < m.touching.size(); ++k)
      overlap -= mobility_(i, m.touching[k]) * twice(static_cast<Eigen::Index>(k)) +
                 compliance_(i, m.touching[k]) * force(static_cast<Eigen::Index>(k));
    if (overlap <= most) continue;
    most = overlap;
    if (which) *which = i;
  }
  return most;
}

/// Places whose force has come to nothing at this time, `touching` of them first among what touches.
void Impact::part(const Modes& m, double at, Eigen::Index touching) {
  const Eigen::VectorXd last = m.force(at);
  const double none = no_force * std::max(peak_.head(place_count()).maxCoeff(), std::numeric_limits<double>::min());
  for (std::size_t k = 0; static_cast<Eigen::Index>(k) < touching; ++k)
    if (last(static_cast<Eigen::Index>(k)) <= none) state_[static_cast<std::size_t>(m.touching[k])] = Touch::gone;
}

/// Until a place lets go or is met (`changed`), something fails, or a full swing of the slowest mode has been seen.
Impact::Stop Impact::swing(const Watch& watch, bool by_rates, double deepest, bool& changed) {
  const Modes m = modes();
  // Places come first among what touches.
  const auto touching = static_cast<Eigen::Index>(m.touching.size()) - bound_;
  const auto least = [&](const Eigen::VectorXd& force) { return touching > 0 ? force.head(touching).minCoeff() : 0.0; };
  const auto used = [&](const Eigen::VectorXd& force, const Eigen::VectorXd& rate) {
    Eigen::VectorXd all = Eigen::VectorXd::Zero(depth_.size());
    all(m.touching) = force;
    all.head(place_count()) = all.head(place_count()).cwiseMax(0.0);
    if (!by_rates) return watch(all, all);
    Eigen::VectorXd rates = Eigen::VectorXd::Zero(depth_.size());
    rates(m.touching) = rate;
    return watch(all, rates);
  };
  const auto depth = [&](const Eigen::VectorXd& pressed) {
    return touching > 0 ? pressed.head(touching).maxCoeff() : 0.0;
  };
  const double step = 2 * pi / m.fastest() / samples_per_period, end = longest_swing(m);
  changed = false;
  Sample now(m, 0);
  if (watch && used(now.force, now.rate) >= 1) return Stop::failed;
  Eigen::Index touched = -1;
  bool parted = false, failed = false, deep = depth(now.pressed) > deepest;
  while (now.time < end && !parted && !failed && !deep && touched < 0) {
    const double at = now.time;
    Sample to(m, std::min(at + step, end));
    // Back to the first time at which it holds.
    const auto stop_where = [&](const auto& holds) { to = Sample(m, first_time(at, to.time, holds)); };
    parted = least(to.force) < 0;
    if (parted) stop_where([&](double t) { return least(m.force(t)) < 0 && t > at; });
    if (largest_overlap(m, to.time, nullptr) > 0) {
      stop_where([&](double t) { return largest_overlap(m, t, nullptr) > 0; });
      (void)largest_overlap(m, to.time, &touched);
      parted = false;
    }
    if (watch && used(to.force, to.rate) >= 1) {
      failed = true;
      parted = false;
      touched = -1;
      stop_where([&](double t) { return used(m.force(t), by_rates ? m.force(t, -1) : to.rate) >= 1; });
    }
    if (depth(to.pressed) > deepest) {
      deep = true;
      parted = failed = false;
      touched = -1;
      stop_where([&](double t) { return depth(m.pressed_at(t)) > deepest; });
    }
    note_peaks(m, now, to);
    now = std::move(to);
  }
  advance(m, now.time);
  if (failed || deep) return failed ? Stop::failed : Stop::deep;
  changed = parted || touched >= 0;
  if (touched >= 0) state_[static_cast<std::size_t>(touched)] = Touch::touching;
  if (parted) part(m, now.time, touching);
  return Stop::held;
}

Impact::Stop Impact::push(const Utilisation& utilisation, double deepest) {
  Watch watch;
  if (utilisation)
    watch = [&](const Eigen::VectorXd& force, const Eigen::VectorXd& /*rate*/) { return utilisation(force); };
  return push(watch, false, deepest);
}

Impact::Stop Impact::push_watched(const Watch& watch, double deepest) { return push(watch, true, deepest); }

Impact::Stop Impact::push(const Watch& watch, bool by_rates, double deepest) {
  for (;;) {
    if (!any(Touch::touching) && (bound_ == 0 ? !fly_to_next_touch() : !any(Touch::behind))) return Stop::parted;
    bool changed = false;
    const Stop stop = swing(watch, by_rates, deepest, changed);
    if (stop == Stop::failed || stop == Stop::deep) return stop;
    if (!changed) return any(Touch::touching) ? stop : Stop::parted;
  }
}

}  // namespace topple::structure
