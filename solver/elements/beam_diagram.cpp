#include "topple/solver/beam_diagram.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "elements/beam_end_springs.h"
#include "elements/beam_internal_forces.h"

namespace topple::solver {
namespace {

using Polynomial = std::array<double, 6>;

template <std::size_t N>
Polynomial widen(const std::array<double, N>& p) {
  Polynomial result{};
  std::copy(p.begin(), p.end(), result.begin());
  return result;
}

Polynomial derivative(const Polynomial& p) {
  Polynomial d{};
  for (std::size_t k = 1; k < p.size(); ++k) d[k - 1] = static_cast<double>(k) * p[k];
  return d;
}

/// The zero of the first `terms` on a bracket with a change of sign, to the last bit or two: Newton's method, and
/// bisection where that would leave the bracket or close it too slowly.
double zero_between(const Polynomial& p, std::size_t terms, double a, double b, bool rising) {
  double x = a + (b - a) / 2, before = b - a;
  constexpr int enough = 200;
  constexpr double squared_is_rounding = 1e-9;  // of the bracket: where Newton's method gets to, it doubles the digits
  const double last_step = squared_is_rounding * (b - a);
  for (int i = 0; i < enough; ++i) {
    double value = p[terms - 1], slope = 0;
    for (std::size_t k = terms - 1; k-- > 0;) {
      slope = slope * x + value;
      value = value * x + p[k];
    }
    if (value == 0) return x;
    ((value < 0) == rising ? a : b) = x;
    double step = -value / slope;
    const bool newton = x + step > a && x + step < b && std::abs(step) <= before / 2;
    if (newton && std::abs(step) < last_step) return x + step;
    if (!newton) step = a + (b - a) / 2 - x;
    if (x + step == x || x + step <= a || x + step >= b) break;
    before = std::abs(step);
    x += step;
  }
  return x;
}

/// One more than the highest power with a coefficient.
template <std::size_t N>
std::size_t terms(const std::array<double, N>& p) {
  std::size_t n = p.size();
  while (n > 0 && p[n - 1] == 0) --n;
  return n;
}

/// At most as many as the highest power, ascending.
struct Places {
  std::array<double, 6> at{};
  std::size_t count = 0;
  void add(double place) { at[count++] = place; }
  [[nodiscard]] const double* begin() const { return at.data(); }
  [[nodiscard]] const double* end() const { return at.data() + count; }
};

/// Places where c + b x + a x2 changes sign, by the formula that loses no digits to cancellation.
Places sign_changes_of_quadratic(double c, double b, double a, double length) {
  Places places;
  const double discriminant = b * b - 4 * a * c;
  if (!(discriminant > 0)) return places;
  const double q = -(b + std::copysign(std::sqrt(discriminant), b)) / 2;
  const auto [first, second] = std::minmax({q / a, q == 0 ? 0 : c / q});
  for (const double place : {first, second})
    if (place > 0 && place < length) places.add(place);
  return places;
}

/// Where p changes sign within (0, length): between neighbouring roots of its derivative it is monotone.
Places sign_changes(const Polynomial& p, double length) {
  const std::size_t n = terms(p);
  Places places;
  if (n < 2) return places;
  if (n == 2) {
    if (const double root = -p[0] / p[1]; root > 0 && root < length) places.add(root);
    return places;
  }
  if (n == 3) return sign_changes_of_quadratic(p[0], p[1], p[2], length);
  double from = 0, value = p[0];
  const auto look_up_to = [&](double to) {
    double there = p[n - 1];
    for (std::size_t k = n - 1; k-- > 0;) there = there * to + p[k];
    if ((value < 0) != (there < 0)) places.add(zero_between(p, n, from, to, value < 0));
    from = to;
    value = there;
  };
  for (const double turn : sign_changes(derivative(p), length)) look_up_to(turn);
  look_up_to(length);
  return places;
}

}  // namespace

struct BeamDiagram::State {
  Beam beam;
  Vec12 end_forces;
  InternalForces forces;
  std::vector<DeformedPiece> deformed;
  Vec6 tip = Vec6::Zero();           ///< displacement of the second end when the first stays
  Vec12 end_offset = Vec12::Zero();  ///< of the rigid ends against the beam's own ends

