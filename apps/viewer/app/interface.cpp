#include "app/interface.h"

#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include <cmath>

extern "C" const unsigned char topple_font_begin[], topple_font_end[], topple_table_font_begin[],
    topple_table_font_end[];

namespace topple::viewer {
namespace {

constexpr float text_pixels = 14, table_pixels = 13;  ///< at scale 1

void add_font(const unsigned char* begin, const unsigned char* end, float pixels) {
  ImFontConfig font;
  font.FontDataOwnedByAtlas = false;
  font.OversampleH = 2;
  ImGui::GetIO().Fonts->AddFontFromMemoryTTF(const_cast<unsigned char*>(begin), static_cast<int>(end - begin),
                                             std::round(pixels), &font);
}

/// All sizes from their values at scale 1, so that nothing is left of a scale before.
void set_looks(float scale) {
  add_font(topple_font_begin, topple_font_end, text_pixels * scale);
  add_font(topple_table_font_begin, topple_table_font_end, table_pixels * scale);
  ImGui::GetIO().Fonts->Build();  // so that sizes in text are known before the first frame
  ImGuiStyle& style = ImGui::GetStyle();
  style = ImGuiStyle();
  ImGui::StyleColorsDark();
  style.ScaleAllSizes(scale);
  style.WindowRounding = 0;
  style.Colors[ImGuiCol_WindowBg] = ImVec4(0.09F, 0.10F, 0.12F, 1.0F);
}

}  // namespace

Interface::Interface(float scale) : scale_(scale) {
  IMGUI_CHECKVERSION();
  ImGui::CreateContext();
  ImGui::GetIO().IniFilename = nullptr;
  set_looks(scale);
  ImGui_ImplOpenGL3_Init("#version 330 core");
}

void Interface::set_scale(float scale) {
  if (scale == scale_) return;
  scale_ = scale;
  // Before the first frame the letters are not on the graphics card yet, and that frame brings them there.
  const bool there = ImGui::GetIO().Fonts->TexID != nullptr;
  if (there) ImGui_ImplOpenGL3_DestroyFontsTexture();
  ImGui::GetIO().Fonts->Clear();
  set_looks(scale);
  if (there) ImGui_ImplOpenGL3_CreateFontsTexture();
}

Interface::~Interface() {
  ImGui_ImplOpenGL3_Shutdown();
  ImGui::DestroyContext();
}

void Interface::begin_frame(glm::dvec2 size, double seconds) {
  ImGuiIO& io = ImGui::GetIO();
  io.DisplaySize = ImVec2(static_cast<float>(size.x), static_cast<float>(size.y));
  io.DeltaTime = static_cast<float>(seconds);
  ImGui_ImplOpenGL3_NewFrame();
  ImGui::NewFrame();
}

void Interface::point(glm::dvec2 pixel) {
  ImGui::GetIO().MousePos = ImVec2(static_cast<float>(pixel.x), static_cast<float>(pixel.y));
}
void Interface::press(bool down) { ImGui::GetIO().MouseDown[0] = down; }
bool Interface::captures_pointer() { return ImGui::GetIO().WantCaptureMouse; }

void Interface::end_frame() {
  ImGui::Render();
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

}  // namespace topple::viewer
