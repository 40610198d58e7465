#pragma once
// Contacts between a polyhedron and the ground: every vertex near it. Bullet's own finds one vertex a step and gathers
// the others over several, on which a slab that lies down rocks.
#include <BulletCollision/CollisionDispatch/btCollisionCreateFunc.h>

class btCollisionDispatcher;

namespace topple::collision {

/// Makes the algorithm for a polyhedron first (`swapped` false) or second (true) in the pair.
class HalfSpaceContactsFactory : public btCollisionAlgorithmCreateFunc {
 public:
  explicit HalfSpaceContactsFactory(bool swapped);
  btCollisionAlgorithm* CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                 const btCollisionObjectWrapper* first,
                                                 const btCollisionObjectWrapper* second) override;
};

/// Has the dispatcher use it for boxes and hulls against planes. The factories must outlive the dispatcher.
void use_half_space_contacts(btCollisionDispatcher& dispatcher, HalfSpaceContactsFactory& polyhedron_first,
                             HalfSpaceContactsFactory& plane_first);

}  // namespace topple::collision
