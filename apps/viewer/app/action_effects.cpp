// What the actions of a script mean that are more than one call of the controller.
#include <map>

#include "app/actions.h"
#include "topple/structure/error.h"

namespace topple::viewer {
namespace {

using Settings = std::map<std::string, double*>;

Settings settings_of(ToolKind kind, Hand& hand) {
  switch (kind) {
    case ToolKind::fire:
      return {{"speed", &hand.shot.speed}, {"mass", &hand.shot.mass}, {"radius", &hand.shot.radius}};
    case ToolKind::swing:
      return {{"cable", &hand.swing.cable},
              {"angle", &hand.swing.angle},
              {"mass", &hand.swing.mass},
              {"radius", &hand.swing.radius}};
    case ToolKind::charge:
      return {{"reach", &hand.charge_radius}};
    case ToolKind::explosion:
      return {{"charge", &hand.explosive}};
    case ToolKind::burn:
      return {{"reach", &hand.burning.reach},
              {"over", &hand.burning.over},
              {"strength", &hand.burning.strength},
              {"stiffness", &hand.burning.stiffness}};
    case ToolKind::thermite:
      return {{"over", &hand.thermite_over}};
    case ToolKind::hook:
      return {{"force", &hand.hauling.force}, {"over", &hand.hauling.over}};
    default:
      return {};
  }
}

}  // namespace

void pick_up(const ToolAction& tool, Hand& hand) {
  const Settings known = settings_of(tool.kind, hand);
  for (const auto& [name, value] : tool.settings) {
    const auto setting = known.find(name);
    if (setting == known.end()) {
      std::string accepted;
      for (const auto& [key, unused] : known) accepted += (accepted.empty() ? "" : ", ") + key;
      throw structure::InputError(std::string("tool \"") + tool_names[static_cast<std::size_t>(tool.kind)] +
                                  "\": no setting '" + name + "'; accepted: " + (accepted.empty() ? "none" : accepted));
    }
    *setting->second = value;
  }
  hand.tool = tool.kind;
}

RunRules rules_of(const RestartAction& restart, const Scene& scene) {
  RunRules rules{scene.scenario.failure, scene.scenario.fracture, nullptr};
  rules.failure.bracing = restart.bracing.value_or(rules.failure.bracing);
  rules.failure.mechanism = restart.mechanism.value_or(rules.failure.mechanism);
  rules.failure.sudden = restart.sudden.value_or(rules.failure.sudden);
  rules.failure.second_order = restart.second_order.value_or(rules.failure.second_order);
  if (restart.panels_stay_whole) rules.fracture.reset();
  if (restart.fracture) {
    if (!rules.fracture) rules.fracture.emplace();
    rules.fracture->method = *restart.fracture;
  }
  if (restart.cell && rules.fracture) rules.fracture->cell = *restart.cell;
  if (!restart.materials.empty()) rules.building = building_with_strengths(scene, restart.materials);
  return rules;
}

}  // namespace topple::viewer
