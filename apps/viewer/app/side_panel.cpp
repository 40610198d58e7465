#include "app/side_panel.h"

#include <imgui.h>

#include <algorithm>
#include <numeric>

#include "renderer/palette.h"

namespace topple::viewer {
namespace {

ImVec4 to_imgui(Rgba colour) {
  const glm::vec4 c = unpack(colour);
  return {c.r, c.g, c.b, 1.0F};
}
void legend_entry(const char* label, Rgba colour) {
  ImGui::ColorButton(label, to_imgui(colour), ImGuiColorEditFlags_NoTooltip | ImGuiColorEditFlags_NoPicker,
                     ImVec2(ImGui::GetFontSize(), ImGui::GetFontSize()));
  ImGui::SameLine();
  ImGui::TextUnformatted(label);
}

void legend(const ViewOptions& options) {
  const JointPalette palette = joint_palette(options.colour_blind_safe);
  if (options.colouring == Colouring::joints) {
    legend_entry("force", palette.force);
    ImGui::SameLine();
    legend_entry("moment", palette.torque);
    ImGui::SameLine();
    legend_entry("both", palette.both);
  }
  if (options.colouring == Colouring::utilisation)
    for (const auto& [label, value] : {std::pair{"0", 0.0}, {"25", 0.25}, {"50", 0.5}, {"75", 0.75}, {"100 %", 1.0}}) {
      legend_entry(label, utilisation_colour(value));
      ImGui::SameLine();
    }
  if (options.colouring == Colouring::component)
    for (const auto& [label, value] : {std::pair{"-1", -1.0}, {"0", 0.0}, {"+1", 1.0}}) {
      legend_entry(label, signed_colour(value));
      ImGui::SameLine();
    }
  legend_entry("failed", palette.failed);
}

void switches(const char* title, PartSwitches& parts) {
  ImGui::PushID(title);
  ImGui::TextUnformatted(title);
  ImGui::Checkbox("posts", &parts.posts);
  ImGui::SameLine();
  ImGui::Checkbox("beams", &parts.beams);
  ImGui::SameLine();
  ImGui::Checkbox("braces", &parts.braces);
  ImGui::Checkbox("slabs", &parts.slabs);
  ImGui::SameLine();
  ImGui::Checkbox("walls", &parts.walls);
  ImGui::PopID();
}

void slider(const char* label, double& value, float low, float high, const char* format) {
  auto v = static_cast<float>(value);
  if (ImGui::SliderFloat(label, &v, low, high, format, ImGuiSliderFlags_Logarithmic)) value = v;
}

void help_window(bool& open) {
  ImGui::SetNextWindowPos(ImVec2(20, 20), ImGuiCond_FirstUseEver);
  if (ImGui::Begin("Help", &open, ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse)) {
    ImGui::TextUnformatted(
        "left click        fire at what is under the pointer\n"
        "left drag         orbit          right drag  pan\n"
        "wheel             zoom           W A S D Q E fly\n"
        "space             pause          N  single step\n"
        "R                 restart        U  undo the last action\n"
        "C                 next colouring F  frame the building\n"
        "1 2 3 4           posts, beams, slabs, walls\n"
        "P                 save a picture H  this help\n"
        "Esc               leave");
  }
  ImGui::End();
}

}  // namespace

double SidePanel::width() { return 24 * static_cast<double>(ImGui::GetIO().Fonts->Fonts[0]->FontSize); }

void SidePanel::view(Controller& controller) {
  ViewOptions& options = controller.options;
  constexpr const char* colourings[] = {"parts", "joints: force and moment", "utilisation", "one component"};
  int colouring = static_cast<int>(options.colouring);
  if (ImGui::Combo("colours", &colouring, colourings, IM_ARRAYSIZE(colourings)))
    options.colouring = static_cast<Colouring>(colouring);
  constexpr const char* components[] = {"axial", "shear y", "shear z", "torsion", "moment y", "moment z"};
  if (options.colouring == Colouring::component)
    ImGui::Combo("component", &options.component, components, IM_ARRAYSIZE(components));
  bool largest = options.scale == Scale::largest_in_view;
  if (ImGui::Checkbox("scale by the largest in view", &largest))
    options.scale = largest ? Scale::largest_in_view : Scale::capacity;
  legend(options);
  switches("shown", options.shown);
  switches("joints coloured", options.coloured);
  ImGui::Checkbox("failed joints", &options.failed_joints);
  ImGui::SameLine();
  ImGui::Checkbox("colour-blind safe", &options.colour_blind_safe);
  ImGui::SliderFloat("deflection", &options.deflection_scale, 0, 1000, "x %.0f", ImGuiSliderFlags_Logarithmic);
  ImGui::SliderFloat("slabs", &options.slab_opacity, 0.05F, 1, "%.2f");
  ImGui::SliderFloat("walls", &options.wall_opacity, 0.05F, 1, "%.2f");
  ImGui::Checkbox("shadows", &options.shadows);
  ImGui::SameLine();
  ImGui::Checkbox("occlusion", &options.ambient_occlusion);
  ImGui::SameLine();
  ImGui::Checkbox("grid", &options.grid);
}

void SidePanel::tools(Controller& controller) {
  Driver& driver = controller.driver();
  if (ImGui::Button(driver.paused() ? "Run" : "Pause")) driver.set_paused(!driver.paused());
  ImGui::SameLine();
  if (ImGui::Button("Step")) driver.single_step();
  ImGui::SameLine();
  if (ImGui::Button("Undo")) driver.undo();
  ImGui::SameLine();
  if (ImGui::Button("Restart")) driver.restart();
  ImGui::SameLine();
  if (ImGui::Button("Help")) controller.help = !controller.help;
  double speed = driver.speed();
  slider("speed", speed, 0.02F, 1, "x %.2f");
  if (speed != driver.speed()) driver.set_speed(speed);
  slider("shot", controller.shot.speed, 5, 300, "%.0f m/s");
  slider("mass", controller.shot.mass, 10, 20000, "%.0f kg");
  slider("radius", controller.shot.radius, 0.1F, 2, "%.2f m");
}

void SidePanel::state(const Controller& controller, const Snapshot& moment) {
  ImGui::Text("%.2f s, step %lld%s", moment.time, static_cast<long long>(moment.step),
              controller.building().members.empty() ? ""
              : moment.at_rest                      ? ", at rest"
                                                    : "");
  ImGui::Text("standing: %d of %zu members, %d of %zu panels", moment.membership->members_standing,
              controller.building().members.size(), moment.membership->panels_standing,
              controller.building().panels.size());
  const auto asleep =
      std::count_if(moment.bodies.begin(), moment.bodies.end(), [](const BodyPose& b) { return b.asleep; });
  ImGui::Text("bodies: %zu, asleep %zu", moment.bodies.size(), static_cast<std::size_t>(asleep));
  const auto& c = moment.counters;
  const auto number = [](std::uint64_t n) { return static_cast<unsigned long long>(n); };
  ImGui::Text("solves %llu, low rank %llu, factors %llu", number(c.solves), number(c.low_rank),
              number(c.refactorisations));
  ImGui::Text("segmentations %llu, collision steps %llu", number(c.segmentations), number(c.collision_steps));
  ImGui::Text("idle steps %llu, contacts ignored %llu", number(c.steps_idle), number(c.contacts_ignored));
}

void SidePanel::performance(const Snapshot& moment) {
  if (moment.step != last_step_) {
    const double whole = std::accumulate(moment.stage_seconds.begin(), moment.stage_seconds.end(), 0.0);
    for (std::size_t i = 0; i < history_.size(); ++i) {
      const double seconds = i < 6 ? moment.stage_seconds[i] : whole;
      history_[i].push_back(static_cast<float>(1e3 * seconds));
      if (history_[i].size() > history_length) history_[i].erase(history_[i].begin());
    }
    last_step_ = moment.step;
  }
  for (std::size_t i = 0; i < history_.size(); ++i) {
    const auto& values = history_[i];
    if (values.empty()) continue;
    char text[48];
    std::snprintf(text, sizeof text, "%.3f ms", static_cast<double>(values.back()));
    const char* name = i < 6 ? structure::stage_names[i] : "step";
    ImGui::PlotLines(name, values.data(), static_cast<int>(values.size()), 0, text, 0, FLT_MAX,
                     ImVec2(0, 1.6F * ImGui::GetFontSize()));
  }
  ImGui::Text("picture: %.1f ms", static_cast<double>(1000.0F / ImGui::GetIO().Framerate));
}

void SidePanel::joints(Controller& controller, const Snapshot& moment) {
  for (const structure::JointId id : moment.answer->most_used) {
    const auto& joint = moment.answer->joints[static_cast<std::size_t>(id.index)];
    const structure::Joint& owner = controller.building()[id];
    char text[96];
    std::snprintf(text, sizeof text, "%5.1f %%  %-12s %s", 100.0 * static_cast<double>(joint.utilisation),
                  structure::sense_names[static_cast<std::size_t>(joint.sense)], owner.name.c_str());
    if (ImGui::Selectable(text, controller.options.selected_joint == id)) {
      controller.options.selected_joint = id;
      controller.options.selected_member = owner.member;
      controller.options.selected_panel = owner.panel;
    }
  }
}

void SidePanel::draw(Controller& controller, const Snapshot& moment, const std::string& error) {
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  const auto width = static_cast<float>(SidePanel::width());
  ImGui::SetNextWindowPos(ImVec2(display.x - width, 0));
  ImGui::SetNextWindowSize(ImVec2(width, display.y));
  ImGui::Begin(controller.building().title.empty() ? "Topple" : controller.building().title.c_str(), nullptr,
               ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse);
  ImGui::PushItemWidth(0.62F * width);
  if (!error.empty()) ImGui::TextWrapped("The simulation stopped: %s", error.c_str());
  if (controller.message) ImGui::TextWrapped("%s", controller.message->c_str());
  tools(controller);
  if (ImGui::CollapsingHeader("View", ImGuiTreeNodeFlags_DefaultOpen)) view(controller);
  if (ImGui::CollapsingHeader("State", ImGuiTreeNodeFlags_DefaultOpen)) state(controller, moment);
  if (ImGui::CollapsingHeader("Most used joints", ImGuiTreeNodeFlags_DefaultOpen)) joints(controller, moment);
  if (ImGui::CollapsingHeader("Performance")) performance(moment);
  ImGui::PopItemWidth();
  ImGui::End();
  if (controller.help) help_window(controller.help);
}

}  // namespace topple::viewer
