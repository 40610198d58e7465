#include "dynamics/rigid_ends.h"

#include <Eigen/Geometry>

#include "assembly/element_masses.h"
#include "elements/beam.h"
#include "elements/beam_mass.h"

namespace topple::solver {
namespace {

const Beam& beam_of(const FrameSystem& system, int beam) { return system.model.beams[static_cast<std::size_t>(beam)]; }

}  // namespace

Vec12 rigid_end_motion(const FrameSystem& system, int beam, const Eigen::VectorXd& scaled) {
  const Beam& own = beam_of(system, beam);
  return rigid_end_displacements(own, system.node_displacement_of_scaled(own.node[0], scaled),
                                 system.node_displacement_of_scaled(own.node[1], scaled));
}

Vec12 own_end_motion(const FrameSystem& system, int beam, const Mat12& follows, const Eigen::VectorXd& scaled) {
  return follows * rigid_end_motion(system, beam, scaled);
}

bool is_held(const FrameSystem& system, int beam) {
  const auto& ends = beam_of(system, beam).end_stiffness;
  return system.beam_stands[static_cast<std::size_t>(beam)] != 0 && !(ends[0].isZero(0) && ends[1].isZero(0));
}

void add_on_rigid_ends(const FrameSystem& system, int beam, const Vec12& local, Eigen::VectorXd& force) {
  const Beam& own = beam_of(system, beam);
  const Vec12 global = node_forces(own, local);
  for (std::size_t end = 0; end < 2; ++end)
    if (system.node_stands[static_cast<std::size_t>(own.node[end])] != 0)
      system.dofs().add_node_force(own.node[end], global.segment<6>(static_cast<Eigen::Index>(6 * end)), force.data());
}

Vec6 rigid_motion_at(const Vec3& point, int component) {
  Vec6 motion = Vec6::Zero();
  motion(component) = 1;
  if (component >= 3) motion.head<3>() = Vec3::Unit(component - 3).cross(point);
  return motion;
}

Vec6 about_origin(const FrameSystem& system, int beam, const Vec12& local) {
  const Beam& own = beam_of(system, beam);
  Vec6 sum;
  for (int c = 0; c < 6; ++c) {
    const auto at = [&](std::size_t end) {
      return rigid_motion_at(system.model.nodes[static_cast<std::size_t>(own.node[end])], c);
    };
    sum(c) = rigid_end_displacements(own, at(0), at(1)).dot(local);
  }
  return sum;
}

Mat12 mass_of_beam(const FrameSystem& system, const MassModel& masses, int beam) {
  const Beam& own = beam_of(system, beam);
  return mass_between_ends(own, masses, mass_length(masses, own, beam));
}

Vec6 momentum_of_beam(const FrameSystem& system, const MassModel& masses, int beam, const Mat12& follows,
                      const Eigen::VectorXd& velocities) {
  return about_origin(system, beam,
                      mass_of_beam(system, masses, beam) * own_end_motion(system, beam, follows, velocities));
}

}  // namespace topple::solver
