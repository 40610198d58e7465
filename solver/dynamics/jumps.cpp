#include "dynamics/jumps.h"

#include <stdexcept>
#include <utility>

#include "dynamics/following_factor.h"
#include "dynamics/products.h"

namespace topple::solver {
namespace {

/// Velocities are found to this share of the impulses: by so many passes of conjugate gradients at most, or so many
/// answers of the factor, of which one is nearly always enough.
constexpr double solved = 1e-12;
constexpr int most_event_passes = 2000, most_refinements = 3;
/// Damping over an impulse, of s: with less than this conjugate gradients on M take few passes.
constexpr double least_share = 0.01;

double diagonal_of(const SparseSymmetric& A, Eigen::Index equation) {
  return A.value[static_cast<std::size_t>(A.start[static_cast<std::size_t>(equation)])];
}

/// With e = d a1: M + e K = e (K + s M) + (1 - e s) M.
double share_of_mass(const FrameSystem& system, double softened) { return 1 - softened * system.inertia->factor; }

}  // namespace

FrameDynamics::State::Jumps::Jumps(const AnalysisOptions& options, double softened)
    : options_(options), softened_(softened) {}
FrameDynamics::State::Jumps::~Jumps() = default;

void FrameDynamics::State::Jumps::set_softened(double softened) {
  softened_ = softened;
  factor_.reset();
}

void FrameDynamics::State::Jumps::forget_frame() {
  if (factor_) factor_->forget_frame();
}

Eigen::VectorXd FrameDynamics::State::Jumps::on_mass(const FrameSystem& system, Eigen::VectorXd impulses) {
  for (Eigen::Index e = 0; e < system.dofs().equations; ++e)
    if (!(diagonal_of(system.mass(), e) > 0)) impulses(e) = 0;
  return impulses;
}

bool FrameDynamics::State::Jumps::damps(const FrameSystem& system) const {
  return softened_ * system.inertia->factor > least_share;
}

FrameDynamics::State::FollowingFactor& FrameDynamics::State::Jumps::factor(const FrameSystem& system) {
  if (!factor_) factor_ = std::make_unique<FollowingFactor>(system, options_, softened_);
  factor_->follow(system);
  factor_->renew();
  return *factor_;
}

Eigen::VectorXd FrameDynamics::State::Jumps::velocities(const FrameSystem& system, const Eigen::VectorXd& impulses) {
  if (!damps(system)) return velocities_by_mass(system, impulses);
  FollowingFactor& by = factor(system);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(impulses.size()), left = impulses, more;
  SideBySide<1> of_whole, of_mass;
  const double enough = solved * impulses.norm(), inert = share_of_mass(system, softened_);
  for (int pass = 0; pass < most_refinements && left.norm() > enough; ++pass) {
    more = left;
    by.solve(more);
    x += more;
    multiply<1>(system.matrix(), x.transpose(), of_whole);
    multiply<1>(system.mass(), x.transpose(), of_mass);
    left = impulses - (softened_ * of_whole.row(0) + inert * of_mass.row(0)).transpose();
  }
  if (!x.allFinite()) throw std::runtime_error("the velocities that an impulse leaves were not found");
  return x;
}

/// Each equation by its own mass.
Eigen::VectorXd FrameDynamics::State::Jumps::velocities_by_mass(const FrameSystem& system, Eigen::VectorXd left) const {
  const Eigen::Index n = system.dofs().equations;
  const SparseSymmetric &M = system.mass(), &whole = system.matrix();
  const double inert = share_of_mass(system, softened_);
  Eigen::VectorXd inverse(n), x = Eigen::VectorXd::Zero(n);
  for (Eigen::Index e = 0; e < n; ++e) {
    const double diagonal =
        softened_ > 0 ? softened_ * diagonal_of(whole, e) + inert * diagonal_of(M, e) : diagonal_of(M, e);
    inverse(e) = diagonal > 0 ? 1 / diagonal : 0;
  }
  SideBySide<1> of_whole;
  const auto apply = [&](const SideBySide<1>& v, SideBySide<1>& product) {
    multiply<1>(M, v, product);
    if (!(softened_ > 0)) return;
    multiply<1>(whole, v, of_whole);
    product = softened_ * of_whole + inert * product;
  };
  Eigen::VectorXd guided = inverse.cwiseProduct(left);
  double now_left = left.dot(guided);
  const double enough = solved * solved * now_left;
  SideBySide<1> direction = guided.transpose(), product;
  for (int pass = 0; now_left > enough; ++pass) {
    if (pass == most_event_passes) throw std::runtime_error("the velocities that an impulse leaves were not found");
    apply(direction, product);
    const double step = now_left / direction.row(0).dot(product.row(0));
    x += step * direction.row(0).transpose();
    left -= step * product.row(0).transpose();
    guided = inverse.cwiseProduct(left);
    const double before_this = std::exchange(now_left, left.dot(guided));
    direction = (guided + now_left / before_this * direction.row(0).transpose()).transpose();
  }
  return x;
}

Eigen::MatrixXd FrameDynamics::State::Jumps::mobility(const FrameSystem& system, const Eigen::MatrixXd& F) {
  Eigen::MatrixXd G(F.rows(), F.cols());
  for (Eigen::Index j = 0; j < F.cols(); ++j) G.col(j) = on_mass(system, F.col(j));
  if (damps(system)) return factor(system).between(F, G);
  Eigen::MatrixXd result(F.cols(), F.cols());
  for (Eigen::Index j = 0; j < F.cols(); ++j) result.col(j) = F.transpose() * velocities_by_mass(system, G.col(j));
  return result;
}

}  // namespace topple::solver
