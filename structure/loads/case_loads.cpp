#include "loads/case_loads.h"

namespace topple::structure {

CaseLoads case_loads(const Building& building, const Frame& frame, const EdgeMembers& edges,
                     const std::vector<CombinationId>& combinations) {
  const auto count = static_cast<Eigen::Index>(combinations.size());
  Eigen::MatrixXd of_all = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(building.cases.size()), count);
  for (Eigen::Index j = 0; j < count; ++j)
    for (const auto& [id, factor] : building[combinations[static_cast<std::size_t>(j)]].factors)
      of_all(id.index, j) += factor;
  std::vector<Eigen::Index> used;
  for (Eigen::Index c = 0; c < of_all.rows(); ++c)
    if (!of_all.row(c).isZero(0)) used.push_back(c);
  CaseLoads result;
  if (used.size() >= combinations.size()) return result;
  for (const Eigen::Index c : used) {
    const Combination alone{{}, {{LoadCaseId(static_cast<std::size_t>(c)), 1.0}}};
    result.sets.push_back(combination_loads(building, frame, edges, alone).set);
  }
  result.factors = of_all(used, Eigen::all);
  return result;
}

}  // namespace topple::structure
