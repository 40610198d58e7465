#pragma once
// One contact between a body and a standing part, at its instant.
#include <vector>

#include "simulation/debris/body.h"
#include "simulation/impact/impact_settings.h"
#include "topple/structure/standing_frame.h"

namespace topple::structure {

[[nodiscard]] inline bool strikes(const collision::Contact& contact) {
  return contact.approach_speed >= impact_settings.least_speed;
}

struct Strike {
  Body* body = nullptr;
  ContactPlace place;
  Part part;
  Vec3 normal;                 ///< into the structure
  collision::BodyState state;  ///< where the body is at that instant, true velocities
  double swept_at = 0;         ///< time of impact as swept, s
  double own_time = 0;         ///< the same since the body's state was last set
  double mass = 0;             ///< effective, along the normal, kg
  double speed = 0, speed_out = 0;
  double peak_force = 0;
  double structure_mass = 0, lost = 0;
  bool through = false;  ///< what was hit is gone
  std::vector<JointBreak> breaks;
  std::vector<collision::BodyId> chunks;  ///< that it broke out of a standing panel
  double chunk_speed = 0;                 ///< with which they left it along the normal, in the mean of their mass
};

/// N s at a global point, on the body.
struct PointImpulse {
  Vec3 impulse, point;
};

}  // namespace topple::structure
