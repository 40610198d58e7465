#pragma once
// Numbers that a caller gives, as indices of what a model has. Each throws std::invalid_argument for one that it has
// not.
#include <cstddef>

#include "topple/solver/frame_model.h"

namespace topple::solver {

[[nodiscard]] std::size_t checked_node(const FrameModel& model, int node);
[[nodiscard]] std::size_t checked_beam(const FrameModel& model, int beam);
[[nodiscard]] std::size_t checked_shell(const FrameModel& model, int shell);
[[nodiscard]] std::size_t checked_patch(const FrameModel& model, int patch);
[[nodiscard]] std::size_t checked_support(const FrameModel& model, int support);

}  // namespace topple::solver
