#pragma once
#include <string>

#include "topple/solver/static_analysis.h"
#include "topple/structure/frame.h"

namespace topple::structure {

/// One line that names the nodes that move, how, and the members that move, in the building's own names.
[[nodiscard]] std::string describe_instability(const Building& building, const Frame& frame,
                                               const solver::Instability& instability);

}  // namespace topple::structure
