#pragma once
// The lognormal fragility curve of greatest likelihood.
#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "topple/structure/study/study_statistics.h"

namespace topple::structure::study {

/// a, b of P(hit) = Phi(a + b x) with the greatest likelihood; none where it has no maximum.
[[nodiscard]] std::optional<std::array<double, 2>> fit_probit(std::span<const double> x, const std::vector<bool>& hit);
/// Classes of equal counts, and the curve where all x are above 0.
[[nodiscard]] Fragility fit_fragility(std::string input, std::span<const double> x, const std::vector<bool>& hit);

}  // namespace topple::structure::study