  [[nodiscard]] std::size_t piece_at(double distance, bool beyond = false) const {
    const auto passed = [&](double start) { return beyond ? distance >= start : distance > start; };
    std::size_t i = 0;
    while (i + 1 < forces.pieces.size() && passed(forces.pieces[i + 1].start)) ++i;
    return i;
  }
  [[nodiscard]] Polynomial curve(std::size_t piece, Quantity quantity) const {
    if (quantity < deflection_y) return widen(forces.pieces[piece].force[static_cast<std::size_t>(quantity)]);
    const bool along_y = quantity == deflection_y;
    Polynomial p = along_y ? deformed[piece].v : deformed[piece].w;
    const double slope = tip(along_y ? 1 : 2) / beam.length;  // of the chord, seen from the first section
    p[0] -= slope * forces.pieces[piece].start;
    p[1] -= slope;
    return p;
  }
  /// An internal force at the second end, where no point load comes between: the end force itself, to the last bit.
  [[nodiscard]] double at_second_end(Quantity quantity, double by_polynomial) const {
    return forces.second_end(quantity) == by_polynomial ? end_forces(6 + quantity) : by_polynomial;
  }
  void rigid_motion(int translation, int rotation, double sense, const Vec12& rigid_ends, double& offset,
                    double& slope) const;
};

namespace {
/// The thread is ending, or the program: what is destroyed after the spare one has nowhere to leave its own.
thread_local bool spare_is_gone = false;
}  // namespace

void BeamDiagram::Free::operator()(State* state) const {
  if (spare_is_gone) {
    delete state;
    return;
  }
  // The last one is kept for the next on the same thread: diagrams come one after the other by the hundred thousand.
  spare().reset(state);
}

std::unique_ptr<BeamDiagram::State>& BeamDiagram::spare() {
  struct Spare {
    std::unique_ptr<State> state;
    Spare() = default;
    Spare(const Spare&) = delete;
    Spare& operator=(const Spare&) = delete;
    ~Spare() { spare_is_gone = true; }
  };
  thread_local Spare kept;
  return kept.state;
}

BeamDiagram::BeamDiagram(const Beam& beam, const Vec12& end_forces, std::span<const BeamLoad> loads,
                         double stiffness_factor)
    : state_(!spare_is_gone && spare() ? spare().release() : new State) {
  state_->beam = beam;
  state_->end_forces = end_forces;
  state_->deformed.clear();
  state_->end_offset.setZero();
  find_internal_forces(beam.length, end_forces.head<6>(), loads, state_->forces);
  state_->tip = integrate_deformation(beam, stiffness_factor, state_->forces, &state_->deformed);
  for (const BeamLoad& load : loads) {
    if (load.kind != BeamLoad::Kind::temperature) continue;
    state_->end_offset.head<6>() += load.first;
    state_->end_offset.tail<6>() += load.last;
  }
}
BeamDiagram::~BeamDiagram() = default;
BeamDiagram::BeamDiagram(BeamDiagram&&) noexcept = default;
BeamDiagram& BeamDiagram::operator=(BeamDiagram&&) noexcept = default;

double BeamDiagram::value(Quantity quantity, double distance, bool beyond) const {
  const double x = std::clamp(distance, 0.0, state_->beam.length);
  const std::size_t piece = state_->piece_at(x, beyond);
  const double found = polynomial(state_->curve(piece, quantity), x - state_->forces.pieces[piece].start);
  return x == state_->beam.length && quantity < deflection_y ? state_->at_second_end(quantity, found) : found;
}

std::array<double, 8> BeamDiagram::values(double distance, bool beyond) const {
  std::array<double, 8> result{};
  for (int q = 0; q < quantities; ++q) {
    result[static_cast<std::size_t>(q)] = value(static_cast<Quantity>(q), distance, beyond);
  }
  return result;
}

std::vector<double> BeamDiagram::breaks() const {
  std::vector<double> places;
  for (std::size_t i = 1; i < state_->forces.pieces.size(); ++i) places.push_back(state_->forces.pieces[i].start);
  return places;
}

namespace {

/// The least and the largest of what comes, the first place where several are equal.
class Extremes {
 public:
  void consider(double value, double at) {
    if (first_ || value < range_.least.value) range_.least = {value, at};
    if (first_ || value > range_.greatest.value) range_.greatest = {value, at};
    first_ = false;
  }
  /// A polynomial in the distance from `start`; at_end(its value there) is what counts at its end.
  template <std::size_t N, class AtEnd>
  void consider(const std::array<double, N>& p, double start, double length, AtEnd at_end) {
    const std::size_t n = terms(p);
    consider(p[0], start);
    if (n > 2)
      for (const double turn : sign_changes(derivative(widen(p)), length)) consider(polynomial(p, turn), start + turn);
    if (n > 1) consider(at_end(polynomial(p, length)), start + length);
  }
  [[nodiscard]] const BeamDiagram::Range& range() const { return range_; }

