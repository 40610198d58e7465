#pragma once
// Analyses one after the other of buildings that differ in numbers alone, as samples of a study do.
#include "topple/solver/kept_equations.h"
#include "topple/structure/analysis.h"

namespace topple::structure {

/// As analyse(), with the same numbers. What one leaves in `kept` (ordering, symbolic factor, stiffnesses of what is
/// the same) serves the next.
[[nodiscard]] AnalysisResult analyse_with(solver::KeptEquations& kept, const Building& building,
                                          const AnalysisRequest& request);

/// The same where only the uses of joints, the ends of members and the storeys are wanted: without extremes and
/// stations along members, the largest displacement, and the meshes' errors (and what would be warned of for these),
/// which take half of the time that a whole one takes beside its equations.
[[nodiscard]] AnalysisResult analyse_briefly(solver::KeptEquations& kept, const Building& building,
                                             const AnalysisRequest& request);

}  // namespace topple::structure
