#pragma once
// How samples of collapses and of analyses become numbers.
#include <limits>
#include <memory>

#include "study/study_base.h"

namespace topple::structure::study {

/// Of a measure that a sample does not have.
inline constexpr double no_value = std::numeric_limits<double>::quiet_NaN();

[[nodiscard]] std::unique_ptr<SampleEvaluator> collapse_evaluator(std::shared_ptr<const StudyBase> base);
[[nodiscard]] std::unique_ptr<SampleEvaluator> analysis_evaluator(std::shared_ptr<const StudyBase> base);

/// Whether a ready output is there for this base.
[[nodiscard]] bool ready_for(std::string_view output, Study::Base base);

/// The number at a pointer of a JSON text; NaN where there is null. Throws std::runtime_error with what stands
/// there instead.
[[nodiscard]] double number_at(const formats::JsonDocument& results, const Recorded& recorded);

/// Members, panels and joints of a building as one bit each, as digits; "" where none is set.
[[nodiscard]] std::string parts_text(const std::vector<bool>& bits);

}  // namespace topple::structure::study
