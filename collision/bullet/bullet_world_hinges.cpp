// Hinges and ball joints between bodies, or a body and space, and the forces that they carry.
#include <BulletDynamics/ConstraintSolver/btGeneric6DofSpring2Constraint.h>
#include <BulletDynamics/ConstraintSolver/btPoint2PointConstraint.h>

#include <algorithm>
#include <stdexcept>
#include <tuple>

#include "bullet/bullet_world.h"

namespace topple::collision {

namespace {

/// Share of a joint's gap that is closed in a step. Bullet's 0.2 lets heavy floors sag visibly from their hinges.
constexpr double kGapClosed = 0.4;

/// Euler angles are singular where their middle one reaches a right angle: a held component goes there.
RotateOrder rotation_order(const std::array<bool, 6>& held) {
  if (held[4]) return RO_XYZ;
  if (held[5]) return RO_YZX;
  return RO_ZXY;
}

bool is_ball(const std::array<bool, 6>& held) {
  return held[0] && held[1] && held[2] && !held[3] && !held[4] && !held[5];
}

}  // namespace

std::unique_ptr<btTypedConstraint> BulletWorld::make_constraint(const HingeDescription& description, Body& held_body,
                                                                Body* other) const {
  // Columns of the joint's frame are its axes.
  const Mat3 axes = description.axes.transpose();
  const btTransform frame(to_bullet(Eigen::Quaterniond(axes)), to_bullet(description.point));
  btRigidBody& holder = other ? *other->rigid : btTypedConstraint::getFixedBody();
  const btTransform in_body = held_body.rigid->getWorldTransform().inverse() * frame;
  const btTransform in_holder = holder.getWorldTransform().inverse() * frame;
  if (is_ball(description.held)) {
    auto ball =
        std::make_unique<btPoint2PointConstraint>(*held_body.rigid, holder, in_body.getOrigin(), in_holder.getOrigin());
    ball->m_setting.m_tau = kGapClosed;
    ball->setParam(BT_CONSTRAINT_ERP, kGapClosed, -1);
    return ball;
  }
  // Bullet measures its six freedoms along the axes of the first body's frame: the holder's.
  auto joint = std::make_unique<btGeneric6DofSpring2Constraint>(holder, *held_body.rigid, in_holder, in_body,
                                                                rotation_order(description.held));
  for (int i = 0; i < 6; ++i) {
    if (description.held[static_cast<std::size_t>(i)]) {
      joint->setLimit(i, 0, 0);
    } else {
      joint->setLimit(i, 1, -1);  // low above high: free
    }
    joint->setParam(BT_CONSTRAINT_STOP_ERP, kGapClosed, i);
  }
  return joint;
}

HingeId BulletWorld::add_hinge(const HingeDescription& description) {
  const std::string name = "hinge " + std::to_string(next_hinge_);
  if (!description.point.allFinite() || !description.axes.isUnitary(1e-9) || description.axes.determinant() < 0) {
    throw std::invalid_argument(name + ": its point must be finite and its axes a rotation");
  }
  if (std::none_of(description.held.begin(), description.held.end(), [](bool held) { return held; })) {
    throw std::invalid_argument(name + ": it holds nothing; at least one component must be held");
  }
  Body& held_body = body(description.body.value);
  Body* other = description.other ? &body(description.other->value) : nullptr;
  if (other == &held_body)
    throw std::invalid_argument(name + ": it joins body " + std::to_string(held_body.id) + " to itself");
  auto hinge = std::make_unique<Hinge>();
  hinge->body = held_body.id;
  hinge->other = other ? other->id : -1;
  hinge->constraint = make_constraint(description, held_body, other);
  const btTransform holder = other ? other->rigid->getWorldTransform() : btTransform::getIdentity();
  hinge->point_in_body = held_body.rigid->getWorldTransform().invXform(to_bullet(description.point));
  hinge->axes_in_holder = description.axes * from_bullet(holder.getBasis());
  hinge->constraint->setJointFeedback(&hinge->feedback);
  world_.addConstraint(hinge->constraint.get(), other != nullptr);
  held_body.hinges.insert(next_hinge_);
  if (other) other->hinges.insert(next_hinge_);
  wake(description.body);
  if (other) wake(*description.other);
  hinges_.emplace(next_hinge_, std::move(hinge));
  return {next_hinge_++};
}

void BulletWorld::remove_hinge(HingeId id) {
  Hinge& gone = hinge(id.value);
  world_.removeConstraint(gone.constraint.get());
  for (const std::int64_t end : {gone.body, gone.other}) {
    if (end < 0) continue;
    body(end).hinges.erase(id.value);
    wake({end});
  }
  hinges_.erase(id.value);
}

void BulletWorld::read_hinge(Hinge& read, double dt) const {
  const Body& held_body = body(read.body);
  read.work_lost = 0;
  if (!held_body.rigid->isActive()) return;  // asleep: it pulls as it did
  const Body* other = read.other < 0 ? nullptr : &body(read.other);
  const bool body_is_first = &read.constraint->getRigidBodyA() == held_body.rigid.get();
  const Vec3 force = from_bullet(body_is_first ? read.feedback.m_appliedForceBodyA : read.feedback.m_appliedForceBodyB);
  const Vec3 torque =
      from_bullet(body_is_first ? read.feedback.m_appliedTorqueBodyA : read.feedback.m_appliedTorqueBodyB);
  const btTransform holder = other ? other->velocities.pose : btTransform::getIdentity();
  const Vec3 arm = from_bullet(held_body.velocities.pose.getBasis() * read.point_in_body);
  const Mat3 axes = read.axes_in_holder * from_bullet(holder.getBasis()).transpose();
  // What the holder does to the body, its torque about the centre of mass; turned round, about the joint.
  read.force.head<3>() = -(axes * force);
  read.force.tail<3>() = -(axes * (torque - arm.cross(force)));

  // An impulse times the mean of the velocities before and after it is the energy that it brings in.
  const auto brought = [&](const Body& one, const btVector3& push, const btVector3& turn) {
    const SolverVelocities& v = one.velocities;
    return dt * (push.dot(v.linear_before + v.linear_after) + turn.dot(v.angular_before + v.angular_after)) / 2;
  };
  const auto& [force_a, torque_a, force_b, torque_b] =
      std::tie(read.feedback.m_appliedForceBodyA, read.feedback.m_appliedTorqueBodyA, read.feedback.m_appliedForceBodyB,
               read.feedback.m_appliedTorqueBodyB);
  read.work_lost -= body_is_first ? brought(held_body, force_a, torque_a) : brought(held_body, force_b, torque_b);
  if (other && other->rigid->isActive())
    read.work_lost -= body_is_first ? brought(*other, force_b, torque_b) : brought(*other, force_a, torque_a);
}

double BulletWorld::hinge_work_lost(HingeId id) const { return hinge(id.value).work_lost; }

Eigen::Matrix<double, 6, 1> BulletWorld::hinge_force(HingeId id) const { return hinge(id.value).force; }

}  // namespace topple::collision
