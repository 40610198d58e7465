// The journal of a study, and studies over a function of the host's own.
#include <sys/stat.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "support/scratch_folder.h"
#include "topple/structure/error.h"
#include "topple/structure/study/study.h"

using namespace topple::structure;

namespace {

/// Square of the one input; fails where that is below 0.1.
class Square : public SampleEvaluator {
 public:
  void evaluate(Sample& sample) override {
    const double x = sample.inputs[0].number;
    if (x < 0.1) throw std::runtime_error("too \"small\"\nfor it");
    sample.outputs = {x * x, x > 0.9 ? std::numeric_limits<double>::quiet_NaN() : 1 / x};
    sample.parts = "0f";
  }
};

StudyTask squares(std::uint64_t samples = 50) {
  Distribution d;
  d.low = 0;
  d.high = 1;
  StudyTask task;
  task.sampler = StudySampler({{"x", d}}, {}, Sampling::latin, samples, 11);
  task.outputs = {"square", "inverse"};
  task.fingerprint = 17;
  task.make_evaluator = [] { return std::make_unique<Square>(); };
  return task;
}

std::string text_of(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

}  // namespace

TEST_CASE("What is no file where a study keeps its journal is refused, and nothing waits for it") {
  const StudyTask task = squares();
  for (const std::string name : {"journal.jsonl", "times.csv"})
    for (const std::string kind : {"pipe", "folder", "device", "loop"}) {
      CAPTURE(name, kind);
      const topple::test::ScratchFolder folder;
      const std::filesystem::path place = folder / name;
      if (kind == "pipe") REQUIRE(mkfifo(place.c_str(), 0600) == 0);
      if (kind == "folder") std::filesystem::create_directory(place);
      if (kind == "device") std::filesystem::create_symlink("/dev/full", place);
      if (kind == "loop") std::filesystem::create_symlink(name, place);
      CHECK_THROWS_AS(StudyJournal(task, folder.path(), StudyJournal::Found::resume), InputError);
    }
}

TEST_CASE("A line of the journal reads back to the same bits, and shows each change of a byte") {
  const StudyTask task = squares();
  const auto evaluator = task.make_evaluator();
  for (std::uint64_t k = 0; k < 50; ++k) {
    const Sample sample = run_sample(task, *evaluator, k);
    const std::string line = journal_line(task, sample);
    const auto read = read_journal_line(task, line);
    REQUIRE(read);
    CHECK(journal_line(task, *read) == line);
    CHECK(read->inputs[0].number == sample.inputs[0].number);
    CHECK(read->failed == sample.failed);
    CHECK(sample.failed.find('\n') == std::string::npos);
    CHECK(read->outputs.size() == sample.outputs.size());
    if (k > 3) continue;
    for (std::size_t i = 0; i < line.size(); ++i) {
      std::string damaged = line;
      damaged[i] ^= 1;
      CHECK_FALSE(read_journal_line(task, damaged));
    }
  }
}

TEST_CASE("A journal takes in what is there, drops half a line, and refuses what is damaged or of another study") {
  const topple::test::ScratchFolder folder;
  StudyTask task = squares();
  {
    StudyJournal journal(task, folder.path(), StudyJournal::Found::refuse);
    StudyRun run;
    run.threads = 2;
    run_samples(task, run, journal);
  }
  CHECK_THROWS_AS(StudyJournal(task, folder.path(), StudyJournal::Found::refuse), InputError);
  const std::filesystem::path file = folder.path() / "journal.jsonl";
  const std::string whole = text_of(file);
  std::ofstream(file, std::ios::trunc) << whole.substr(0, whole.size() - 20);
  {
    StudyJournal journal(task, folder.path(), StudyJournal::Found::resume);
    CHECK(journal.found().size() == 49);
    StudyRun run;
    run.threads = 1;
    run_samples(task, run, journal);
  }
  CHECK(text_of(file) == whole);  // the one that was cut is the last
  {
    task.fingerprint = 18;
    CHECK_THROWS_AS(StudyJournal(task, folder.path(), StudyJournal::Found::resume), InputError);
    task.fingerprint = 17;
  }
  std::string damaged = whole;
  damaged[whole.size() / 2] ^= 4;
  std::ofstream(file, std::ios::trunc) << damaged;
  CHECK_THROWS_AS(StudyJournal(task, folder.path(), StudyJournal::Found::resume), InputError);
}

TEST_CASE("Samples that failed are taken for done, and run once more where that is asked for") {
  const topple::test::ScratchFolder folder;
  StudyTask task = squares();
  StudyRun run;
  run.threads = 1;
  const auto failed = [&](const std::vector<Sample>& samples) {
    return std::count_if(samples.begin(), samples.end(), [](const Sample& one) { return !one.failed.empty(); });
  };
  {
    StudyJournal journal(task, folder.path(), StudyJournal::Found::refuse);
    run_samples(task, run, journal);
  }
  const std::filesystem::path file = folder.path() / "journal.jsonl";
  const std::string first = text_of(file);
  {
    StudyJournal journal(task, folder.path(), StudyJournal::Found::resume);
    CHECK(journal.found().size() == 50);
    CHECK(failed(journal.found()) == 5);
    run_samples(task, run, journal);
  }
  CHECK(text_of(file) == first);  // nothing is missing
  std::size_t again = 0;
  task.make_evaluator = [&]() -> std::unique_ptr<SampleEvaluator> {
    struct Mended : SampleEvaluator {
      std::size_t& again;
      explicit Mended(std::size_t& count) : again(count) {}
      void evaluate(Sample& sample) override {
        ++again;
        sample.outputs = {sample.inputs[0].number, 0};
      }
    };
    return std::make_unique<Mended>(again);
  };
  {
    StudyJournal journal(task, folder.path(), StudyJournal::Found::retry_failed);
    CHECK(journal.found().size() == 45);
    run_samples(task, run, journal);
  }
  CHECK(again == 5);
  CHECK(text_of(file).starts_with(first));  // nothing is taken back
  const StudyJournal journal(task, folder.path(), StudyJournal::Found::resume);
  CHECK(journal.found().size() == 50);
  CHECK(failed(journal.found()) == 0);
}

TEST_CASE("A study over a function gives the same samples for any number of threads") {
  const StudyTask task = squares(500);
  StudyRun one, three;
  one.threads = 1;
  three.threads = 3;
  const auto a = run_samples(task, one), b = run_samples(task, three);
  REQUIRE(a.size() == 500);
  REQUIRE(b.size() == 500);
  std::size_t failed = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    CHECK(journal_line(task, a[i]) == journal_line(task, b[i]));
    failed += !a[i].failed.empty();
  }
  CHECK(failed == 50);  // a Latin hypercube has a tenth of its samples in the lowest tenth
}

TEST_CASE("A run of samples ends where it is stopped") {
  const StudyTask task = squares();
  StudyRun run;
  run.threads = 1;
  std::uint64_t done = 0;
  run.progress = [&](std::uint64_t so_far, std::uint64_t) { done = so_far; };
  run.stopped = [&] { return done >= 7; };
  CHECK(run_samples(task, run).size() == 7);
}
