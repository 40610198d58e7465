#include "elements/beam_column.h"

#include <algorithm>
#include <cmath>

namespace topple::solver {
namespace {

/// v, rotation, M, T at a point by those at the start (columns 0 to 3), and what the loads add (column 4). Scaled by
/// the length h: v/h, M h/EI, T h2/EI.
using Transfer = Eigen::Matrix<double, 4, 5>;

struct Scaled {
  double h, EI;
  [[nodiscard]] Eigen::Vector4d scale() const { return {h, 1, EI / h, EI / (h * h)}; }
};

/// Axial force in powers of the distance over h, times h2/EI; and the shear compliance over that of bending.
struct ScaledColumn {
  std::array<double, 3> n{};
  double shear = 0;

  ScaledColumn(const ColumnPlane& plane, const ColumnStretch& stretch) {
    const double h = stretch.length, EI = plane.bending_stiffness;
    shear = plane.shear_compliance * EI / (h * h);
    double power = h * h / EI;
    for (std::size_t k = 0; k < n.size(); ++k, power *= h) n[k] = stretch.axial[k] * power;
    // Where the axial force all but takes the shear stiffness away the series would diverge: far beyond any real load,
    // but a trial factor may go there. Its mean serves then.
    constexpr double far_from_singular = 0.25;
    if (shear * (std::abs(n[1]) + std::abs(n[2])) > far_from_singular * std::abs(1 + n[0] * shear))
      n = {n[0] + n[1] / 2 + n[2] / 3, 0, 0};
  }
};

/// The power series of v, rotation, M, T along a stretch, in the distance over h: that of v' = w is that of
/// (rotation + shear T)/(1 + n shear). One column for each state at the start; the loads act on the last one.
template <int columns>
class Series {
 public:
  using Terms = Eigen::Matrix<double, 4, columns>;

  Series(const ColumnPlane& plane, const ColumnStretch& stretch, const Terms& start)
      : column_(plane, stretch), rotation_(start.row(1)), M_(start.row(2)), T_(start.row(3)) {
    const double h = stretch.length, moment = h * h / plane.bending_stiffness;
    turn_ = plane.free_curvature * h;
    m_ = {stretch.moment * moment, stretch.moment_slope * moment * h};
    q_ = {stretch.force * moment * h, stretch.force_slope * moment * h * h};
  }

  /// The coefficients of the next power, from the first on.
  Terms next() {
    const auto& n = column_.n;
    const double shear = column_.shear, share = 1.0 / (power_ + 1);
    const Row w = (rotation_ + shear * T_ - shear * (n[1] * w_ + n[2] * before_)) / (1 + n[0] * shear);
    Row turned = M_, bent = n[0] * w + n[1] * w_ + n[2] * before_ - T_, sheared = Row::Zero();
    before_ = w_;
    w_ = w;
    if (power_ == 0) turned(columns - 1) += turn_;
    if (power_ < 2) {
      bent(columns - 1) -= m_[static_cast<std::size_t>(power_)];
      sheared(columns - 1) -= q_[static_cast<std::size_t>(power_)];
    }
    rotation_ = share * turned;
    M_ = share * bent;
    T_ = share * sheared;
    ++power_;
    Terms terms;
    terms << w * share, rotation_, M_, T_;
    return terms;
  }

