#include "beam_column.h"

#include <cmath>

namespace topple::solver {
namespace {

/// v, rotation, M, T, and the constants 1 and the distance from the start, which carry the loads. Scaled by the
/// length h: v/h, M h/EI, T h2/EI, distance/h.
using Transfer = Eigen::Matrix<double, 6, 6>;

struct Scaled {
  double h, EI;
  [[nodiscard]] Eigen::Vector4d scale() const { return {h, 1, EI / h, EI / (h * h)}; }
};

Transfer exponential(Transfer a) {
  const double norm = a.cwiseAbs().rowwise().sum().maxCoeff();
  int halvings = 0;
  for (double n = norm; n > 0.5; n /= 2) ++halvings;
  a /= std::ldexp(1.0, halvings);
  constexpr int terms = 14;  // 0.5^14/14! is below rounding
  Transfer result = Transfer::Identity();
  for (int k = terms; k > 0; --k) result = Transfer::Identity() + a * result / k;
  for (int k = 0; k < halvings; ++k) result = (result * result).eval();
  return result;
}

/// Over the distance x from the stretch's start, scaled by the stretch's length.
Transfer transfer(const ColumnPlane& plane, const ColumnStretch& stretch, double x) {
  const double h = stretch.length, EI = plane.bending_stiffness;
  const double n = stretch.axial * h * h / EI, shear = plane.shear_compliance * EI / (h * h);
  const double slope = 1 / (1 + n * shear);
  Transfer a = Transfer::Zero();
  a(0, 1) = slope;
  a(0, 3) = slope * shear;
  a(1, 2) = 1;
  a(1, 4) = plane.free_curvature * h;
  a(2, 1) = n * slope;
  a(2, 3) = n * slope * shear - 1;
  a(2, 4) = -stretch.moment * h * h / EI;
  a(2, 5) = -stretch.moment_slope * h * h * h / EI;
  a(3, 4) = -stretch.force * h * h * h / EI;
  a(3, 5) = -stretch.force_slope * h * h * h * h / EI;
  a(5, 4) = 1;
  return exponential(a * (x / h));
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
  Eigen::Matrix<double, 6, 1> state;
  state << part.start.cwiseQuotient(scale), 1, 0;
  const Eigen::Matrix<double, 6, 1> there = transfer(plane_, part.stretch, distance - part.stretch.start) * state;
  return there.head<4>().cwiseProduct(scale);
}

}  // namespace topple::solver
