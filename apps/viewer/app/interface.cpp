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

}  // namespace

Interface::Interface(float scale) {
  IMGUI_CHECKVERSION();
  ImGui::CreateContext();
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;
  add_font(topple_font_begin, topple_font_end, text_pixels * scale);
  add_font(topple_table_font_begin, topple_table_font_end, table_pixels * scale);
  io.Fonts->Build();  // so that sizes in text are known before the first frame
  ImGui::StyleColorsDark();
  ImGui::GetStyle().ScaleAllSizes(scale);
  ImGui::GetStyle().WindowRounding = 0;
  ImGui::GetStyle().Colors[ImGuiCol_WindowBg] = ImVec4(0.09F, 0.10F, 0.12F, 1.0F);
  ImGui_ImplOpenGL3_Init("#version 330 core");
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
bool Interface::wants_pointer() { return ImGui::GetIO().WantCaptureMouse; }

void Interface::end_frame() {
  ImGui::Render();
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

}  // namespace topple::viewer