 private:
  BeamDiagram::Range range_;
  bool first_ = true;
};

}  // namespace

BeamDiagram::Range BeamDiagram::extremes(Quantity quantity) const {
  Extremes extremes;
  for (std::size_t i = 0; i < state_->forces.pieces.size(); ++i) {
    const BeamPiece& piece = state_->forces.pieces[i];
    const bool last = i + 1 == state_->forces.pieces.size();
    const auto at_end = [&](double value) { return last ? state_->at_second_end(quantity, value) : value; };
    if (quantity < deflection_y)
      extremes.consider(piece.force[static_cast<std::size_t>(quantity)], piece.start, piece.length, at_end);
    else
      extremes.consider(state_->curve(i, quantity), piece.start, piece.length, std::identity());
  }
  return extremes.range();
}

/// The rigid part of the motion in one plane, offset + slope x, from two components that are not released: the beam's
/// own end is its rigid end less the stretch of the spring between them.
void BeamDiagram::State::rigid_motion(int translation, int rotation, double sense, const Vec12& rigid_ends,
                                      double& offset, double& slope) const {
  const auto held = [&](int f) { return beam.end_stiffness[static_cast<std::size_t>(f / 6)](f % 6) > 0; };
  const auto end = [&](int f) {
    return rigid_ends(f) - end_offset(f) -
           spring_compliance(beam.end_stiffness[static_cast<std::size_t>(f / 6)](f % 6)) * end_forces(f);
  };
  const int v1 = translation, v2 = translation + 6, r1 = rotation, r2 = rotation + 6;
  const double L = beam.length;
  const auto slope_at = [&](int r) { return sense * (end(r) - (r == r2 ? tip(rotation) : 0)); };
  const auto place_at = [&](int v) { return end(v) - (v == v2 ? tip(translation) : 0); };
  if (held(v1) && held(v2)) {
    offset = place_at(v1);
    slope = (place_at(v2) - place_at(v1)) / L;
  } else if ((held(v1) || held(v2)) && (held(r1) || held(r2))) {
    slope = slope_at(held(r1) ? r1 : r2);
    offset = held(v1) ? place_at(v1) : place_at(v2) - slope * L;
  } else {
    offset = rigid_ends(v1);
    slope = sense * rigid_ends(r1);
  }
}

Vec6 BeamDiagram::displacement(double distance, const Vec12& rigid_ends) const {
  const State& s = *state_;
  const double x = std::clamp(distance, 0.0, s.beam.length);
  const std::size_t i = s.piece_at(x);
  const double t = x - s.forces.pieces[i].start;
  const DeformedPiece& d = s.deformed[i];
  const auto axial_start = [&](int f) {
    const double k1 = s.beam.end_stiffness[0](f), k2 = s.beam.end_stiffness[1](f);
    if (k1 > 0) return rigid_ends(f) - s.end_offset(f) - spring_compliance(k1) * s.end_forces(f);
    if (k2 > 0) return rigid_ends(f + 6) - s.end_offset(f + 6) - spring_compliance(k2) * s.end_forces(f + 6) - s.tip(f);
    return rigid_ends(f);
  };
  double v = 0, v_slope = 0, w = 0, w_slope = 0;
  s.rigid_motion(1, 5, 1, rigid_ends, v, v_slope);
  s.rigid_motion(2, 4, -1, rigid_ends, w, w_slope);
  Vec6 result;
  result << axial_start(0) + polynomial(d.u, t), v + v_slope * x + polynomial(d.v, t),
      w + w_slope * x + polynomial(d.w, t), axial_start(3) + polynomial(d.theta_x, t),
      -w_slope + polynomial(d.theta_y, t), v_slope + polynomial(d.theta_z, t);
  return result;
}

}  // namespace topple::solver
