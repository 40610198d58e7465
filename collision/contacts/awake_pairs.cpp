#include "contacts/awake_pairs.h"

#include <BulletCollision/BroadphaseCollision/btOverlappingPairCache.h>
#include <BulletCollision/CollisionDispatch/btCollisionObject.h>

#include <algorithm>

namespace topple::collision {

namespace {

bool is_awake(const btBroadphaseProxy& proxy) {
  return static_cast<const btCollisionObject*>(proxy.m_clientObject)->isActive();
}

}  // namespace

void AwakePairsDispatcher::dispatchAllCollisionPairs(btOverlappingPairCache* cache, const btDispatcherInfo& info,
                                                     btDispatcher*) {
  awake_.clear();
  btBroadphasePair* const pairs = cache->getOverlappingPairArrayPtr();
  for (int i = 0; i < cache->getNumOverlappingPairs(); ++i) {
    const btBroadphaseProxy &first = *pairs[i].m_pProxy0, &second = *pairs[i].m_pProxy1;
    if (!is_awake(first) && !is_awake(second)) continue;
    const auto high = static_cast<std::uint64_t>(first.m_uniqueId), low = static_cast<std::uint64_t>(second.m_uniqueId);
    awake_.push_back({high << 32 | low, i});
  }
  std::sort(awake_.begin(), awake_.end(), [](const Pair& a, const Pair& b) { return a.ids > b.ids; });
  for (const Pair& pair : awake_) getNearCallback()(pairs[pair.at], *this, info);
}

}  // namespace topple::collision
