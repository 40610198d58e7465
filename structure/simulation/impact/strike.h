#pragma once
// One contact between a body and a standing part, at its instant.
#include "simulation/simulation_state.h"

namespace topple::structure {

struct Simulation::State::Strike {
  Body* body = nullptr;
  ContactPlace place;
  Part part;
  Vec3 normal;                 ///< into the structure
  collision::BodyState state;  ///< where the body is at that instant, true velocities
  double swept_at = 0;         ///< time of impact as swept
  double own_time = 0;         ///< the same since the body's state was last set
  double mass = 0;             ///< effective, along the normal
  double speed = 0, speed_out = 0;
  double peak_force = 0;
  double structure_mass = 0, lost = 0;
  bool through = false;  ///< what was hit is gone
  std::vector<JointBreak> breaks;
  std::vector<collision::BodyId> chunks;  ///< that it broke out of a standing panel
};

/// N s at a global point, on the body.
struct Simulation::State::PointImpulse {
  Vec3 impulse, point;
};

}  // namespace topple::structure
