#include "topple/structure/results_selection.h"

#include <algorithm>
#include <numeric>

#include "model/index_of.h"

namespace topple::structure {

ResultsSelection select_members(const Building& building, const AnalysisResult& result, std::size_t count,
                                std::size_t of_section) {
  const std::size_t all = building.members.size();
  std::vector<double> use(all, 0);
  for (const CombinationResult& c : result.combinations)
    for (std::size_t m = 0; m < c.designs.size(); ++m) use[m] = std::max(use[m], c.designs[m].utilisation);
  std::vector<std::size_t> by_utilisation(all);
  std::iota(by_utilisation.begin(), by_utilisation.end(), std::size_t{0});
  std::stable_sort(by_utilisation.begin(), by_utilisation.end(),
                   [&](std::size_t a, std::size_t b) { return use[a] > use[b]; });
  std::vector<char> chosen(all, 0);
  std::vector<std::size_t> taken(building.sections.size(), 0);
  std::size_t number = 0;
  for (const std::size_t m : by_utilisation) {
    if (number == count || taken[index_of(building.members[m].section)]++ >= of_section) continue;
    chosen[m] = 1;
    ++number;
  }
  const std::size_t others = all - number, wanted = std::min(count - number, others);
  for (std::size_t m = 0, seen = 0; m < all; ++m) {
    if (chosen[m] != 0) continue;
    if ((seen + 1) * wanted / std::max<std::size_t>(others, 1) > seen * wanted / std::max<std::size_t>(others, 1))
      chosen[m] = 1;
    ++seen;
  }
  ResultsSelection selection;
  std::vector<char> nodes(building.nodes.size(), 0);
  for (std::size_t m = 0; m < all; ++m) {
    if (chosen[m] == 0) continue;
    selection.members.push_back(m);
    for (const NodeId node : building.members[m].nodes) nodes[index_of(node)] = 1;
  }
  for (const NodeSupport& support : building.supports) nodes[index_of(support.node)] = 1;
  for (const Panel& panel : building.panels)
    for (const NodeId node : panel.nodes) nodes[index_of(node)] = 1;
  for (std::size_t n = 0; n < nodes.size(); ++n)
    if (nodes[n] != 0) selection.nodes.push_back(n);
  return selection;
}

}  // namespace topple::structure
