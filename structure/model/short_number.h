#pragma once
// Numbers in sentences: warnings, errors, the summary.
#include <string>

namespace topple::structure {

/// With so many significant digits, trailing zeros left out: "0.00123", "1.2e+06".
[[nodiscard]] std::string short_number(double value, int digits = 4);

}  // namespace topple::structure
