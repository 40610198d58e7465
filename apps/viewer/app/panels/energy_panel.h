#pragma once
// The tab of energies: how those of the ledger went over the run.
#include <array>
#include <cstddef>
#include <vector>

#include "app/controller.h"

namespace topple::viewer {

/// One of the curves, J. What stands has elastic energy from the start: only what has come to it is drawn.
struct EnergyCurve {
  const char* name;
  double (*value)(const structure::Ledger& now, const structure::Ledger& at_start);
};
inline constexpr std::size_t energy_curve_count = 7;
[[nodiscard]] const std::array<EnergyCurve, energy_curve_count>& energy_curves();

class EnergyPanel {
 public:
  /// `moment` is what the scene shows: marked in the curves, and told in numbers.
  void draw(Controller& controller, const Snapshot& moment);

 private:
  void plot(Controller& controller, const std::vector<Recording::Energies>& points, double marked);

  std::array<bool, energy_curve_count> shown_{true, true, true, true, true, true, true};
};

}  // namespace topple::viewer
