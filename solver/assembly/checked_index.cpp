#include "assembly/checked_index.h"

#include <stdexcept>
#include <string>

namespace topple::solver {
namespace {

std::size_t checked(const char* kind, int number, std::size_t count) {
  if (number < 0 || static_cast<std::size_t>(number) >= count)
    throw std::invalid_argument(std::string(kind) + " " + std::to_string(number) + " does not exist; there are " +
                                std::to_string(count));
  return static_cast<std::size_t>(number);
}

}  // namespace

std::size_t checked_node(const FrameModel& model, int node) { return checked("node", node, model.nodes.size()); }
std::size_t checked_beam(const FrameModel& model, int beam) { return checked("beam", beam, model.beams.size()); }
std::size_t checked_shell(const FrameModel& model, int shell) { return checked("shell", shell, model.shells.size()); }
std::size_t checked_patch(const FrameModel& model, int patch) { return checked("patch", patch, model.patches.size()); }
std::size_t checked_support(const FrameModel& model, int support) {
  return checked("support", support, model.supports.size());
}

}  // namespace topple::solver
