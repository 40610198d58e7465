#include "bullet/free_spin_world.h"

#include <BulletDynamics/Dynamics/btRigidBody.h>

#include "bullet/bullet_types.h"
#include "solver/free_rotation.h"

namespace topple::collision {

namespace {

btVector3 principal_inertia(const btRigidBody& body) {
  const btVector3& inverse = body.getInvInertiaDiagLocal();
  return {1 / inverse.x(), 1 / inverse.y(), 1 / inverse.z()};
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
  for (Cable* cable : cables_)
    if (cable->body().isActive()) cable->hold(time_step);
  for (int i = 0; i < m_nonStaticRigidBodies.size(); ++i) {
    btRigidBody& body = *m_nonStaticRigidBodies[i];
    if (!body.isActive()) continue;
    SolverVelocities& velocities = record_(body);
    velocities.linear_after = body.getLinearVelocity();
    velocities.angular_after = body.getAngularVelocity();
    velocities.pose.setBasis(body.getWorldTransform().getBasis());
  }
  btDiscreteDynamicsWorld::integrateTransforms(time_step);
  for (int i = 0; i < m_nonStaticRigidBodies.size(); ++i) {
    btRigidBody& body = *m_nonStaticRigidBodies[i];
    if (!body.isActive()) continue;
    const btVector3 inertia = principal_inertia(body);
    if (spins_freely(inertia) || body.getAngularVelocity().fuzzyZero()) continue;
    // A body that stopped short at a contact found on its way turns for as long as it moved.
    const SolverVelocities& now = record_(body);
    const FreeRotation turned = rotated_freely({from_bullet(now.pose.getRotation()), from_bullet(now.angular_after)},
                                               from_bullet(inertia), time_step * body.getHitFraction());
    body.setAngularVelocity(to_bullet(turned.spin));
    btTransform pose = body.getWorldTransform();
    pose.setRotation(to_bullet(turned.orientation));
    body.setCenterOfMassTransform(pose);
  }
}

}  // namespace topple::collision
