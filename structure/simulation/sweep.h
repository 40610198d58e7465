#pragma once
// The sweep stage: shapes are made for what awake bodies may reach in this step, then the collision world sweeps.
#include <vector>

#include "simulation/debris/break_up.h"
#include "simulation/debris/debris.h"

namespace topple::structure {

class Sweep {
 public:
  /// All must outlive it.
  Sweep(Scene& scene, Debris& debris, const BreakUp& break_up) : scene_(scene), debris_(debris), break_up_(break_up) {}

  /// What awake bodies will touch within `dt`, s: a step, or a part of the one that runs. `structure` where what stands
  /// moves, else nullptr.
  [[nodiscard]] std::vector<collision::Contact> contacts(double dt, const collision::MovingStructure* structure);

  /// It has nothing of its own.
  template <class Archive>
  void serialize(Archive&) {
    [[maybe_unused]] auto& [scene, debris, break_up] = *this;
  }

 private:
  /// Of a body in this step: its way, and how far its turn takes a point that is as far from its centre as is asked.
  struct Way {
    Vec3 travel;
    double turned_by;
  };
  [[nodiscard]] Way way_of(const collision::BodyState& state, double radius) const;
  [[nodiscard]] Bounds swept_bounds(const Body& body, const collision::BodyState& state) const;
  [[nodiscard]] bool stays(const BodyMotion& one, const collision::BodyState& state) const;
  void approach(BodyMotion& one, const collision::BodyState& state);

  Scene& scene_;
  Debris& debris_;
  const BreakUp& break_up_;
};

}  // namespace topple::structure
