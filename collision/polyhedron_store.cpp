#include "polyhedron_store.h"

namespace topple::collision {

namespace {
/// Shapes kept; a world that has seen more starts anew.
constexpr std::size_t most_kept = 20000;
}  // namespace

void PolyhedronStore::give_features(btPolyhedralConvexShape& shape, const std::vector<double>& made_from) {
  if (const auto found = known_.find(made_from); found != known_.end()) {
    shape.setPolyhedralFeatures(found->second);
    return;
  }
  shape.initializePolyhedralFeatures();
  if (shape.getConvexPolyhedron() == nullptr) return;
  if (known_.size() >= most_kept) known_.clear();
  known_.emplace(made_from, *shape.getConvexPolyhedron());
}

}  // namespace topple::collision
