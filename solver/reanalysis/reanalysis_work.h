#pragma once
// Counters and predicted operations of a Reanalysis; each of its parts adds its own.
#include "topple/solver/reanalysis.h"

namespace topple::solver {

struct ReanalysisWork {
  ReanalysisCounters counters;
  double operations = 0;  ///< of the last solve()
  template <class Archive>
  void serialize(Archive& archive) {
    auto& [done, of_last] = *this;
    archive(done, of_last);
  }
};

}  // namespace topple::solver
