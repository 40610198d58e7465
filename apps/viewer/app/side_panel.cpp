#include "app/side_panel.h"

#include <algorithm>
#include <cstdio>
#include <string>

#include "app/widgets.h"

namespace topple::viewer {
namespace {

double text_size() { return static_cast<double>(ImGui::GetIO().Fonts->Fonts[0]->FontSize); }

void help_window(bool& open) {
  ImGui::SetNextWindowPos(ImVec2(20, 20), ImGuiCond_FirstUseEver);
  if (ImGui::Begin("Help", &open, ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse)) {
    const TableFont columns;
    ImGui::TextUnformatted(Controller::key_help());
  }
  ImGui::End();
}

void leave_window(Controller& controller, glm::dvec2 scene) {
  ImGui::SetNextWindowPos(ImVec2(static_cast<float>(scene.x / 2), static_cast<float>(scene.y / 2)), ImGuiCond_Always,
                          ImVec2(0.5F, 0.5F));
  if (ImGui::Begin("Leave?", &controller.window.asks_to_leave,
                   ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoMove)) {
    ImGui::TextUnformatted("End the program? The run is lost unless it was saved.");
    if (ImGui::Button("End (Enter)")) controller.window.leaves = true;
    ImGui::SameLine();
    if (ImGui::Button("Stay (Esc)")) controller.window.asks_to_leave = false;
  }
  ImGui::End();
}

}  // namespace

glm::dvec2 SidePanel::scene_size(glm::dvec2 window) {
  return {std::max(window.x - 25 * text_size(), 0.25 * window.x),
          std::max(window.y - 6.2 * text_size(), 0.25 * window.y)};
}

void SidePanel::part(Controller& controller, const Snapshot& moment) {
  ImGui::InputTextWithHint("##search", "search by name, * for any", search_.data(), search_.size());
  for (const structure::JointId id : controller.search(search_.data(), 8)) {
    const structure::Joint& joint = controller.building()[id];
    const bool whole = std::string_view(search_.data()).find(':') == std::string_view::npos;
    const std::string& name = !whole                 ? joint.name
                              : joint.member.valid() ? controller.building()[joint.member].name
                                                     : controller.building()[joint.panel].name;
    if (ImGui::Selectable(name.c_str(), controller.options.selected_joint == id)) controller.select(id);
  }
  if (controller.options.selected_joint.valid()) {
    ImGui::Separator();
    const structure::Joint& chosen = controller.building()[controller.options.selected_joint];
    ImGui::TextWrapped("%s", part_text(controller.building(), controller.options.selected_joint).c_str());
    const int joints = chosen.member.valid() ? 2 : 4;
    for (int end = 0; end < joints; ++end) {
      if (end > 0) ImGui::SameLine();
      const structure::JointId id = chosen.member.valid() ? controller.building().joint(chosen.member, end)
                                                          : controller.building().joint(chosen.panel, end);
      if (toggle_button(controller.building()[id].name.c_str(), id == controller.options.selected_joint))
        controller.select(id);
    }
    draw_joint(controller, moment, controller.options.selected_joint, true);
  } else {
    ImGui::TextWrapped("Right click a part, or choose one below.");
  }
  ImGui::Separator();
  ImGui::TextUnformatted("most used joints");
  joints(controller, moment);
}

void SidePanel::state(const Controller& controller, const Snapshot& moment) {
  ImGui::Text("%.2f s, step %lld%s", moment.time, static_cast<long long>(moment.step),
              moment.at_rest ? ", at rest" : "");
  ImGui::Text("standing: %d/%zu members, %d/%zu panels", moment.membership->members_standing,
              controller.building().members.size(), moment.membership->panels_standing,
              controller.building().panels.size());
  const auto asleep =
      std::count_if(moment.bodies.begin(), moment.bodies.end(), [](const BodyPose& b) { return b.asleep; });
  ImGui::Text("bodies: %zu, asleep %zu", moment.bodies.size(), static_cast<std::size_t>(asleep));
}

void SidePanel::joints(Controller& controller, const Snapshot& moment) {
  const TableFont columns;
  for (const structure::JointId id : moment.answer->most_used) {
    const auto& joint = moment.answer->joints[static_cast<std::size_t>(id.index)];
    char text[96];
    std::snprintf(text, sizeof text, "%5.1f %%  %-12s %s", 100.0 * static_cast<double>(joint.utilisation),
                  structure::sense_names[static_cast<std::size_t>(joint.sense)],
                  controller.building()[id].name.c_str());
    if (ImGui::Selectable(text, controller.options.selected_joint == id)) controller.select(id);
  }
}

void SidePanel::draw(Controller& controller, const Snapshot& moment, const SceneInstances& scene,
                     const std::string& error) {
  if (controller.window.photo) return;
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  const glm::dvec2 left = scene_size({display.x, display.y});
  const float width = display.x - static_cast<float>(left.x);
  ImGui::SetNextWindowPos(ImVec2(static_cast<float>(left.x), 0));
  ImGui::SetNextWindowSize(ImVec2(width, display.y));
  if (controller.window.panels_wanted) ImGui::SetNextWindowFocus();
  ImGui::Begin(
      "Topple", nullptr,
      ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoTitleBar);
  ImGui::PushItemWidth(0.62F * width);
  ImGui::TextWrapped("%s", controller.building().title.empty() ? "Topple" : controller.building().title.c_str());
  if (!error.empty()) ImGui::TextWrapped("The simulation stopped: %s", error.c_str());
  run_bar(controller);
  if (!controller.driver().begun()) ImGui::TextWrapped("How it stands is being found; until then it is seen unloaded.");
  state(controller, moment);
  ImGui::TextWrapped("%s", controller.message ? controller.message->c_str() : "");
  if (ImGui::BeginTabBar("tabs")) {
    const auto tab = [](const char* name, const auto& content) {
      if (!ImGui::BeginTabItem(name)) return;
      ImGui::BeginChild(name, ImVec2(0, 0), false, ImGuiWindowFlags_NavFlattened);
      content();
      ImGui::EndChild();
      ImGui::EndTabItem();
    };
    tab("View", [&] { view(controller, moment, scene); });
    tab("Part", [&] { part(controller, moment); });
    tab("Tune", [&] { tuning_.draw(controller, moment); });
    tab("Files", [&] { output_.draw(controller); });
    tab("Energy", [&] { energies_.draw(controller, moment); });
    tab("Times", [&] { performance(controller, moment); });
    tab("Play", [&] { play_.draw(controller); });
    ImGui::EndTabBar();
  }
  ImGui::PopItemWidth();
  ImGui::End();
  draw_timeline(controller, moment, left, static_cast<double>(display.y));
  if (controller.window.help) help_window(controller.window.help);
  if (controller.window.asks_to_leave) leave_window(controller, left);
}

}  // namespace topple::viewer
