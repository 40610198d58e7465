#pragma once
// Contacts between two polyhedra of which one at least is a hull. As Bullet finds them (nearest points, and where the
// two overlap their faces clipped against each other), but not sought while a plane is known that parts the two (in a
// heap of slabs four of five pairs whose bounds meet do not touch), nor while they have hardly moved against each
// other.
#include <BulletCollision/CollisionDispatch/btCollisionCreateFunc.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpaPenetrationDepthSolver.h>

class btCollisionDispatcher;

namespace topple::collision {

class PolyhedronContactsFactory final : public btCollisionAlgorithmCreateFunc {
 public:
  btCollisionAlgorithm* CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                 const btCollisionObjectWrapper* first,
                                                 const btCollisionObjectWrapper* second) override;

 private:
  btGjkEpaPenetrationDepthSolver depths_;
};

/// Room that the dispatcher's pool needs for each pair (m_customCollisionAlgorithmMaxElementSize of its configuration).
[[nodiscard]] int size_of_polyhedron_contacts();

/// Has the dispatcher use it for hulls against hulls and boxes. The factory must outlive the dispatcher.
void use_polyhedron_contacts(btCollisionDispatcher& dispatcher, PolyhedronContactsFactory& factory);

}  // namespace topple::collision
