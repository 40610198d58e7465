#pragma once
// Options of `topple analyse` as a study's base gives them.
#include <optional>

#include "topple/structure/analysis.h"
#include "topple/structure/member_checks.h"
#include "topple/structure/study/study.h"

namespace topple::structure::study {

struct AnalysisOfSample {
  AnalysisRequest request;
  std::optional<DesignCode> code;
};

/// The request that the options make of this building. Throws InputError, which names the study, for an option that is
/// not known and for names that the building has not.
[[nodiscard]] AnalysisOfSample analysis_of(const Study& study, const Building& building);

}  // namespace topple::structure::study
