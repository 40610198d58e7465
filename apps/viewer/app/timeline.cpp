#include <algorithm>
#include <cstdio>

#include "app/side_panel.h"
#include "app/widgets.h"

namespace topple::viewer {
namespace {

using Kind = structure::SimulationEvent::Kind;

Rgba event_colour(Kind kind) {
  switch (kind) {
    case Kind::tool:
      return rgba(255, 170, 40);
    case Kind::impact:
      return rgba(240, 240, 240);
    case Kind::joint_broke:
    case Kind::joint_yielded:
    case Kind::panel_fractured:
      return rgba(90, 140, 255);
    case Kind::detached:
    case Kind::split:
    case Kind::mechanism:
      return rgba(230, 80, 70);
    default:
      return rgba(120, 200, 120);
  }
}

/// Marks below the slider; the text of those near the pointer.
void event_marks(Controller& controller, const std::vector<Recording::Event>& events, std::array<double, 2> span,
                 ImVec2 from, float width) {
  const float height = 0.9F * ImGui::GetFontSize();
  const double length = std::max(span[1] - span[0], 1e-9);
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddRectFilled(from, ImVec2(from.x + width, from.y + height), ImGui::GetColorU32(ImVec4(1, 1, 1, 0.06F)));
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  const bool inside = mouse.y >= from.y && mouse.y <= from.y + height;
  std::string near;
  int more = 0, last_pixel = -1;
  Kind last_kind{};
  for (const Recording::Event& event : events) {
    const float x = from.x + width * static_cast<float>((event.time - span[0]) / length);
    const int pixel = static_cast<int>(x);
    if (pixel != last_pixel || event.kind != last_kind)
      list->AddLine(ImVec2(x, from.y), ImVec2(x, from.y + height),
                    ImGui::GetColorU32(to_imgui(event_colour(event.kind))), 1.5F);
    last_pixel = pixel, last_kind = event.kind;
    if (!inside || std::abs(mouse.x - x) > 4) continue;
    constexpr int shown = 12;
    char time[32];
    std::snprintf(time, sizeof time, "%.2f s  ", event.time);
    if (++more <= shown) near += (near.empty() ? "" : "\n") + (time + event.text);
  }
  ImGui::Dummy(ImVec2(width, height));
  if (near.empty()) return;
  if (more > 12) near += "\n... " + std::to_string(more) + " in all";
  // Above the panel, in the scene, and towards its middle.
  const bool left = 2 * mouse.x > from.x + width;
  ImGui::SetNextWindowPos(ImVec2(mouse.x, ImGui::GetWindowPos().y), ImGuiCond_Always, ImVec2(left ? 1.0F : 0.0F, 1.0F));
  ImGui::BeginTooltip();
  ImGui::TextUnformatted(near.c_str());
  ImGui::EndTooltip();
  if (ImGui::IsMouseClicked(0))
    controller.playback().seek(span[0] + length * static_cast<double>((mouse.x - from.x) / width));
}

}  // namespace

void draw_timeline(Controller& controller, const Snapshot& moment, glm::dvec2 scene_size, double window_height) {
  ImGui::SetNextWindowPos(ImVec2(0, static_cast<float>(scene_size.y)));
  ImGui::SetNextWindowSize(ImVec2(static_cast<float>(scene_size.x), static_cast<float>(window_height - scene_size.y)));
  ImGui::Begin("Time", nullptr,
               ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse |
                   ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoScrollbar);
  const auto span = controller.driver().recording().span();
  const bool back = controller.playback().looking_at().has_value();
  if (ImGui::Button(controller.playback().replaying() ? "Stop" : "Replay")) {
    if (!back || *controller.playback().looking_at() >= span[1]) controller.playback().seek(span[0]);
    controller.playback().replay(!controller.playback().replaying());
  }
  ImGui::SameLine();
  if (toggle_button("Present", !back)) controller.playback().seek_present();
  ImGui::SameLine();
  if (ImGui::Button("Go on from here")) controller.playback().go_on_from_here();
  ImGui::SameLine();
  if (span[0] > 0) {
    if (ImGui::Button("Recompute past")) controller.playback().record_past();
    ImGui::SameLine();
  }
  const auto events = controller.driver().recording().events();
  ImGui::Text("%.2f s of %.2f s, %zu events%s", moment.time, span[1], events.size(), back ? ", looking back" : "");
  auto time = static_cast<float>(moment.time);
  const float width = ImGui::GetContentRegionAvail().x;
  ImGui::PushItemWidth(width);
  const ImVec2 from = ImGui::GetCursorScreenPos();
  if (ImGui::SliderFloat("##time", &time, static_cast<float>(span[0]), static_cast<float>(span[1]), "%.2f s"))
    controller.playback().seek(static_cast<double>(time));
  ImGui::PopItemWidth();
  event_marks(controller, events, span, ImVec2(from.x, ImGui::GetCursorScreenPos().y), width);
  ImGui::End();
}

}  // namespace topple::viewer
