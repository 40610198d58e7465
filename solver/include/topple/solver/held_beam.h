#pragma once
// A beam whose nodes are held, under loads of its own.
#include <array>
#include <span>

#include "topple/solver/frame_model.h"

namespace topple::solver {

/// What a beam with held nodes does under its own loads.
struct HeldBeam {
  Vec12 end_forces = Vec12::Zero();                          ///< local, as StaticSolution has them
  std::array<Vec6, 2> on_nodes{Vec6::Zero(), Vec6::Zero()};  ///< what it hands to its nodes, global
};
[[nodiscard]] HeldBeam hold_beam(const Beam& beam, std::span<const BeamLoad> loads);
/// J, strain of the beam and its end springs. Over any motion of its nodes its strain energy is this and that of the
/// motion alone: the two do no work on each other.
[[nodiscard]] double held_strain_energy(const Beam& beam, std::span<const BeamLoad> loads);
/// How far the point of its axis at `distance` (m) from the first end has moved, global. Exact (Timoshenko beam, end
/// springs and releases included).
[[nodiscard]] Vec3 held_displacement(const Beam& beam, double distance, std::span<const BeamLoad> loads);

}  // namespace topple::solver
