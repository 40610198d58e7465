#pragma once
// Explosions in the air: what their blast wave gives to the parts that it reaches.
#include <vector>

#include "topple/structure/host_contact.h"
#include "topple/structure/simulation.h"

namespace topple::viewer {

struct Explosion {
  structure::Vec3 centre = structure::Vec3::Zero();
  double charge = 20;  ///< kg of TNT
};

/// Impulse per area of a wave that meets a wall head-on, Pa s: `distance` in m, `charge` in kg of TNT, a sphere in free
/// air (Kingery and Bulmash, ARBRL-TR-02555, 1984). The fit holds from 0.0531 to 40 m/kg^(1/3); nearer and farther the
/// value at that end is given.
[[nodiscard]] double reflected_impulse(double distance, double charge);

/// What the wave does, as contacts of bodies that strike: for each half metre of the faces and members that a straight
/// line from the centre meets, the nearest first. The wave passes in milliseconds, before anything has moved, so that
/// it gives its impulse: a body as heavy as what it strikes, with twice the speed that the impulse would give to that,
/// leaves both with this speed. The impulse goes with the cosine of the angle at which the wave meets the face; waves
/// that go round corners, and gases that stay in rooms, are left out. So is what the wave would move more slowly than
/// `least_blast_speed`.
[[nodiscard]] std::vector<structure::HostContact> blast_contacts(const structure::Simulation& simulation,
                                                                 const Explosion& explosion);
inline constexpr double least_blast_speed = 1.0;  ///< m/s

}  // namespace topple::viewer
