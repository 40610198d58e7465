#pragma once
#include "formats/model_draft.h"

namespace topple::structure::formats {

/// Generates a `building` that is given by places in plan (key `places`) instead of a grid: posts stand on places,
/// beams span between any two, the same on every storey that their rule names.
void generate_from_plan(const JsonValue& place, ModelDraft& draft);

}  // namespace topple::structure::formats
