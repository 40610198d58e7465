#pragma once
// Shells whose corners are not the nodes that their neighbours have: each hangs on one through a joint that gives.
#include <Eigen/Core>
#include <algorithm>
#include <vector>

namespace topple::solver {

/// The stiffness of such a shell is a patch of the model (its own is given as zero); its mass, and what its membrane
/// forces do to displaced corners, act in the patch's freedoms too.
struct JointedShell {
  int shell = -1;  ///< index in FrameModel::shells
  int patch = -1;  ///< its first four nodes are those of the shell; others have freedoms of their own
  /// Displacements of the four corners (global, 24) by the freedoms of the patch's nodes. The freedoms of a node beyond
  /// the first four are the motion of one corner against the shell's node there, along orthonormal axes.
  Eigen::MatrixXd corners;
};

/// In a list in order of shells: the one of that shell, or null.
[[nodiscard]] inline const JointedShell* jointed_shell(const std::vector<JointedShell>& all, int shell) {
  const auto found = std::lower_bound(all.begin(), all.end(), shell,
                                      [](const JointedShell& jointed, int number) { return jointed.shell < number; });
  return found != all.end() && found->shell == shell ? &*found : nullptr;
}
/// In a list in order of patches: the one of that patch, or null.
[[nodiscard]] inline const JointedShell* jointed_shell_of_patch(const std::vector<JointedShell>& all, int patch) {
  const auto found = std::lower_bound(all.begin(), all.end(), patch,
                                      [](const JointedShell& jointed, int number) { return jointed.patch < number; });
  return found != all.end() && found->patch == patch ? &*found : nullptr;
}

}  // namespace topple::solver
