#include "app/output/output_panel.h"

#include "app/widgets.h"

namespace topple::viewer {
namespace {

bool file_and_button(const char* label, std::array<char, 256>& file) {
  ImGui::PushID(label);
  ImGui::InputText("##file", file.data(), file.size());
  ImGui::SameLine();
  const bool pressed = ImGui::Button(label);
  ImGui::PopID();
  return pressed && file[0] != 0;
}

}  // namespace

void OutputPanel::draw(Controller& controller) {
  ImGui::TextWrapped("The picture that is seen (.png):");
  if (file_and_button("Picture", picture_)) controller.window.picture_wanted = picture_.data();
  ImGui::TextWrapped("All that was recorded, from here: a folder of pictures, or a video (.mp4, .webm; needs ffmpeg):");
  if (file_and_button("Pictures", sequence_)) controller.window.sequence_wanted = sequence_.data();
  ImGui::TextWrapped("The run for others: a page to turn and play (.html), USD (.usda), glTF (.glb):");
  if (!file_and_button("Export", run_)) return;
  try {
    controller.files().export_run(run_.data());
  } catch (const std::exception& failed) {
    controller.message = failed.what();
  }
}

}  // namespace topple::viewer
