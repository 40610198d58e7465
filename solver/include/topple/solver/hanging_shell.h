#pragma once
// Shells whose corners are not the nodes that their neighbours have: each hangs on one through a joint that gives.
#include <Eigen/Core>
#include <algorithm>
#include <vector>

namespace topple::solver {

/// The stiffness of such a shell is a patch of the model (its own is given as zero); its mass, and what its membrane
/// forces do to displaced corners, act in the patch's freedoms too.
struct HangingShell {
  int shell = -1;  ///< index in FrameModel::shells
  int patch = -1;  ///< its first four nodes are those of the shell; others have freedoms of their own
  /// Displacements of the four corners (global, 24) by the freedoms of the patch's nodes. The freedoms of a node beyond
  /// the first four are the motion of one corner against the shell's node there, along orthonormal axes.
  Eigen::MatrixXd corners;
};

/// In a list in order of shells: the one of that shell, or null.
[[nodiscard]] inline const HangingShell* hanging_shell(const std::vector<HangingShell>& all, int shell) {
  const auto found = std::lower_bound(all.begin(), all.end(), shell,
                                      [](const HangingShell& hanging, int number) { return hanging.shell < number; });
  return found != all.end() && found->shell == shell ? &*found : nullptr;
}
/// In a list in order of patches: the one of that patch, or null.
[[nodiscard]] inline const HangingShell* hanging_on_patch(const std::vector<HangingShell>& all, int patch) {
  const auto found = std::lower_bound(all.begin(), all.end(), patch,
                                      [](const HangingShell& hanging, int number) { return hanging.patch < number; });
  return found != all.end() && found->patch == patch ? &*found : nullptr;
}

}  // namespace topple::solver
