#pragma once
#include <string>

#include "topple/solver/static_analysis.h"
#include "topple/solver/unresolved_modes.h"
#include "topple/structure/analysis.h"
#include "topple/structure/frame.h"

namespace topple::structure {

/// One line that names the nodes that move, how, and the members that move, in the building's own names.
[[nodiscard]] std::string describe_instability(const Building& building, const Frame& frame,
                                               const solver::Instability& instability);
/// What moves as a structure buckles, of a second-order analysis.
[[nodiscard]] std::string describe_buckling(const Building& building, const Frame& frame,
                                            const solver::Instability& instability);
/// The same as a motion that can be drawn. `kind` as in Diagnosis.
[[nodiscard]] Diagnosis diagnose(const Building& building, const Frame& frame, const solver::Instability& instability,
                                 const char* kind, CombinationId combination, const std::string& message);

/// Why natural modes cannot be told from rounding, with the nodes between which stiffness over mass goes so far.
[[nodiscard]] std::string describe_unresolved(const Building& building, const solver::UnresolvedModes& unresolved);

}  // namespace topple::structure
