#pragma once
// What the contact algorithms of this folder share: one manifold for the pair, no time of impact, and where the skin of
// a polyhedron lies.
#include <BulletCollision/CollisionDispatch/btActivatingCollisionAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>
#include <BulletCollision/CollisionShapes/btPolyhedralConvexShape.h>

namespace topple::collision {

class PolyhedronPair : public btActivatingCollisionAlgorithm {
 public:
  explicit PolyhedronPair(const btCollisionAlgorithmConstructionInfo& info) : btActivatingCollisionAlgorithm(info) {}
  ~PolyhedronPair() override {
    if (manifold_) m_dispatcher->releaseManifold(manifold_);
  }
  PolyhedronPair(const PolyhedronPair&) = delete;
  PolyhedronPair& operator=(const PolyhedronPair&) = delete;

  btScalar calculateTimeOfImpact(btCollisionObject*, btCollisionObject*, const btDispatcherInfo&,
                                 btManifoldResult*) override {
    return 1;
  }
  void getAllContactManifolds(btManifoldArray& manifolds) override {
    if (manifold_) manifolds.push_back(manifold_);
  }

 protected:
  /// A box holds its skin inside its vertices, a hull outside.
  [[nodiscard]] static btScalar skin_outside(const btPolyhedralConvexShape& shape) {
    return shape.getShapeType() == BOX_SHAPE_PROXYTYPE ? 0 : shape.getMargin();
  }

  btPersistentManifold* manifold_ = nullptr;
};

}  // namespace topple::collision
