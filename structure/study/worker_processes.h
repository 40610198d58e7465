#pragma once
// Samples side by side in processes of their own, for what must not run twice at once in one: the collision engine has
// state that all worlds of a process share, and two collapses at once may then differ in their last bits.
#include <functional>

#include "topple/structure/study/study.h"

namespace topple::structure::study {

/// Forks `workers` processes, which take the samples make(0) ... make(count - 1) as they become free; calls `take` with
/// each as it ends, in this process. A worker that dies makes the sample that it was at a failed one, and is replaced.
void run_in_processes(const StudyTask& task, const StudyRun& run, std::size_t count, std::size_t workers,
                      const std::function<Sample(std::size_t)>& make, const std::function<void(Sample&&)>& take);

/// Sets outputs and seconds, or the reason why there are none.
void evaluate(SampleEvaluator& evaluator, Sample& sample);

}  // namespace topple::structure::study
