#include "analysis/answer_warnings.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "model/short_number.h"

namespace topple::structure {

namespace {

/// What an answer says of its own error, where that is more than an engineer can overlook.
void warn_of_error(const Building& building, AnalysisResult& result) {
  constexpr double few_digits = 1e-6;
  const auto digits = [](double error) { return std::to_string(error < 1 ? static_cast<int>(-std::log10(error)) : 0); };
  for (const CombinationResult& c : result.combinations) {
    const std::string of = "combination " + building[c.combination].name + ": ";
    if (!(c.equilibrium_error <= few_digits))
      result.warnings.push_back(of + "reactions balance the loads to about " + digits(c.equilibrium_error) +
                                " digits only (equilibrium error " + short_number(c.equilibrium_error) + ")");
    if (!c.quality.converged)
      result.warnings.push_back(of + "the equations are not solved to rounding (backward error " +
                                short_number(c.quality.backward_error) + "); about " + digits(c.quality.error_bound) +
                                " digits of the displacements are certain");
  }
}

/// Stresses of a mesh that is too coarse; the deflections' error goes with the square.
void warn_of_meshes(const Building& building, AnalysisResult& result) {
  constexpr double coarse = 0.4;  // deflections are then off by some per cent
  for (const CombinationResult& c : result.combinations) {
    if (!(c.discretisation_error > coarse)) continue;
    const auto worst = std::max_element(c.panels.begin(), c.panels.end(), [](const auto& a, const auto& b) {
      return a.discretisation_error < b.discretisation_error;
    });
    result.warnings.push_back("combination " + building[c.combination].name +
                              ": the shells' meshes are coarse: estimated error of stresses " +
                              short_number(100 * c.discretisation_error) + " %, most in panel " +
                              building.panels[static_cast<std::size_t>(worst - c.panels.begin())].name +
                              "; a larger `mesh` lowers it");
  }
}

/// Loads that lift the whole are mostly signs that are missing.
void warn_of_lifting_loads(const Building& building, AnalysisResult& result) {
  constexpr double rounding = 1e-9;
  if (building.units.consistent) return;  // up may be any way
  for (const CombinationResult& c : result.combinations)
    if (c.total_load[2] > rounding * c.total_load.head<3>().norm())
      result.warnings.push_back("combination " + building[c.combination].name + ": its loads lift the structure (" +
                                short_number(c.total_load[2] / building.units.force) +
                                " upwards on balance); loads that act downwards are negative along z");
}

/// Beyond a tenth of the structure's size nothing linear holds.
void warn_of_large_deflections(const Building& building, AnalysisResult& result) {
  constexpr double large = 0.1;
  if (building.nodes.empty()) return;
  Vec3 low = building.nodes.front().position, high = low;
  for (const Node& node : building.nodes) {
    low = low.cwiseMin(node.position);
    high = high.cwiseMax(node.position);
  }
  const double size = (high - low).norm();
  for (const CombinationResult& c : result.combinations) {
    const std::string of = "combination " + building[c.combination].name + ": ";
    if (c.largest.value > large * size) {
      result.warnings.push_back(of + "the largest displacement (" +
                                short_number(c.largest.value / building.units.length) +
                                ") is above a tenth of the structure's size; small displacements are assumed");
      continue;
    }
    for (std::size_t m = 0; m < c.members.size(); ++m) {
      const auto sag = [&](std::size_t q) {
        return std::max(std::abs(c.members[m].min[q].value), std::abs(c.members[m].max[q].value));
      };
      if (std::max(sag(6), sag(7)) <= large * building.members[m].length) continue;
      result.warnings.push_back(of + "member " + building.members[m].name +
                                " deflects by more than a tenth of its length; small displacements are assumed");
      break;
    }
  }
}

}  // namespace

void warn_of_answer(const Building& building, AnalysisResult& result) {
  warn_of_error(building, result);
  warn_of_meshes(building, result);
  warn_of_lifting_loads(building, result);
  warn_of_large_deflections(building, result);
}

void warn_of_heated_elements(const Building& building, const std::vector<CombinationLoads>& loads,
                             AnalysisResult& result) {
  std::set<int> heated;
  for (const CombinationLoads& one : loads)
    for (const solver::BeamLoad& load : one.set.beams)
      if (load.kind == solver::BeamLoad::Kind::temperature) heated.insert(load.beam);
  if (heated.empty()) return;
  result.warnings.push_back(
      "end forces are Frame3DD's own, which are not in equilibrium for heated elements under geometric stiffness (" +
      building.members[static_cast<std::size_t>(*heated.begin())].name +
      (heated.size() > 1 ? " and " + std::to_string(heated.size() - 1) + " more" : "") +
      "); --p-delta=cubic gives those in equilibrium");
}

}  // namespace topple::structure
