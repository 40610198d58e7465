#pragma once
// Collision detection of a step: bounds of awake bodies, near pairs, and their contacts.
#include <cstdint>
#include <vector>

#include "debris/ignored_pairs.h"
#include "solver/parallel_region.h"

namespace topple::collision {

/// Seeks them for the scene, pair by pair, where the two may have come together or apart.
class PairSearch {
 public:
  /// Shares its loops in `region`, when that is open.
  PairSearch(DebrisScene& scene, const IgnoredPairs& ignored, ParallelRegion& region)
      : scene_(scene), ignored_(ignored), region_(region) {}

  /// Where what is awake may be within `dt`.
  void update_bounds(double dt);
  /// Which pairs are near, by their bounds.
  void find_near();
  void note_ways(double dt);
  /// Contacts of all pairs that may have come together or apart since they were last looked at. Those of two that will
  /// not touch within `dt`, as they move, lie so far apart that they do not push.
  void seek_contacts(double dt);
  /// DebrisScene::touching.
  void find_touching();

 private:
  [[nodiscard]] double margin_of(const Collider& a, const Collider& b) const;
  [[nodiscard]] bool is_due(const PairEnds& ends) const;
  void seek(std::uint32_t index);
  template <class Choice>
  void choose(const Choice& is_chosen, std::vector<std::uint32_t>& chosen);

  DebrisScene& scene_;
  const IgnoredPairs& ignored_;
  ParallelRegion& region_;
  std::vector<std::uint32_t> due_;  ///< pairs to be looked at, in order
  std::vector<std::uint32_t> far_;  ///< pairs that are no longer near, in order
  std::vector<char> chosen_;        ///< of the pairs that a loop goes through: those that it has picked out
};

}  // namespace topple::collision
