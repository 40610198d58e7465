#include "elements/beam_end_springs.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace topple::solver {
namespace {
constexpr double infinity = std::numeric_limits<double>::infinity();
}

double spring_compliance(double stiffness) {
  if (std::isinf(stiffness)) return 0;
  return stiffness > 0 ? 1 / stiffness : infinity;
}

AxialEnds::AxialEnds(double flexibility, const std::array<double, 2>& end_stiffness) : flexibility_(flexibility) {
  for (std::size_t end = 0; end < 2; ++end) {
    compliance_[end] = spring_compliance(end_stiffness[end]);
    released_[end] = std::isinf(compliance_[end]);
    if (!released_[end]) flexibility_ += compliance_[end];
  }
  if (!released_[0] && !released_[1]) stiffness_ = 1 / flexibility_;
}

std::array<double, 2> AxialEnds::fixed_end_forces(double statics, double deformation, double& unbalanced) const {
  if (loose()) {
    unbalanced += std::abs(statics);
    return {0, 0};
  }
  if (released_[0]) return {0, statics};
  if (released_[1]) return {statics, 0};
  const double first = (compliance_[1] * statics - deformation) / flexibility_;
  return {first, statics - first};
}

// Rotations are multiplied, moments divided by the length, so that all flexibilities compare.
BendingEnds::BendingEnds(double length, double bending_stiffness, double shear_flexibility, double sense,
                         const std::array<double, 4>& end_stiffness)
    : length_(length), sense_(sense) {
  for (std::size_t k = 0; k < 4; ++k) {
    compliance_[k] = spring_compliance(end_stiffness[k]) * (k % 2 == 1 ? length * length : 1.0);
  }
  choose_basis();
  const double unit = length * length * length / bending_stiffness;
  Eigen::Matrix2d basic;
  basic << unit / 3 + shear_flexibility, -sense * unit / 2, -sense * unit / 2, unit;
  flexibility_ = to_unknowns_.transpose() * basic * to_unknowns_;
  for (int k = 0; k < 4; ++k) {
    const double c = compliance_[static_cast<std::size_t>(k)];
    if (std::isfinite(c) && c > 0) flexibility_ += c * end_forces_.row(k).transpose() * end_forces_.row(k);
  }
  stiffness_.setZero();
  if (released_ == 1) stiffness_(1, 1) = 1 / flexibility_(1, 1);
  if (released_ == 0) {
    const double determinant = flexibility_(0, 0) * flexibility_(1, 1) - flexibility_(0, 1) * flexibility_(1, 0);
    stiffness_ << flexibility_(1, 1), -flexibility_(0, 1), -flexibility_(1, 0), flexibility_(0, 0);
    stiffness_ /= determinant;
  }
}

/// The unknowns are the forces at the two softest independent freedoms: then a soft spring stands alone on the diagonal
/// of the flexibility and costs no digits.
void BendingEnds::choose_basis() {
  Eigen::Matrix<double, 4, 2> statics;  // forces at v1, r1, v2, r2 per unit V and M/L at the first end
  statics << 1, 0, 0, 1, -1, 0, sense_, -1;
  std::array<int, 4> order{1, 3, 0, 2};
  const auto stiffer = [&](int a, int b) {
    return compliance_[static_cast<std::size_t>(a)] < compliance_[static_cast<std::size_t>(b)];
  };
  // By insertion: stable, and (unlike std::stable_sort) without asking for memory.
  for (std::size_t k = 1; k < order.size(); ++k)
    for (std::size_t i = k; i > 0 && stiffer(order[i - 1], order[i]); --i) std::swap(order[i - 1], order[i]);
  const auto shear = [](int freedom) { return freedom % 2 == 0; };
  std::size_t second = 1;
  while (shear(order[0]) && shear(order[second])) ++second;
  basis_ = {order[0], order[second]};
  Eigen::Matrix2d chosen;
  chosen << statics.row(basis_[0]), statics.row(basis_[1]);
  // The determinant is +1 or -1 and the entries are integers: the inverse is exact.
  const double determinant = chosen(0, 0) * chosen(1, 1) - chosen(0, 1) * chosen(1, 0);
  to_unknowns_ << chosen(1, 1), -chosen(0, 1), -chosen(1, 0), chosen(0, 0);
  to_unknowns_ *= determinant;
  end_forces_ = statics * to_unknowns_;
  const auto is_released = [&](int freedom) { return std::isinf(compliance_[static_cast<std::size_t>(freedom)]); };
  for (int freedom : basis_) released_ += is_released(freedom) ? 1 : 0;
  loose_ = std::count_if(order.begin(), order.end(), is_released) > released_;
}

Eigen::Matrix4d BendingEnds::stiffness() const {
  Eigen::Matrix<double, 4, 2> scaled = end_forces_;
  scaled.row(1) *= length_;
  scaled.row(3) *= length_;
  return scaled * stiffness_ * scaled.transpose();
}

Eigen::Vector4d BendingEnds::fixed_end_forces(const Eigen::Vector2d& statics, const Eigen::Vector2d& deformation,
                                              double& unbalanced) const {
  const Eigen::Vector4d particular(0, 0, statics(0), statics(1) / length_);
  // Displacement of the first end relative to the second, work-conjugate to V and M/L.
  const Eigen::Vector2d relative(sense_ * length_ * deformation(1) - deformation(0), -length_ * deformation(1));
  Eigen::Vector2d gap = to_unknowns_.transpose() * relative;
  for (int k = 0; k < 4; ++k) {
    const double c = compliance_[static_cast<std::size_t>(k)];
    if (std::isfinite(c)) gap += c * particular(k) * end_forces_.row(k).transpose();
  }
  Eigen::Vector2d unknown = Eigen::Vector2d::Zero();
  for (int i = 0; i < released_; ++i) unknown(i) = -particular(basis_[static_cast<std::size_t>(i)]);
  if (released_ == 0) unknown = -(stiffness_ * gap);
  if (released_ == 1) unknown(1) = -(gap(1) + flexibility_(1, 0) * unknown(0)) * stiffness_(1, 1);
  Eigen::Vector4d force = end_forces_ * unknown + particular;
  for (int k = 0; k < 4; ++k) {
    if (!std::isinf(compliance_[static_cast<std::size_t>(k)])) continue;
    unbalanced += std::abs(force(k));
    force(k) = 0;
  }
  force(1) *= length_;
  force(3) *= length_;
  return force;
}

}  // namespace topple::solver
