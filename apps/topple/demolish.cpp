// topple demolish SCENARIO: runs a collapse without a window, as fast as it can.
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>

#include "command.h"
#include "image_sequence.h"
#include "topple/structure/collapse_report.h"
#include "topple/structure/drawn_model.h"
#include "topple/structure/error.h"
#include "topple/structure/files.h"
#include "write_files.h"

namespace topple::app {

namespace {

struct DemolishOptions {
  std::string scenario, folder;
  int threads = 1;
  bool images = false;
  double rate = 30;
};

/// A line on a terminal, rewritten every so many steps; nothing when standard error goes elsewhere.
class Progress {
 public:
  void show(const structure::Simulation& simulation) {
    if (!terminal_ || simulation.steps() % 30 != 0) return;
    std::fprintf(stderr, "\r%8.2f s  %zu bodies  %zu events ", simulation.time(), simulation.bodies().size(),
                 simulation.events().size());
  }
  ~Progress() {
    if (terminal_) std::fprintf(stderr, "\r\033[K");
  }

 private:
  bool terminal_ = isatty(STDERR_FILENO) != 0;
};

int demolish(const DemolishOptions& options) {
  if (options.images && options.folder.empty()) throw structure::InputError("--images: -o DIR must say where");
  const std::filesystem::path file = structure::find_scenario(options.scenario);
  auto [building, scenario] = structure::read_scenario(file);
  structure::Simulation simulation(std::move(building), std::move(scenario), {options.threads, {}});
  const double roof_sag = simulation.frame().roof_sag();
  std::optional<structure::DrawnModel> drawn;
  if (!options.folder.empty())
    if (auto meshes = structure::read_drawn_meshes(
            simulation.building(), structure::find_model(simulation.scenario().model, file.parent_path()));
        !meshes.empty())
      drawn.emplace(simulation.building(), std::move(meshes));
  structure::StepTimes times;
  std::optional<ImageSequence> images;
  if (options.images) images.emplace(simulation, options.folder, options.rate);
  if (images) images->write_due(simulation);
  {
    Progress progress;
    while (!simulation.finished()) {
      simulation.skip_idle();
      if (images) images->write_due(simulation);
      simulation.step();
      if (drawn) drawn->update(simulation);
      if (images) images->write_due(simulation);
      times.add(simulation);
      progress.show(simulation);
    }
  }
  if (!options.folder.empty()) structure::write_collapse(options.folder, simulation, times, roof_sag);
  if (drawn) write_files(options.folder, {{"meshes.glb", structure::drawn_model_glb(*drawn, simulation)}});
  std::fputs(structure::collapse_text(simulation, times).c_str(), stdout);
  return success;
}

const Registration registration{
    {"demolish", "Run a scenario: what breaks, what falls, what stands", [](CLI::App& app) {
       auto options = std::make_shared<DemolishOptions>();
       app.add_option("SCENARIO", options->scenario, "Scenario: a shipped one's name, or a file")->required();
       app.add_option("-o,--output", options->folder, "Folder for events.jsonl, summary.json and standing.json");
       app.add_flag("--images", options->images, "Draw frame-00000.png and so on into the folder");
       app.add_option("--rate", options->rate, "Pictures for each simulated second")->check(CLI::PositiveNumber);
       app.add_option("--threads", options->threads, "Threads of the solver")->check(CLI::Range(1, 256));
       return [options] { return demolish(*options); };
     }}};

}  // namespace
}  // namespace topple::app
