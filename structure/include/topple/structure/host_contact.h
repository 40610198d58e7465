#pragma once
// Bodies that a host owns (a car, a character): each step they come in as contacts, and what they felt goes back.
#include <Eigen/Core>

#include "topple/collision/world.h"
#include "topple/structure/building.h"

namespace topple::structure {

/// One contact of a body that the simulation does not move, where it comes to touch something. SI, global axes.
struct HostContact {
  std::int64_t key = 0;                  ///< chosen by the host, given back with the impulse
  MemberId member;                       ///< what is touched: a standing member ...
  PanelId panel;                         ///< ... or panel ...
  collision::BodyId body;                ///< ... or debris
  Vec3 point = Vec3::Zero();             ///< where they touch, m
  Vec3 normal = Vec3::UnitX();           ///< unit, into what is touched
  double mass = 0;                       ///< above zero
  Mat3 inertia = Mat3::Zero();           ///< about its centre, positive definite
  Vec3 centre = Vec3::Zero();            ///< of mass
  Vec3 velocity = Vec3::Zero();          ///< of the centre of mass, m/s
  Vec3 angular_velocity = Vec3::Zero();  ///< rad/s, global axes
};

/// What a host's body felt at a contact in the last step.
struct HostImpulse {
  std::int64_t key = 0;         ///< that the host gave
  Vec3 impulse = Vec3::Zero();  ///< on the host's body, at the contact's point, N s
  double speed_in = 0;          ///< closing before, m/s
  double speed_out = 0;         ///< closing afterwards, m/s; negative when they part
  bool through = false;         ///< what stood in its way stands no more
};

}  // namespace topple::structure
