#include "free_spin_world.h"

#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <LinearMath/btTransformUtil.h>

namespace topple::collision {

namespace {

btVector3 principal_inertia(const btRigidBody& body) {
  const btVector3& inverse = body.getInvInertiaDiagLocal();
  return {1 / inverse.x(), 1 / inverse.y(), 1 / inverse.z()};
}

btVector3 angular_momentum(const btRigidBody& body, const btVector3& inertia) {
  const btMatrix3x3& axes = body.getWorldTransform().getBasis();
  return axes * (inertia * (body.getAngularVelocity() * axes));
}

btVector3 angular_velocity(const btMatrix3x3& axes, const btVector3& inertia, const btVector3& momentum) {
  return axes * ((momentum * axes) / inertia);
}

bool spins_freely(const btVector3& inertia) { return inertia.x() == inertia.y() && inertia.y() == inertia.z(); }

}  // namespace

void FreeSpinWorld::predictUnconstraintMotion(btScalar time_step) {
  for (int i = 0; i < m_nonStaticRigidBodies.size(); ++i) {
    btRigidBody& body = *m_nonStaticRigidBodies[i];
    SolverVelocities& velocities = record_(body);
    velocities = {};
    velocities.pose = body.getWorldTransform();
    if (!body.isActive()) continue;
    velocities.linear_before = body.getLinearVelocity();
    velocities.angular_before = body.getAngularVelocity();
  }
  btDiscreteDynamicsWorld::predictUnconstraintMotion(time_step);
}

void FreeSpinWorld::integrateTransforms(btScalar time_step) {
  btAlignedObjectArray<btVector3> momenta;
  momenta.resize(m_nonStaticRigidBodies.size());
  for (int i = 0; i < m_nonStaticRigidBodies.size(); ++i) {
    btRigidBody& body = *m_nonStaticRigidBodies[i];
    if (!body.isActive()) continue;
    SolverVelocities& velocities = record_(body);
    velocities.linear_after = body.getLinearVelocity();
    velocities.angular_after = body.getAngularVelocity();
    const btVector3 inertia = principal_inertia(body);
    momenta[i] = angular_momentum(body, inertia);
    if (spins_freely(inertia) || momenta[i].fuzzyZero()) continue;
    btTransform half_way;
    btTransformUtil::integrateTransform(body.getWorldTransform(), {0, 0, 0}, body.getAngularVelocity(), time_step / 2,
                                        half_way);
    body.setAngularVelocity(angular_velocity(half_way.getBasis(), inertia, momenta[i]));
  }
  btDiscreteDynamicsWorld::integrateTransforms(time_step);
  for (int i = 0; i < m_nonStaticRigidBodies.size(); ++i) {
    btRigidBody& body = *m_nonStaticRigidBodies[i];
    if (!body.isActive()) continue;
    const btVector3 inertia = principal_inertia(body);
    if (spins_freely(inertia) || momenta[i].fuzzyZero()) continue;
    body.setAngularVelocity(angular_velocity(body.getWorldTransform().getBasis(), inertia, momenta[i]));
    body.setInterpolationAngularVelocity(body.getAngularVelocity());
  }
}

}  // namespace topple::collision
