// topple check MODEL: reads a model, says what is in it and what can be done with it.
#include <cstdio>

#include "command.h"
#include "topple/structure/error.h"
#include "topple/structure/files.h"

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
}

void print_readiness(const Building& building, structure::Purpose purpose, const char* command) {
  try {
    structure::refuse_unbuilt(building, purpose);
    std::printf("  %s: ready\n", command);
  } catch (const structure::InputError& error) {
    std::printf("  %s: %s\n", command, error.what());
  }
}

int check(const std::string& model) {
  const Building building = structure::read_model(structure::find_model(model), structure::Purpose::inspect);
  print_contents(building);
  print_readiness(building, structure::Purpose::analyse, "analyse");
  print_readiness(building, structure::Purpose::demolish, "demolish");
  return success;
}

const Registration registration({"check", "Read a model and say what is in it",
                                 [](CLI::App& app) -> std::function<int()> {
                                   auto model = std::make_shared<std::string>();
                                   app.add_option("MODEL", *model, "A shipped model's name, or a file")->required();
                                   return [model] { return check(*model); };
                                 }});

}  // namespace

}  // namespace topple::app
