#pragma once
// The page of a study: distributions, probability of collapse, what it hangs on, fragility, the building coloured by
// how often its parts fall. One file without scripts, which prints.
#include <span>
#include <string>

#include "topple/structure/study/study_optimise.h"
#include "topple/structure/study/study_statistics.h"

namespace topple::app {

/// `building`: the base; null where there is none. `chosen`: further HTML behind the title (an optimisation's answer).
[[nodiscard]] std::string study_page(const structure::Study& study, const structure::StudyTask& task,
                                     std::span<const structure::Sample> samples,
                                     const structure::StudyStatistics& statistics, const structure::Building* building,
                                     const std::string& chosen = {});

/// The answer of an optimisation, for `chosen`.
[[nodiscard]] std::string chosen_section(const structure::Study& study, const structure::StudyTask& task,
                                         const structure::OptimiseResult& result);

/// The building seen at an angle from above, members and panels by the share of samples in which they fell, joints by
/// that in which they broke; as SVG.
[[nodiscard]] std::string building_drawing(const structure::Building& building, const structure::PartShares& shares);

}  // namespace topple::app
