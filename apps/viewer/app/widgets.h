#pragma once
// Small parts of panels.
#include <imgui.h>

#include <optional>
#include <span>

#include "renderer/shapes/palette.h"

namespace topple::viewer {

/// While it lives, text is written with letters of one width: Interface loads that font second.
class TableFont {
 public:
  TableFont() { ImGui::PushFont(ImGui::GetIO().Fonts->Fonts[1]); }
  ~TableFont() { ImGui::PopFont(); }
  TableFont(const TableFont&) = delete;
  TableFont& operator=(const TableFont&) = delete;
};

[[nodiscard]] inline ImVec4 to_imgui(Rgba colour) {
  const glm::vec4 c = unpack(colour);
  return {c.r, c.g, c.b, 1.0F};
}
inline void legend_entry(const char* label, Rgba colour) {
  const float side = ImGui::GetFontSize();
  ImGui::ColorButton(label, to_imgui(colour), ImGuiColorEditFlags_NoTooltip | ImGuiColorEditFlags_NoPicker,
                     ImVec2(side, side));
  ImGui::SameLine();
  ImGui::TextUnformatted(label);
}
/// True while it is being changed.
inline bool slider(const char* label, double& value, double low, double high, const char* format,
                   ImGuiSliderFlags flags = ImGuiSliderFlags_Logarithmic) {
  auto v = static_cast<float>(value);
  if (!ImGui::SliderFloat(label, &v, static_cast<float>(low), static_cast<float>(high), format, flags)) return false;
  value = static_cast<double>(v);
  return true;
}
/// Values at even distances as a line over the width of an item (of all that is left, where the label begins with ##),
/// `text` in it, the label beside it; `marked`: a share of the width. Nothing pops up over it. Returns the share of the
/// width that was clicked.
std::optional<float> plot_line(const char* label, std::span<const float> values, const char* text, float height,
                               std::optional<float> marked = std::nullopt);

/// A button that is lit when it is on.
inline bool toggle_button(const char* label, bool on) {
  if (on) ImGui::PushStyleColor(ImGuiCol_Button, ImVec4(0.85F, 0.45F, 0.10F, 1.0F));
  const bool pressed = ImGui::Button(label);
  if (on) ImGui::PopStyleColor();
  return pressed;
}

}  // namespace topple::viewer
