// topple study: many samples of an analysis or a collapse, their distribution, and what it hangs on.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <memory>
#include <optional>

#include "command.h"
#include "progress.h"
#include "study_page.h"
#include "study_ranks.h"
#include "topple/structure/error.h"
#include "topple/structure/formats/files.h"
#include "topple/structure/formats/json_tree.h"
#include "topple/structure/formats/output_files.h"
#include "topple/structure/study/study.h"
#include "topple/structure/study/study_optimise.h"

namespace topple::app {

namespace {

struct StudyOptions {
  std::string study, folder, samples;
  int threads = 0;
  bool resume = false, retry_failed = false, html = false;
};

using Found = structure::StudyJournal::Found;
Found found_of(const StudyOptions& options) {
  if (options.retry_failed) return Found::retry_failed;
  return options.resume ? Found::resume : Found::refuse;
}

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

/// What a run is about; the same on every rank.
struct Prepared {
  std::filesystem::path file;
  structure::Study study;
  structure::StudyTask task;
  structure::StudyRun run;
};

void set_run(const StudyOptions& options, Prepared& all) {
  all.run = range_of(options.samples, all.task.sampler.samples());
  all.run.threads = options.threads;
  all.run.stopped = [] { return interrupted.load(); };
  all.run.progress = [](std::uint64_t done, std::uint64_t count) {
    report_progress("samples", static_cast<double>(done) / static_cast<double>(count));
  };
  std::signal(SIGINT, interrupt);
  std::signal(SIGTERM, interrupt);
}

Prepared prepared(const StudyOptions& options) {
  Prepared all;
  all.file = structure::find_study(options.study);
  all.study = structure::read_study(all.file);
  all.task = structure::study_task(all.study);
  set_run(options, all);
  return all;
}

const std::vector<std::string>& result_names() {
  static const std::vector<std::string> names{"journal.jsonl", "times.csv", "samples.csv", "study.json", "study.html"};
  return names;
}

std::optional<structure::Building> building_of(const structure::Study& study) {
  if (study.base == structure::Study::Base::scenario) return structure::read_scenario(study.scenario).first;
  if (study.base == structure::Study::Base::model) return structure::read_model(study.model);
  return std::nullopt;
}

using structure::OptimiseResult;

/// The answer of an optimisation as a part of study.json.
structure::JsonTree answer_json(const Prepared& all, const OptimiseResult& result) {
  using Json = structure::JsonTree;
  const auto design_json = [&](const structure::StudyDesign& design) {
    Json inputs = Json::object(), outputs = Json::object();
    for (std::size_t v = 0; v < design.chosen.size(); ++v)
      inputs[result.chosen_names[v]] =
          design.chosen[v].is_number() ? Json(design.chosen[v].number) : Json::parse(design.chosen[v].json);
    for (std::size_t i = 0; i < design.outputs.size(); ++i) outputs[all.task.outputs[i]] = design.outputs[i];
    return Json{{"run", design.run}, {"feasible", design.violation == 0}, {"inputs", inputs}, {"outputs", outputs}};
  };
  Json json = {{"method", result.method}, {"runs", result.designs.size()}, {"finished", result.finished}};
  if (result.designs.empty()) return json;
  json["best"] = design_json(result.best);
  Json history = Json::array();
  for (const structure::StudyDesign& design : result.designs) history.push_back({design.objective, design.violation});
  json["history"] = std::move(history);
  for (const structure::StudyDesign& design : result.finalists) json["finalists"].push_back(design_json(design));
  return json;
}

/// From the journal as it is now: the table, the statistics, the page.
int write_results(const StudyOptions& options, const Prepared& all, const OptimiseResult* answer = nullptr) {
  const std::vector<structure::Sample> journal =
      sorted(structure::StudyJournal(all.task, options.folder, Found::resume).found());
  // Of an optimisation the statistics are those of its answer.
  const std::vector<structure::Sample>& samples = answer ? answer->unseen : journal;
  const std::optional<structure::Building> building = building_of(all.study);
  const structure::Building* base = building ? &*building : nullptr;
  structure::StudyStatistics statistics = structure::study_statistics(all.study, all.task, samples, base);
  if (answer) statistics.planned = static_cast<std::size_t>(all.study.optimise->unseen);
  const std::string json = structure::study_json(all.study, all.task, samples, statistics, base,
                                                 answer ? answer_json(all, *answer) : structure::JsonTree());
  structure::NamedFiles files{{"samples.csv", structure::samples_csv(all.task, journal)}, {"study.json", json}};
  if (options.html)
    files.emplace_back("study.html", study_page(all.study, all.task, samples, statistics, base,
                                                answer ? chosen_section(all.study, all.task, *answer) : ""));
  structure::write_files(options.folder, files);
  std::printf("%s: ", all.study.title.empty() ? all.study.file.c_str() : all.study.title.c_str());
  if (answer) {
    const auto failed =
        std::count_if(journal.begin(), journal.end(), [](const auto& one) { return !one.failed.empty(); });
    std::printf("%zu of %d designs tried, %zu runs failed\n", answer->designs.size(), all.study.optimise->runs,
                static_cast<std::size_t>(failed));
    if (statistics.done > 0)
      std::printf("  the best one on %zu unseen samples, %zu failed:\n", statistics.done, statistics.failed);
  } else {
    std::printf("%zu of %zu samples, %zu failed\n", statistics.done, statistics.planned, statistics.failed);
  }
  for (const structure::OutputStatistics& output : statistics.outputs) {
    if (output.count == 0) continue;
    std::printf("  %-24s mean %-12.5g deviation %-12.5g %.5g to %.5g\n", output.name.c_str(), output.mean, output.sd,
                output.least, output.largest);
  }
  if (statistics.collapse) {
    const structure::Interval wilson = statistics.collapse->wilson();
    std::printf("  collapse in %.2f %% of the samples (95 %% interval: %.2f to %.2f %%)\n",
                100 * statistics.collapse->share(), 100 * wilson[0], 100 * wilson[1]);
  }
  if (interrupted) std::printf("interrupted: --resume goes on\n");
  return interrupted ? failure : success;
}

/// One of the processes of mpirun.
int study_on_ranks(const StudyOptions& options) {
  const Ranks ranks;
  Prepared all;
  std::optional<structure::OutputFolder> folder;
  std::unique_ptr<structure::StudyJournal> journal;
  const bool ready = ranks.together([&] {
    if (options.threads > 1)
      throw structure::InputError(
          "--threads: each process of mpirun computes one sample at a time; accepted: more of them");
    all = prepared(options);
    if (all.study.optimise)
      throw structure::InputError(all.study.file +
                                  ": an optimisation runs in one process, on its threads, as each generation waits for "
                                  "the one before; accepted: a start without mpirun");
    if (ranks.rank() != 0) return;
    folder.emplace(options.folder, std::vector{all.file}, result_names());
    journal = std::make_unique<structure::StudyJournal>(all.task, options.folder, found_of(options));
  });
  // Rank 0 tells, and its status is the job's: mpirun ends all ranks as soon as one ends with an error, and one of
  // these could end before rank 0 has written what is wrong.
  if (!ready || !ranks.same_on_all(all.task.fingerprint)) return success;
  if (ranks.rank() != 0) {
    ranks.work(all.task, all.run);
    return success;
  }
  ranks.run_workers(all.task, all.run, *journal);
  journal.reset();
  return write_results(options, all);
}

void print_answer(const Prepared& all, const OptimiseResult& result) {
  if (result.designs.empty()) return;
  std::printf("  best of %zu designs (%s), run %llu%s:\n", result.designs.size(), result.method.c_str(),
              static_cast<unsigned long long>(result.best.run),
              result.best.violation == 0 ? "" : ", which does not keep to all bounds");
  for (std::size_t v = 0; v < result.best.chosen.size(); ++v) {
    const structure::StudyValue& value = result.best.chosen[v];
    std::printf("    %-28s %s\n", result.chosen_names[v].c_str(),
                value.is_number() ? std::to_string(value.number).c_str() : value.json.c_str());
  }
  for (std::size_t i = 0; i < result.best.outputs.size(); ++i)
    if (const double output = result.best.outputs[i]; std::isfinite(output))
      std::printf("    -> %-25s %.6g\n", all.task.outputs[i].c_str(), output);
    else  // what this design does not have, or whose runs failed
      std::printf("    -> %-25s no number\n", all.task.outputs[i].c_str());
}

int optimise(const StudyOptions& options) {
  if (!options.samples.empty())
    throw structure::InputError("--samples: an optimisation has no slices; accepted: a study without \"optimise\"");
  Prepared all;
  all.file = structure::find_study(options.study);
  all.study = structure::read_study(all.file);
  const structure::StudyOptimiser optimiser(all.study);
  all.task = optimiser.task();
  set_run(options, all);
  const structure::OutputFolder folder(options.folder, {all.file}, result_names());
  OptimiseResult result;
  {
    structure::StudyJournal journal(all.task, options.folder, found_of(options));
    result = optimiser.run(all.run, journal);
  }
  const int status = write_results(options, all, &result);
  print_answer(all, result);
  return status;
}

int study(const StudyOptions& options) {
  if (started_on_ranks()) return study_on_ranks(options);
  if (structure::read_study(structure::find_study(options.study)).optimise) return optimise(options);
  const Prepared all = prepared(options);
  const structure::OutputFolder folder(options.folder, {all.file}, result_names());
  {
    structure::StudyJournal journal(all.task, options.folder, found_of(options));
    structure::run_samples(all.task, all.run, journal);
  }
  return write_results(options, all);
}

const Registration registration{
    {"study", "Run many samples of a model or scenario and tell their distribution", [](CLI::App& app) {
       auto options = std::make_shared<StudyOptions>();
       app.add_option("STUDY", options->study, "Study: a shipped one's name, or a file")->required();
       app.add_option("-o,--output", options->folder, "Folder for journal.jsonl, samples.csv, study.json")->required();
       app.add_option("--samples", options->samples, "Only samples A:B, from A up to B, without B");
       app.add_flag("--resume", options->resume, "Go on with the journal in the folder: only what is missing");
       app.add_flag("--retry-failed", options->retry_failed,
                    "Go on like --resume, and run samples that failed once more");
       app.add_flag("--html", options->html, "Write study.html as well, a page with figures that print");
       app.add_option("--threads", options->threads,
                      "Samples at once; without it every processor (one in each process of mpirun)")
           ->check(whole_number(1, 1024));
       return [options] { return study(*options); };
     }}};

}  // namespace
}  // namespace topple::app
