#pragma once
// The pieces of a collapse as a host sees them after each step: by handles that live as long as the piece, flat arrays
// of poses, and what was made, split, moved and gone.
#include <memory>
#include <span>
#include <vector>

#include "simulation/debris/debris.h"

namespace topple::structure {

class PieceViews {
 public:
  /// Both must outlive it.
  PieceViews(const Scene& scene, const Debris& debris) : scene_(scene), debris_(debris) {}

  /// A step begins: nothing has changed yet.
  void start_step() { changes_ = {}; }
  void record_split(collision::BodyId whole, collision::BodyId piece) {
    changes_.split.push_back({whole.value, piece.value});
  }
  /// The bodies as they are now. An array of poses that somebody holds stays as it is; another takes its place.
  void update();

  [[nodiscard]] std::span<const BodyView> all() const { return views_; }
  [[nodiscard]] const std::shared_ptr<std::vector<double>>& poses() const { return poses_; }
  [[nodiscard]] const PieceChanges& changes() const { return changes_; }

  template <class Archive>
  void save(Archive& archive) const {
    auto& [scene, debris, views, poses, changes] = *this;
    archive(changes);
  }
  /// After bodies and world: views and poses are of them.
  template <class Archive>
  void load(Archive& archive) {
    archive(changes_);
    view_bodies();
  }

 private:
  void view_bodies();
  void record_changes(std::span<const std::int64_t> before);

  const Scene& scene_;
  const Debris& debris_;
  std::vector<BodyView> views_;
  std::shared_ptr<std::vector<double>> poses_ = std::make_shared<std::vector<double>>();
  PieceChanges changes_;
};

}  // namespace topple::structure
