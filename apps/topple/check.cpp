// topple check FILE: reads a model, scenario, panel or study, says what is in it and what can be done with it.
#include <array>
#include <cstdio>
#include <variant>

#include "command.h"
#include "topple/structure/analysis.h"
#include "topple/structure/error.h"
#include "topple/structure/formats/files.h"
#include "topple/structure/formats/panel_file.h"
#include "topple/structure/formats/plain_text.h"
#include "topple/structure/modelling_checks.h"
#include "topple/structure/simulation.h"
#include "topple/structure/study/study.h"
#include "topple/structure/study/study_optimise.h"
#include "topple/structure/visual_mesh.h"

namespace topple::app {

namespace {

using structure::Building;

void print_contents(const Building& building) {
  std::size_t posts = 0, beams = 0, braces = 0, slabs = 0, walls = 0, breakable = 0;
  for (const auto& member : building.members) {
    if (member.kind == structure::MemberKind::post) ++posts;
    if (member.kind == structure::MemberKind::beam) ++beams;
    if (member.kind == structure::MemberKind::brace) ++braces;
  }
  for (const auto& panel : building.panels) ++(panel.kind == structure::PanelKind::slab ? slabs : walls);
  for (const auto& joint : building.joints) breakable += joint.capacity.breakable ? 1 : 0;
  std::printf("%s: %s\n", building.file.c_str(), building.title.empty() ? "(no title)" : building.title.c_str());
  std::printf("  %zu nodes, %zu supported\n", building.nodes.size(),
              building.supports.size() + building.edge_supports.size());
  std::printf("  %zu members: %zu posts, %zu beams, %zu braces\n", building.members.size(), posts, beams, braces);
  std::printf("  %zu panels: %zu slabs, %zu walls\n", building.panels.size(), slabs, walls);
  std::printf("  %zu joints, %zu of them can break\n", building.joints.size(), breakable);
  std::printf("  %zu materials, %zu sections, %zu load cases\n", building.materials.size(), building.sections.size(),
              building.cases.size());
  std::printf("  combinations:");
  for (const auto& combination : building.combinations) std::printf(" \"%s\"", combination.name.c_str());
  std::printf("\n");
  for (const std::string& warning : building.warnings) std::printf("  warning: %s\n", warning.c_str());
  for (const std::string& warning : structure::modelling_warnings(building))
    std::printf("  warning: %s\n", warning.c_str());
}

/// Only what would run is ready: the first combination is solved.
void try_one_combination(const Building& building) {
  structure::AnalysisRequest request;
  request.combinations = {structure::CombinationId(std::size_t{0})};
  (void)structure::analyse(building, request);
}

void print_outcome(const char* command, const std::function<void()>& needed) {
  try {
    needed();
    std::printf("  %s: ready\n", command);
  } catch (const std::exception& error) {
    std::printf("  %s: %s\n", command, structure::one_line(error.what()).c_str());
  }
}

/// Ready is what all files are there for, those that the model names included.
void print_readiness(const Building& building, const std::filesystem::path& file) {
  const auto drawings = [&] { (void)structure::read_drawn_meshes(building, file); };
  bool drawn = true;
  try {
    drawings();
  } catch (const structure::InputError&) {
    drawn = false;
  }
  std::string unstable;  // a collapse begins with the same structure, standing
  print_outcome("analyse", [&] {
    structure::refuse_unbuilt(building, structure::Purpose::analyse);
    try {
      try_one_combination(building);
    } catch (const structure::UnstableModel& moves) {
      unstable = moves.what();
      throw;
    }
    // Drawings count in an analysis by their weight alone.
    if (!drawn) (void)structure::read_model(file, structure::Purpose::analyse);
  });
  print_outcome("demolish", [&] {
    structure::refuse_unbuilt(building, structure::Purpose::demolish);
    if (!drawn) drawings();
    if (!unstable.empty()) throw structure::UnstableModel(unstable);
  });
}

int check_model(const std::filesystem::path& file) {
  const Building building = structure::read_model(file, structure::Purpose::inspect);
  print_contents(building);
  print_readiness(building, file);
  return success;
}

const char* tool_name(const structure::Tool& tool) {
  // In the order of the alternatives of structure::Tool.
  static constexpr std::array names{"projectile", "wrecking_ball", "cut",     "remove",
                                    "charge",     "weaken",        "gravity", "load"};
  static_assert(names.size() == std::variant_size_v<structure::Tool>);
  return names[tool.index()];
}

int check_scenario(const std::filesystem::path& file) {
  const auto [building, scenario] = structure::read_scenario(file);
  std::printf("%s: %s\n", scenario.file.c_str(), scenario.title.empty() ? "(no title)" : scenario.title.c_str());
  std::printf("  model \"%s\", combination \"%s\"\n", scenario.model.c_str(),
              building[*scenario.combination].name.c_str());
  std::printf("  steps of %g s for %g s%s\n", scenario.step, scenario.duration,
              scenario.until_rest ? ", or until all is at rest" : "");
  std::printf("  %zu events\n", scenario.events.size());
  for (const structure::Event& event : scenario.events)
    std::printf("    at %g s: %s\n", event.at, tool_name(event.tool));
  print_outcome("demolish", [&, &b = building, &s = scenario] {
    (void)structure::read_drawn_meshes(b, structure::find_model(s.model, file.parent_path()));
    (void)structure::Simulation(b, s);  // what only model and scenario together can tell
  });
  return success;
}

int check_panel(const std::filesystem::path& file) {
  const structure::PanelFile panel = structure::read_panel(file);
  std::printf("%s: a panel\n", panel.file.c_str());
  std::printf("  %zu corners, %zu openings, %g m thick, %g kg/m3\n", panel.shape.outline.size(),
              panel.shape.openings.size(), panel.shape.thickness, panel.density);
  std::printf("  %zu hits\n  fracture: ready\n", panel.hits.size());
  return success;
}

int check_study(const std::filesystem::path& file) {
  const structure::Study study = structure::read_study(file);
  const structure::StudyTask task =
      study.optimise ? structure::StudyOptimiser(study).task() : structure::study_task(study);
  std::printf("%s: %s\n", study.file.c_str(), study.title.empty() ? "(no title)" : study.title.c_str());
  std::printf("  %llu samples of %zu variables\n", static_cast<unsigned long long>(task.sampler.samples()),
              task.sampler.variables().size());
  std::printf("  records:");
  for (const std::string& output : task.outputs) std::printf(" \"%s\"", output.c_str());
  std::printf("\n");
  print_outcome("study", [&] {
    const structure::Sample first = structure::run_sample(task, *task.make_evaluator(), 0);
    if (!first.failed.empty()) throw std::runtime_error("sample 0: " + first.failed);
  });
  return success;
}

/// A path, or what is shipped by this name: a model, else a scenario, else a panel, else a study.
std::filesystem::path find_any(const std::string& name) {
  try {
    return structure::find_model(name);
  } catch (const structure::InputError&) {
    for (const auto find : {structure::find_scenario, structure::find_panel, structure::find_study}) try {
        return find(name);
      } catch (const structure::InputError&) {
        continue;
      }
    throw;  // what models there are
  }
}

int check(const std::string& name) {
  const std::filesystem::path file = find_any(name);
  if (structure::is_scenario(file)) return check_scenario(file);
  if (structure::is_study(file)) return check_study(file);
  if (structure::is_panel(file)) return check_panel(file);
  return check_model(file);
}

const Registration registration(
    {"check", "Read a model, scenario, panel or study and say what is in it",
     [](CLI::App& app) -> std::function<int()> {
       auto model = std::make_shared<std::string>();
       app.add_option("MODEL", *model, "A shipped model's, scenario's, panel's or study's name, or a file")->required();
       return [model] { return check(*model); };
     }});

}  // namespace

}  // namespace topple::app
