#include "analysis/loads_by_member.h"

#include <algorithm>
#include <numeric>

namespace topple::structure {

namespace {

solver::BeamLoad scaled(solver::BeamLoad load, double factor) {
  load.first *= factor;
  load.last *= factor;
  load.strain *= factor;
  load.curvature_y *= factor;
  load.curvature_z *= factor;
  return load;
}

}  // namespace

LoadsByMember::LoadsByMember(std::size_t members, const std::vector<solver::BeamLoad>& loads)
    : start_(members + 1, 0), loads_(&loads) {
  for (const solver::BeamLoad& load : loads) ++start_[static_cast<std::size_t>(load.beam) + 1];
  std::partial_sum(start_.begin(), start_.end(), start_.begin());
  const auto before = [](const solver::BeamLoad& a, const solver::BeamLoad& b) { return a.beam < b.beam; };
  if (std::is_sorted(loads.begin(), loads.end(), before)) return;
  sorted_ = loads;
  std::stable_sort(sorted_.begin(), sorted_.end(), before);
  loads_ = &sorted_;
}

CaseLoadsByMember::CaseLoadsByMember(std::size_t members, const CaseLoads& cases) : cases_(cases) {
  for (const solver::LoadSet& set : cases.sets) by_case_.emplace_back(members, set.beams);
}

void CaseLoadsByMember::add_up(std::size_t combination, std::size_t member, std::vector<solver::BeamLoad>& sum) const {
  constexpr auto distributed = solver::BeamLoad::Kind::distributed;
  sum.clear();
  for (std::size_t c = 0; c < by_case_.size(); ++c) {
    const double factor = cases_.factors(static_cast<Eigen::Index>(c), static_cast<Eigen::Index>(combination));
    if (factor == 0) continue;
    for (const solver::BeamLoad& load : by_case_[c].on(member)) {
      const auto same_length = [&](const solver::BeamLoad& other) {
        return load.kind == distributed && other.kind == distributed && load.from == other.from && load.to == other.to;
      };
      const auto there = std::find_if(sum.begin(), sum.end(), same_length);
      if (there == sum.end()) {
        sum.push_back(scaled(load, factor));
      } else {
        there->first += factor * load.first;
        there->last += factor * load.last;
      }
    }
  }
}

}  // namespace topple::structure
