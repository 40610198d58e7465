// stress_reanalysis [FRAMES [CHANGES [FIRST]]]: random frames (1000, numbered from FIRST) that change at random (100
// times each), every answer against a fresh analysis, every mechanism against its verdict. One process
// for each core takes every so manieth frame.
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <thread>
#include <vector>

#include "solver/changing_frame.h"

using namespace topple::test;

namespace {

struct Share {
  ChangeTally tally;
  long frames = 0, large = 0;  ///< of 5,000 freedoms or more
  long failures = 0;
};

Share follow_frames(unsigned first, unsigned frames, unsigned step, int changes) {
  constexpr std::size_t freedoms_of_large = 5000;
  constexpr long most_told = 20;
  Share share;
  for (unsigned n = first; n < frames; n += step) {
    std::string fault;
    try {
      ChangingFrame frame = numbered_frame(n);
      ++share.frames;
      if (6 * frame.standing->model().nodes.size() >= freedoms_of_large) ++share.large;
      fault = follow(frame, changes, share.tally);
    } catch (const std::exception& error) {
      fault = std::string("ends with: ") + error.what();
    }
    if (fault.empty() || ++share.failures > most_told) continue;
    std::printf("frame %u, %s\n", n, fault.c_str());
    std::fflush(stdout);
  }
  return share;
}

void add(const Share& one, Share& sum) {
  sum.frames += one.frames;
  sum.large += one.large;
  sum.failures += one.failures;
  ChangeTally& t = sum.tally;
  t.answers += one.tally.answers;
  t.mechanisms += one.tally.mechanisms;
  t.splits += one.tally.splits;
  t.in_warning_band += one.tally.in_warning_band;
  t.difference = std::max(t.difference, one.tally.difference);
  t.work.unchanged += one.tally.work.unchanged;
  t.work.load_solves += one.tally.work.load_solves;
  t.work.low_rank += one.tally.work.low_rank;
  t.work.refactorisations += one.tally.work.refactorisations;
}

/// One process, whose share comes back through a pipe.
struct Worker {
  pid_t process = -1;
  int result = -1;
};

Worker start(unsigned first, unsigned frames, unsigned step, int changes) {
  int ends[2];
  if (pipe(ends) != 0) throw std::runtime_error("no pipe");
  const pid_t process = fork();
  if (process < 0) throw std::runtime_error("no process");
  if (process > 0) {
    close(ends[1]);
    return {process, ends[0]};
  }
  close(ends[0]);
  const Share share = follow_frames(first, frames, step, changes);
  const bool told = write(ends[1], &share, sizeof share) == static_cast<ssize_t>(sizeof share);
  _exit(told ? 0 : 1);
}

bool finish(const Worker& worker, Share& sum) {
  Share share;
  const bool told = read(worker.result, &share, sizeof share) == static_cast<ssize_t>(sizeof share);
  int status = 0;
  const bool ended = waitpid(worker.process, &status, 0) == worker.process && status == 0;
  if (told && ended) add(share, sum);
  return told && ended;
}

void print_row(const char* what, unsigned long long count, long asked) {
  std::printf("  %-44s %9llu   (asked: %ld)\n", what, count, asked);
}

}  // namespace

int main(int argc, char** argv) {
  const int frames = argc > 1 ? std::atoi(argv[1]) : 1000, changes = argc > 2 ? std::atoi(argv[2]) : 100;
  const unsigned first = argc > 3 ? static_cast<unsigned>(std::atoi(argv[3])) : 0;
  if (frames < 1 || changes < 1) {
    std::fprintf(stderr, "usage: stress_reanalysis [FRAMES [CHANGES [FIRST]]]\n");
    return 2;
  }
  const unsigned step = std::max(1u, std::min(std::thread::hardware_concurrency(), static_cast<unsigned>(frames)));
  std::vector<Worker> workers;
  for (unsigned w = 0; w < step; ++w)
    workers.push_back(start(first + w, first + static_cast<unsigned>(frames), step, changes));
  Share sum;
  bool all = true;
  for (const Worker& worker : workers) all = finish(worker, sum) && all;
  const ChangeTally& t = sum.tally;
  const auto count = [](auto value) { return static_cast<unsigned long long>(value); };
  std::printf("%ld frames, %d changes each\n", sum.frames, changes);
  print_row("frames of 5,000 freedoms or more", count(sum.large), frames / 10);
  print_row("answers compared with fresh ones", count(t.answers), static_cast<long>(frames) * changes);
  print_row("nothing changed", t.work.unchanged, 1000);
  print_row("only loads", t.work.load_solves, 1000);
  print_row("low-rank corrections", t.work.low_rank, 1000);
  print_row("new factors", t.work.refactorisations, 1000);
  print_row("mechanisms", count(t.mechanisms), 1000);
  print_row("of them parts that split off", count(t.splits), 1000);
  std::printf("  %-44s %9ld\n", "states in the warning band", t.in_warning_band);
  std::printf("largest difference %.2g of what is allowed; %ld failures%s\n", t.difference, sum.failures,
              all ? "" : "; a process did not end well");
  return all && sum.failures == 0 ? 0 : 1;
}
