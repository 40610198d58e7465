#pragma once
// Sequential impulse with as many iterations as a group of touching bodies needs.
#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolver.h>

namespace topple::collision {

/// Bodies that lie on what stands, or hang by joints, load it with what their contacts carry: that wants many
/// iterations. A heap that touches nothing but the ground and itself wants as many as keep it from creeping.
class IslandSolver final : public btSequentialImpulseConstraintSolver {
 public:
  IslandSolver(int bearing, int loose) : bearing_(bearing), loose_(loose) {}

  btScalar solveGroup(btCollisionObject** bodies, int body_count, btPersistentManifold** manifolds, int manifold_count,
                      btTypedConstraint** constraints, int constraint_count, const btContactSolverInfo& info,
                      btIDebugDraw* drawer, btDispatcher* dispatcher) override;

 private:
  int bearing_, loose_;
};

}  // namespace topple::collision
