#include "solver/equilibrium.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

namespace topple::collision {

namespace {
/// Share of a contact's stiffness that a body is taken to have by itself, times what is out of balance: keeps the steps
/// of loose bodies finite and leaves the last steps Newton's.
constexpr double kLoose = 1e-3, kLeastLoose = 1e-10;
constexpr double kInner = 0.02;    ///< residual of the linear equations, of what they began with
constexpr double kDescent = 1e-4;  ///< share of the decrease that the slope promises which a step must bring (Armijo)
constexpr double kGives = 0.02;    ///< of the largest way: what gives as much is in the mechanism
constexpr int kNewtonSteps = 40;
constexpr int kCuts = 20;  ///< halvings of a step
}  // namespace

/// With s >= 0 the multiplier of the bound, n_i = max(0, z_i + friction d_i s) and T shrinks by s d: where
/// |T| = friction (sum of n) is one piecewise linear, concave equation for s, which Newton's steps solve exactly.
void project_on_cone(const RestContact::Rows& z, const RestContact::Rows& stiffness, int count, double friction,
                     RestContact::Rows& nearest, RestContact::Square& gives) {
  const Vec3 across = z.tail<3>();
  const double length = across.norm(), slip = stiffness[4];
  double s = 0, stiff = slip;
  std::array<bool, 4> bears{};
  for (int pass = 0; pass < 6; ++pass) {
    double pressed = 0;
    stiff = slip;
    for (int i = 0; i < count; ++i) {
      const double force = z[i] + friction * stiffness[i] * s;
      bears[static_cast<std::size_t>(i)] = force > 0;
      if (force <= 0) continue;
      pressed += force;
      stiff += friction * friction * stiffness[i];
    }
    const double over = length - s * slip - friction * pressed;
    if (pass == 0 && over <= 0) break;  // friction holds
    const double better = s + over / stiff;
    if (pass > 0 && !(better < s)) break;
    s = better;
  }
  nearest.setZero();
  gives.setZero();
  for (int i = 0; i < count; ++i)
    if (bears[static_cast<std::size_t>(i)]) {
      nearest[i] = z[i] + friction * stiffness[i] * s;
      gives(i, i) = stiffness[i];
    }
  if (s == 0) {
    nearest.tail<3>() = across;
    gives.bottomRightCorner<3, 3>() = slip * Mat3::Identity();
    return;
  }
  const bool any = std::find(bears.begin(), bears.end(), true) != bears.end();
  const double left = any ? std::max(0.0, 1 - s * slip / length) : 0;
  const Vec3 along = across / length;
  nearest.tail<3>() = left * across;
  RestContact::Rows bound = RestContact::Rows::Zero();  // of the cone's side, times D
  for (int i = 0; i < count; ++i)
    if (bears[static_cast<std::size_t>(i)]) bound[i] = friction * stiffness[i];
  bound.tail<3>() = -slip * along;
  const Mat3 side = along * along.transpose();
  gives.bottomRightCorner<3, 3>() = slip * (left * (Mat3::Identity() - side) + side);
  gives.noalias() -= bound * bound.transpose() / stiff;
}

double Equilibrium::respond(const Vectors& y, Vectors& out) {
  double energy = 0;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    out[i] = bodies[i].weight;
    energy -= bodies[i].weight.dot(y[i]);
  }
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    RestContact& one = contacts[k];
    const auto first = static_cast<std::size_t>(one.first), second = static_cast<std::size_t>(one.second);
    const RestContact::Rows way = one.on_second * y[second] - one.on_first * y[first];
    project_on_cone(one.start - one.stiffness.cwiseProduct(way), one.stiffness, one.count, one.friction, one.force,
                    gives_[k]);
    if (either_moves(one.first, one.second)) {
      project_on_cone(one.start, one.stiffness, one.count, one.friction, one.force, gives_[k]);
      gives_[k].setZero();
      energy -= one.force.dot(way);
    } else {
      energy += one.force.cwiseAbs2().cwiseQuotient(one.stiffness).sum() / 2;
    }
    out[first] -= one.on_first.transpose() * one.force;
    out[second] += one.on_second.transpose() * one.force;
  }
  for (std::size_t k = 0; k < joints.size(); ++k) {
    RestJoint& one = joints[k];
    const auto first = static_cast<std::size_t>(one.first), second = static_cast<std::size_t>(one.second);
    const RestJoint::Rows way = one.on_second * y[second] + one.on_first * y[first];
    one.force = one.start - one.stiffness * way;
    pulls_[k] = !one.pulls_only || one.force[0] > 0;
    if (!pulls_[k]) one.force.setZero();
    // |lambda|^2/2 in D^-1 but for a constant; what a cable leaves out of its row has no such energy.
    if (one.pulls_only)
      energy += pulls_[k] && one.stiffness(0, 0) > 0 ? one.force[0] * one.force[0] / (2 * one.stiffness(0, 0)) : 0;
    else
      energy += way.dot(one.stiffness * way) / 2 - one.start.dot(way);
    out[first] += one.on_first.transpose() * one.force;
    out[second] += one.on_second.transpose() * one.force;
  }
  out[0].setZero();
  for (std::size_t i = 1; i < bodies.size(); ++i)
    if (bodies[i].moves) out[i].setZero();
  return energy;
}

