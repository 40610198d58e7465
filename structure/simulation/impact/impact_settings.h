#pragma once
// The numbers that decide what counts as an impact and what counts as pressing.

namespace topple::structure {

struct ImpactSettings {
  /// m/s. A contact that was there before and closes no faster is lying, rolling or settling; so is one between bodies
  /// that is new. A body gains it in a fall of 13 mm. Larger: slow blows break nothing; smaller: more is looked at.
  double least_speed = 0.5;
  /// m. Places that are no farther from touching when the first of them touches, touch with it: collision shapes are no
  /// truer. Larger: more is taken as one impact.
  double touching = 1e-3;
  /// Places that give way alike to this share are one place (a beam and a post hit at their common node).
  double same_place = 1e-6;
  /// A stiff place among soft ones (by their frequencies) is over before these feel anything: they are followed one
  /// after the other. Larger: more is followed together, at a cost of as many samples.
  double most_unlike = 30;
  /// s. What lies on debris presses on its joints with its force over this time: longer than the contact solver's
  /// chatter, shorter than anything that settles.
  double pressing_time = 0.1;
  /// Forces on a body below this multiple of its weight, and spins whose pull is below this multiple of gravity, are
  /// those of lying, rolling and tumbling: what fell in one piece bears them, and its joints are not asked.
  double hard = 3;
};

inline constexpr ImpactSettings impact_settings{};

}  // namespace topple::structure
