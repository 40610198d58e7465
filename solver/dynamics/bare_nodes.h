#pragma once
// Nodes with neither stiffness nor mass. Their motion is undetermined, so their equations are left out.
#include <vector>

#include "assembly/element_masses.h"
#include "assembly/frame_system.h"
#include "reanalysis/requested_changes.h"

namespace topple::solver {

/// The nodes of such parts once the changes are carried out, among those that elements which change reach; ascending.
/// Often a node to which nothing holds any more.
[[nodiscard]] std::vector<int> bare_nodes(const FrameSystem& system, const SystemInertia& inertia,
                                          const RequestedChanges& changes);

}  // namespace topple::solver
