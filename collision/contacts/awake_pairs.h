#pragma once
// Pairs whose bounds meet, gone through in an order that does not depend on how they came to meet. Bullet's own way of
// that orders all pairs of the world in each step; most are asleep in a large heap.
#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>

#include <cstdint>
#include <vector>

namespace topple::collision {

class AwakePairsDispatcher final : public btCollisionDispatcher {
 public:
  using btCollisionDispatcher::btCollisionDispatcher;
  /// Only those of which one at least is awake.
  void dispatchAllCollisionPairs(btOverlappingPairCache* cache, const btDispatcherInfo& info,
                                 btDispatcher* dispatcher) override;

 private:
  struct Pair {
    std::uint64_t ids;  ///< unique in the broadphase, of both
    int at;             ///< place in the cache
  };
  std::vector<Pair> awake_;
};

}  // namespace topple::collision
