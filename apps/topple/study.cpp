// topple study: many samples of an analysis or a collapse, their distribution, and what it hangs on.
#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdio>

#include "command.h"
#include "progress.h"
#include "topple/structure/error.h"
#include "topple/structure/output_files.h"
#include "topple/structure/study.h"

namespace topple::app {

namespace {

struct StudyOptions {
  std::string study, folder, samples;
  int threads = 0;
  bool resume = false;
};

std::atomic<bool> interrupted{false};
void interrupt(int) { interrupted = true; }

/// "A:B", either of which may be left out.
structure::StudyRun range_of(const std::string& text, std::uint64_t samples) {
  structure::StudyRun run;
  run.to = samples;
  if (text.empty()) return run;
  const std::size_t colon = text.find(':');
  const auto bound = [&](const std::string& part, std::uint64_t absent) {
    if (part.empty()) return absent;
    if (part.size() > 15 || part.find_first_not_of("0123456789") != std::string::npos) return ~std::uint64_t{0};
    return static_cast<std::uint64_t>(std::stoull(part));
  };
  if (colon != std::string::npos) {
    run.from = bound(text.substr(0, colon), 0);
    run.to = bound(text.substr(colon + 1), samples);
  }
  if (colon == std::string::npos || run.from >= run.to || run.to > samples)
    throw structure::InputError("--samples " + text + ": accepted: A:B, samples from A up to B, without B, of 0 to " +
                                std::to_string(samples));
  return run;
}

std::vector<structure::Sample> sorted(std::vector<structure::Sample> samples) {
  std::sort(samples.begin(), samples.end(),
            [](const structure::Sample& a, const structure::Sample& b) { return a.number < b.number; });
  return samples;
}

int study(const StudyOptions& options) {
  const std::filesystem::path file = structure::find_study(options.study);
  const structure::Study study = structure::read_study(file);
  const structure::StudyTask task = structure::study_task(study);
  structure::StudyRun run = range_of(options.samples, task.sampler.samples());
  run.threads = options.threads;
  const structure::OutputFolder folder(options.folder, {file}, {"journal.jsonl", "times.csv", "samples.csv"});
  {
    structure::StudyJournal journal(task, options.folder, options.resume);
    run.stopped = [] { return interrupted.load(); };
    run.progress = [](std::uint64_t done, std::uint64_t all) {
      tell_progress("samples", static_cast<double>(done) / static_cast<double>(all));
    };
    std::signal(SIGINT, interrupt);
    std::signal(SIGTERM, interrupt);
    structure::run_samples(task, run, journal);
  }
  const structure::StudyJournal journal(task, options.folder, true);
  const std::vector<structure::Sample> samples = sorted(journal.found());
  structure::write_files(options.folder, {{"samples.csv", structure::samples_csv(task, samples)}});
  const auto failed = std::count_if(samples.begin(), samples.end(), [](const auto& s) { return !s.failed.empty(); });
  std::printf("%s: %zu of %llu samples, %td failed\n", study.title.empty() ? study.file.c_str() : study.title.c_str(),
              samples.size(), static_cast<unsigned long long>(task.sampler.samples()), failed);
  return interrupted ? failure : success;
}

const Registration registration{
    {"study", "Run many samples of a model or scenario and tell their distribution", [](CLI::App& app) {
       auto options = std::make_shared<StudyOptions>();
       app.add_option("STUDY", options->study, "Study: a shipped one's name, or a file")->required();
       app.add_option("-o,--output", options->folder, "Folder for journal.jsonl, samples.csv, study.json")->required();
       app.add_option("--samples", options->samples, "Only samples A:B, from A up to B, without B");
       app.add_flag("--resume", options->resume, "Go on with the journal in the folder: only what is missing");
       app.add_option("--threads", options->threads, "Samples at once; every processor without it")
           ->check(whole_number(1, 1024));
       return [options] { return study(*options); };
     }}};

}  // namespace
}  // namespace topple::app
