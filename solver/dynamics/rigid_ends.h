#pragma once
// Between the equations of a frame that moves and the rigid ends of one beam: motion, forces, momentum.
#include "assembly/frame_system.h"
#include "topple/solver/modes.h"

namespace topple::solver {

/// Of the beam's rigid ends, local, in a motion of the scaled equations.
[[nodiscard]] Vec12 rigid_end_motion(const FrameSystem& system, int beam, const Eigen::VectorXd& scaled);
/// Of the beam's own ends, local, which follow its rigid ends as `follows` has it (ends_by_rigid_ends()).
[[nodiscard]] Vec12 own_end_motion(const FrameSystem& system, int beam, const Mat12& follows,
                                   const Eigen::VectorXd& scaled);
/// The beam is there, and a joint holds it.
[[nodiscard]] bool is_held(const FrameSystem& system, int beam);
/// Adds local forces on the rigid ends to those on the numbered freedoms, not scaled; what is on a node that has left
/// is left out.
void add_on_rigid_ends(const FrameSystem& system, int beam, const Vec12& local, Eigen::VectorXd& force);
/// Of a point in the rigid motion number `component`: translations along the axes, rotations about them through the
/// origin.
[[nodiscard]] Vec6 rigid_motion_at(const Vec3& point, int component);
/// Force and moment about the origin, global, of forces on the beam's rigid ends, local; or of momenta there.
[[nodiscard]] Vec6 about_origin(const FrameSystem& system, int beam, const Vec12& local);
/// Mass between the beam's own ends, local.
[[nodiscard]] Mat12 mass_of_beam(const FrameSystem& system, const MassModel& masses, int beam);
/// Linear and angular momentum about the origin of a beam whose nodes move with these velocities (scaled equations),
/// and whose ends follow them as `follows` has it (local).
[[nodiscard]] Vec6 momentum_of_beam(const FrameSystem& system, const MassModel& masses, int beam, const Mat12& follows,
                                    const Eigen::VectorXd& velocities);

}  // namespace topple::solver
