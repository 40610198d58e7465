#pragma once
// Load cases as sets of their own, of which combinations are sums.
#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "topple/structure/frame.h"

namespace topple::structure {

struct CaseLoads {
  std::vector<solver::LoadSet> sets;  ///< of the cases that any of the combinations has, with a factor of 1
  Eigen::MatrixXd factors;            ///< of each of these (rows) in each combination (columns)
};

/// Resultant over each edge of each panel of what it hands on, N, global; everything standing.
using EdgeForces = std::vector<std::array<Vec3, 4>>;
[[nodiscard]] EdgeForces edge_forces(const Building& building, const EdgeMembers& edges, const PartLoads& loads);

/// One combination, everything standing.
struct CombinationLoads {
  PartLoads parts;                       ///< but for what acts on members, which is in the sets
  solver::LoadSet set;                   ///< on the frame
  std::optional<solver::LoadSet> whole;  ///< on whole members, where a mesh divides some
  EdgeForces edge_forces;
};
/// Some panel has a mesh, which may divide members along it: loads then lie on pieces of these.
[[nodiscard]] bool has_meshes(const Frame& frame);
/// Its parts alone.
[[nodiscard]] PartLoads loads_beside_members(const Building& building, const Combination& combination);
[[nodiscard]] CombinationLoads combination_loads(const Building& building, const Frame& frame, const EdgeMembers& edges,
                                                 const Combination& combination);

/// load_set() with the loads of members apart, in their order; `forces`, where wanted, as edge_forces() gives them.
[[nodiscard]] solver::LoadSet load_set(const Building& building, const EdgeMembers& edges, const PartLoads& loads,
                                       std::vector<solver::BeamLoad> on_members, EdgeForces* forces = nullptr);

/// Everything standing, on the frame. Nothing where there are not fewer cases than combinations.
[[nodiscard]] CaseLoads case_loads(const Building& building, const Frame& frame, const EdgeMembers& edges,
                                   const std::vector<CombinationId>& combinations);
/// What a combination that need not be the building's own brings.
[[nodiscard]] PartLoads part_loads(const Building& building, const Combination& combination);

}  // namespace topple::structure
