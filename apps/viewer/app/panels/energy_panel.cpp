#include "app/panels/energy_panel.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "app/widgets.h"

namespace topple::viewer {
namespace {

using structure::Ledger;

/// Told apart by all (Okabe and Ito).
constexpr std::array<Rgba, energy_curve_count> colours{rgba(230, 159, 0),  rgba(86, 180, 233), rgba(0, 158, 115),
                                                       rgba(240, 228, 66), rgba(0, 114, 178),  rgba(213, 94, 0),
                                                       rgba(204, 121, 167)};

/// The unit in which a plot of this height is told.
struct Unit {
  double size;
  const char* name;
};
Unit unit_of(double largest) {
  if (largest >= 1e9) return {1e9, "GJ"};
  if (largest >= 1e6) return {1e6, "MJ"};
  return largest >= 1e3 ? Unit{1e3, "kJ"} : Unit{1, "J"};
}

}  // namespace

const std::array<EnergyCurve, energy_curve_count>& energy_curves() {
  static const std::array<EnergyCurve, energy_curve_count> curves{
      {{"moving, what stands", [](const Ledger& now, const Ledger&) { return now.kinetic_standing; }},
       {"elastic, since the start", [](const Ledger& now, const Ledger& start) { return now.elastic - start.elastic; }},
       {"damped", [](const Ledger& now, const Ledger&) { return now.damped; }},
       {"moving, debris",
        [](const Ledger& now, const Ledger&) { return now.kinetic_translation + now.kinetic_rotation; }},
       {"freed by breaks", [](const Ledger& now, const Ledger&) { return now.freed_by_breaks; }},
       {"taken by hinges", [](const Ledger& now, const Ledger&) { return now.dissipated_in_joints; }},
       {"lost in impacts",
        [](const Ledger& now, const Ledger&) { return now.lost_in_impacts + now.lost_in_contacts; }}}};
  return curves;
}

void EnergyPanel::plot(Controller& controller, const std::vector<Recording::Energies>& points, double marked) {
  const Ledger& start = points.front().ledger;
  double low = 0, high = 0;
  for (std::size_t c = 0; c < energy_curve_count; ++c)
    for (const Recording::Energies& point : points) {
      if (!shown_[c]) break;
      const double value = energy_curves()[c].value(point.ledger, start);
      low = std::min(low, value), high = std::max(high, value);
    }
  const Unit unit = unit_of(std::max(high, -low));
  ImGui::Text("%.4g to %.4g %s, %.1f to %.1f s", low / unit.size, high / unit.size, unit.name, points.front().time,
              points.back().time);
  const ImVec2 from = ImGui::GetCursorScreenPos();
  const float width = std::max(ImGui::GetContentRegionAvail().x, ImGui::GetFontSize()),
              height = 9 * ImGui::GetFontSize();
  if (ImGui::InvisibleButton("energies", ImVec2(width, height)) && points.back().time > points.front().time)
    controller.playback().seek(points.front().time +
                               (points.back().time - points.front().time) *
                                   static_cast<double>((ImGui::GetIO().MousePos.x - from.x) / width));
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddRectFilled(from, ImVec2(from.x + width, from.y + height), ImGui::GetColorU32(ImVec4(1, 1, 1, 0.06F)));
  const double length = std::max(points.back().time - points.front().time, 1e-9), range = high > low ? high - low : 1;
  const auto across = [&](double time) {
    return from.x + width * static_cast<float>((time - points.front().time) / length);
  };
  const auto up = [&](double value) { return from.y + height * static_cast<float>((high - value) / range); };
  list->AddLine(ImVec2(from.x, up(0)), ImVec2(from.x + width, up(0)), ImGui::GetColorU32(ImVec4(1, 1, 1, 0.3F)));
  list->AddLine(ImVec2(across(marked), from.y), ImVec2(across(marked), from.y + height),
                ImGui::GetColorU32(ImVec4(1, 1, 1, 0.5F)));
  std::vector<ImVec2> line(points.size());
  for (std::size_t c = 0; c < energy_curve_count; ++c) {
    if (!shown_[c]) continue;
    std::transform(points.begin(), points.end(), line.begin(), [&](const Recording::Energies& point) {
      return ImVec2(across(point.time), up(energy_curves()[c].value(point.ledger, start)));
    });
    list->AddPolyline(line.data(), static_cast<int>(line.size()), ImGui::GetColorU32(to_imgui(colours[c])),
                      ImDrawFlags_None, 0.12F * ImGui::GetFontSize());
  }
}

void EnergyPanel::draw(Controller& controller, const Snapshot& moment) {
  const auto points = controller.driver().recording().energies();
  if (points.empty()) return;
  plot(controller, points, moment.time);
  const Ledger &now = moment.energies, &start = points.front().ledger;
  ImGui::Text("at %.2f s, in kJ", moment.time);
  for (std::size_t c = 0; c < energy_curve_count; ++c) {
    ImGui::PushID(static_cast<int>(c));
    ImGui::PushStyleColor(ImGuiCol_CheckMark, to_imgui(colours[c]));
    ImGui::Checkbox("##shown", &shown_[c]);
    ImGui::PopStyleColor();
    ImGui::SameLine();
    const TableFont columns;
    ImGui::TextColored(to_imgui(colours[c]), "%-24s %12.3f", energy_curves()[c].name,
                       energy_curves()[c].value(now, start) / 1e3);
    ImGui::PopID();
  }
  const TableFont columns;
  ImGui::Text("   %-24s %12.3f", "work of gravity", (now.gravity_work - start.gravity_work) / 1e3);
  ImGui::Text("   %-24s %12.3f", "work put in", now.work_put_in / 1e3);
  ImGui::Text("   %-24s %12.1e", "left over, of both", now.residual());
}

}  // namespace topple::viewer
