#include "contacts/polyhedron_contacts.h"

#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletCollision/CollisionDispatch/btManifoldResult.h>
#include <BulletCollision/CollisionShapes/btConvexPolyhedron.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkPairDetector.h>
#include <BulletCollision/NarrowPhaseCollision/btPolyhedralContactClipping.h>
#include <BulletCollision/NarrowPhaseCollision/btVoronoiSimplexSolver.h>

#include <new>

#include "contacts/polyhedron_pair.h"

namespace topple::collision {

namespace {

/// m: contacts are sought anew when a point of one body may have moved farther than this against the other. Until then
/// they go along with both, with errors of the second order; a quarter of what overlaps are left unpushed by.
constexpr btScalar kMoved = 0.0005;

const btPolyhedralConvexShape& polyhedron(const btCollisionObjectWrapper* wrapper) {
  return *static_cast<const btPolyhedralConvexShape*>(wrapper->getCollisionShape());
}

/// Hands the nearest points on, measured between the vertices of hulls: they touch without their skins.
struct BetweenVertices : btDiscreteCollisionDetectorInterface::Result {
  BetweenVertices(btManifoldResult& all, btScalar first, btScalar second)
      : result(all), skins(first + second), others(second) {}
  void setShapeIdentifiersA(int, int) override {}
  void setShapeIdentifiersB(int, int) override {}
  void addContactPoint(const btVector3& normal_on_second, const btVector3& point, btScalar depth) override {
    normal = normal_on_second;
    distance = depth + skins;
    found = true;
    result.addContactPoint(normal, point - normal * others, distance);
  }
  btManifoldResult& result;
  btScalar skins, others, distance = BT_LARGE_FLOAT;
  btVector3 normal{0, 0, 0};
  bool found = false;
};

class PolyhedronContacts final : public PolyhedronPair {
 public:
  PolyhedronContacts(const btCollisionAlgorithmConstructionInfo& info, const btCollisionObjectWrapper* second,
                     btConvexPenetrationDepthSolver& depths)
      : PolyhedronPair(info), depths_(depths) {
    btVector3 centre;
    polyhedron(second).getBoundingSphere(centre, reach_);
    reach_ += centre.length();
  }

  void processCollision(const btCollisionObjectWrapper* first, const btCollisionObjectWrapper* second,
                        const btDispatcherInfo& info, btManifoldResult* result) override {
    const btTransform now = first->getWorldTransform().inverseTimes(second->getWorldTransform());
    if (apart_) {
      const btScalar far = far_enough(first, second);
      if (distance_moved(now) < gap_ - far) return;
      measured_at_ = now;
      gap_ = gap(polyhedron(first), polyhedron(second), now);
      if (gap_ > far) return;
      apart_ = false;
    }
    if (manifold_ && manifold_->getNumContacts() > 0 && distance_moved(now) <= kMoved) {
      result->setPersistentManifold(manifold_);
      result->refreshContactPoints();
      return;
    }
    measured_at_ = now;
    seek(first, second, info, *result);
  }

 private:
  /// No point of the second has moved farther in the first's frame since contacts or the gap were sought.
  [[nodiscard]] btScalar distance_moved(const btTransform& now) const {
    btScalar turned = 0;  // Frobenius norm: sqrt(2) times the largest change of a unit vector
    for (int row = 0; row < 3; ++row) turned += (now.getBasis()[row] - measured_at_.getBasis()[row]).length2();
    return (now.getOrigin() - measured_at_.getOrigin()).length() + reach_ * btSqrt(turned / 2);
  }

  [[nodiscard]] static btScalar far_enough(const btCollisionObjectWrapper* first,
                                           const btCollisionObjectWrapper* second) {
    return polyhedron(first).getMargin() + polyhedron(second).getMargin() + gContactBreakingThreshold;
  }

  /// Along the axis, between the two without their margins.
  [[nodiscard]] btScalar gap(const btPolyhedralConvexShape& first, const btPolyhedralConvexShape& second,
                             const btTransform& now) const {
    const btVector3 in_second = axis_ * now.getBasis();
    const btVector3 a = first.localGetSupportingVertexWithoutMargin(axis_);
    const btVector3 b = now * second.localGetSupportingVertexWithoutMargin(-in_second);
    return axis_.dot(b - a);
  }

