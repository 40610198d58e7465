#pragma once
// Studies on many machines: ranks of MPI take samples as they become free, rank 0 writes.
#include <functional>

#include "topple/structure/study/study.h"

namespace topple::app {

/// True where mpirun (or srun with PMI) has started this process as one of several. MPI is initialised for no other.
[[nodiscard]] bool started_on_ranks();

/// The processes of one job. Throws InputError where this program was built without MPI.
class Ranks {
 public:
  Ranks();
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;
  ~Ranks();
  [[nodiscard]] int rank() const { return rank_; }
  [[nodiscard]] int size() const { return size_; }

  /// Does `work` on every rank. Where it throws on any, rank 0 throws (its own, else what the first has told), and the
  /// others return false, so that one line is told.
  [[nodiscard]] bool together(const std::function<void()>& work) const;
  /// Throws InputError on rank 0 when ranks read other files than it did; false on all of them then.
  [[nodiscard]] bool same_on_all(std::uint64_t fingerprint) const;
  /// Rank 0: hands out what the journal lacks, a few samples at a time, and writes what comes back; computes samples
  /// itself on `run.threads` threads (0: one) beside. Ends the job when the journal cannot be written.
  void run_workers(const structure::StudyTask& task, const structure::StudyRun& run,
                   structure::StudyJournal& journal) const;
  /// The others: computes what rank 0 hands out until there is no more.
  void work(const structure::StudyTask& task, const structure::StudyRun& run) const;

 private:
  int rank_ = 0, size_ = 1;
};

}  // namespace topple::app
