#pragma once
// Samples whose inputs are given, side by side.
#include <functional>
#include <vector>

#include "topple/structure/study/study.h"

namespace topple::structure::study {

/// Evaluates samples; calls `take` with each as it ends, one at a time. What `take` throws ends the run.
void run_each(const StudyTask& task, const StudyRun& run, std::vector<Sample> samples,
              const std::function<void(Sample&&)>& take);

}  // namespace topple::structure::study