  void seek(const btCollisionObjectWrapper* first, const btCollisionObjectWrapper* second, const btDispatcherInfo& info,
            btManifoldResult& result) {
    const btPolyhedralConvexShape &a = polyhedron(first), &b = polyhedron(second);
    if (!manifold_) manifold_ = m_dispatcher->getNewManifold(first->getCollisionObject(), second->getCollisionObject());
    result.setPersistentManifold(manifold_);
    btVoronoiSimplexSolver simplex;
    btGjkPairDetector detector(&a, &b, &simplex, &depths_);
    btGjkPairDetector::ClosestPointInput input;
    input.m_transformA = first->getWorldTransform();
    input.m_transformB = second->getWorldTransform();
    input.m_maximumDistanceSquared = far_enough(first, second) * far_enough(first, second);
    BetweenVertices nearest(result, skin_outside(a), skin_outside(b));
    detector.getClosestPoints(input, nearest, info.m_debugDraw);
    if (nearest.found && nearest.distance < 0) clip(a, b, input, nearest, result);
    result.refreshContactPoints();
    if (nearest.found || manifold_->getNumContacts() > 0) return;
    // The search ended with an axis that shows them apart.
    const btVector3 axis = detector.getCachedSeparatingAxis();
    if (!(axis.length2() > SIMD_EPSILON)) return;
    axis_ = -axis.normalized() * first->getWorldTransform().getBasis();
    gap_ = gap(a, b, measured_at_);
    apart_ = gap_ > far_enough(first, second);
    if (!apart_) return;
    m_dispatcher->releaseManifold(manifold_);
    manifold_ = nullptr;
    result.setPersistentManifold(nullptr);
  }

  static void clip(const btPolyhedralConvexShape& a, const btPolyhedralConvexShape& b,
                   const btGjkPairDetector::ClosestPointInput& input, const BetweenVertices& nearest,
                   btManifoldResult& result) {
    if (!a.getConvexPolyhedron() || !b.getConvexPolyhedron()) return;
    btVertexArray work_a, work_b;
    btPolyhedralContactClipping::clipHullAgainstHull(
        nearest.normal, *a.getConvexPolyhedron(), *b.getConvexPolyhedron(), input.m_transformA, input.m_transformB,
        nearest.distance - gContactBreakingThreshold, gContactBreakingThreshold, work_a, work_b, result);
  }

  btConvexPenetrationDepthSolver& depths_;
  btScalar reach_ = 0;                                    ///< of the second, from its origin
  btTransform measured_at_ = btTransform::getIdentity();  ///< the second in the first's frame
  bool apart_ = false;
  btVector3 axis_{0, 0, 0};  ///< unit, from the first to the second, in the first's frame: shows them apart
  btScalar gap_ = 0;         ///< along the axis, as they were
};

}  // namespace

btCollisionAlgorithm* PolyhedronContactsFactory::CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                                          const btCollisionObjectWrapper*,
                                                                          const btCollisionObjectWrapper* second) {
  // Bullet frees the algorithm into the pool that this comes from.
  void* memory = info.m_dispatcher1->allocateCollisionAlgorithm(sizeof(PolyhedronContacts));
  return new (memory) PolyhedronContacts(info, second, depths_);
}

int size_of_polyhedron_contacts() { return sizeof(PolyhedronContacts); }

void use_polyhedron_contacts(btCollisionDispatcher& dispatcher, PolyhedronContactsFactory& factory) {
  dispatcher.registerCollisionCreateFunc(CONVEX_HULL_SHAPE_PROXYTYPE, CONVEX_HULL_SHAPE_PROXYTYPE, &factory);
  dispatcher.registerCollisionCreateFunc(CONVEX_HULL_SHAPE_PROXYTYPE, BOX_SHAPE_PROXYTYPE, &factory);
  dispatcher.registerCollisionCreateFunc(BOX_SHAPE_PROXYTYPE, CONVEX_HULL_SHAPE_PROXYTYPE, &factory);
}

}  // namespace topple::collision
