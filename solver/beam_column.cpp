#include "beam_column.h"

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

/// Over the distance x from the stretch's start. The series of v' = w is that of (rotation + shear T)/(1 + n shear).
Transfer transfer(const ColumnPlane& plane, const ColumnStretch& stretch, double x) {
  using Row = Eigen::Matrix<double, 1, 5>;
  const auto& [n, shear] = ScaledColumn(plane, stretch);
  const double h = stretch.length, EI = plane.bending_stiffness, moment = h * h / EI, to = x / h;
  const std::array<double, 2> m{stretch.moment * moment, stretch.moment_slope * moment * h},
      q{stretch.force * moment * h, stretch.force_slope * moment * h * h};
  Transfer sum = Transfer::Zero();
  sum.leftCols<4>().setIdentity();
  Row rotation = sum.row(1), M = sum.row(2), T = sum.row(3), w = Row::Zero(), before = Row::Zero();
  double power = 1;
  int small = 0;
  constexpr double rounding = 1e-18;  // the entries of unit columns are near 1
  constexpr int most_terms = 200, in_turn = 4;
  for (int k = 0; k < most_terms && small < in_turn; ++k) {
    const Row next = (rotation + shear * T - shear * (n[1] * w + n[2] * before)) / (1 + n[0] * shear);
    const Row pushed = n[0] * next + n[1] * w + n[2] * before;
    before = w;
    w = next;
    const Row turned = M, sheared = T;
    T.setZero();
    M = pushed - sheared;
    rotation = turned;
    if (k == 0) rotation(4) += plane.free_curvature * h;
    if (k < 2) {
      M(4) -= m[static_cast<std::size_t>(k)];
      T(4) -= q[static_cast<std::size_t>(k)];
    }
    const double share = 1.0 / (k + 1);
    rotation *= share;
    M *= share;
    T *= share;
    power *= to;
    Transfer term;
    term << w * share, rotation, M, T;
    sum += power * term;
    const double units = term.leftCols<4>().cwiseAbs().maxCoeff(), loads = term.col(4).cwiseAbs().maxCoeff();
    const bool is_small = units * power < rounding && loads * power <= rounding * sum.col(4).cwiseAbs().maxCoeff();
    small = is_small ? small + 1 : 0;
  }
  return sum;
}

int negative_pivots(const Eigen::Matrix2d& m) {
  const double second = m(1, 1) - (m(0, 0) != 0 ? m(1, 0) * m(0, 1) / m(0, 0) : 0);
  return (m(0, 0) < 0 ? 1 : 0) + (second < 0 ? 1 : 0);
}

}  // namespace

BeamColumn::BeamColumn(const ColumnPlane& plane, std::span<const ColumnStretch> stretches,
                       const std::array<double, 4>& end_stiffness)
    : plane_(plane) {
  for (const ColumnStretch& stretch : stretches) {
    const Transfer t = transfer(plane, stretch, stretch.length);
    const Eigen::Matrix2d to_force = t.block<2, 2>(0, 2).inverse();
    const Eigen::Matrix2d first_u = -to_force * t.block<2, 2>(0, 0);
    const Eigen::Vector2d first_g = -to_force * t.block<2, 1>(0, 4);
    const Eigen::Matrix2d D = t.block<2, 2>(2, 2);
    Eigen::Matrix<double, 4, 4> force;  // M1, T1, M2, T2 by u1, u2
    force << first_u, to_force, t.block<2, 2>(2, 0) + D * first_u, D * to_force;
    Eigen::Vector4d load;
    load << first_g, D * first_g + t.block<2, 1>(2, 4);
    // What acts on the ends, in the order of the freedoms, and back from the scale of the length.
    const double EI = plane.bending_stiffness, h = stretch.length;
    const Eigen::Vector4d forces_scale(EI / (h * h), EI / h, EI / (h * h), EI / h), moves_scale(1 / h, 1, 1 / h, 1);
    Segment segment;
    segment.stretch = stretch;
    const std::array<int, 4> from{1, 0, 3, 2};
    for (int i = 0; i < 4; ++i) {
      const double sign = (i < 2 ? -1 : 1) * forces_scale(i);
      segment.stiffness.row(i) =
          sign * force.row(from[static_cast<std::size_t>(i)]).cwiseProduct(moves_scale.transpose());
      segment.fixed(i) = sign * load(from[static_cast<std::size_t>(i)]);
    }
    segments_.push_back(segment);
  }
  chain(stretches);
  stiffness_ = (0.5 * (stiffness_ + stiffness_.transpose())).eval();
  add_springs(end_stiffness);
}

void BeamColumn::chain(std::span<const ColumnStretch> stretches) {
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
    joint.load = fixed_.tail<2>() + segments_[i].fixed.head<2>() -
                 Eigen::Vector2d(stretches[i].point_force, stretches[i].point_moment);
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

/// One freedom after the other: the beam's own end is condensed, the hub takes its place behind the spring.
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

BeamColumn::Curve BeamColumn::curve(const Eigen::Vector4d& hubs) const {
  Eigen::Vector4d ends = hubs;
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
  curve.plane_ = plane_;
  for (std::size_t i = 0; i < segments_.size(); ++i) {
    Eigen::Vector4d u;
    u << place[i], place[i + 1];
    const Eigen::Vector4d force = segments_[i].stiffness * u + segments_[i].fixed;
    curve.parts_.push_back({segments_[i].stretch, {u(0), u(1), -force(1), -force(0)}});
  }
  return curve;
}

Eigen::Vector4d BeamColumn::Curve::at(double distance) const {
  std::size_t i = 0;
  while (i + 1 < parts_.size() && distance > parts_[i + 1].stretch.start) ++i;
  const Part& part = parts_[i];
  const Eigen::Vector4d scale = Scaled{part.stretch.length, plane_.bending_stiffness}.scale();
  Eigen::Matrix<double, 5, 1> state;
  state << part.start.cwiseQuotient(scale), 1;
  const Eigen::Vector4d there = transfer(plane_, part.stretch, distance - part.stretch.start) * state;
  return there.cwiseProduct(scale);
}

}  // namespace topple::solver
