// The tab of what is seen, and its legend.
#include <algorithm>
#include <cstdio>

#include "app/side_panel.h"
#include "app/widgets.h"
#include "renderer/shapes/arrows.h"

namespace topple::viewer {
namespace {

constexpr const char* component_words[] = {"axial", "shear y", "shear z", "torsion", "moment y", "moment z"};

void colour_bar(Rgba (*colour)(double), double low, double high) {
  constexpr int steps = 60;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = 0.92F * ImGui::GetContentRegionAvail().x, height = 0.8F * ImGui::GetFontSize();
  for (int i = 0; i < steps; ++i) {
    const double share = low + (high - low) * (i + 0.5) / steps;
    const float x0 = at.x + width * static_cast<float>(i) / steps,
                x1 = at.x + width * static_cast<float>(i + 1) / steps;
    ImGui::GetWindowDrawList()->AddRectFilled(ImVec2(x0, at.y), ImVec2(x1, at.y + height),
                                              ImGui::GetColorU32(to_imgui(colour(share))));
  }
  ImGui::Dummy(ImVec2(width, height));
}

void legend(const ViewOptions& options, const Snapshot& moment, const SceneInstances& scene) {
  const JointPalette palette = joint_palette(options.colour_blind_safe);
  const bool capacity = options.scale == Scale::capacity;
  char text[96];
  switch (options.colouring) {
    case Colouring::joints:
      legend_entry("force", palette.force);
      ImGui::SameLine();
      legend_entry("moment", palette.torque);
      ImGui::SameLine();
      legend_entry("both", palette.both);
      if (capacity)
        ImGui::TextUnformatted("full colour: at capacity");
      else
        ImGui::Text("full colour: %.1f %% of capacity", 100 * scene.largest());
      break;
    case Colouring::utilisation:
      colour_bar(utilisation_colour, 0, 1);
      ImGui::TextUnformatted("0          50 %       100 %  red: above");
      break;
    case Colouring::path:
      colour_bar(utilisation_colour, 0, 1);
      ImGui::TextUnformatted("share of the force: 0 to 100 %");
      break;
    case Colouring::component:
      colour_bar(signed_colour, -1, 1);
      if (capacity)
        std::snprintf(text, sizeof text, "- capacity        0        + capacity");
      else
        std::snprintf(text, sizeof text, "-%.3g        0        +%.3g %s", scene.largest() / 1e3, scene.largest() / 1e3,
                      options.component < 3 ? "kN" : "kN m");
      ImGui::TextUnformatted(text);
      break;
    default:
      break;
  }
  if (options.colouring != Colouring::materials) legend_entry("failed", failed_colour(options));
  if (options.analysis() && options.yielded_joints && !moment.answer->plastic_rotations.empty())
    legend_entry("yielded (balls): twice as large at the limit", palette.yielded);
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

void scale_slider(const char* label, float& value, float high) {
  ImGui::SliderFloat(label, &value, 0, high, "x %.1f", ImGuiSliderFlags_Logarithmic);
}

void diagrams(ViewOptions& options, const SceneInstances& scene) {
  int choice = options.diagram + 1;
  constexpr const char* choices[] = {"none", "axial", "shear y", "shear z", "torsion", "moment y", "moment z"};
  if (ImGui::Combo("diagram", &choice, choices, IM_ARRAYSIZE(choices))) options.diagram = choice - 1;
  if (options.diagram < 0) return;
  scale_slider("its scale", options.diagram_scale, 10);
  const auto& [low, high] = scene.diagram_range();
  ImGui::Text("%.4g ... %.4g %s", low / 1e3, high / 1e3, options.diagram < 3 ? "kN" : "kN m");
}

void arrows(ViewOptions& options, const Snapshot& moment) {
  ImGui::Checkbox("loads", &options.loads);
  ImGui::SameLine();
  ImGui::Checkbox("reactions", &options.reactions);
  ImGui::SameLine();
  ImGui::Checkbox("contacts", &options.contacts);
  if (!(options.loads || options.reactions || options.contacts)) return;
  scale_slider("arrows", options.arrow_scale, 10);
  if (!moment.answer->forces) return;
  const ArrowScale scale = arrow_scale(*moment.answer->forces);
  const auto entry = [](const char* what, double largest, const char* unit, Rgba colour) {
    if (largest <= 0) return;
    char text[64];
    std::snprintf(text, sizeof text, "%s, longest %.4g %s", what, largest / 1e3, unit);
    legend_entry(text, colour);
  };
  if (options.loads) entry("spread", scale.spread, "kN/m", load_colour);
  if (options.loads) entry("at points", scale.points, "kN", load_colour);
  if (options.reactions) entry("reactions", scale.reactions, "kN", reaction_colour);
  if (options.contacts) entry("contacts", scale.contacts, "kN", contact_colour);
}

void mode_choice(Controller& controller) {
  ModeView& mode = controller.mode;
  int kind = mode.kind ? 1 + static_cast<int>(*mode.kind) : 0;
  constexpr const char* kinds[] = {"none", "vibration", "buckling"};
  if (ImGui::Combo("mode", &kind, kinds, IM_ARRAYSIZE(kinds)))
    mode.kind = kind == 0 ? std::nullopt : std::optional(static_cast<ModeKind>(kind - 1));
  if (!mode.kind) return;
  const auto* known = controller.modes().find(*mode.kind);
  if (known == nullptr) return ImGui::TextUnformatted("being worked out ...");
  if (known->empty()) return ImGui::TextWrapped("no mode: %s", controller.modes().error(*mode.kind).c_str());
  int number = mode.number + 1;
  if (ImGui::SliderInt("number", &number, 1, static_cast<int>(known->size()))) mode.number = number - 1;
  scale_slider("swing", mode.scale, 10);
  const double value = (*known)[std::min(static_cast<std::size_t>(mode.number), known->size() - 1)].value;
  ImGui::Text(*mode.kind == ModeKind::vibration ? "%.3f Hz, undamaged" : "at %.2f times the loads, undamaged", value);
}

}  // namespace

void SidePanel::view(Controller& controller, const Snapshot& moment, const SceneInstances& scene) {
  ViewOptions& options = controller.options;
  constexpr const char* colourings[] = {
      "materials", "parts", "joints: force and moment", "utilisation", "one component", "segments", "load path"};
  int colouring = static_cast<int>(options.colouring);
  if (ImGui::Combo("colours", &colouring, colourings, IM_ARRAYSIZE(colourings)))
    options.colouring = static_cast<Colouring>(colouring);
  if (options.colouring == Colouring::component)
    ImGui::Combo("component", &options.component, component_words, IM_ARRAYSIZE(component_words));
  bool largest = options.scale == Scale::largest_in_view;
  if (ImGui::Checkbox("scale by the largest in view", &largest))
    options.scale = largest ? Scale::largest_in_view : Scale::capacity;
  legend(options, moment, scene);
  ImGui::Separator();
  diagrams(options, scene);
  arrows(options, moment);
  mode_choice(controller);
  ImGui::SliderFloat("deflection", &options.deflection_scale, 0, 1000, "x %.0f", ImGuiSliderFlags_Logarithmic);
  float motion = options.motion_scale_now();
  if (ImGui::SliderFloat("motion", &motion, 0, 1000, options.motion_scale < 0 ? "x %.0f, as above" : "x %.0f",
                         ImGuiSliderFlags_Logarithmic))
    options.motion_scale = motion;
  if (options.motion_scale >= 0 && ImGui::Button("Motion as deflection"))
    options.motion_scale = ViewOptions::as_deflection;
  ImGui::Separator();
  switches("shown", options.shown);
  switches("joints coloured", options.coloured);
  ImGui::Checkbox("failed joints", &options.failed_joints);
  ImGui::SameLine();
  ImGui::Checkbox("yielded", &options.yielded_joints);
  ImGui::Checkbox("colour-blind safe", &options.colour_blind_safe);
  const auto opacity = [](const char* label, float& value, float now) {
    if (ImGui::SliderFloat(label, &now, 0.05F, 1, "%.2f")) value = now;
  };
  opacity("slabs##opacity", options.slab_opacity, options.slab_opacity_now());
  opacity("walls##opacity", options.wall_opacity, options.wall_opacity_now());
  ImGui::Checkbox("shadows", &options.shadows);
  ImGui::SameLine();
  ImGui::Checkbox("occlusion", &options.ambient_occlusion);
  ImGui::SameLine();
  ImGui::Checkbox("grid", &options.grid);
  ImGui::Checkbox("debris", &options.debris);
  ImGui::SameLine();
  ImGui::Checkbox("dust", &options.dust);
}

}  // namespace topple::viewer
