#pragma once
// The numbers that decide what counts as an impact and what counts as pressing.

namespace topple::structure {

struct ImpactSettings {
  /// m/s. A contact that was there before and closes no faster is lying, rolling or settling; so is one between bodies
  /// that is new. A body gains it in a fall of 13 mm. Larger: slow impacts break nothing; smaller: more is looked at.
  double least_speed = 0.5;
  /// m/s. What closes slower with what stands lies down on it, new or not: contacts bear it. A body gains it in a fall
  /// of 0.02 mm. Without it, what rests beside a part strikes it at every step by rounding.
  double lies_down = 0.02;
  /// Of what a part's own joints bear: what closes more slowly than `least_speed`, but with a momentum that contacts
  /// would take within a substep by a larger force, strikes what moves by the law of impact. Smaller: more is asked of
  /// the law; it decides nothing as substeps become short.
  double taken_by_contacts = 0.1;
  /// m. Places that are no farther from touching when the first of them touches, touch with it: collision shapes are no
  /// truer. Larger: more is taken as one impact.
  double touching = 1e-3;
  /// Places that give way alike to this share are one place (a beam and a post hit at their common node).
  double same_place = 1e-6;
  /// A stiff place among soft ones (by their frequencies) is over before these feel anything: they are followed one
  /// after the other, twice as much together each time that some still close. Larger: more is followed together, at a
  /// cost of as many samples.
  double most_unlike = 30;
  /// m. When a break would move an unloaded place by more, the statics are on their way to a mechanism that the
  /// structure has had no time to reach: the push ends there, and the body keeps the speed it has.
  double largest_shift = 0.1;
  /// Of the larger extent of what is pushed in: displacements are small up to there. What gives way by more is bent out
  /// of shape by its weight and its speed, slower than any impact, and the push ends. Larger: soft things break by
  /// slower pushes.
  double small_displacements = 0.1;
  /// Nodes of what is struck move while the push lasts, by modes. Those faster than the push by this factor bear it as
  /// at rest (to 1/64), those slower by its square float. Larger: more is followed, at a cost of as many samples.
  double follows = 8;
  /// m. A place that gives way farther without bearing the body is part of something that swings or falls with it,
  /// which linear statics say nothing about.
  double largest_depth = 3;
  /// Joints that come this near to failing (relative) fail with the first: symmetric ones differ by rounding only.
  double same_instant = 1e-6;
  /// s. For so long after they met, at least, what two things do to each other is an impact, of which the law of impact
  /// has said what it breaks: contacts take its momentum in less, and it presses on no joint. Panels of debris break by
  /// their impulse over this time, and hinges by their mean force. Larger: what lands heavily presses later, and
  /// shorter pulls of hinges break nothing.
  double landing_time = 0.01;
  /// s. What lies on debris presses on its joints with its force over this time: longer than the contact solver's
  /// chatter, shorter than anything that settles.
  double pressing_time = 0.1;
  /// Forces on a body below this multiple of its weight, and spins whose pull is below this multiple of gravity, are
  /// those of lying, rolling and tumbling: what fell in one piece bears them, and its joints are not asked.
  double hard = 3;
};

#ifdef TOPPLE_VARIED_CONSTANTS  // benchmarks/constants: each halved and doubled
inline ImpactSettings impact_settings{};
#else
inline constexpr ImpactSettings impact_settings{};
#endif

}  // namespace topple::structure
