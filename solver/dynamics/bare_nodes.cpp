#include "dynamics/bare_nodes.h"

#include <algorithm>

namespace topple::solver {
namespace {

class BareParts {
 public:
  BareParts(const FrameSystem& system, const SystemInertia& inertia, const RequestedChanges& changes)
      : system_(system), inertia_(inertia), changes_(changes) {}

  /// The nodes to which what holds this one goes on, itself first; none where something of them has mass, or a support.
  [[nodiscard]] std::vector<int> part_of(int start) const {
    std::vector<int> part{start};
    for (std::size_t next = 0; next < part.size(); ++next) {
      const int node = part[next];
      if (system_.node_stands[static_cast<std::size_t>(node)] == 0) continue;
      if (stays(node) || !follow_beams(node, part) || !follow_shells(node, part)) return {};
    }
    return part;
  }

 private:
  static void reach(int node, std::vector<int>& part) {
    if (std::find(part.begin(), part.end(), node) == part.end()) part.push_back(node);
  }

  /// By what it has beside beams and shells.
  [[nodiscard]] bool stays(int node) const {
    const auto n = static_cast<std::size_t>(node);
    if (system_.dofs().diaphragm_of_node[n] >= 0 || !inertia_.at_node[n].head<3>().isZero(0)) return true;
    for (const int patch : system_.patches_of_node(node))  // some hold on to the ground
      if (!changes_.mass_of_patch(system_.model, patch).isZero(0) || patch_holds(patch, node)) return true;
    for (const Support& support : system_.model.supports)
      if (support.node == node && !support.stiffness.head<3>().isZero(0)) return true;
    return false;
  }

  /// False: one of them has mass.
  [[nodiscard]] bool follow_beams(int node, std::vector<int>& part) const {
    for (const int beam : system_.beams_of_node(node)) {
      const BeamTarget& target = changes_.beam(static_cast<std::size_t>(beam));
      const Beam& b = system_.model.beams[static_cast<std::size_t>(beam)];
      if (target.removed) continue;
      for (std::size_t end = 0; end < 2; ++end) {
        if (b.node[end] != node || target.end_stiffness[end].isZero(0)) continue;
        if (target.density != 0) return false;
        if (!target.end_stiffness[1 - end].isZero(0)) reach(b.node[1 - end], part);
      }
    }
    return true;
  }

  [[nodiscard]] bool follow_shells(int node, std::vector<int>& part) const {
    for (const int shell : system_.shells_of_node(node)) {
      if (!shell_holds(shell, node)) continue;
      const Shell& own = system_.model.shells[static_cast<std::size_t>(shell)];
      if (own.density != 0) return false;
      for (const int corner : own.node)
        if (shell_holds(shell, corner)) reach(corner, part);
    }
    return true;
  }

  [[nodiscard]] bool shell_holds(int shell, int node) const {
    const auto i = static_cast<std::size_t>(shell);
    if (changes_.shell_removed(i)) return false;
    const Shell& own = system_.model.shells[i];
    if (own.density != 0) return true;
    const Mat24* stiffness = changes_.stiffness_of_shell(system_.model, shell);
    if (stiffness == nullptr) return true;
    for (std::size_t corner = 0; corner < 4; ++corner)
      if (own.node[corner] == node && !stiffness->middleRows<6>(static_cast<Eigen::Index>(6 * corner)).isZero(0))
        return true;
    return false;
  }

  [[nodiscard]] bool patch_holds(int patch, int node) const {
    const Patch& own = system_.model.patches[static_cast<std::size_t>(patch)];
    const Eigen::MatrixXd& stiffness = changes_.stiffness_of_patch(system_.model, patch);
    for (std::size_t n = 0; n < own.node.size(); ++n)
      if (own.node[n] == node && !stiffness.middleRows<6>(static_cast<Eigen::Index>(6 * n)).isZero(0)) return true;
    return false;
  }

  const FrameSystem& system_;
  const SystemInertia& inertia_;
  const RequestedChanges& changes_;
};

}  // namespace

std::vector<int> bare_nodes(const FrameSystem& system, const SystemInertia& inertia, const RequestedChanges& changes) {
  const BareParts parts(system, inertia, changes);
  const FrameModel& model = system.model;
  std::vector<int> nodes;
  const auto look_at = [&](const auto& element_nodes) {
    for (const int node : element_nodes) {
      if (system.node_stands[static_cast<std::size_t>(node)] == 0) continue;
      const std::vector<int> part = parts.part_of(node);
      nodes.insert(nodes.end(), part.begin(), part.end());
    }
  };
  for (const int beam : changes.beams()) look_at(model.beams[static_cast<std::size_t>(beam)].node);
  for (const int shell : changes.shells()) look_at(model.shells[static_cast<std::size_t>(shell)].node);
  for (const auto& [shell, stiffness] : changes.shell_stiffness())
    look_at(model.shells[static_cast<std::size_t>(shell)].node);
  for (const auto& [patch, stiffness] : changes.patch_stiffness())
    look_at(model.patches[static_cast<std::size_t>(patch)].node);
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

}  // namespace topple::solver
