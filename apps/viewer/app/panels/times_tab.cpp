// The tab of what steps and pictures cost.
#include <cstdio>
#include <numeric>
#include <string>

#include "app/side_panel.h"
#include "app/widgets.h"

namespace topple::viewer {

std::string ratio_text(double ratio) {
  char text[32];
  std::snprintf(text, sizeof text, ratio < 0.1 ? "x %.2g" : "x %.2f", ratio);
  return text;
}

void SidePanel::performance(const Controller& controller, const Snapshot& moment) {
  const Driver& driver = controller.driver();
  ImGui::Text("pace: %s asked, %s reached", ratio_text(driver.speed()).c_str(),
              driver.paused() ? "paused," : ratio_text(driver.ratio()).c_str());
  const auto& c = moment.counters;
  const auto number = [](std::uint64_t n) { return static_cast<unsigned long long>(n); };
  ImGui::TextUnformatted("solved");
  ImGui::Text("  %llu answers: %llu corrections, %llu factors", number(c.solves), number(c.low_rank),
              number(c.refactorisations));
  ImGui::Text("  %llu segmentations, %llu collision steps", number(c.segmentations), number(c.collision_steps));
  ImGui::TextUnformatted("skipped");
  ImGui::Text("  %llu steps: nothing was awake or changed", number(c.steps_idle));
  ImGui::Text("  %llu changes of contact: within the dead band", number(c.contacts_ignored));
  ImGui::TextUnformatted("time of each stage");
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
    (void)plot_line(name, values, text, 1.6F * ImGui::GetFontSize());
  }
  picture_history_.push_back(static_cast<float>(controller.window.picture_processor));
  if (picture_history_.size() > history_length) picture_history_.erase(picture_history_.begin());
  char text[64];
  std::snprintf(text, sizeof text, "%.2f ms of processor time", controller.window.picture_processor);
  (void)plot_line("picture", picture_history_, text, 1.6F * ImGui::GetFontSize());
  const auto curve = [](const char* name, std::vector<float>& history, double value, const char* format) {
    history.push_back(static_cast<float>(value));
    if (history.size() > history_length) history.erase(history.begin());
    char shown[64];
    std::snprintf(shown, sizeof shown, format, value);
    (void)plot_line(name, history, shown, 1.6F * ImGui::GetFontSize());
  };
  curve("graphics", graphics_history_, controller.window.picture_graphics, "%.2f ms on the graphics card");
  curve("pace", pace_history_, driver.paused() ? 0 : driver.ratio(), "x %.2f of real time");
  ImGui::Text("a picture each %.1f ms, drawing and waiting included",
              static_cast<double>(1000.0F / ImGui::GetIO().Framerate));
}

}  // namespace topple::viewer
