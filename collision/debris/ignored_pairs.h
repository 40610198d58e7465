#pragma once
// Pairs whose contacts are not reported until they have come apart (World::ignore_until_separated).
#include <map>

#include "contacts/contact_forces.h"
#include "debris/debris_scene.h"

namespace topple::collision {

/// Which pairs are ignored, and since when.
class IgnoredPairs {
 public:
  explicit IgnoredPairs(const DebrisScene& scene) : scene_(scene) {}
  /// The same pairs, of another scene that holds the same.
  IgnoredPairs(const IgnoredPairs& of, const DebrisScene& scene)
      : scene_(scene), ignored_(of.ignored_), released_(of.released_) {}
  IgnoredPairs(const IgnoredPairs&) = delete;
  IgnoredPairs& operator=(const IgnoredPairs&) = delete;

  /// Throws invalid_argument for the ground and for a body and itself, out_of_range for what is not in the world.
  void add(BodyId body, const Touched& other);
  [[nodiscard]] bool any() const { return !ignored_.empty(); }
  [[nodiscard]] bool ignores(const Solid& first, const Solid& second) const;
  /// What has gone.
  void forget(Touched::Kind kind, std::int64_t id);
  /// As a step begins, `dt` long.
  void begin_step(double dt);
  /// Those that have come apart are pairs like any other.
  void release(double dt, bool about_to_step);

  template <class Archive>
  void serialize(Archive& archive) {
    auto& [scene, ignored, released] = *this;
    archive(ignored, released);
  }

 private:
  [[nodiscard]] const Solid& solid(const SolidPair& pair) const;
  void ignore(const SolidPair& pair, bool ignored);

  const DebrisScene& scene_;
  std::map<SolidPair, bool> ignored_;            ///< true: told again since the last step, and for the next in any case
  std::map<SolidPair, std::uint64_t> released_;  ///< after which step
};

}  // namespace topple::collision
