#pragma once
// The standard normal distribution.

namespace topple::structure::study {

/// Share below z.
[[nodiscard]] double normal_share(double z);
/// The inverse, 0 < share < 1, to about 16 digits (M. J. Wichura, Algorithm AS 241, Appl. Statist. 37, 1988).
[[nodiscard]] double normal_quantile(double share);

}  // namespace topple::structure::study
