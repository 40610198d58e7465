#include "simulation/impact/coupled_push.h"
#include "simulation/impact/shared_push.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace topple::structure {

namespace {
using shared_push::first_time;
using shared_push::free_motion;
using shared_push::no_force;
using shared_push::passes_zero;
using shared_push::pi;
using shared_push::samples_per_period;
}  // namespace

CoupledPush::CoupledPush(const PushingBody& body, std::vector<PushedPlace> places, Eigen::MatrixXd compliance,
                         const Eigen::MatrixXd& structure)
    : places_(std::move(places)), compliance_(std::move(compliance)) {
  const auto n = static_cast<Eigen::Index>(places_.size());
  if (n == 0 || compliance_.rows() != n || compliance_.cols() != n)
    throw std::invalid_argument("a push needs a place, and a row and a column of compliance for each");
  if (structure.size() > 0 && (structure.rows() != n || structure.cols() != n))
    throw std::invalid_argument("the structure's mass needs a row and a column for each place");
  if (!(body.mass > 0) || Eigen::LLT<Mat3>(body.inertia).info() != Eigen::Success)
    throw std::invalid_argument("a pushing body needs mass and inertia above zero");
  jacobian_.resize(n, 6);
  for (Eigen::Index i = 0; i < n; ++i) {
    const PushedPlace& place = places_[static_cast<std::size_t>(i)];
    jacobian_.row(i) << place.normal.transpose(), (place.point - body.centre).cross(place.normal).transpose();
  }
  touches_.assign(places_.size(), 1);
  weight_ << body.weight, Vec3::Zero();
  rate_ << body.velocity, body.spin;
  inverse_mass_root_.setZero();
  inverse_mass_root_.topLeftCorner<3, 3>() = Mat3::Identity() / std::sqrt(body.mass);
  inverse_mass_root_.bottomRightCorner<3, 3>() =
      Eigen::SelfAdjointEigenSolver<Mat3>(body.inertia).operatorInverseSqrt();
  if (structure.size() > 0) add_share(structure);
  rate_at_most_stored_ = rate_;
  shift_ = peak_ = Eigen::VectorXd::Zero(n);
  refresh();
}

/// In the body's own mass the first touch is q' -> (1 + S)^-1 q' and the mass 1 + S, S = R' J' A J R.
void CoupledPush::add_share(const Eigen::MatrixXd& structure) {
  const Eigen::MatrixXd shared = jacobian_ * inverse_mass_root_;
  const Mat6 whole = Mat6::Identity() + Mat6(shared.transpose() * structure * shared);
  const Eigen::SelfAdjointEigenSolver<Mat6> eigen(whole);
  const Vec6 own = eigen.eigenvectors().transpose() * (inverse_mass_root_.inverse() * rate_);
  inverse_mass_root_ = Mat6(inverse_mass_root_ * eigen.eigenvectors());
  rate_ = inverse_mass_root_ * own.cwiseQuotient(eigen.eigenvalues());
  inverse_mass_root_ = Mat6(inverse_mass_root_ * eigen.eigenvalues().cwiseSqrt().cwiseInverse().asDiagonal());
}

/// Stiffness of the places that touch: the others bear nothing, so that their compliances drop out of C.
void CoupledPush::refresh() {
  std::vector<int> touching;
  for (std::size_t i = 0; i < touches_.size(); ++i)
    if (touches_[i] != 0) touching.push_back(static_cast<int>(i));
  stiffness_ = Eigen::MatrixXd::Zero(compliance_.rows(), compliance_.cols());
  if (touching.empty()) return;
  const Eigen::MatrixXd part = compliance_(touching, touching);
  const Eigen::LLT<Eigen::MatrixXd> factor(part);
  if (factor.info() != Eigen::Success) throw std::invalid_argument("the compliance of a push is not positive definite");
  const Eigen::MatrixXd stiffness = factor.solve(Eigen::MatrixXd::Identity(part.rows(), part.cols()));
  stiffness_(touching, touching) = stiffness;
}

void CoupledPush::weaken(Eigen::MatrixXd compliance, const Eigen::VectorXd& shift) {
  compliance_ = std::move(compliance);
  shift_ += shift;
  most_stored_ = 0;
  rate_at_most_stored_ = rate_;
  refresh();
}

void CoupledPush::let_go(std::size_t place) {
  touches_[place] = 0;
  refresh();
}

Eigen::VectorXd CoupledPush::force_at(const Vec6& coordinates) const {
  return stiffness_ * (jacobian_ * coordinates - shift_);
}
Eigen::VectorXd CoupledPush::force() const { return force_at(coordinates_); }

double CoupledPush::stored_at(const Vec6& coordinates) const {
  const Eigen::VectorXd depth = jacobian_ * coordinates - shift_;
  return 0.5 * depth.dot(stiffness_ * depth);
}
double CoupledPush::stored() const { return stored_at(coordinates_); }

/// Between two samples the energy has at most one extreme: where its rate, force times speed, passes through zero.
void CoupledPush::note_most_stored(const Modes& modes, double from, double to) {
  const auto rate = [&](double t) { return force_at(coordinates(modes, t)).dot(jacobian_ * rates(modes, t)); };
  const auto note = [&](double t) {
    const double stored = stored_at(coordinates(modes, t));
    if (stored <= most_stored_) return;
    most_stored_ = stored;
    rate_at_most_stored_ = rates(modes, t);
  };
  const double at_from = rate(from), at_to = rate(to);
  if (at_from > 0 && at_to < 0) note(passes_zero(from, to, at_from, at_to, rate));
  note(to);
}

