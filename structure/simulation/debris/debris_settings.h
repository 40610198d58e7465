#pragma once
// Constants of debris: where a body begins, what it passes through, and how much a load that it lays on what stands
// must change before the frame is solved again.

namespace topple::structure {

struct DebrisSettings {
  // What lies on, or hangs from, what stands.
  /// s over which forces on what stands at rest are averaged. Longer than the contact solver's chatter, shorter than
  /// anything that settles. Longer: loads come later.
  double smoothing_time = 0.1;
  /// Of what a part can still bear: a load that changes by less is not told to the frame. Larger: fewer solves, and
  /// joints break later by that share.
  double band_of_margin = 0.1;
  /// Of the body's weight: that band is never more nor less, whatever the joints can bear.
  double largest_band = 0.25, smallest_band = 0.01;
  /// Of the member's length: a load that has moved by more counts as changed.
  double moved_share = 0.1;
  /// Of the body's weight: a hinge's pull that changes by less is not told to the frame.
  double hinge_band = 0.05;

  // Where bodies begin.
  /// m. A part starts where its statics had it, but no farther from the undeformed place: a segment on its way to a
  /// mechanism has static answers of metres, which it has had no time to reach.
  double largest_start = 0.05;
  /// m: radius of the sphere that stands for a node's mass falling alone. It decides what the node rolls over.
  double node_radius = 0.1;
  /// m: radius of the ball that stands for a host's body while it strikes; mass and inertia are its own.
  double stand_in_radius = 0.05;

  // Shapes: neighbours must not be born inside each other.
  /// m left between neighbours beyond their own size: more than the skin of any collision shape.
  double neighbour_gap = 0.01;
  /// Of its length: no end is shortened by more, so that stubby parts keep a body.
  double largest_cut = 0.4;
  /// Cosine of the angle within which a member counts as lying along an edge, and sine of that from which it pierces a
  /// panel.
  double along_edge = 0.999, piercing = 0.1;

  // What passes what.
  /// m: what stands so near to a hinge is passed by what hangs on it.
  double joint_room = 0.3;
  /// Sine of the angle to a panel below which an impact does not punch it.
  double flattest_punch = 0.5;

  /// m. Where what stands moves, a part is hit where it is once it is off by this; nearer, where it was. Larger: debris
  /// rests as far above or in what has sunk; smaller: what lies on a floor that sways is woken more often.
  double follow = 0.01;

  /// Of a part's own mass: what gives way where debris presses on a part that moves otherwise than in the substep
  /// before. Below 4/3 of it forces between the two settle (collision/debris/moving_obstacles.cpp); a half leaves
  /// room for a part whose end moves more easily than its middle. It decides how soon they settle, in substeps, and not
  /// on what.
  double share_of_part = 0.5;

  // What is looked for. These decide what is computed, not what comes out.
  /// m around a body's swept bounds: what its shapes' skins and a step's turn may add.
  double sweep_margin = 0.25;
  /// m around that which is looked over with it: a body that lies or rolls stays in it, one that falls for some steps.
  double look_ahead = 1;
};

#ifdef TOPPLE_VARIED_CONSTANTS  // benchmarks/constants: each halved and doubled
inline DebrisSettings debris_settings{};
#else
inline constexpr DebrisSettings debris_settings{};
#endif

}  // namespace topple::structure
