// topple analyse: static analysis of a model, summary on the terminal, files on request.
#if __has_include(<malloc.h>)
#include <malloc.h>
#endif
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <iterator>
#include <memory>

#include "analyse_options.h"
#include "command.h"
#include "html_report.h"
#include "motion_options.h"
#include "progress.h"
#include "topple/structure/analysis.h"
#include "topple/structure/direct_analysis.h"
#include "topple/structure/error.h"
#include "topple/structure/formats/files.h"
#include "topple/structure/formats/input_files.h"
#include "topple/structure/formats/output_files.h"
#include "topple/structure/member_checks.h"
#include "topple/structure/modelling_checks.h"

namespace topple::app {

namespace {

using namespace topple::structure;

/// Seconds by stage, in the order of their names.
class StageClock {
 public:
  void stop(const std::string& stage) {
    const auto now = std::chrono::steady_clock::now();
    seconds[stage] += std::chrono::duration<double>(now - last_).count();
    last_ = now;
  }
  std::map<std::string, double> seconds;

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

/// The smallest multiple of `stations` that is not below `wanted`.
int whole_multiple(int stations, int wanted) {
  return stations == 0 ? wanted : stations * std::max(1, (wanted + stations - 1) / stations);
}

/// A file's text and tree are free again, but scattered: without this they would stand under the factor at the peak.
void give_back_free_memory() {
#if defined(__GLIBC__)
  malloc_trim(0);
#endif
}

/// What moves, as results.json and in the drawings that are asked for.
void write_diagnosis(const AnalyseOptions& options, const Building& building, const AnalysisRequest& request,
                     const Diagnosis& diagnosis) {
  std::vector<std::pair<std::string, std::string>> files;
  files.emplace_back("results.json", diagnosis_json(building, request, diagnosis));
  if (options.html) files.emplace_back("report.html", html_report(building, {}, files[0].second));
  if (options.vtu)
    for (auto& file : diagnosis_vtu(building, diagnosis)) files.push_back(std::move(file));
  write_files(options.output, files);
}

/// Names of files that a run may write.
const std::vector<std::string>& result_names() {
  static const std::vector<std::string> names{"results.json", "report.html", "*.csv", "*.vtu"};
  return names;
}

void write_answer(const AnalyseOptions& options, const Building& building, const AnalysisRequest& request,
                  const AnalysisResult& result, const DesignInput& design,
                  const std::map<std::string, double>& seconds) {
  report_progress("writing", -1);
  std::vector<std::pair<std::string, std::string>> files;
  std::vector<StreamedFile> streamed;
  const bool sample = building.members.size() > most_members_whole;
  if (options.html && !sample) {
    files.emplace_back("results.json", results_json(building, request, result, seconds));
    files.emplace_back("report.html",
                       html_report(building, result, files[0].second, {options.project, options.author, design}));
  } else {
    streamed.push_back(
        {"results.json", [&](const auto& sink) { write_results_json(building, request, result, seconds, sink); }});
  }
  if (options.html && sample) {
    const ResultsSelection selection = select_members(building, result, members_selected, selected_of_section);
    files.emplace_back("report.html",
                       html_report(building, result, results_json(building, request, result, seconds, selection),
                                   {options.project, options.author, design}, &selection));
  }
  const auto append = [&](NamedTexts more) { std::move(more.begin(), more.end(), std::back_inserter(files)); };
  if (options.csv) append(results_csv(building, result));
  if (options.vtu) append(results_vtu(building, result));
  append(motion_csv(building, request, result));
  write_files(options.output, files, streamed);
}

/// Stations and sections that reports, drawings and design checks look at, beside those that were asked for.
AnalysisRequest with_all_that_is_written(const AnalyseOptions& options, const AnalysisRequest& request) {
  AnalysisRequest wider = request;
  const int wanted = std::max({options.html ? report_stations : 0, options.vtu ? drawing_stations : 0,
                               options.code.empty() ? 0 : design_stations});
  wider.stations = whole_multiple(request.stations, wanted);
  wider.critical_sections = !options.code.empty();
  wider.progress = report_progress;
  return wider;
}

/// `yielded`: stiffness that direct analysis with tau_b found.
AnalysisResult answer(const AnalyseOptions& options, const Building& building, const AnalysisRequest& request,
                      std::vector<YieldedStiffness>& yielded) {
  if (options.direct_analysis != "tau-b")
    return analyse(options.direct_analysis.empty() ? building : with_reduced_stiffness(building), request);
  DirectAnalysis found = analyse_directly(building, request);
  yielded = std::move(found.yielded);
  return std::move(found.result);
}

int run(const AnalyseOptions& options) {
  require_sound(options);
  StageClock clock;
  const std::filesystem::path file = find_model(options.model);
  std::optional<OutputFolder> folder;
  if (!options.output.empty()) folder.emplace(options.output, model_files(file), result_names());
  report_progress("reading", -1);
  Building read = read_model(file);
  for (std::string& warning : modelling_warnings(read)) read.warnings.push_back(std::move(warning));
  const bool direct = !options.direct_analysis.empty(), computes_tau_b = options.direct_analysis == "tau-b";
  const double share = computes_tau_b ? out_of_plumb : out_of_plumb + in_place_of_tau_b;
  const Building building = direct ? with_notional_loads(read, combinations_of(read, options), share) : std::move(read);
  give_back_free_memory();
  clock.stop("read");
  const AnalysisRequest request = analysis_request(options, file, building);
  const AnalysisRequest wider = with_all_that_is_written(options, request);
  // Kept to the end of the process, which gives it back at once: piece by piece that takes longer than a solve.
  static AnalysisResult result;
  std::vector<YieldedStiffness> yielded;
  std::optional<UnstableAnalysis> failed;  // some combinations; the others are written all the same
  try {
    result = answer(options, building, wider, yielded);
  } catch (const UnstableAnalysis& unstable) {
    if (options.diagnose) write_diagnosis(options, building, request, unstable.diagnosis);
    if (!unstable.partial) throw;
    failed = unstable;
    result = std::move(*unstable.partial);
  }
  clock.stop("analyse");
  if (result.combinations.empty() && (options.html || options.vtu || !options.code.empty()))
    throw InputError(building.file + ": " + result.warnings.back() +
                     "; accepted: no --html, --vtu and --code, which are about combinations");
  DesignInput design = design_input(options, building);
  design.yielded = std::move(yielded);
  if (!options.code.empty()) {
    report_progress("design checks", -1);
    const DesignCode code = options.code == "en1993" ? DesignCode::en1993 : DesignCode::aisc360;
    check_design(building, code, options.drift_limit ? 1 / *options.drift_limit : usual_drift_limit, result, design);
    clock.stop("design");
  }
  clock.seconds["order"] = result.statistics.order_seconds;
  clock.seconds["assemble"] = result.statistics.assemble_seconds;
  clock.seconds["factor"] = result.statistics.factor_seconds;
  clock.seconds["solve"] = result.statistics.solve_seconds;
  if (request.losses.any() || request.time_history) clock.seconds["losses"] = result.loss_seconds;
  if (!options.output.empty() && !(failed && options.diagnose)) {  // else results.json holds what moves
    write_answer(options, building, request, result, design, clock.seconds);
    clock.stop("write");
  }
  std::fputs(summary_text(building, result, clock.seconds).c_str(), stdout);
  if (options.output.empty())
    std::puts("more: -o DIR writes results.json; --csv, --vtu, --html add tables and drawings");
  if (failed) throw *failed;
  return success;
}

void declare_design(CLI::App& app, AnalyseOptions& options) {
  app.add_option("--code", options.code, "Check every member by EN 1993-1-1 or AISC 360")
      ->check(CLI::IsMember({"en1993", "aisc360"}));
  app.add_option("--effective-lengths", options.effective_lengths,
                 "With --code: automatic (charts; with --buckling its modes), charts, or assumed (posts sway)")
      ->check(CLI::IsMember({"automatic", "charts", "assumed"}));
  app.add_option("--stiffeners", options.stiffeners,
                 "With --code: NAME=SPACING of transverse stiffeners, by member, pattern or group")
      ->expected(1)
      ->take_all();
  app.add_flag("--direct-analysis{notional}", options.direct_analysis,
               "With --code aisc360 --p-delta: notional loads, reduced stiffness and K = 1 (AISC 360 chapter C); with "
               "=tau-b, tau_b from the axial forces")
      ->check(CLI::IsMember({"notional", "tau-b"}));
  app.add_flag("--rigid-end-posts", options.rigid_end_posts, "With --code en1993: rigid end posts of webs");
  app.add_option("--warping", options.warping, "With --code: warping at members' ends, free or held (else the worst)")
      ->check(CLI::IsMember({"free", "held"}));
  app.add_option("--drift-limit", options.drift_limit, "With --code: limit of the storey drift, height/N")
      ->check(in_range({0, 1e6, true}));
}

void declare_modes(CLI::App& app, AnalyseOptions& options) {
  app.add_option("--modes", options.modes, "Lowest natural frequencies and modes")->check(whole_number(1, 100000));
  app.add_option("--divide", options.divide,
                 "With --modes: elements of every member in the modes, which then swing by themselves as well (1)")
      ->check(whole_number(1, 64));
  app.add_option("--mass", options.mass, "Mass of elements: consistent (default) or lumped")
      ->check(CLI::IsMember({"consistent", "lumped"}));
  app.add_option("--torsional-mass", options.torsional_mass,
                 "Spin of members about their axes: density x polar moment (default) or density x J")
      ->check(CLI::IsMember({"polar", "j"}));
  app.add_flag("--rotary-inertia", options.rotary_inertia, "Rotary inertia of members' sections in bending");
}

std::function<int()> declare(CLI::App& app) {
  auto options = std::make_shared<AnalyseOptions>();
  app.add_option("MODEL", options->model, "A shipped model's name, a file (.json, .3dd), or a folder of tables (.csv)")
      ->required();
  app.add_option("-o", options->output, "Folder for results.json and the other files");
  app.add_option("--combination", options->combinations, "Combination to analyse (all, when none is named)")
      ->expected(1)
      ->take_all();
  app.add_option("--stations", options->stations, "Stations along each member in results.json")
      ->check(whole_number(1, 10000));
  app.add_option("--threads", options->threads, "Threads (else one for each processor); they change no number")
      ->check(whole_number(1, 1024));
  app.add_option("--factor", options->factor,
                 "Whose factorisation: multifrontal (ours, the default) or cholmod; answers agree to rounding")
      ->check(CLI::IsMember({"multifrontal", "cholmod"}));
  app.add_flag("--p-delta{exact}", options->p_delta,
               "Second order: exact (stability functions) or, with =cubic, the cubic geometric stiffness")
      ->check(CLI::IsMember({"exact", "cubic"}));
  app.add_option("--buckling", options->buckling, "Lowest buckling factors of each combination")
      ->check(whole_number(1, 1000));
  declare_design(app, *options);
  app.add_option("--lose", options->lose, "Member to lose suddenly, alone, with the whole state after it")
      ->expected(1)
      ->take_all();
  app.add_option("--lose-each", options->lose_each, "Group whose members are lost one at a time, with what is worst")
      ->expected(1)
      ->take_all();
  app.add_option("--sudden", options->sudden, "Factor f of a sudden loss: R0 + f (R1 - R0); 1 is the static state")
      ->check(in_range(structure::ranges::sudden));
  app.add_option("--cuts", options->cuts,
                 "JSON file of planes: resultants of all that passes each of them, beside the model's own `cuts`");
  declare_motion_options(app, options->motion);
  declare_modes(app, *options);
  app.add_flag("--csv", options->csv, "Write tables: displacements, reactions, members, joints, panels");
  app.add_flag("--vtu", options->vtu, "Write COMBINATION.vtu for ParaView");
  app.add_flag("--diagnose", options->diagnose,
               "Where the model is not stable, write what moves (results.json, and with --vtu, --html its drawing)");
  app.add_flag("--html", options->html, "Write report.html");
  app.add_option("--project", options->project, "Name of the project on the report's cover");
  app.add_option("--author", options->author, "Author on the report's cover");
  return [options] { return run(*options); };
}

const Registration registration({"analyse", "Analyse a model statically", declare});

}  // namespace
}  // namespace topple::app
