#pragma once
// The moving bodies, in order of id. What each step reads of all of them lies in one array. Bodies for which impacts
// are sought are listed on their own: they are few, as most bodies are chunks.
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "simulation/debris/body.h"

namespace topple::structure {

/// How a body moves in this step.
struct BodyMotion {
  std::int64_t id = -1;
  Body* body = nullptr;
  double mass = 0;
  bool asleep = false;             ///< as accounted last
  Vec3 step_start = Vec3::Zero();  ///< where its centre was when the step began
  collision::BodyState before;     ///< at the start of this step's motion, after its impacts
  double reach = 0;                ///< no point of its bounds is farther from its centre, m
  Bounds looked_over;              ///< a place that it is in
  /// When its surroundings were seen to last: how far its swept bounds can come to lie from where they were before they
  /// leave that place or meet anything of Body::near, and what they were made of.
  struct Seen {
    double room = 0;  ///< m
    Vec3 position = Vec3::Zero(), travel = Vec3::Zero();
    Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
    double turned_by = 0;  ///< m
    double reach = 0;      ///< m, Obstacles::reach()
  } seen;
};
template <class Archive>
void serialize(Archive& archive, BodyMotion::Seen& seen) {
  auto& [room, position, travel, orientation, turned_by, reach] = seen;
  archive(room, position, travel, orientation, turned_by, reach);
}
/// The body is found by its id; `step_start` and `before` are of the step that runs.
template <class Archive>
void serialize(Archive& archive, BodyMotion& motion) {
  auto& [id, body, mass, asleep, step_start, before, reach, looked_over, seen] = motion;
  archive(id, mass, asleep, reach, looked_over, seen);
}

class Bodies {
 public:
  using Map = std::map<std::int64_t, Body>;
  using iterator = Map::iterator;
  using const_iterator = Map::const_iterator;

  Body& add(std::int64_t id, Body one);
  void erase(std::int64_t id);

  [[nodiscard]] iterator begin() { return all_.begin(); }
  [[nodiscard]] iterator end() { return all_.end(); }
  [[nodiscard]] const_iterator begin() const { return all_.begin(); }
  [[nodiscard]] const_iterator end() const { return all_.end(); }
  [[nodiscard]] const_iterator find(std::int64_t id) const { return all_.find(id); }
  [[nodiscard]] iterator find(std::int64_t id) { return all_.find(id); }
  [[nodiscard]] bool contains(std::int64_t id) const { return all_.contains(id); }
  [[nodiscard]] std::size_t size() const { return all_.size(); }
  /// Its id, which no body had before; -1 while there is none.
  [[nodiscard]] std::int64_t newest() const { return all_.empty() ? -1 : all_.rbegin()->first; }
  /// Throws std::out_of_range for one that is not there.
  [[nodiscard]] Body& at(std::int64_t id) { return all_.at(id); }
  [[nodiscard]] const Body& at(std::int64_t id) const { return all_.at(id); }

  [[nodiscard]] std::span<BodyMotion> motions() { return motions_; }
  [[nodiscard]] std::span<const BodyMotion> motions() const { return motions_; }
  [[nodiscard]] BodyMotion& motion(std::int64_t id);
  [[nodiscard]] const BodyMotion& motion(std::int64_t id) const { return const_cast<Bodies*>(this)->motion(id); }

  /// Ids of those that are one panel and no member, and of those with members that hold more than one part together.
  [[nodiscard]] std::span<const std::int64_t> single_panels() const { return single_panels_; }
  [[nodiscard]] std::span<const std::int64_t> composed() const { return composed_; }

  template <class Archive>
  void serialize(Archive& archive) {
    auto& [all, motions, single_panels, composed] = *this;
    archive(all, motions, single_panels, composed);
    if constexpr (Archive::is_loading::value)
      for (BodyMotion& one : motions) one.body = &all.at(one.id);
  }

 private:
  Map all_;  ///< where a body is it stays
  std::vector<BodyMotion> motions_;
  std::vector<std::int64_t> single_panels_, composed_;
};

}  // namespace topple::structure
