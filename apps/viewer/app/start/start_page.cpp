#include "app/start/start_page.h"

#include <imgui.h>

#include <algorithm>
#include <filesystem>

#include "app/start/recent_files.h"
#include "app/widgets.h"
#include "topple/structure/error.h"
#include "topple/structure/formats/files.h"
#include "topple/structure/formats/output_files.h"

namespace topple::viewer {
namespace {

ImTextureID as_imgui(const StoredPicture& picture) {
  return reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(picture.texture.get()));
}

void length(const char* label, double& value, double low, double high, const char* format = "%.2f m") {
  slider(label, value, low, high, format, ImGuiSliderFlags_None);
}

}  // namespace

StartPage::StartPage() : scenes_(shipped_scenes()), recent_(recent_files()) {}

void StartPage::scene(const ShippedScene& scene, float width) {
  const auto [found, is_new] = pictures_.try_emplace(scene.name);
  if (is_new) found->second = read_picture(scene.picture);
  ImGui::PushID(scene.name.c_str());
  ImGui::BeginGroup();
  const ImVec2 size(width, width * 9 / 16);
  const bool pressed = found->second ? ImGui::ImageButton(as_imgui(*found->second), size, ImVec2(0, 0), ImVec2(1, 1), 2)
                                     : ImGui::Button(scene.name.c_str(), ImVec2(size.x + 4, size.y + 4));
  if (pressed) chosen_ = scene.name;
  ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + width);
  ImGui::TextUnformatted(scene.name.c_str());
  ImGui::TextDisabled("%s", scene.title.c_str());
  ImGui::PopTextWrapPos();
  ImGui::EndGroup();
  ImGui::PopID();
}

void StartPage::scenes() {
  const float space = ImGui::GetStyle().ItemSpacing.x, all = ImGui::GetContentRegionAvail().x;
  const int columns = std::max(1, static_cast<int>(all / (15 * ImGui::GetFontSize())));
  const float width = all / static_cast<float>(columns) - space - 8;
  // A table keeps rows apart whose titles take more lines than others.
  if (!ImGui::BeginTable("scenes", columns, ImGuiTableFlags_SizingStretchSame)) return;
  for (const ShippedScene& one : scenes_) {
    ImGui::TableNextColumn();
    scene(one, width);
  }
  ImGui::EndTable();
}

void StartPage::files() {
  ImGui::TextWrapped("A scenario or a model (.json, .3dd), or a folder of tables:");
  const bool entered = ImGui::InputText("##path", path_.data(), path_.size(), ImGuiInputTextFlags_EnterReturnsTrue);
  ImGui::SameLine();
  if ((ImGui::Button("Open") || entered) && path_[0] != 0) chosen_ = path_.data();
  ImGui::Separator();
  if (recent_.empty()) ImGui::TextDisabled("Files that you open are listed here.");
  for (const std::string& name : recent_)
    if (ImGui::Selectable(name.c_str())) chosen_ = name;
}

void StartPage::editor() {
  ImGui::PushItemWidth(16 * ImGui::GetFontSize());
  ImGui::InputText("title", title_.data(), title_.size());
  int frame = static_cast<int>(plan_.frame);
  if (ImGui::Combo("frame", &frame, frame_names.data(), static_cast<int>(frame_names.size())))
    plan_.frame = static_cast<FrameKind>(frame);
  ImGui::SliderInt("posts along x", plan_.posts.data(), 2, 20);
  ImGui::SliderInt("posts along y", plan_.posts.data() + 1, 2, 20);
  ImGui::SliderInt("storeys", &plan_.storeys, 1, 60);
  length("bay along x", plan_.bay[0], 1, 15);
  length("bay along y", plan_.bay[1], 1, 15);
  length("storey height", plan_.storey_height, 2, 8);
  length("post width", plan_.post_width, 0.1, 2);
  length("beam depth", plan_.beam_depth, 0.1, 2);
  ImGui::Checkbox("floors", &plan_.floors);
  if (plan_.floors) length("floor thickness", plan_.floor_thickness, 0.05, 1);
  ImGui::TextUnformatted("brick walls on the sides");
  constexpr std::array<const char*, 4> sides{"x-", "x+", "y-", "y+"};
  for (std::size_t i = 0; i < sides.size(); ++i) {
    if (i > 0) ImGui::SameLine();
    ImGui::Checkbox(sides[i], &plan_.walls[i]);
  }
  if (std::any_of(plan_.walls.begin(), plan_.walls.end(), [](bool w) { return w; }))
    length("wall thickness", plan_.wall_thickness, 0.05, 1);
  ImGui::InputText("file", file_.data(), file_.size());
  if (ImGui::Button("Write the model and open it")) write_plan();
  ImGui::PopItemWidth();
}

void StartPage::write_plan() {
  try {
    plan_.title = title_.data();
    const std::string text = make_model_text(plan_);
    (void)structure::parse_model(text, file_.data());  // what is written can be read
    structure::write_file(file_.data(), text);
    chosen_ = file_.data();
  } catch (const std::exception& failed) {
    message = failed.what();
  }
}

std::optional<std::string> StartPage::draw() {
  chosen_.reset();
  ImGui::SetNextWindowPos(ImVec2(0, 0));
  ImGui::SetNextWindowSize(ImGui::GetIO().DisplaySize);
  ImGui::Begin("Start", nullptr,
               ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse |
                   ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoBringToFrontOnFocus);
  ImGui::TextUnformatted("Topple: choose a building. Esc leaves.");
  if (!message.empty()) ImGui::TextWrapped("%s", message.c_str());
  if (ImGui::BeginTabBar("start")) {
    const auto tab = [&](const char* name, void (StartPage::*content)()) {
      if (!ImGui::BeginTabItem(name)) return;
      ImGui::BeginChild(name, ImVec2(0, 0), false, ImGuiWindowFlags_NavFlattened);
      (this->*content)();
      ImGui::EndChild();
      ImGui::EndTabItem();
    };
    tab("Scenes", &StartPage::scenes);
    tab("Files", &StartPage::files);
    tab("New building", &StartPage::editor);
    ImGui::EndTabBar();
  }
  ImGui::End();
  return std::exchange(chosen_, std::nullopt);
}

}  // namespace topple::viewer
