#pragma once
// The numbers that decide how what stands moves.

namespace topple::structure {

struct MotionSettings {
  /// s. Substeps of a step are as few as are no longer than this. At eight of a sixtieth of a second all joints of the
  /// seed building peak within 1 % of all its modes after a loss, at four 0.3 % of them do not (docs/dynamics.md).
  /// Longer: peaks are missed; shorter: dearer.
  double longest_substep = 1.0 / 480;
  /// Of each joint's capacity: a substep that is off by more (solver::DynamicOptions::largest_error), or in which
  /// something breaks, is taken in parts. Ten such in a row are off by 2 %. Larger: what is hit flies off otherwise (at
  /// ten times this, a post of the house by 2 % faster with substeps of 1/480 and 1/960 s than with shorter ones);
  /// smaller: dearer.
  double substep_error = 0.002;
  /// Of a substep, at most. Of the house, a post hit with 60 m/s, the joints that break in the next tenth of a second
  /// and their order are those of 64 and of 512 undivided substeps of 1/60 s; of 8, 16 and 32 undivided ones others
  /// break. Fewer: what follows an impact hangs on the substep; more: dearer.
  int substep_parts = 8;
  /// s. An impulse acts over a substep, and over no less than this: what it throws is damped by stiffness for so long.
  /// A hit on a member lasts for some milliseconds. As long as a substep alone, a shot's own speed after it would hang
  /// on the substep (4.3 m/s at 1/480 s, 4.8 at 1/1920 of what hits the house with 60 m/s). Longer: what is hit is
  /// heavier.
  double shortest_impulse = 1.0 / 480;
  /// What a substep leaves of motion that it cannot resolve: the shock of a break or an impact dies away in some
  /// substeps. What resolved motion loses is accounted on its own.
  double spectral_radius = 0.8;
  /// Shares of critical damping. Steel below its yield stress, and concrete that cracks (N. M. Newmark, W. J. Hall,
  /// Earthquake Spectra and Design, 1982: 2 to 3 % and 3 to 5 % at half of yield). Members of several materials count
  /// by the energy that they store under the loads. Less: higher peaks, and longer until rest.
  double metal_damping = 0.02, other_damping = 0.05;
  /// Of the mass that is free to move, or of its moment of inertia: a mode with more, along or about any axis, is one
  /// of the building. Damping holds at the lowest of these: what hangs loosely swings slower, and took the damping of
  /// all else away (a damaged house swayed at 0.35 % for a minute). Larger: the modes of large parts count as theirs
  /// alone.
  double mode_of_whole = 0.05;
  /// Modes, the lowest first, among which one of the building is sought; where none is, the last of them counts. Parts
  /// that hang loosely are few. Fewer: more of these take damping away; more: dearer.
  int modes_sought = 8;
  /// Pa: at least this stiff is a metal (aluminium has 70 GPa, the stiffest concrete 50).
  double metal_modulus = 60e9;
  /// Of each joint's capacity: what counts as rest. Smaller: it moves on for longer, with the same breaks.
  double rest_utilisation = 0.01;
  /// m: the same for displacements, where no joint has a capacity.
  double rest_displacement = 1e-3;
  /// s between looks for rest: each is a static answer.
  double rest_looks = 0.25;
  /// rad. A chord that has turned by this has left small displacements: what can move without strain leaves the frame.
  double largest_turn = 0.1;
  /// rad. From here on nothing is damped by mass while it turns further: that would brake what falls.
  double falling_turn = 0.02;
};

template <class Archive>
void serialize(Archive& archive, MotionSettings& settings) {
  auto& [longest_substep, substep_error, substep_parts, shortest_impulse, spectral_radius, metal_damping, other_damping,
         mode_of_whole, modes_sought, metal_modulus, rest_utilisation, rest_displacement, rest_looks, largest_turn,
         falling_turn] = settings;
  archive(longest_substep, substep_error, substep_parts, shortest_impulse, spectral_radius, metal_damping,
          other_damping, mode_of_whole, modes_sought, metal_modulus, rest_utilisation, rest_displacement, rest_looks,
          largest_turn, falling_turn);
}

#ifdef TOPPLE_VARIED_CONSTANTS  // benchmarks/constants: each halved and doubled
inline MotionSettings motion_settings{};
#else
inline constexpr MotionSettings motion_settings{};
#endif

}  // namespace topple::structure