void Equilibrium::assemble(double loose) {
  blocks_.assign(bodies.size(), Mat6::Identity() * loose);
  links_.clear();
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    const RestContact& one = contacts[k];
    if (gives_[k].isZero(0)) continue;
    const auto first = static_cast<std::size_t>(one.first), second = static_cast<std::size_t>(one.second);
    const RestContact::Jacobian on_first = gives_[k] * one.on_first;
    if (first != 0) blocks_[first].noalias() += one.on_first.transpose() * on_first;
    if (second != 0) blocks_[second].noalias() += one.on_second.transpose() * (gives_[k] * one.on_second);
    if (first != 0 && second != 0) links_.push_back({one.first, one.second, -one.on_second.transpose() * on_first});
  }
  for (std::size_t k = 0; k < joints.size(); ++k) {
    if (!pulls_[k]) continue;
    const RestJoint& one = joints[k];
    blocks_[static_cast<std::size_t>(one.first)] += one.on_first.transpose() * one.stiffness * one.on_first;
    blocks_[static_cast<std::size_t>(one.second)] += one.on_second.transpose() * one.stiffness * one.on_second;
    if (one.first != 0 && one.second != 0)
      links_.push_back({one.first, one.second, one.on_second.transpose() * one.stiffness * one.on_first});
  }
  inverses_.resize(blocks_.size());
  for (std::size_t i = 1; i < blocks_.size(); ++i) inverses_[i] = blocks_[i].ldlt().solve(Mat6::Identity());
}

void Equilibrium::multiply(const Vectors& p, Vectors& out) const {
  for (std::size_t i = 1; i < out.size(); ++i) out[i].noalias() = blocks_[i] * p[i];
  for (const Link& link : links_) {
    const auto first = static_cast<std::size_t>(link.first), second = static_cast<std::size_t>(link.second);
    out[second].noalias() += link.block * p[first];
    out[first].noalias() += link.block.transpose() * p[second];
  }
}

double Equilibrium::size(const Vectors& out) const {
  double largest = 0;
  for (std::size_t i = 1; i < out.size(); ++i)
    largest = std::max(largest, out[i].cwiseProduct(bodies[i].scale).cwiseAbs().maxCoeff());
  return largest;
}

int Equilibrium::newton_step(const Vectors& out, double enough, Vectors& step, int passes) {
  const std::size_t count = bodies.size();
  const auto dot = [&](const Vectors& a, const Vectors& b) {
    double sum = 0;
    for (std::size_t i = 1; i < count; ++i) sum += a[i].dot(b[i]);
    return sum;
  };
  Vectors left = out, better(count, Vec6::Zero()), along(count), image(count, Vec6::Zero());
  step.assign(count, Vec6::Zero());
  for (std::size_t i = 1; i < count; ++i) better[i] = inverses_[i] * left[i];
  along = better;
  double product = dot(left, better);
  const double until = enough * enough * product;
  int used = 0;
  while (used < passes && product > until) {
    multiply(along, image);
    ++used;
    const double length = product / dot(along, image);
    for (std::size_t i = 1; i < count; ++i) {
      step[i] += length * along[i];
      left[i] -= length * image[i];
      better[i].noalias() = inverses_[i] * left[i];
    }
    const double next = dot(left, better);
    for (std::size_t i = 1; i < count; ++i) along[i] = better[i] + next / product * along[i];
    product = next;
  }
  return used;
}

bool Equilibrium::solve(double tolerance, int passes) {
  const std::size_t count = bodies.size();
  gives_.assign(contacts.size(), RestContact::Square::Zero());
  pulls_.assign(joints.size(), 1);
  Vectors y(count, Vec6::Zero()), tried(count, Vec6::Zero()), out(count), step;
  double energy = respond(y, out);
  residual_ = size(out);
  passes_ = newton_steps_ = 0;
  while (residual_ > tolerance && newton_steps_ < kNewtonSteps && passes_ < passes) {
    ++newton_steps_;
    assemble(std::max(kLeastLoose, kLoose * std::min(1.0, residual_)));
    passes_ += std::max(1, newton_step(out, kInner, step, passes - passes_));
    double slope = 0;
    for (std::size_t i = 1; i < count; ++i) slope -= out[i].dot(step[i]);
    double length = 1, now = 0;
    bool better = false;
    for (int cut = 0; cut < kCuts && !better; ++cut, length /= 2) {
      for (std::size_t i = 1; i < count; ++i) tried[i] = y[i] + length * step[i];
      now = respond(tried, out);
      // Near the end the energy's own rounding hides what a step brings; the residual tells then.
      better = now <= energy + kDescent * length * slope || size(out) < residual_ / 2;
    }
    if (!better) break;
    y.swap(tried);
    energy = now;
    residual_ = size(out);
  }
  respond(y, out);
  residual_ = size(out);
  y_.swap(y);
  return residual_ <= tolerance;
}

bool Equilibrium::leave_out_what_gives(double share) {
  const auto way = [&](std::size_t i) { return y_[i].cwiseQuotient(bodies[i].scale).norm(); };
  double most = 0;
  std::size_t asked = 0, left_out = 0;
  for (std::size_t i = 1; i < bodies.size(); ++i) {
    most = std::max(most, way(i));
    asked += bodies[i].moves ? 0 : 1;
  }
  for (std::size_t i = 1; i < bodies.size(); ++i) {
    if (bodies[i].moves || way(i) < kGives * most) continue;
    bodies[i].moves = true;
    ++left_out;
  }
  for (const RestJoint& one : joints)
    if (either_moves(one.first, one.second)) return false;
  return static_cast<double>(left_out) <= share * static_cast<double>(asked);
}

}  // namespace topple::collision
