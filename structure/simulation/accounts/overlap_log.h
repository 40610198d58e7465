#pragma once
// Bodies that stay inside each other. Their names are recorded when that is seen, as bodies may split or leave later.
#include "simulation/debris/debris.h"
#include "topple/collision/overlap_watch.h"

namespace topple::structure {

class OverlapLog {
 public:
  /// Both must outlive it.
  OverlapLog(const Scene& scene, const Debris& debris) : scene_(scene), debris_(debris) {}

  /// After each step of the collision world.
  void read();
  [[nodiscard]] const BodyOverlaps& told() const { return told_; }

  template <class Archive>
  void serialize(Archive& archive) {
    auto& [scene, debris, watch, told] = *this;
    archive(watch, told);
  }

 private:
  const Scene& scene_;
  const Debris& debris_;
  collision::OverlapWatch watch_;
  BodyOverlaps told_;
};

}  // namespace topple::structure
