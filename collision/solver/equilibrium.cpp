#include "solver/equilibrium.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace topple::collision {

namespace {
/// Share of a row's stiffness that it is taken to have where it gives way: keeps the steps of loose bodies finite.
constexpr double kLoose = 1e-6;
/// Residual of the linear equations, of what they began with.
constexpr double kInner = 0.05;
constexpr int kNewtonSteps = 40;
}  // namespace

void Equilibrium::respond(const Vectors& y, Vectors& out) {
  for (std::size_t i = 0; i < bodies.size(); ++i) out[i] = bodies[i].weight;
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    RestContact& one = contacts[k];
    const auto first = static_cast<std::size_t>(one.first), second = static_cast<std::size_t>(one.second);
    const RestContact::Rows way = one.on_second * y[second] - one.on_first * y[first];
    double pressed = 0, grip = 0;
    for (int i = 0; i < one.points; ++i) {
      const double tried = one.start[i] - one.stiffness[i] * way[i];
      one.force[i] = std::max(0.0, tried);
      gives_[k][i] = tried > 0 ? 1 : kLoose;
      pressed += one.force[i];
      grip += one.force[i] * one.lever[static_cast<std::size_t>(i)];
    }
    Eigen::Matrix2d matrix;
    matrix << one.stiffness[4], one.coupling, one.coupling, one.stiffness[5];
    const Eigen::Vector2d tried = one.start.segment<2>(4) - matrix * way.segment<2>(4);
    const double bound = one.friction * pressed, length = tried.norm();
    if (length <= bound) {
      one.force.segment<2>(4) = tried;
      slides_[k] = matrix;
    } else {
      const Eigen::Vector2d along = tried / length;
      one.force.segment<2>(4) = bound * along;
      slides_[k] = (bound / length + kLoose) *
                       (matrix - (matrix * along) * (matrix * along).transpose() / along.dot(matrix * along)) +
                   kLoose * matrix;
    }
    const double twist = one.start[6] - one.stiffness[6] * way[6], most = one.friction * grip;
    one.force[6] = std::clamp(twist, -most, most);
    gives_[k][6] = std::abs(twist) <= most ? 1 : kLoose;
    out[first] -= one.on_first.transpose() * one.force;
    out[second] += one.on_second.transpose() * one.force;
  }
  for (std::size_t k = 0; k < joints.size(); ++k) {
    RestJoint& one = joints[k];
    const auto first = static_cast<std::size_t>(one.first), second = static_cast<std::size_t>(one.second);
    one.force = one.start - one.stiffness * (one.on_second * y[second] + one.on_first * y[first]);
    pulls_[k] = !one.pulls_only || one.force[0] > 0;
    if (!pulls_[k]) one.force.setZero();
    out[first] += one.on_first.transpose() * one.force;
    out[second] += one.on_second.transpose() * one.force;
  }
  out[0].setZero();
}

void Equilibrium::multiply(const Vectors& p, Vectors& out) const {
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = kLoose * p[i];
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    const RestContact& one = contacts[k];
    const auto first = static_cast<std::size_t>(one.first), second = static_cast<std::size_t>(one.second);
    const RestContact::Rows way = one.on_second * p[second] - one.on_first * p[first];
    RestContact::Rows force = gives_[k].cwiseProduct(one.stiffness).cwiseProduct(way);
    force.segment<2>(4) = slides_[k] * way.segment<2>(4);
    out[first] -= one.on_first.transpose() * force;
    out[second] += one.on_second.transpose() * force;
  }
  for (std::size_t k = 0; k < joints.size(); ++k) {
    if (!pulls_[k]) continue;
    const RestJoint& one = joints[k];
    const auto first = static_cast<std::size_t>(one.first), second = static_cast<std::size_t>(one.second);
    const RestJoint::Rows force = one.stiffness * (one.on_second * p[second] + one.on_first * p[first]);
    out[first] += one.on_first.transpose() * force;
    out[second] += one.on_second.transpose() * force;
  }
  out[0].setZero();
}

