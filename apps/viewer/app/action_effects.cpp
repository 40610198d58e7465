// What the actions of a script mean that are more than one call of the controller.
#include <map>

#include "app/actions.h"
#include "topple/structure/error.h"

namespace topple::viewer {
namespace {

using Settings = std::map<std::string, double*>;

Settings settings_of(ToolKind kind, Controller& c) {
  switch (kind) {
    case ToolKind::fire:
      return {{"speed", &c.shot.speed}, {"mass", &c.shot.mass}, {"radius", &c.shot.radius}};
    case ToolKind::swing:
      return {
          {"cable", &c.swing.cable}, {"angle", &c.swing.angle}, {"mass", &c.swing.mass}, {"radius", &c.swing.radius}};
    case ToolKind::charge:
      return {{"reach", &c.charge_radius}};
    case ToolKind::explosion:
      return {{"charge", &c.explosive}};
    case ToolKind::burn:
      return {{"reach", &c.burning.reach},
              {"over", &c.burning.over},
              {"strength", &c.burning.strength},
              {"stiffness", &c.burning.stiffness}};
    case ToolKind::thermite:
      return {{"over", &c.thermite_over}};
    case ToolKind::hook:
      return {{"force", &c.hauling.force}, {"over", &c.hauling.over}};
    default:
      return {};
  }
}

}  // namespace

void take(const ToolAction& tool, Controller& controller) {
  const Settings known = settings_of(tool.kind, controller);
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
  controller.tool = tool.kind;
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
