// Samples on the threads of one process: each takes the next that is missing.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <mutex>
#include <thread>

#include "parallel/side_by_side.h"
#include "topple/structure/plain_text.h"
#include "topple/structure/study.h"

namespace topple::structure {

namespace {

/// Calls `take` with each sample of `numbers` as it ends, one at a time. What `take` throws ends the run.
void run_each(const StudyTask& task, const StudyRun& run, const std::vector<std::uint64_t>& numbers,
              const std::function<void(Sample&&)>& take) {
  std::atomic<std::size_t> next{0};
  std::atomic<bool> ended{false};
  std::mutex mutex;
  std::exception_ptr failure;
  std::uint64_t done = 0;
  const auto work = [&] {
    try {
      const std::unique_ptr<SampleEvaluator> evaluator = task.make_evaluator();
      for (std::size_t i = next++; i < numbers.size() && !ended && !(run.stopped && run.stopped()); i = next++) {
        Sample sample = run_sample(task, *evaluator, numbers[i]);
        const std::lock_guard lock(mutex);
        if (ended) return;
        take(std::move(sample));
        if (run.progress) run.progress(++done, numbers.size());
      }
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!failure) failure = std::current_exception();
      ended = true;
    }
  };
  std::vector<std::thread> beside;
  for (std::size_t t = 1; t < workers_for(numbers.size(), run.threads); ++t) beside.emplace_back(work);
  work();
  for (std::thread& thread : beside) thread.join();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace

Sample run_sample(const StudyTask& task, SampleEvaluator& evaluator, std::uint64_t k) {
  const auto start = std::chrono::steady_clock::now();
  Sample sample;
  sample.number = k;
  sample.inputs = task.sampler.values(k);
  try {
    evaluator.evaluate(sample);
  } catch (const std::exception& error) {
    sample.outputs.clear();
    sample.parts.clear();
    sample.failed = one_line(error.what());
    if (sample.failed.empty()) sample.failed = "no reason was given";
  }
  sample.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return sample;
}

void run_samples(const StudyTask& task, const StudyRun& run, StudyJournal& journal) {
  std::vector<std::uint64_t> missing;
  for (std::uint64_t k = run.from; k < std::min(run.to, task.sampler.samples()); ++k)
    if (!journal.has(k)) missing.push_back(k);
  run_each(task, run, missing, [&](Sample&& sample) { journal.add(sample); });
  journal.sync();
}

std::vector<Sample> run_samples(const StudyTask& task, const StudyRun& run) {
  std::vector<std::uint64_t> numbers;
  for (std::uint64_t k = run.from; k < std::min(run.to, task.sampler.samples()); ++k) numbers.push_back(k);
  std::vector<Sample> samples;
  run_each(task, run, numbers, [&](Sample&& sample) { samples.push_back(std::move(sample)); });
  std::sort(samples.begin(), samples.end(), [](const Sample& a, const Sample& b) { return a.number < b.number; });
  return samples;
}

}  // namespace topple::structure
