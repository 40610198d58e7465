// Panels on a display whose scale changes while the window is open.
#include <imgui.h>

#include <catch2/catch.hpp>

#include "app/interface.h"
#include "app/side_panel.h"
#include "app/start/start_page.h"
#include "renderer/frame_composer.h"
#include "renderer/gl_errors.h"
#include "renderer/headless_context.h"

using namespace topple::viewer;

namespace {

/// The start page as it is laid out now, and how large its letters are.
float letters_of(Interface& interface, StartPage& page) {
  float size = 0;
  // What scrolls knows its size from the frame before.
  for (int frame = 0; frame < 3; ++frame) {
    interface.begin_frame({1600, 1200}, 1.0 / 60);
    (void)page.draw();
    size = ImGui::GetFontSize();
    Interface::end_frame();
    check_gl_errors();
  }
  return size;
}

}  // namespace

TEST_CASE("letters, spaces and panels follow the display's scale while the window is open, and come back") {
  const HeadlessContext context;
  const FrameComposer picture({1600, 1200});
  Interface interface(1);
  StartPage page;
  const glm::dvec2 window(2400, 1600);
  const float letters = letters_of(interface, page);
  const ImGuiStyle style = ImGui::GetStyle();
  const glm::dvec2 scene = SidePanel::scene_size(window);
  interface.set_scale(2);
  CHECK(SidePanel::scene_size(window).x == Approx(window.x - 2 * (window.x - scene.x)));
  CHECK(letters_of(interface, page) == 2 * letters);
  CHECK(ImGui::GetStyle().FramePadding.x == 2 * style.FramePadding.x);
  CHECK(ImGui::GetIO().Fonts->Fonts.Size == 2);
  interface.set_scale(1.5F);
  CHECK(letters_of(interface, page) == 1.5F * letters);
  CHECK(ImGui::GetStyle().ItemSpacing.y == 1.5F * style.ItemSpacing.y);
  interface.set_scale(1);
  CHECK(letters_of(interface, page) == letters);
  CHECK(ImGui::GetStyle().FramePadding.x == style.FramePadding.x);
  CHECK(ImGui::GetStyle().ScrollbarSize == style.ScrollbarSize);
  CHECK(SidePanel::scene_size(window) == scene);
}