/// The peak of each force between two samples, likewise.
void CoupledPush::note_peaks(const Modes& modes, double from, double to) {
  const Eigen::VectorXd at_from = stiffness_ * (jacobian_ * rates(modes, from));
  const Eigen::VectorXd at_to = stiffness_ * (jacobian_ * rates(modes, to));
  peak_ = peak_.cwiseMax(force_at(coordinates(modes, to)));
  for (Eigen::Index i = 0; i < peak_.size(); ++i) {
    if (!(at_from(i) > 0 && at_to(i) < 0)) continue;
    const auto rate = [&](double t) { return stiffness_.row(i).dot(jacobian_ * rates(modes, t)); };
    const double at = passes_zero(from, to, at_from(i), at_to(i), rate);
    peak_(i) = std::max(peak_(i), force_at(coordinates(modes, at))(i));
  }
}

CoupledPush::Modes CoupledPush::modes() const {
  const Eigen::Matrix<double, Eigen::Dynamic, 6> scaled_places = jacobian_ * inverse_mass_root_;
  const Mat6 scaled = scaled_places.transpose() * stiffness_ * scaled_places;
  const Eigen::SelfAdjointEigenSolver<Mat6> eigen(scaled);
  Modes result;
  result.shape = inverse_mass_root_ * eigen.eigenvectors();
  result.squared = eigen.eigenvalues();
  const double least = free_motion * result.squared.maxCoeff();
  for (int i = 0; i < 6; ++i)
    if (result.squared(i) <= least) result.squared(i) = 0;
  const Mat6 to_modes = result.shape.inverse();
  result.place = to_modes * coordinates_;
  result.speed = to_modes * rate_;
  result.weight = result.shape.transpose() * (weight_ + jacobian_.transpose() * (stiffness_ * shift_));
  return result;
}

double CoupledPush::fastest_over_slowest() const {
  const Vec6 squared = modes().squared;
  double slowest = squared.maxCoeff();
  for (const double one : squared)
    if (one > 0) slowest = std::min(slowest, one);
  return slowest > 0 ? std::sqrt(squared.maxCoeff() / slowest) : 1;
}

CoupledPush::Vec6 CoupledPush::coordinates(const Modes& modes, double t) {
  Vec6 at;
  for (int i = 0; i < 6; ++i) {
    if (modes.squared(i) == 0) {
      at(i) = modes.place(i) + modes.speed(i) * t + modes.weight(i) * t * t / 2;
      continue;
    }
    const double w = std::sqrt(modes.squared(i)), rest = modes.weight(i) / modes.squared(i);
    at(i) = rest + (modes.place(i) - rest) * std::cos(w * t) + modes.speed(i) / w * std::sin(w * t);
  }
  return modes.shape * at;
}

CoupledPush::Vec6 CoupledPush::rates(const Modes& modes, double t) {
  Vec6 at;
  for (int i = 0; i < 6; ++i) {
    if (modes.squared(i) == 0) {
      at(i) = modes.speed(i) + modes.weight(i) * t;
      continue;
    }
    const double w = std::sqrt(modes.squared(i)), rest = modes.weight(i) / modes.squared(i);
    at(i) = (rest - modes.place(i)) * w * std::sin(w * t) + modes.speed(i) * std::cos(w * t);
  }
  return modes.shape * at;
}

void CoupledPush::drop_let_go(const Eigen::VectorXd& force) {
  const double none = no_force * std::max(peak_.maxCoeff(), 1e-300);
  for (std::size_t i = 0; i < touches_.size(); ++i)
    if (touches_[i] != 0 && force(static_cast<Eigen::Index>(i)) <= none) touches_[i] = 0;
  refresh();
}

CoupledPush::Stop CoupledPush::push(const Utilisation& utilisation) {
  const auto touching = [&] { return std::find(touches_.begin(), touches_.end(), 1) != touches_.end(); };
  while (touching()) {
    const Modes modes = this->modes();
    const auto force = [&](double t) { return force_at(coordinates(modes, t)); };
    // Below zero when a contact would have to pull.
    const auto least = [&](double t) {
      const Eigen::VectorXd f = force(t);
      double value = unlimited;
      for (std::size_t i = 0; i < touches_.size(); ++i)
        if (touches_[i] != 0) value = std::min(value, f(static_cast<Eigen::Index>(i)));
      return value;
    };
    const auto used = [&](double t) { return utilisation ? utilisation(force(t).cwiseMax(0.0)) : 0.0; };
    double slowest = unlimited, fastest = 0;
    for (int i = 0; i < 6; ++i) {
      if (modes.squared(i) == 0) continue;
      slowest = std::min(slowest, std::sqrt(modes.squared(i)));
      fastest = std::max(fastest, std::sqrt(modes.squared(i)));
    }
    const double step = 2 * pi / fastest / samples_per_period, end = 2 * pi / slowest;
    double at = 0;
    bool parted = false, failed = used(0) >= 1;
    while (!failed && !parted && at < end) {
      const double next = std::min(at + step, end);
      // At touch every force is zero, and grows.
      double to = next;
      parted = least(next) < 0;
      if (parted) to = first_time(at, next, [&](double t) { return least(t) < 0 && t > at; });
      if (used(to) >= 1) {
        failed = true;
        to = first_time(at, to, [&](double t) { return used(t) >= 1; });
      }
      note_peaks(modes, at, to);
      note_most_stored(modes, at, to);
      at = to;
      if (failed) parted = false;
    }
    const Vec6 now = coordinates(modes, at), speed = rates(modes, at);
    const Eigen::VectorXd last = force_at(now);
    coordinates_ = now;
    rate_ = speed;
    time_ += at;
    if (failed) return Stop::failed;
    if (!parted) return Stop::held;
    drop_let_go(last);
  }
  return Stop::left;
}

}  // namespace topple::structure
