#include "study_ranks.h"

#include <cstdlib>

#include "topple/structure/error.h"

namespace topple::app {

bool started_on_ranks() {
  // Set for each process by OpenMPI, by PMIx (srun --mpi=pmix), and by the older PMI.
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_RANK"})
    if (std::getenv(name) != nullptr) return true;
  return false;
}

}  // namespace topple::app

#ifndef TOPPLE_MPI

namespace topple::app {

Ranks::Ranks() {
  throw structure::InputError(
      "this process was started by mpirun as one of several, and the program was built without MPI; accepted: a build "
      "with TOPPLE_MPI, or a start without mpirun");
}
Ranks::~Ranks() = default;
bool Ranks::together(const std::function<void()>&) const { return false; }
bool Ranks::same_on_all(std::uint64_t) const { return false; }
void Ranks::run_workers(const structure::StudyTask&, const structure::StudyRun&, structure::StudyJournal&) const {}
void Ranks::work(const structure::StudyTask&, const structure::StudyRun&) const {}

}  // namespace topple::app

#else

#include <mpi.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <deque>
#include <exception>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace topple::app {

namespace {

using structure::Sample;
using structure::StudyJournal;
using structure::StudyRun;
using structure::StudyTask;

constexpr int results_tag = 1, numbers_tag = 2;

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

/// Samples still to be handed out: so many at a time that they take about a tenth of a second, and towards the end so
/// few that all ranks end together.
class Handout {
 public:
  Handout(const StudyTask& task, const StudyRun& run, const StudyJournal& journal, int takers)
      : run_(run), takers_(static_cast<std::size_t>(takers)), chunk_(takers_, 1) {
    for (std::uint64_t k = run.from; k < std::min(run.to, task.sampler.samples()); ++k)
      if (!journal.has(k)) missing_.push_back(k);
  }
  /// `seconds`: that the taker's last ones took; below 0: it had none.
  std::vector<std::uint64_t> next(std::size_t taker, double seconds) {
    const std::lock_guard lock(mutex_);
    if (run_.stopped && run_.stopped()) return {};
    constexpr std::size_t most = 512;
    constexpr double short_time = 0.03, long_time = 0.2;  // s
    std::size_t& chunk = chunk_[taker];
    if (seconds >= 0 && seconds < short_time) chunk = std::min(2 * chunk, most);
    if (seconds > long_time) chunk = std::max<std::size_t>(chunk / 2, 1);
    const std::size_t left = missing_.size() - at_;
    const std::size_t count = std::min({chunk, left, left / (2 * takers_) + 1});
    const auto from = missing_.begin() + static_cast<std::ptrdiff_t>(at_);
    at_ += count;
    return {from, from + static_cast<std::ptrdiff_t>(count)};
  }
  [[nodiscard]] std::size_t all() const { return missing_.size(); }

 private:
  const StudyRun& run_;
  std::size_t takers_;
  std::vector<std::size_t> chunk_;
  std::vector<std::uint64_t> missing_;
  std::size_t at_ = 0;
  std::mutex mutex_;
};

struct Line {
  std::uint64_t sample = 0;
  double seconds = 0;
  std::string text;
};

Line line_of(const StudyTask& task, structure::SampleEvaluator& evaluator, std::uint64_t k) {
  const Sample sample = structure::run_sample(task, evaluator, k);
  return {k, sample.seconds, structure::journal_line(task, sample)};
}

/// Lines as bytes: seconds of all, then number, seconds, length and text of each.
std::string packed(double seconds, const std::vector<Line>& lines) {
  std::string bytes;
  const auto put = [&](auto value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof value); };
  put(seconds);
  for (const Line& line : lines) {
    put(line.sample);
    put(line.seconds);
    put(static_cast<std::uint64_t>(line.text.size()));
    bytes += line.text;
  }
  return bytes;
}

