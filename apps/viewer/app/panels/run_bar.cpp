// The buttons of the run, and the tool in hand with its sliders.
#include <exception>
#include <string>
#include <utility>

#include "app/side_panel.h"
#include "app/widgets.h"

namespace topple::viewer {
namespace {

/// Of the tool in hand.
void draw_settings(Hand& hand) {
  if (hand.tool == ToolKind::fire) {
    slider("shot", hand.shot.speed, 5, 300, "%.0f m/s");
    slider("mass", hand.shot.mass, 10, 20000, "%.0f kg");
    slider("radius", hand.shot.radius, 0.1, 2, "%.2f m");
    if (ImGui::Button("Usual shot")) hand.shot = Shot();
  }
  if (hand.tool == ToolKind::swing) {
    slider("cable", hand.swing.cable, 2, 60, "%.1f m");
    slider("angle", hand.swing.angle, 0.1, 1.57, "%.2f rad", ImGuiSliderFlags_None);
    slider("mass", hand.swing.mass, 100, 20000, "%.0f kg");
    slider("radius", hand.swing.radius, 0.2, 2, "%.2f m");
  }
  if (hand.tool == ToolKind::burn) {
    slider("reach", hand.burning.reach, 0.5, 30, "%.1f m");
    slider("over", hand.burning.over, 1, 7200, "%.0f s");
    slider("strength left", hand.burning.strength, 0, 1, "x %.2f", ImGuiSliderFlags_None);
    slider("stiffness left", hand.burning.stiffness, 0.01, 1, "x %.2f", ImGuiSliderFlags_None);
  }
  if (hand.tool == ToolKind::thermite) slider("over", hand.thermite_over, 0.5, 60, "%.1f s");
  if (hand.tool == ToolKind::hook) {
    double kilonewtons = hand.hauling.force / 1e3;
    if (slider("force", kilonewtons, 10, 20000, "%.0f kN")) hand.hauling.force = 1e3 * kilonewtons;
    slider("over", hand.hauling.over, 0.1, 60, "%.1f s");
  }
  if (hand.tool == ToolKind::explosion) slider("TNT", hand.explosive, 0.5, 1000, "%.1f kg");
  if (hand.tool == ToolKind::charge) slider("reach", hand.charge_radius, 0.5, 20, "%.1f m");
}

}  // namespace

void SidePanel::run_bar(Controller& controller) {
  Driver& driver = controller.driver();
  if (ImGui::Button(driver.paused() ? "Run" : "Pause")) {
    controller.playback().seek_present();
    driver.set_paused(!driver.paused());
  }
  if (std::exchange(controller.window.panels_wanted, false)) ImGui::SetKeyboardFocusHere(-1);
  const auto key_button = [&](const char* label, const char* key) {
    ImGui::SameLine();
    if (ImGui::Button(label)) controller.key(key);
  };
  key_button("Step", "n");
  key_button("Undo", "u");
  key_button("Restart", "r");
  key_button("Help", "h");
  ImGui::SameLine();
  if (ImGui::Button("Scenes")) controller.window.wants_another = true;
  double speed = driver.speed();
  const std::string pace = driver.paused() ? "x %.2f, paused" : "x %.2f, runs at " + ratio_text(driver.ratio());
  if (slider("speed", speed, 0.02, 1, pace.c_str())) driver.set_speed(speed);
  ImGui::TextUnformatted("A click will");
  for (std::size_t i = 0; i < tool_names.size(); ++i) {
    if (i % 3 != 0) ImGui::SameLine();
    if (toggle_button(tool_names[i], controller.hand.tool == static_cast<ToolKind>(i)))
      controller.hand.tool = static_cast<ToolKind>(i);
  }
  draw_settings(controller.hand);
  run_files(controller);
}

void SidePanel::run_files(Controller& controller) {
  ImGui::InputText("##saved", saved_.data(), saved_.size());
  const auto with_file = [&](const char* label, void (RunFiles::*what)(const std::string&)) {
    ImGui::SameLine();
    if (!ImGui::Button(label)) return;
    try {
      (controller.files().*what)(saved_.data());
    } catch (const std::exception& failed) {
      controller.message = failed.what();
    }
  };
  with_file("Save", &RunFiles::save);
  with_file("Load", &RunFiles::load);
}

}  // namespace topple::viewer
