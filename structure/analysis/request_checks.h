#pragma once
#include "topple/structure/analysis.h"

namespace topple::structure {

/// Throws std::out_of_range for ids that the building does not have, InputError for numbers that mean nothing.
void require_request(const Building& building, const AnalysisRequest& request);
/// Throws InputError for a member too slender for what is asked for.
void require_stocky(const Building& building, const AnalysisRequest& request);

}  // namespace topple::structure
