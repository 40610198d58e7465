#pragma once
#include <string>

#include "standing/statics/frame_statics.h"

namespace topple::structure {

/// One line: which nodes move, how, and which members hang on them.
[[nodiscard]] std::string describe_mechanism(const Building& building, const FrameMechanism& mechanism);
/// The same without saying that a model is unstable: "node A1 moves along x; members ...".
[[nodiscard]] std::string describe_motion(const Building& building, const FrameMechanism& mechanism);

}  // namespace topple::structure
