#include "app/panels/play_panel.h"

#include <cmath>

#include "app/widgets.h"

namespace topple::viewer {
namespace {

void goal(const char* text, bool reached) {
  ImGui::TextColored(reached ? ImVec4(0.45F, 0.85F, 0.4F, 1) : ImVec4(0.75F, 0.75F, 0.75F, 1), "%s  %s",
                     reached ? "done" : "open", text);
}

}  // namespace

void PlayPanel::goals(Controller& controller) {
  // Weighing all that lies about takes longer than a picture may: some times a second is enough.
  constexpr std::int64_t interval = 15;
  const std::shared_ptr<const Snapshot> present = controller.driver().moment().later;
  if (scored_step_ < 0 || std::abs(present->step - scored_step_) >= interval || present->actions != score_.actions ||
      controller.driver().paused()) {
    if (present->step != scored_step_ || present->actions != score_.actions)
      score_ = score_of(controller.building(), *present, present->actions);
    scored_step_ = present->step;
  }
  ImGui::Text("%d points", score_.points());
  ImGui::Text("down %.0f %%, of it %.0f %% on its own ground, actions %d", 100 * score_.down, 100 * score_.inside,
              score_.actions);
  goal("nine tenths of the building are down", score_.down >= goal_share);
  goal("nine tenths of that lie within 3 m of where it stood",
       score_.down >= goal_share && score_.inside >= goal_share);
  goal("by one action", score_.down >= goal_share && score_.actions == 1);
  ImGui::TextWrapped("Points: 100 x down x on its own ground, a tenth less for each action after the first.");
}

void PlayPanel::earthquake(Controller& controller) {
  slider("peak", controller.hand.shaking.peak, 0.2, 30, "%.1f m/s2");
  slider("lasts", controller.hand.shaking.over, 2, 60, "%.0f s");
  if (ImGui::InputTextWithHint("##ground", "or a file: time, ax, ay, az", ground_.data(), ground_.size()))
    controller.hand.shaking.file = ground_.data();
  ImGui::SameLine();
  if (ImGui::Button("Shake")) controller.key("f8");
}

void PlayPanel::draw(Controller& controller) {
  goals(controller);
  ImGui::Separator();
  ImGui::TextUnformatted("earthquake");
  earthquake(controller);
  ImGui::Separator();
  ImGui::Text("camera: %zu views in its path", controller.path().size());
  if (ImGui::Button("Add view")) controller.key("f5");
  ImGui::SameLine();
  if (ImGui::Button("Fly")) controller.key("f6");
  ImGui::SameLine();
  if (ImGui::Button("Forget")) controller.path().forget();
  ImGui::SameLine();
  if (ImGui::Button("Photo (F7)")) controller.key("f7");
  ImGui::Separator();
  if (controller.window.has_sound)
    slider("sound", controller.window.volume, 0, 1, "%.2f", ImGuiSliderFlags_None);
  else
    ImGui::TextWrapped("No sound: no device was found (or --no-sound).");
}

}  // namespace topple::viewer