 private:
  using Row = Eigen::Matrix<double, 1, columns>;
  ScaledColumn column_;
  Row rotation_, M_, T_, w_ = Row::Zero(), before_ = Row::Zero();
  double turn_ = 0;
  std::array<double, 2> m_{}, q_{};
  int power_ = 0;
};

/// Series end where so many terms in turn are rounding.
constexpr double rounding = 1e-18;
constexpr int most_terms = 200, in_turn = 4;

/// Over a whole stretch.
Transfer transfer(const ColumnPlane& plane, const ColumnStretch& stretch) {
  Transfer sum = Transfer::Zero();
  sum.leftCols<4>().setIdentity();
  Series<5> series(plane, stretch, sum);
  for (int k = 0, small = 0; k < most_terms && small < in_turn; ++k) {
    const Transfer terms = series.next();
    sum += terms;
    // The entries of unit states are near 1, those of the loads are not.
    const double units = terms.leftCols<4>().cwiseAbs().maxCoeff(), loads = terms.col(4).cwiseAbs().maxCoeff();
    small = units < rounding && loads <= rounding * sum.col(4).cwiseAbs().maxCoeff() ? small + 1 : 0;
  }
  return sum;
}

int negative_pivots(const Eigen::Matrix2d& m) {
  const double second = m(1, 1) - (m(0, 0) != 0 ? m(1, 0) * m(0, 1) / m(0, 0) : 0);
  return (m(0, 0) < 0 ? 1 : 0) + (second < 0 ? 1 : 0);
}

}  // namespace

BeamColumn::BeamColumn(const ColumnPlane& plane, std::span<const ColumnStretch> stretches,
                       const std::array<double, 4>& end_stiffness, const Eigen::Vector2d& at_second_end)
    : plane_(plane), stretches_(stretches.begin(), stretches.end()) {
  for (std::size_t first = 0, next = 1; first < stretches_.size(); first = next++) {
    while (next < stretches_.size() && !stretches_[next].begins_segment) ++next;
    segments_.emplace_back();
    segments_.back().first = first;
    segments_.back().count = next - first;
    find_stiffness(segments_.back());
  }
  chain();
  fixed_.tail<2>() -= at_second_end;
  stiffness_ = (0.5 * (stiffness_ + stiffness_.transpose())).eval();
  add_springs(end_stiffness);
}

/// From its transfer matrix, the product of its stretches', in the scale of its length.
void BeamColumn::find_stiffness(Segment& segment) const {
  for (const ColumnStretch& stretch : stretches(segment)) segment.length += stretch.length;
  const double EI = plane_.bending_stiffness, h = segment.length;
  const Eigen::Vector4d scale = Scaled{h, EI}.scale();
  Transfer t = Transfer::Zero();
  t.leftCols<4>().setIdentity();
  for (const ColumnStretch& stretch : stretches(segment)) {
    t(2, 4) -= stretch.point_moment / scale(2);
    t(3, 4) -= stretch.point_force / scale(3);
    const Eigen::Vector4d to_own = Scaled{stretch.length, EI}.scale().cwiseQuotient(scale);
    const Transfer own = transfer(plane_, stretch);
    const Eigen::Matrix4d through = to_own.asDiagonal() * own.leftCols<4>() * to_own.cwiseInverse().asDiagonal();
    t = (through * t).eval();
    t.col(4) += to_own.cwiseProduct(own.col(4));
  }
  const Eigen::Matrix2d to_force = t.block<2, 2>(0, 2).inverse();
  const Eigen::Matrix2d first_u = -to_force * t.block<2, 2>(0, 0);
  const Eigen::Vector2d first_g = -to_force * t.block<2, 1>(0, 4);
  const Eigen::Matrix2d D = t.block<2, 2>(2, 2);
  Eigen::Matrix<double, 4, 4> force;  // M1, T1, M2, T2 by u1, u2
  force << first_u, to_force, t.block<2, 2>(2, 0) + D * first_u, D * to_force;
  Eigen::Vector4d load;
  load << first_g, D * first_g + t.block<2, 1>(2, 4);
  // What acts on the ends, in the order of the freedoms, and back from the scale of the length.
  const Eigen::Vector4d forces_scale(EI / (h * h), EI / h, EI / (h * h), EI / h), moves_scale(1 / h, 1, 1 / h, 1);
  const std::array<int, 4> from{1, 0, 3, 2};
  for (int i = 0; i < 4; ++i) {
    const double sign = (i < 2 ? -1 : 1) * forces_scale(i);
    segment.stiffness.row(i) =
        sign * force.row(from[static_cast<std::size_t>(i)]).cwiseProduct(moves_scale.transpose());
    segment.fixed(i) = sign * load(from[static_cast<std::size_t>(i)]);
  }
}

void BeamColumn::chain() {
  stiffness_ = segments_.front().stiffness;
  fixed_ = segments_.front().fixed;
  for (std::size_t i = 1; i < segments_.size(); ++i) {
    const Eigen::Matrix4d& next = segments_[i].stiffness;
    const Eigen::Matrix2d middle = stiffness_.block<2, 2>(2, 2) + next.block<2, 2>(0, 0);
    buckled_ += negative_pivots(middle);
    Joint joint;
    joint.inverse = middle.inverse();
    joint.to_first = stiffness_.block<2, 2>(2, 0);
    joint.to_next = next.block<2, 2>(0, 2);
    joint.load = fixed_.tail<2>() + segments_[i].fixed.head<2>();
    Eigen::Matrix4d sum = Eigen::Matrix4d::Zero();
    sum.topLeftCorner<2, 2>() = stiffness_.topLeftCorner<2, 2>();
    sum.bottomRightCorner<2, 2>() = next.bottomRightCorner<2, 2>();
    Eigen::Matrix<double, 4, 2> to_joint;
    to_joint << stiffness_.block<2, 2>(0, 2), next.block<2, 2>(2, 0);
    Eigen::Matrix<double, 2, 4> from_joint;
    from_joint << joint.to_first, joint.to_next;
    const Eigen::Matrix<double, 4, 2> share = to_joint * joint.inverse;
    stiffness_ = sum - share * from_joint;
    Eigen::Vector4d fixed;
    fixed << fixed_.head<2>(), segments_[i].fixed.tail<2>();
    fixed_ = fixed - share * joint.load;
    joints_.push_back(joint);
  }
}

/// One freedom after the other: the beam's own end is condensed, the rigid end takes its place behind the spring.
void BeamColumn::add_springs(const std::array<double, 4>& end_stiffness) {
  const Eigen::Vector4d rigid_diagonal = stiffness_.diagonal().cwiseAbs();
  for (int f = 0; f < 4; ++f) {
    const double k = end_stiffness[static_cast<std::size_t>(f)];
    if (std::isinf(k)) continue;
    Spring spring{f, k, stiffness_(f, f) + k, fixed_(f), stiffness_.row(f).transpose()};
    constexpr double rounding = 1e-13;
    if (std::abs(spring.pivot) <= rounding * rigid_diagonal(f)) spring.pivot = 0;  // nothing resists it any more
    if (spring.pivot < 0) ++buckled_;
    const double inverse = spring.pivot == 0 ? 0 : 1 / spring.pivot;
    const Eigen::Vector4d row = spring.row;
    stiffness_ -= row * row.transpose() * inverse;
    fixed_ -= row * (spring.fixed * inverse);
    Eigen::Vector4d through = row * (k * inverse);
    through(f) = k - k * k * inverse;
    stiffness_.row(f) = through.transpose();
    stiffness_.col(f) = through;
    fixed_(f) = k * inverse * spring.fixed;
    springs_.push_back(spring);
  }
}

BeamColumn::Curve BeamColumn::curve(const Eigen::Vector4d& rigid_ends) const {
  Eigen::Vector4d ends = rigid_ends;
  for (std::size_t i = springs_.size(); i-- > 0;) {
    const Spring& spring = springs_[i];
    if (spring.pivot == 0) continue;
    double others = spring.fixed;
    for (int j = 0; j < 4; ++j)
      if (j != spring.freedom) others += spring.row(j) * ends(j);
    ends(spring.freedom) = (spring.stiffness * ends(spring.freedom) - others) / spring.pivot;
  }
  std::vector<Eigen::Vector2d> place(segments_.size() + 1);
  place.front() = ends.head<2>();
  place.back() = ends.tail<2>();
  for (std::size_t i = joints_.size(); i-- > 0;) {
    const Joint& joint = joints_[i];
    place[i + 1] = -joint.inverse * (joint.to_first * place.front() + joint.to_next * place[i + 2] + joint.load);
  }
  Curve curve;
  for (std::size_t i = 0; i < segments_.size(); ++i) {
    Eigen::Vector4d u;
    u << place[i], place[i + 1];
    const Eigen::Vector4d force = segments_[i].stiffness * u + segments_[i].fixed;
    Eigen::Vector4d state(u(0), u(1), -force(1), -force(0));
    for (const ColumnStretch& stretch : stretches(segments_[i])) {
      state(2) -= stretch.point_moment;
      state(3) -= stretch.point_force;
      curve.parts_.push_back(along(plane_, stretch, state));
      state.setZero();
      for (const Eigen::Vector4d& term : curve.parts_.back().series) state += term;
    }
  }
  return curve;
}

/// From v, rotation, M, T at the start of a stretch.
BeamColumn::Curve::Part BeamColumn::along(const ColumnPlane& plane, const ColumnStretch& stretch,
                                          const Eigen::Vector4d& start) {
  const Eigen::Vector4d scale = Scaled{stretch.length, plane.bending_stiffness}.scale();
  Curve::Part part{stretch.start, stretch.length, {start}};
  const Eigen::Vector4d scaled = start.cwiseQuotient(scale);
  Series<1> series(plane, stretch, scaled);
  double largest = scaled.cwiseAbs().maxCoeff();
  for (int k = 0, small = 0; k < most_terms && small < in_turn; ++k) {
    const Eigen::Vector4d terms = series.next();
    const double size = terms.cwiseAbs().maxCoeff();
    part.series.emplace_back(terms.cwiseProduct(scale));
    small = size <= rounding * largest ? small + 1 : 0;
    largest = std::max(largest, size);
  }
  return part;
}

Eigen::Vector4d BeamColumn::Curve::at(double distance) const {
  return {value(0, distance), value(1, distance), value(2, distance), value(3, distance)};
}

double BeamColumn::Curve::value(int component, double distance, bool beyond) const {
  std::size_t i = 0;
  while (i + 1 < parts_.size() && (distance > parts_[i + 1].start || (beyond && distance == parts_[i + 1].start))) ++i;
  const Part& part = parts_[i];
  const double t = (distance - part.start) / part.length;
  double value = 0;
  for (std::size_t k = part.series.size(); k-- > 0;) value = value * t + part.series[k](component);
  return value;
}

}  // namespace topple::solver