std::pair<double, std::vector<Line> > unpacked(const std::string& bytes) {
  std::size_t at = 0;
  const auto get = [&](auto& value) {
    std::memcpy(&value, bytes.data() + at, sizeof value);
    at += sizeof value;
  };
  std::pair<double, std::vector<Line> > result;
  get(result.first);
  while (at < bytes.size()) {
    Line& line = result.second.emplace_back();
    std::uint64_t length = 0;
    get(line.sample);
    get(line.seconds);
    get(length);
    line.text = bytes.substr(at, length);
    at += length;
  }
  return result;
}

/// The threads of rank 0 that compute; what they have made waits here to be written.
class OwnSamples {
 public:
  OwnSamples(const StudyTask& task, Handout& handout, int threads) : running_(threads) {
    for (int t = 0; t < threads; ++t)
      threads_.emplace_back([this, &task, &handout, t] { compute(task, handout, static_cast<std::size_t>(t)); });
  }
  OwnSamples(const OwnSamples&) = delete;
  OwnSamples& operator=(const OwnSamples&) = delete;
  ~OwnSamples() {
    for (std::jthread& thread : threads_) thread.join();
  }
  [[nodiscard]] std::deque<Line> extract() {
    const std::lock_guard lock(mutex_);
    return std::exchange(made_, {});
  }
  [[nodiscard]] bool running() {
    const std::lock_guard lock(mutex_);
    if (failure_) std::rethrow_exception(failure_);
    return running_ > 0 || !made_.empty();
  }

 private:
  void compute(const StudyTask& task, Handout& handout, std::size_t taker) {
    try {
      const auto evaluator = task.make_evaluator();
      double seconds = -1;
      for (auto numbers = handout.next(taker, seconds); !numbers.empty(); numbers = handout.next(taker, seconds)) {
        const double start = now();
        for (const std::uint64_t k : numbers) {
          Line line = line_of(task, *evaluator, k);
          const std::lock_guard lock(mutex_);
          made_.push_back(std::move(line));
        }
        seconds = now() - start;
      }
    } catch (...) {
      const std::lock_guard lock(mutex_);
      failure_ = std::current_exception();
    }
    const std::lock_guard lock(mutex_);
    --running_;
  }

  std::mutex mutex_;
  std::deque<Line> made_;
  std::exception_ptr failure_;
  int running_;
  std::vector<std::jthread> threads_;
};

/// Receives one message of results if there is one; its rank, or -1.
int receive(std::string& bytes) {
  int there = 0;
  MPI_Status status;
  MPI_Iprobe(MPI_ANY_SOURCE, results_tag, MPI_COMM_WORLD, &there, &status);
  if (!there) return -1;
  int size = 0;
  MPI_Get_count(&status, MPI_BYTE, &size);
  bytes.resize(static_cast<std::size_t>(size));
  MPI_Recv(bytes.data(), size, MPI_BYTE, status.MPI_SOURCE, results_tag, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  return status.MPI_SOURCE;
}

[[noreturn]] void end_job(const std::exception& error) {
  std::fprintf(stderr, "topple: %s\n", error.what());
  MPI_Abort(MPI_COMM_WORLD, 1);
  std::abort();
}

}  // namespace

Ranks::Ranks() {
  int provided = 0;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &size_);
}

Ranks::~Ranks() { MPI_Finalize(); }

