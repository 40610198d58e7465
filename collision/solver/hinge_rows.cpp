#include "solver/hinge_rows.h"

#include <Eigen/Cholesky>
#include <algorithm>

namespace topple::collision {

namespace {

/// A vector turned by the rotation vector `by`, exactly.
Vec3 turned(const Vec3& v, const Vec3& by) {
  const double angle = by.norm();
  if (angle == 0) return v;
  return Eigen::AngleAxisd(angle, by / angle) * v;
}

Eigen::Map<Eigen::Matrix<double, 6, 1>> row_of(Motion6& motion) {
  return Eigen::Map<Eigen::Matrix<double, 6, 1>>(motion.linear);
}

}  // namespace

void HingeRows::begin_step(double h) {
  impulse *= h;
  force_total.setZero();
  moment_total.setZero();
  body_moment.setZero();
  holder_moment.setZero();
  moment_where_it_was.setZero();
}

void HingeRows::add_row(const Vec3& along, const Vec3& about, double gap, const SolverBody& of,
                        const SolverBody& other) {
  const int row = count_++;
  along_[static_cast<std::size_t>(row)] = along;
  about_[static_cast<std::size_t>(row)] = about;
  gap_[row] = gap;
  on_body_.row(row) = of.row(along, body_arm_.cross(along) + about);
  on_holder_.row(row) = -other.row(along, holder_arm_.cross(along) + about);
}

void HingeRows::prepare(const SolverBody& of, const SolverBody& other, const Motion6& body_moved,
                        const Motion6& holder_moved) {
  const Vec3 body_turn = of.angular(body_moved), holder_turn = other.angular(holder_moved);
  body_arm_ = turned(of.at.turn * point_in_body, body_turn);
  holder_arm_ = turned(other.at.turn * point_in_holder, holder_turn);
  holder_way_ = other.linear(holder_moved);
  const Vec3 gap = of.at.position + of.linear(body_moved) + body_arm_ - (other.at.position + holder_way_ + holder_arm_);
  Mat3 body_axes, holder_axes;
  for (int i = 0; i < 3; ++i) {
    body_axes.col(i) = turned(of.at.turn * axes_in_body.col(i), body_turn);
    holder_axes.col(i) = turned(other.at.turn * axes_in_holder.col(i), holder_turn);
  }
  // Both act at the body's point: what is left of the gap must not turn into a moment.
  holder_arm_ += gap;
  count_ = 0;
  const Vec3 nothing = Vec3::Zero();
  for (int i = 0; i < 3; ++i)
    if (held[static_cast<std::size_t>(i)]) add_row(holder_axes.col(i), nothing, holder_axes.col(i).dot(gap), of, other);
  std::array<int, 3> free{}, fixed{};
  int free_count = 0, fixed_count = 0;
  for (int i = 0; i < 3; ++i)
    (held[static_cast<std::size_t>(3 + i)] ? fixed[static_cast<std::size_t>(fixed_count++)]
                                           : free[static_cast<std::size_t>(free_count++)]) = i;
  if (free_count == 0) {
    const Eigen::AngleAxisd apart(body_axes * holder_axes.transpose());
    const Vec3 angle = apart.angle() * apart.axis();
    for (int i = 0; i < 3; ++i) add_row(nothing, holder_axes.col(i), holder_axes.col(i).dot(angle), of, other);
  } else if (free_count == 1) {
    // The free axis of the body stays at right angles to the two others of the holder.
    const Vec3 axis = body_axes.col(free[0]);
    for (int k = 0; k < 2; ++k) {
      const Vec3 across = holder_axes.col(fixed[static_cast<std::size_t>(k)]);
      add_row(nothing, axis.cross(across), across.dot(axis), of, other);
    }
  } else if (free_count == 2) {
    const Vec3 of_body = body_axes.col(free[1]), of_holder = holder_axes.col(free[0]);
    add_row(nothing, of_body.cross(of_holder), of_body.dot(of_holder), of, other);
  }
  Eigen::Matrix<double, most, most> mass = Eigen::Matrix<double, most, most>::Identity();
  mass.topLeftCorner(count_, count_) = on_body_.topRows(count_) * on_body_.topRows(count_).transpose() +
                                       on_holder_.topRows(count_) * on_holder_.topRows(count_).transpose();
  inverse_mass_ = mass.ldlt().solve(Eigen::Matrix<double, most, most>::Identity());
}

void HingeRows::apply(const Rows& change, Motion6* velocity, Motion6* changed) const {
  const Eigen::Matrix<double, 6, 1> of_body = on_body_.topRows(count_).transpose() * change.head(count_);
  row_of(velocity[body]) += of_body;
  row_of(changed[body]) += of_body;
  if (holder == 0) return;
  const Eigen::Matrix<double, 6, 1> of_holder = on_holder_.topRows(count_).transpose() * change.head(count_);
  row_of(velocity[holder]) += of_holder;
  row_of(changed[holder]) += of_holder;
}

void HingeRows::solve(double frequency, double damping, double h, Motion6* velocity, Motion6* changed) {
  Rows bias = Rows::Zero();
  double mass_scale = 1, impulse_scale = 0;
  if (frequency > 0) {
    const double w = 2 * M_PI * frequency, a1 = 2 * damping + h * w, a2 = h * w * a1;
    mass_scale = a2 / (1 + a2);
    impulse_scale = 1 / (1 + a2);
    bias = w / a1 * gap_;
  }
  Rows speed = Rows::Zero();
  speed.head(count_) = on_body_.topRows(count_) * row_of(velocity[body]);
  if (holder != 0) speed.head(count_) += on_holder_.topRows(count_) * row_of(velocity[holder]);
  Rows change = Rows::Zero();
  change.head(count_) = -mass_scale * (inverse_mass_.topLeftCorner(count_, count_) * (speed + bias).head(count_)) -
                        impulse_scale * impulse.head(count_);
  impulse += change;
  apply(change, velocity, changed);
}

RestJoint HingeRows::at_rest() const {
  RestJoint joint;
  joint.first = body;
  joint.second = holder;
  joint.on_first.topRows(count_) = on_body_.topRows(count_);
  if (holder != 0) joint.on_second.topRows(count_) = on_holder_.topRows(count_);
  joint.stiffness.topLeftCorner(count_, count_) = inverse_mass_.topLeftCorner(count_, count_);
  joint.start.head(count_) = impulse.head(count_);
  return joint;
}

void HingeRows::store_rest(const Rows& force, double dt) {
  force_total.setZero();
  moment_total.setZero();
  body_moment.setZero();
  holder_moment.setZero();
  moment_where_it_was.setZero();
  impulse = force * dt;
  add_up();
  impulse = force;
}

void HingeRows::add_up() {
  Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
  for (int i = 0; i < count_; ++i) {
    force += impulse[i] * along_[static_cast<std::size_t>(i)];
    moment += impulse[i] * about_[static_cast<std::size_t>(i)];
  }
  force_total += force;
  moment_total += moment;
  body_moment += body_arm_.cross(force) + moment;
  holder_moment -= holder_arm_.cross(force) + moment;
  moment_where_it_was -= (holder_way_ + holder_arm_).cross(force) + moment;
}

}  // namespace topple::collision
