// topple demolish SCENARIO: runs a collapse without a window, as fast as it can.
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <sstream>

#include "command.h"
#include "image_sequence.h"
#include "progress.h"
#include "topple/structure/collapse_animation.h"
#include "topple/structure/collapse_report.h"
#include "topple/structure/error.h"
#include "topple/structure/formats/files.h"
#include "topple/structure/formats/output_files.h"
#include "topple/structure/snapshot.h"
#include "topple/structure/state_store.h"
#include "topple/structure/visual_mesh.h"

namespace topple::app {

namespace {

struct DemolishOptions {
  std::string scenario, folder;
  int threads = 1;
  bool images = false, gltf = false;
  double rate = 30;
  std::vector<double> save;
  std::string resume;
};

/// How far the run is: on a terminal a line that is rewritten every so many steps, elsewhere a line now and then.
class Progress {
 public:
  void show(const structure::Simulation& simulation) {
    if (simulation.steps() % 30 != 0) return;
    if (terminal_)
      std::fprintf(stderr, "\r%8.2f s  %zu bodies  %zu events ", simulation.time(), simulation.bodies().size(),
                   simulation.events().size());
    else
      report_progress("demolishing", simulation.time() / simulation.scenario().duration);
  }
  ~Progress() {
    if (terminal_) std::fprintf(stderr, "\r\033[K");
  }

 private:
  bool terminal_ = isatty(STDERR_FILENO) != 0;
};

/// At once where the state is kept that the snapshot leads to, else by doing again what was done.
void resume(structure::Simulation& simulation, const std::string& file) {
  const structure::Snapshot snapshot = structure::read_snapshot(file);
  if (const auto states = structure::StateStore::of_user(); states && states->load(snapshot, simulation)) return;
  try {
    simulation.restore(snapshot);
  } catch (const structure::InputError& error) {
    throw structure::InputError(file + ": " + error.what());
  }
}

/// The snapshots of --save, each at the end of the first step that reaches its time.
class Saves {
 public:
  Saves(const DemolishOptions& options, const structure::Simulation& simulation)
      : folder_(options.folder), due_(options.save) {
    std::sort(due_.begin(), due_.end());
    due_.erase(std::unique(due_.begin(), due_.end()), due_.end());
    if (simulation.steps() > 0)  // those before a resumed moment are past
      std::erase_if(due_, [&](double at) { return at < simulation.time(); });
    else
      write_due(simulation);
  }

  void write_due(const structure::Simulation& simulation) {
    constexpr double rounding = 1e-9;  // s: a time counts as reached this much early
    for (; next_ < due_.size() && due_[next_] <= simulation.time() + rounding; ++next_) {
      std::ostringstream name;
      name << "snapshot-" << due_[next_] << ".topple";
      structure::write_file(folder_ / name.str(), structure::snapshot_bytes(simulation.save()));
      if (states_) (void)states_->keep(simulation);
    }
  }

  void print_missed(const structure::Simulation& simulation) const {
    for (std::size_t i = next_; i < due_.size(); ++i)
      std::fprintf(stderr, "topple: --save %g: the run ended before, at %g s\n", due_[i], simulation.time());
  }

