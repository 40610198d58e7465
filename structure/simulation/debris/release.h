#pragma once
// The release stage: parts that the frame no longer holds become rigid bodies with their mass, centre and inertia.
#include <optional>

#include "simulation/debris/part_motion.h"
#include "simulation/debris/release_impulses.h"
#include "simulation/fracture/debris_fracture.h"
#include "simulation/fracture/standing_fracture.h"

namespace topple::structure {

/// What it looks at and changes must outlive it.
struct Release {
  /// What has left the frame since the last time.
  void release();
  /// Above the limit of bodies, sleeping ones are dropped, the smallest first and of equals the oldest. Their weight
  /// stays where it lies.
  void keep_limit();

  Scene& scene;
  EventLog& log;
  RunningSums& sums;
  Debris& debris;
  Hinges& hinges;
  const BreakablePanels& panels;
  BreakUp& break_up;
  ReleaseImpulses& release_impulses;
  StandingFracture& standing_fracture;
  DebrisFracture& debris_fracture;

 private:
  void release(const Detached& part);
  [[nodiscard]] PartMotion displacement_of(const Detached& part) const;
  // cut_in_two.cpp: the pieces of a post that buckled inside.
  void release_in_two(const Detached& part);
  [[nodiscard]] Body piece_of(MemberId member, int end, double cut) const;
  void check_momentum(const Body& body, const std::optional<Detached::Motion>& motion);
  void remove_body(collision::BodyId id, bool keep_weight);
};

/// It has nothing of its own.
template <class Archive>
void serialize(Archive&, Release& of) {
  [[maybe_unused]] auto& [scene, log, sums, debris, hinges, panels, break_up, release_impulses, standing_fracture,
                          debris_fracture] = of;
}

}  // namespace topple::structure
