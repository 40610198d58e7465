// What is told of one part: under the pointer, and in the panel.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "app/side_panel.h"
#include "app/widgets.h"

namespace topple::viewer {
namespace {

using structure::Sense;

const structure::JointCapacity& capacity_now(const Controller& controller, const Snapshot& moment,
                                             structure::JointId joint) {
  return joint_capacity(controller.building(), moment, joint);
}

/// The sense that a component of this sign is held against.
Sense sense_of(int component, double demand) {
  if (component == 0) return demand < 0 ? Sense::compression : Sense::tension;
  return static_cast<Sense>(component + 1);
}

/// `strength`: what is left of the capacity.
void component_row(int component, double demand, const structure::JointCapacity& capacity, double strength, bool edge) {
  constexpr const char* names[] = {"N ", "Vy", "Vz", "T ", "My", "Mz"};
  const char* unit = component < 3 ? (edge ? "kN/m" : "kN  ") : (edge ? "kN  " : "kN m");
  const double limit = strength * capacity.value[static_cast<std::size_t>(sense_of(component, demand))];
  if (!capacity.breakable || !std::isfinite(limit))
    ImGui::Text("%s %10.2f %s", names[component], demand / 1e3, unit);
  else
    ImGui::Text("%s %10.2f / %9.1f %s %5.1f %%", names[component], demand / 1e3, limit / 1e3, unit,
                100 * std::abs(demand) / limit);
}

}  // namespace

std::string part_text(const structure::Building& building, structure::JointId id) {
  const structure::Joint& joint = building[id];
  char text[256];
  if (joint.member.valid()) {
    const auto& member = building[joint.member];
    constexpr const char* kinds[] = {"post", "beam", "brace"};
    std::snprintf(text, sizeof text, "%s: %s, section %s, %s, %.2f m", member.name.c_str(),
                  kinds[static_cast<std::size_t>(member.kind)], building[member.section].name.c_str(),
                  building[member.material].name.c_str(), member.length);
  } else {
    const auto& panel = building[joint.panel];
    std::snprintf(text, sizeof text, "%s: %s, %.0f mm, %s", panel.name.c_str(),
                  panel.kind == structure::PanelKind::slab ? "slab" : "wall", 1000 * panel.thickness,
                  building[panel.material].name.c_str());
  }
  return text;
}

std::vector<std::string> yield_text(const Snapshot& moment, structure::JointId joint) {
  std::vector<std::string> lines;
  for (const structure::PlasticRotation& one : moment.answer->plastic_rotations) {
    if (one.joint != joint) continue;
    char text[128];
    std::snprintf(text, sizeof text, "%s turned plastically by %.4f of %.4f rad",
                  structure::sense_names[static_cast<std::size_t>(one.sense)], std::abs(one.turned), one.limit);
    lines.emplace_back(text);
  }
  return lines;
}

void draw_joint(Controller& controller, const Snapshot& moment, structure::JointId id, bool with_history) {
  const TableFont columns;
  const auto& joint = moment.answer->joints[static_cast<std::size_t>(id.index)];
  const char* state = !joint.intact ? "failed" : joint.standing ? "" : "part of a body";
  ImGui::Text("joint %s %s", controller.building()[id].name.c_str(), state);
  if (joint.intact && joint.standing) {
    const structure::JointCapacity& capacity = capacity_now(controller, moment, id);
    if (capacity.breakable)
      ImGui::Text("utilisation %.1f %% (%s)", 100.0 * static_cast<double>(joint.utilisation),
                  structure::sense_names[static_cast<std::size_t>(joint.sense)]);
    else
      ImGui::TextUnformatted("never breaks");
    if (capacity.breakable && joint.strength < 0.9995F)
      ImGui::Text("weakened: %.1f %% of its capacity is left", 100.0 * static_cast<double>(joint.strength));
    for (const std::string& line : yield_text(moment, id)) ImGui::TextUnformatted(line.c_str());
    const bool edge = controller.building()[id].panel.valid();
    for (int c = 0; c < 6; ++c)
      component_row(c, static_cast<double>(joint.demand[static_cast<std::size_t>(c)]), capacity,
                    static_cast<double>(joint.strength), edge);
  }
  if (!with_history) return;
  const auto history = controller.driver().recording().history(id);
  if (history.size() < 2) return;
  std::vector<float> values;
  for (const auto& point : history) values.push_back(100 * point[1]);
  const auto begin = static_cast<double>(history.front()[0]), end = static_cast<double>(history.back()[0]);
  ImGui::Text("up to %.1f %%, %.1f to %.1f s", static_cast<double>(*std::max_element(values.begin(), values.end())),
              begin, end);
  const auto clicked = plot_line("##history", values, "", 5 * ImGui::GetFontSize(),
                                 static_cast<float>((moment.time - begin) / std::max(end - begin, 1e-9)));
  if (clicked) controller.playback().seek(begin + (end - begin) * static_cast<double>(*clicked));
}

namespace {

void draw_short(const FrameAnswer::Joint& joint) {
  const TableFont columns;
  if (!joint.standing) return ImGui::TextUnformatted("part of a body");
  if (!joint.intact) return ImGui::TextUnformatted("its nearest joint failed");
  ImGui::Text("utilisation %.1f %%", 100.0 * static_cast<double>(joint.utilisation));
}

}  // namespace

void draw_hover_text(Controller& controller, const Snapshot& moment) {
  const auto& hovered = controller.hovered();
  if (!hovered || !hovered->joint.valid() || ImGui::GetIO().WantCaptureMouse || controller.window.asks_to_leave) return;
  const ImVec2 display = ImGui::GetIO().DisplaySize, pointer = ImGui::GetIO().MousePos;
  const glm::dvec2 scene = SidePanel::scene_size({display.x, display.y});
  if (pointer.x > static_cast<float>(scene.x) || pointer.y > static_cast<float>(scene.y)) return;
  // It grows towards the middle of the scene, so that it lies over no panel.
  const bool left = 2 * pointer.x > static_cast<float>(scene.x), up = 2 * pointer.y > static_cast<float>(scene.y);
  const float away = ImGui::GetFontSize();
  ImGui::SetNextWindowPos(ImVec2(pointer.x + (left ? -away : away), pointer.y + (up ? -away : away)), ImGuiCond_Always,
                          ImVec2(left ? 1.0F : 0.0F, up ? 1.0F : 0.0F));
  ImGui::BeginTooltip();
  ImGui::TextUnformatted(part_text(controller.building(), hovered->joint).c_str());
  // Who demolishes is to see what is hit: all numbers are for those who select or look at forces.
  if (controller.hand.tool == ToolKind::select || controller.options.analysis())
    draw_joint(controller, moment, hovered->joint, true);
  else
    draw_short(moment.answer->joints[static_cast<std::size_t>(hovered->joint.index)]);
  ImGui::EndTooltip();
}

}  // namespace topple::viewer
