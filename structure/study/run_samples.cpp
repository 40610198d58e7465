// Samples on the threads of one process: each takes the next that is missing.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <mutex>
#include <new>

#include "parallel/in_order.h"
#include "study/run_each.h"
#include "study/worker_processes.h"
#include "topple/solver/parallel_for.h"
#include "topple/structure/formats/plain_text.h"
#include "topple/structure/study/study.h"

namespace topple::structure {

void study::evaluate(SampleEvaluator& evaluator, Sample& sample) {
  const auto start = std::chrono::steady_clock::now();
  try {
    evaluator.evaluate(sample);
  } catch (const std::bad_alloc&) {
    throw;  // no fault of the sample: the run ends, and goes on where there is more memory
  } catch (const std::exception& error) {
    sample.outputs.clear();
    sample.parts.clear();
    sample.failed = one_line(error.what());
    if (sample.failed.empty()) sample.failed = "no reason was given";
  }
  sample.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

namespace {

using study::evaluate;

/// Calls `make(i)` for the samples 0 ... count - 1 and `take` with each as it ends, one at a time.
void run_all(const StudyTask& task, const StudyRun& run, std::size_t count,
             const std::function<Sample(std::size_t)>& make, const std::function<void(Sample&&)>& take) {
  if (count == 0) return;
  const int workers = workers_for(count, run.threads);
  if (task.apart && workers > 1)
    return study::run_in_processes(task, run, count, static_cast<std::size_t>(workers), make, take);
  std::atomic<std::size_t> next{0};
  std::atomic<bool> ended{false};
  std::mutex mutex;
  std::exception_ptr failure;
  std::uint64_t done = 0;
  const auto work = [&](int /*worker*/) {
    try {
      const std::unique_ptr<SampleEvaluator> evaluator = task.make_evaluator();
      for (std::size_t i = next++; i < count && !ended && !(run.stopped && run.stopped()); i = next++) {
        Sample sample = make(i);
        evaluate(*evaluator, sample);
        const std::lock_guard lock(mutex);
        if (ended) return;
        take(std::move(sample));
        if (run.progress) run.progress(++done, count);
      }
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!failure) failure = std::current_exception();
      ended = true;
    }
  };
  solver::parallel_for(workers, workers, work);
  if (failure) std::rethrow_exception(failure);
}

Sample drawn(const StudyTask& task, std::uint64_t k) {
  Sample sample;
  sample.number = k;
  sample.inputs = task.sampler.values(k);
  return sample;
}

}  // namespace

void study::run_each(const StudyTask& task, const StudyRun& run, std::vector<Sample> samples,
                     const std::function<void(Sample&&)>& take) {
  run_all(
      task, run, samples.size(), [&](std::size_t i) { return std::move(samples[i]); }, take);
}

Sample run_sample(const StudyTask& task, SampleEvaluator& evaluator, std::uint64_t k) {
  Sample sample = drawn(task, k);
  evaluate(evaluator, sample);
  return sample;
}

void run_samples(const StudyTask& task, const StudyRun& run, StudyJournal& journal) {
  std::vector<std::uint64_t> missing;
  for (std::uint64_t k = run.from; k < std::min(run.to, task.sampler.samples()); ++k)
    if (!journal.has(k)) missing.push_back(k);
  run_all(
      task, run, missing.size(), [&](std::size_t i) { return drawn(task, missing[i]); },
      [&](Sample&& sample) { journal.add(sample); });
  journal.sync();
}

std::vector<Sample> run_samples(const StudyTask& task, const StudyRun& run) {
  std::vector<std::uint64_t> numbers;
  for (std::uint64_t k = run.from; k < std::min(run.to, task.sampler.samples()); ++k) numbers.push_back(k);
  std::vector<Sample> samples;
  run_all(
      task, run, numbers.size(), [&](std::size_t i) { return drawn(task, numbers[i]); },
      [&](Sample&& sample) { samples.push_back(std::move(sample)); });
  std::sort(samples.begin(), samples.end(), [](const Sample& a, const Sample& b) { return a.number < b.number; });
  return samples;
}

}  // namespace topple::structure