bool Ranks::together(const std::function<void()>& work) const {
  std::exception_ptr own;
  std::string told;
  try {
    work();
  } catch (const std::exception& error) {
    own = std::current_exception();
    told = error.what();
  }
  // The first rank on which it failed tells.
  int first = own ? rank_ : size_;
  MPI_Allreduce(MPI_IN_PLACE, &first, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
  if (first == size_) return true;
  int length = static_cast<int>(told.size());
  MPI_Bcast(&length, 1, MPI_INT, first, MPI_COMM_WORLD);
  told.resize(static_cast<std::size_t>(length));
  MPI_Bcast(told.data(), length, MPI_BYTE, first, MPI_COMM_WORLD);
  if (rank_ != 0) return false;
  if (own) std::rethrow_exception(own);
  throw structure::InputError("rank " + std::to_string(first) + ": " + told);
}

bool Ranks::same_on_all(std::uint64_t fingerprint) const {
  std::array<std::uint64_t, 2> range{fingerprint, ~fingerprint};
  MPI_Allreduce(MPI_IN_PLACE, range.data(), 2, MPI_UINT64_T, MPI_MIN, MPI_COMM_WORLD);
  if (range[0] == ~range[1]) return true;
  if (rank_ == 0)
    throw structure::InputError(
        "ranks have read different files: the study, model or scenario is not the same on all machines");
  return false;
}

void Ranks::run_workers(const StudyTask& task, const StudyRun& run, StudyJournal& journal) const {
  const int threads = std::max(1, run.threads);
  Handout handout(task, run, journal, threads + size_ - 1);
  std::uint64_t done = 0;
  const auto write = [&](const Line& line, const std::string& where) {
    journal.add_line(line.sample, line.text, line.seconds, where);
    if (run.progress) run.progress(++done, handout.all());
  };
  try {
    OwnSamples own(task, handout, threads);
    int working = size_ - 1;
    std::string bytes;
    while (working > 0 || own.running()) {
      const std::deque<Line> mine = own.extract();
      for (const Line& line : mine) write(line, "rank 0");
      const int from = receive(bytes);
      if (from >= 0) {
        const auto [seconds, lines] = unpacked(bytes);
        // The next ones first: the rank works while its last ones are written.
        const auto numbers = handout.next(static_cast<std::size_t>(threads + from - 1), lines.empty() ? -1 : seconds);
        MPI_Send(numbers.data(), static_cast<int>(numbers.size()), MPI_UINT64_T, from, numbers_tag, MPI_COMM_WORLD);
        if (numbers.empty()) --working;
        for (const Line& line : lines) write(line, "rank " + std::to_string(from));
      } else if (mine.empty()) {
        // Waiting in MPI would keep a processor busy that computes samples.
        std::this_thread::sleep_for(std::chrono::microseconds(100));
      }
    }
    journal.sync();
  } catch (const std::exception& error) {
    end_job(error);
  }
}

void Ranks::work(const StudyTask& task, const StudyRun& run) const {
  try {
    const int threads = std::max(1, run.threads);
    std::vector<std::unique_ptr<structure::SampleEvaluator> > evaluators(static_cast<std::size_t>(threads));
    std::vector<Line> lines;
    double seconds = 0;
    for (;;) {
      const std::string bytes = packed(seconds, lines);
      MPI_Send(bytes.data(), static_cast<int>(bytes.size()), MPI_BYTE, 0, results_tag, MPI_COMM_WORLD);
      MPI_Status status;
      MPI_Probe(0, numbers_tag, MPI_COMM_WORLD, &status);
      int count = 0;
      MPI_Get_count(&status, MPI_UINT64_T, &count);
      std::vector<std::uint64_t> numbers(static_cast<std::size_t>(count));
      MPI_Recv(numbers.data(), count, MPI_UINT64_T, 0, numbers_tag, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
      if (numbers.empty()) return;
      const double start = now();
      lines.assign(numbers.size(), {});
      std::exception_ptr failure;
      std::mutex mutex;
      const auto compute = [&](std::size_t t) {
        try {
          if (!evaluators[t]) evaluators[t] = task.make_evaluator();
          for (std::size_t i = t; i < numbers.size(); i += evaluators.size())
            lines[i] = line_of(task, *evaluators[t], numbers[i]);
        } catch (...) {
          const std::lock_guard lock(mutex);
          failure = std::current_exception();
        }
      };
      {
        std::vector<std::jthread> beside;
        for (std::size_t t = 1; t < evaluators.size(); ++t) beside.emplace_back(compute, t);
        compute(0);
      }
      if (failure) std::rethrow_exception(failure);
      seconds = now() - start;
    }
  } catch (const std::exception& error) {
    end_job(error);
  }
}

}  // namespace topple::app

#endif
