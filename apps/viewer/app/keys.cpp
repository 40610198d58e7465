// What the keys do.
#include <algorithm>
#include <glm/gtc/constants.hpp>

#include "app/controller.h"

namespace topple::viewer {

const char* Controller::key_help() {
  return "left click        use the tool in hand    right click   select\n"
         "left drag         orbit                   right drag    pan\n"
         "wheel             zoom                    W A S D Q E   fly\n"
         "space             pause                   N             single step\n"
         "R                 restart                 U             undo the last action\n"
         "G                 fire                    B             wrecking ball\n"
         "J                 cut a joint             M             remove a part\n"
         "K                 charge                  L             load path\n"
         "T                 remove a support        V             select\n"
         "C                 next colouring          X             panels clear or not\n"
         "Z                 burn                    I             next diagram\n"
         "1 2 3 4 5         posts, beams, slabs, walls, braces\n"
         "6                 explosion\n"
         "7 8 9 0           seen from the front, the side, above, behind\n"
         "O                 loads and reactions     Y             back to the present\n"
         "F                 frame the building      P             save a picture\n"
         ". ,               thermite, hook          - =           slower, faster\n"
         "arrows            orbit                   Enter         the tool in the middle\n"
         "F5 F6 F7          add a view, fly through all, photo mode (no panels)\n"
         "[ ]               back and on in time     Backspace     go on from there\n"
         "F8                earthquake              Tab           panels by the keyboard\n"
         "H                 this help               Esc           end the program (asks first)";
}

bool Controller::key(const std::string& name) {
  const auto meanings = key_meanings();
  const auto meaning = meanings.find(name);
  if (meaning == meanings.end()) return false;
  meaning->second();
  return true;
}

std::map<std::string, std::function<void()>> Controller::key_meanings() {
  const auto hold = [this](ToolKind kind) { return [this, kind] { tool = kind; }; };
  return {{"space",
           [this] {
             if (looking_at_)
               replaying_ = !replaying_;
             else
               driver_.set_paused(!driver_.paused());
           }},
          {"n", [this] { driver_.single_step(); }},
          {"r",
           [this] {
             look_at_present();
             driver_.restart();
           }},
          {"u",
           [this] {
             look_at_present();
             driver_.undo();
           }},
          {"f", [this] { frame_building(); }},
          {"g",
           [this] {
             tool = ToolKind::fire;
             shot = Shot();
           }},
          {"b", hold(ToolKind::swing)},
          {"z", hold(ToolKind::burn)},
          {"j", hold(ToolKind::cut)},
          {"m", hold(ToolKind::remove)},
          {"k", hold(ToolKind::charge)},
          {"l", hold(ToolKind::path)},
          {"t", hold(ToolKind::support)},
          {"v", hold(ToolKind::select)},
          {"x", [this] { show(options.slab_opacity_now() < 0.5F ? "panels" : "frame"); }},
          {"c", [this] { options.colouring = static_cast<Colouring>((static_cast<int>(options.colouring) + 1) % 6); }},
          {"i", [this] { options.diagram = options.diagram == 5 ? -1 : options.diagram + 1; }},
          {"o", [this] { options.loads = options.reactions = options.contacts = !options.loads; }},
          {"y", [this] { look_at_present(); }},
          {"bracketleft", [this] { look_along(-look_step); }},
          {"bracketright", [this] { look_along(look_step); }},
          {"backspace",
           [this] {
             if (looking_at_) go_on_from_here();
           }},
          {"6", hold(ToolKind::explosion)},
          {"7", [this] { view_from(-glm::half_pi<double>(), 0.05); }},
          {"8", [this] { view_from(0, 0.05); }},
          {"9", [this] { view_from(-0.95, 0.9); }},
          {"0", [this] { view_from(2.2, 0.3); }},
          {"1", [this] { options.shown.posts = !options.shown.posts; }},
          {"2", [this] { options.shown.beams = !options.shown.beams; }},
          {"3", [this] { options.shown.slabs = !options.shown.slabs; }},
          {"4", [this] { options.shown.walls = !options.shown.walls; }},
          {"5", [this] { options.shown.braces = !options.shown.braces; }},
          {"period", hold(ToolKind::thermite)},
          {"comma", hold(ToolKind::hook)},
          {"minus", [this] { driver_.set_speed(std::max(0.02, driver_.speed() / 2)); }},
          {"equal", [this] { driver_.set_speed(std::min(1.0, driver_.speed() * 2)); }},
          {"left",
           [this] {
             drag({0, 0}, {-0.04 * size_.y, 0});
           }},
          {"right",
           [this] {
             drag({0, 0}, {0.04 * size_.y, 0});
           }},
          {"up",
           [this] {
             drag({0, 0}, {0, 0.04 * size_.y});
           }},
          {"down",
           [this] {
             drag({0, 0}, {0, -0.04 * size_.y});
           }},
          {"enter", [this] { click(size_ / 2.0); }},
          {"f5",
           [this] {
             add_view();
             message = std::to_string(views_.size()) + " views in the camera's path";
           }},
          {"f6", [this] { fly_path(); }},
          {"f7", [this] { photo = !photo; }},
          {"f8",
           [this] {
             try {
               shake();
             } catch (const std::exception& failed) {
               message = failed.what();
             }
           }},
          {"escape", [this] { asks_to_leave = !asks_to_leave; }},
          {"h", [this] { help = !help; }}};
}

}  // namespace topple::viewer
