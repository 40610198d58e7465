#pragma once
// What a Reanalysis tells of its work; each of its parts adds its own.
#include "topple/solver/reanalysis.h"

namespace topple::solver {

struct ReanalysisWork {
  ReanalysisCounters counters;
  double operations = 0;  ///< of the last solve()
};

}  // namespace topple::solver
