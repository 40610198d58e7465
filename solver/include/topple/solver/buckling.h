#pragma once
// Linear buckling: by which factor may the loads grow, the axial forces with them, before the structure buckles.
#include <vector>

#include "topple/solver/frame_model.h"
#include "topple/solver/jointed_shell.h"
#include "topple/solver/static_analysis.h"

namespace topple::solver {

/// A load factor at which the structure buckles, and the shape in which it does.
struct BucklingMode {
  double factor = 0;        ///< multiplies all loads of the set
  std::vector<Vec6> shape;  ///< per node, largest translation 1; all zero when a member buckles between nodes at rest
};

/// The lowest positive factors in order, at most `count` of them: fewer when no more exist below `largest_factor`. One
/// member for each column is enough: the beam-column's exact stiffness at a trial factor is factorised, and the number
/// of critical factors below it is that of negative pivots plus that of members buckled between held ends (Wittrick
/// and Williams 1971). The factors are found together by residual inverse iteration, and proved by a count; where that
/// does not get there, each is enclosed by counts and Newton's method. Shells bring the geometric stiffness
/// of their membrane forces, which is as fine as their mesh. `first_order`: the linear answer of this model to these
/// loads, where it is known; null: it is found here. Throws Instability where the model is a mechanism.
[[nodiscard]] std::vector<BucklingMode> buckling_modes(const FrameModel& model, const LoadSet& loads, int count,
                                                       const AnalysisOptions& options, double largest_factor = 1e6,
                                                       const std::vector<JointedShell>& jointed = {},
                                                       const StaticSolution* first_order = nullptr);

}  // namespace topple::solver
