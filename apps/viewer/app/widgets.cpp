#include "app/widgets.h"

#include <algorithm>
#include <string_view>
#include <vector>

namespace topple::viewer {

std::optional<float> plot_line(const char* label, std::span<const float> values, const char* text, float height,
                               std::optional<float> marked) {
  const ImVec2 from = ImGui::GetCursorScreenPos();
  const bool labelled = std::string_view(label).substr(0, 2) != "##";
  // What pops up has no width of its own when it is drawn first.
  const float width =
      std::max(labelled ? ImGui::CalcItemWidth() : ImGui::GetContentRegionAvail().x, 12 * ImGui::GetFontSize());
  const bool clicked = ImGui::InvisibleButton(label, ImVec2(width, height));
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddRectFilled(from, ImVec2(from.x + width, from.y + height), ImGui::GetColorU32(ImGuiCol_FrameBg));
  const float high = values.empty() ? 0 : *std::max_element(values.begin(), values.end());
  std::vector<ImVec2> line;
  for (std::size_t i = 0; i < values.size() && values.size() > 1; ++i)
    line.emplace_back(from.x + width * static_cast<float>(i) / static_cast<float>(values.size() - 1),
                      from.y + height * (high > 0 ? 1 - std::clamp(values[i] / high, 0.0F, 1.0F) : 1));
  const float thin = 0.08F * ImGui::GetFontSize();
  list->AddPolyline(line.data(), static_cast<int>(line.size()), ImGui::GetColorU32(ImGuiCol_PlotLines),
                    ImDrawFlags_None, thin);
  if (marked && *marked >= 0 && *marked <= 1)
    list->AddLine(ImVec2(from.x + *marked * width, from.y), ImVec2(from.x + *marked * width, from.y + height),
                  ImGui::GetColorU32(ImVec4(1, 1, 1, 0.5F)), thin);
  const float middle = (width - ImGui::CalcTextSize(text).x) / 2;
  list->AddText(ImVec2(from.x + std::max(middle, 0.0F), from.y + ImGui::GetStyle().FramePadding.y / 2),
                ImGui::GetColorU32(ImGuiCol_Text), text);
  if (labelled) {
    ImGui::SameLine(0, ImGui::GetStyle().ItemInnerSpacing.x);
    ImGui::TextUnformatted(label);
  }
  if (!clicked) return std::nullopt;
  return std::clamp((ImGui::GetIO().MousePos.x - from.x) / width, 0.0F, 1.0F);
}

}  // namespace topple::viewer
