#pragma once
// What became of a joint of a standing frame: it broke, or it turned and holds.
#include <optional>

#include "topple/structure/building.h"

namespace topple::structure {

enum class BreakCause { impact, overload, buckling, bracing, tool };

/// A joint that broke, or yielded, and why.
struct JointBreak {
  JointId joint;                            ///< that broke
  BreakCause cause = BreakCause::overload;  ///< what broke it
  Sense sense = Sense::tension;             ///< in which it was over capacity
  double demand = 0;                        ///< in that sense, N or N m
  double capacity = 0;                      ///< in that sense, N or N m
  int generation = 0;                       ///< within the step
  double energy = 0;                        ///< elastic energy that the break sets free
  Vec3 position = Vec3::Zero();             ///< of the joint, m
  /// No joint broke: the member of this one was cut in two here, as a fraction of its length from its first end.
  std::optional<double> inside{};
};

/// A joint that has turned beyond what is elastic, and holds.
struct PlasticRotation {
  JointId joint;                  ///< of a member's end that stands
  Sense sense = Sense::moment_y;  ///< torsion, moment_y or moment_z
  double turned = 0;              ///< rad, of the rigid end less that of the member's end; keeps its sign
  double limit = 0;               ///< rad: the joint breaks where it would turn further than that, either way
};

}  // namespace topple::structure
