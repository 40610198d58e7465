#pragma once
// Bodies that stay inside each other. An engine that works with impulses lets things overlap for a moment wherever they
// meet, and pushes them apart again; where a heavy body lies on a light one, and in a jammed heap, it never gets there:
// the light one is pressed into what it lies on, and in the end squeezed out. What lasts is seen, and is told.
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "topple/collision/world_archive.h"

namespace topple::collision {

/// Two parts that were inside each other all through a time of OverlapWatch::lasting.
struct Overlap {
  BodyId body;                 ///< one of the two
  std::int64_t part_tag = -1;  ///< ConvexPart::tag of its part
  Touched other;               ///< what it is inside of
  double depth = 0;            ///< least over that time, m
  double thickness = 0;        ///< of the thinner of the two parts, m
  /// More than this share of the thickness is deep.
  [[nodiscard]] bool deep() const;
};
/// Its members for an archive, as those of world_archive.h.
template <class Archive>
void serialize(Archive& archive, Overlap& of) {
  auto& [body, part_tag, other, depth, thickness] = of;
  archive(body, part_tag, other, depth, thickness);
}

/// Watches the contacts of a world, step by step, for overlaps that last.
class OverlapWatch {
 public:
  /// An overlap counts when it lasts so long, s: what comes together at speed has been pushed apart by then (Bullet
  /// takes a fifth of an overlap away in each step).
  static constexpr double lasting = 0.25;
  /// Overlaps up to this are not looked at, m: hulls have a skin of 2 mm against the ground, and what rests is left a
  /// little inside what it rests on.
  static constexpr double tolerance = 0.003;
  /// Share of the thickness of the thinner part from which an overlap is deep: the engine is losing. A box with 50
  /// times its mass on it, which is squeezed out in the end, is in by 2.7 %; one with 30 times, which holds, by 0.5 %.
  static constexpr double deep_share = 0.02;

  /// Call after each World::step(dt), with its contacts. Those of sleeping bodies are not among them; what they are
  /// inside of they were before they fell asleep.
  void read(std::span<const Contact> contacts, double dt);
  /// The deepest in m, if there was any above the tolerance.
  [[nodiscard]] const std::optional<Overlap>& deepest() const { return deepest_; }
  /// How often a pair of parts came to lie deep inside each other.
  [[nodiscard]] std::uint64_t deep_count() const { return deep_count_; }

  /// All that it has read, for an archive.
  template <class Archive>
  void serialize(Archive& archive) {
    auto& [watched, next, time, deepest, deep_count] = *this;
    archive(watched, time, deepest, deep_count);  // `next` is room
  }

 private:
  struct Watched {
    Overlap least;
    double since = 0;
    bool counted = false;
    template <class Archive>
    void serialize(Archive& archive) {
      auto& [overlap, from, told] = *this;
      archive(overlap, from, told);
    }
  };
  void finish(Watched& pair);

  std::vector<Watched> watched_, next_;  ///< in the order of contacts
  double time_ = 0;
  std::optional<Overlap> deepest_;
  std::uint64_t deep_count_ = 0;
};

}  // namespace topple::collision
