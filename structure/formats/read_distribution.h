#pragma once
// How a number is spread, as studies tell it.
#include "formats/json/json_document.h"
#include "topple/structure/study/study.h"

namespace topple::structure::formats {

/// The keys of a distribution, in an object that may hold others.
[[nodiscard]] bool is_distribution_key(std::string_view key);
/// Of the one distribution that the object holds. Throws InputError.
[[nodiscard]] Distribution read_distribution(const JsonValue& object);
[[nodiscard]] StudyValue read_study_value(const JsonValue& value);

}  // namespace topple::structure::formats