void Equilibrium::precondition() {
  blocks_.assign(bodies.size(), Mat6::Identity() * kLoose);
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    const RestContact& one = contacts[k];
    Eigen::Matrix<double, 7, 7> middle = gives_[k].cwiseProduct(one.stiffness).asDiagonal();
    middle.block<2, 2>(4, 4) = slides_[k];
    blocks_[static_cast<std::size_t>(one.first)] += one.on_first.transpose() * middle * one.on_first;
    blocks_[static_cast<std::size_t>(one.second)] += one.on_second.transpose() * middle * one.on_second;
  }
  for (std::size_t k = 0; k < joints.size(); ++k) {
    if (!pulls_[k]) continue;
    const RestJoint& one = joints[k];
    blocks_[static_cast<std::size_t>(one.first)] += one.on_first.transpose() * one.stiffness * one.on_first;
    blocks_[static_cast<std::size_t>(one.second)] += one.on_second.transpose() * one.stiffness * one.on_second;
  }
  for (Mat6& block : blocks_) block = Mat6(block.ldlt().solve(Mat6::Identity()));
}

double Equilibrium::size(const Vectors& out) const {
  double largest = 0;
  for (std::size_t i = 1; i < out.size(); ++i)
    largest = std::max(largest, out[i].cwiseProduct(bodies[i].scale).cwiseAbs().maxCoeff());
  return largest;
}

double Equilibrium::sum_of_squares(const Vectors& out) const {
  double sum = 0;
  for (std::size_t i = 1; i < out.size(); ++i) sum += out[i].cwiseProduct(bodies[i].scale).squaredNorm();
  return sum;
}

int Equilibrium::newton_step(const Vectors& out, Vectors& step, int passes) {
  const std::size_t count = bodies.size();
  const auto dot = [&](const Vectors& a, const Vectors& b) {
    double sum = 0;
    for (std::size_t i = 1; i < count; ++i) sum += a[i].dot(b[i]);
    return sum;
  };
  precondition();
  Vectors left = out, better(count), along(count), image(count, Vec6::Zero());
  step.assign(count, Vec6::Zero());
  for (std::size_t i = 0; i < count; ++i) better[i] = blocks_[i] * left[i];
  better[0].setZero();
  along = better;
  double product = dot(left, better);
  const double enough = kInner * kInner * product;
  int used = 0;
  while (used < passes && product > enough) {
    multiply(along, image);
    ++used;
    const double length = product / dot(along, image);
    for (std::size_t i = 1; i < count; ++i) {
      step[i] += length * along[i];
      left[i] -= length * image[i];
      better[i] = blocks_[i] * left[i];
    }
    const double next = dot(left, better);
    for (std::size_t i = 1; i < count; ++i) along[i] = better[i] + next / product * along[i];
    product = next;
  }
  return used;
}

bool Equilibrium::solve(double tolerance, int passes) {
  const std::size_t count = bodies.size();
  gives_.assign(contacts.size(), RestContact::Rows::Zero());
  slides_.assign(contacts.size(), Eigen::Matrix2d::Zero());
  pulls_.assign(joints.size(), 1);
  Vectors y(count, Vec6::Zero()), tried(count), out(count), step;
  respond(y, out);
  residual_ = size(out);
  double merit = sum_of_squares(out);
  for (int k = 0; k < kNewtonSteps && residual_ > tolerance && passes > 0; ++k) {
    passes -= std::max(1, newton_step(out, step, passes));
    double length = 1, now = 0;
    for (int cut = 0; cut < 6; ++cut, length /= 2) {
      for (std::size_t i = 0; i < count; ++i) tried[i] = y[i] + length * step[i];
      respond(tried, out);
      now = sum_of_squares(out);
      if (now < merit) break;
    }
    if (!(now < merit)) break;
    y.swap(tried);
    merit = now;
    residual_ = size(out);
  }
  respond(y, out);
  residual_ = size(out);
  return residual_ <= tolerance;
}

}  // namespace topple::collision
