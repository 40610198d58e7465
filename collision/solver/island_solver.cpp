#include "solver/island_solver.h"

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>

#include <algorithm>
#include <span>

#include "shapes/solid.h"

namespace topple::collision {

namespace {

bool touches_what_stands(const btPersistentManifold& manifold) {
  const auto stands = [](const btCollisionObject* object) {
    return static_cast<const Solid*>(object->getUserPointer())->kind == Touched::Kind::obstacle;
  };
  return stands(manifold.getBody0()) || stands(manifold.getBody1());
}

}  // namespace

btScalar IslandSolver::solveGroup(btCollisionObject** bodies, int body_count, btPersistentManifold** manifolds,
                                  int manifold_count, btTypedConstraint** constraints, int constraint_count,
                                  const btContactSolverInfo& info, btIDebugDraw* drawer, btDispatcher* dispatcher) {
  const std::span touching(manifolds, static_cast<std::size_t>(manifold_count));
  const bool bears = constraint_count > 0 || std::any_of(touching.begin(), touching.end(),
                                                         [](const auto* one) { return touches_what_stands(*one); });
  btContactSolverInfo own = info;
  own.m_numIterations = bears ? bearing_ : loose_;
  return btSequentialImpulseConstraintSolver::solveGroup(bodies, body_count, manifolds, manifold_count, constraints,
                                                         constraint_count, own, drawer, dispatcher);
}

}  // namespace topple::collision
