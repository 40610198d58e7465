#include "contacts/half_space_contacts.h"

#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletCollision/CollisionDispatch/btManifoldResult.h>
#include <BulletCollision/CollisionShapes/btStaticPlaneShape.h>

#include <initializer_list>
#include <new>

#include "contacts/polyhedron_pair.h"

namespace topple::collision {

namespace {

class HalfSpaceContacts final : public PolyhedronPair {
 public:
  HalfSpaceContacts(const btCollisionAlgorithmConstructionInfo& info, const btCollisionObjectWrapper* first,
                    const btCollisionObjectWrapper* second, bool swapped)
      : PolyhedronPair(info), swapped_(swapped) {
    const btCollisionObjectWrapper* solid = swapped ? second : first;
    const btCollisionObjectWrapper* ground = swapped ? first : second;
    // The solid first, whichever way round the pair is: the vertices of a body that slides stay the points that they
    // were.
    if (m_dispatcher->needsCollision(solid->getCollisionObject(), ground->getCollisionObject())) {
      manifold_ = m_dispatcher->getNewManifold(solid->getCollisionObject(), ground->getCollisionObject());
    }
  }

  void processCollision(const btCollisionObjectWrapper* first, const btCollisionObjectWrapper* second,
                        const btDispatcherInfo&, btManifoldResult* result) override {
    if (!manifold_) return;
    const btCollisionObjectWrapper* solid = swapped_ ? second : first;
    const btCollisionObjectWrapper* ground = swapped_ ? first : second;
    const auto* shape = static_cast<const btPolyhedralConvexShape*>(solid->getCollisionShape());
    const auto* plane = static_cast<const btStaticPlaneShape*>(ground->getCollisionShape());
    const btTransform& plane_pose = ground->getWorldTransform();
    const btVector3 normal = plane_pose.getBasis() * plane->getPlaneNormal();
    const btScalar offset = plane->getPlaneConstant() + normal.dot(plane_pose.getOrigin());
    const btScalar skin = skin_outside(*shape);
    result->setPersistentManifold(manifold_);
    result->refreshContactPoints();  // before, so that points of the last step that have gone do not crowd out those of
                                     // now
    for (int i = 0; i < shape->getNumVertices(); ++i) {
      btVector3 vertex;
      shape->getVertex(i, vertex);
      vertex = solid->getWorldTransform() * vertex - normal * skin;
      const btScalar height = normal.dot(vertex) - offset;
      if (height <= manifold_->getContactBreakingThreshold())
        result->addContactPoint(normal, vertex - normal * height, height);
    }
  }

 private:
  bool swapped_;
};

}  // namespace

HalfSpaceContactsFactory::HalfSpaceContactsFactory(bool swapped) { m_swapped = swapped; }

btCollisionAlgorithm* HalfSpaceContactsFactory::CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                                         const btCollisionObjectWrapper* first,
                                                                         const btCollisionObjectWrapper* second) {
  // Bullet frees the algorithm into the pool that this comes from.
  void* memory = info.m_dispatcher1->allocateCollisionAlgorithm(sizeof(HalfSpaceContacts));
  return new (memory) HalfSpaceContacts(info, first, second, m_swapped);
}

void use_half_space_contacts(btCollisionDispatcher& dispatcher, HalfSpaceContactsFactory& polyhedron_first,
                             HalfSpaceContactsFactory& plane_first) {
  for (const int kind : {BOX_SHAPE_PROXYTYPE, CONVEX_HULL_SHAPE_PROXYTYPE}) {
    dispatcher.registerCollisionCreateFunc(kind, STATIC_PLANE_PROXYTYPE, &polyhedron_first);
    dispatcher.registerCollisionCreateFunc(STATIC_PLANE_PROXYTYPE, kind, &plane_first);
  }
}

}  // namespace topple::collision