 private:
  std::filesystem::path folder_;
  std::optional<structure::StateStore> states_ = structure::StateStore::of_user();
  std::vector<double> due_;
  std::size_t next_ = 0;
};

/// Names of files that a run may write.
const std::vector<std::string>& result_names() {
  static const std::vector<std::string> names{"events.jsonl", "summary.json", "standing.json",    "meshes.glb",
                                              "collapse.glb", "frame-*.png",  "snapshot-*.topple"};
  return names;
}

std::vector<std::filesystem::path> inputs(const DemolishOptions& options, const std::filesystem::path& scenario) {
  std::vector<std::filesystem::path> files{scenario};
  if (!options.resume.empty()) files.emplace_back(options.resume);
  return files;
}

int demolish(const DemolishOptions& options) {
  const std::pair<bool, const char*> into_folder[] = {
      {options.images, "--images"}, {options.gltf, "--gltf"}, {!options.save.empty(), "--save"}};
  for (const auto& [asked, name] : into_folder)
    if (asked && options.folder.empty()) throw structure::InputError(std::string(name) + ": -o DIR must say where");
  const std::filesystem::path file = structure::find_scenario(options.scenario);
  std::optional<structure::OutputFolder> results;
  if (!options.folder.empty()) results.emplace(options.folder, inputs(options, file), result_names());
  auto [building, scenario] = structure::read_scenario(file);
  structure::Simulation simulation(std::move(building), std::move(scenario), {options.threads, {}});
  const double roof_sag = simulation.frame().roof_sag();
  std::optional<structure::VisualMesh> drawn;
  if (!options.folder.empty())
    if (auto meshes = structure::read_drawn_meshes(
            simulation.building(), structure::find_model(simulation.scenario().model, file.parent_path()));
        !meshes.empty())
      drawn.emplace(simulation.building(), std::move(meshes));
  if (!options.resume.empty()) resume(simulation, options.resume);
  Saves saves(options, simulation);
  structure::StepTimes times;
  std::optional<ImageSequence> images;
  structure::VisualMesh* const around = drawn ? &*drawn : nullptr;
  if (around) around->update(simulation);
  if (options.images) images.emplace(simulation, options.folder, options.rate, around);
  if (images) images->write_due(simulation);
  std::optional<structure::CollapseAnimation> animation;
  if (options.gltf) animation.emplace(simulation, options.rate, around);
  {
    Progress progress;
    while (!simulation.finished()) {
      simulation.skip_idle();
      if (images) images->write_due(simulation);
      if (animation) animation->add_due(simulation);
      saves.write_due(simulation);
      simulation.step();
      if (drawn) drawn->update(simulation);
      if (images) images->write_due(simulation);
      if (animation) animation->add_due(simulation);
      saves.write_due(simulation);
      times.add(simulation);
      progress.show(simulation);
    }
  }
  if (!options.folder.empty()) structure::write_collapse(options.folder, simulation, times, roof_sag);
  if (drawn) structure::write_files(options.folder, {{"meshes.glb", structure::visual_mesh_glb(*drawn, simulation)}});
  if (animation) structure::write_files(options.folder, {{"collapse.glb", animation->glb()}});
  if (images) images->finish(*results);
  saves.print_missed(simulation);
  std::fputs(structure::collapse_text(simulation, times).c_str(), stdout);
  if (options.folder.empty()) std::fputs("  files:  none; -o FOLDER writes what happened and what stands\n", stdout);
  return success;
}

const Registration registration{
    {"demolish", "Run a scenario: what breaks, what falls, what stands", [](CLI::App& app) {
       auto options = std::make_shared<DemolishOptions>();
       app.add_option("SCENARIO", options->scenario, "Scenario: a shipped one's name, or a file")->required();
       app.add_option("-o,--output", options->folder, "Folder for events.jsonl, summary.json and standing.json");
       app.add_flag("--images", options->images, "Draw frame-00000.png and so on into the folder");
       app.add_flag("--gltf", options->gltf, "Write the collapse as an animation, collapse.glb, into the folder");
       app.add_option("--rate", options->rate, "Frames for each simulated second of both")
           ->check(in_range(structure::ranges::rate));
       app.add_option("--save", options->save, "Write snapshot-SECONDS.topple into the folder at this time")
           ->allow_extra_args(false)
           ->check(in_range(structure::ranges::instant));
       app.add_option("--resume", options->resume, "Go on from a snapshot of the same scenario");
       app.add_option("--threads", options->threads, "Threads of statics and debris; they change no number")
           ->check(whole_number(1, 256));
       return [options] { return demolish(*options); };
     }}};

}  // namespace
}  // namespace topple::app
