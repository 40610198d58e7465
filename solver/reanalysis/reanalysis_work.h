#pragma once
// Counters and predicted operations of a Reanalysis; each of its parts adds its own.
#include "topple/solver/reanalysis.h"

namespace topple::solver {

struct ReanalysisWork {
  ReanalysisCounters counters;
  double operations = 0;  ///< of the last solve()
};

}  // namespace topple::solver
