// What the keys do.
#include <algorithm>
#include <exception>
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

namespace {

struct Key {
  const char* name;
  void (*press)(Controller& controller);
};

template <ToolKind kind>
void hold(Controller& c) {
  c.hand.tool = kind;
}
template <bool PartSwitches::*part>
void toggle(Controller& c) {
  c.options.shown.*part = !(c.options.shown.*part);
}
/// By this share of the picture's height.
void drag_along(Controller& c, double x, double y) { c.drag({0, 0}, {x * c.size().y, y * c.size().y}); }
constexpr double dragged = 0.04;

const Key of_the_run[] = {
    {"space",
     [](Controller& c) {
       if (c.playback().looking_at())
         c.playback().replay(!c.playback().replaying());
       else
         c.driver().set_paused(!c.driver().paused());
     }},
    {"n", [](Controller& c) { c.driver().single_step(); }},
    {"r",
     [](Controller& c) {
       c.playback().seek_present();
       c.driver().restart();
     }},
    {"u",
     [](Controller& c) {
       c.playback().seek_present();
       c.driver().undo();
     }},
    {"y", [](Controller& c) { c.playback().seek_present(); }},
    {"bracketleft", [](Controller& c) { c.playback().seek_by(-Playback::key_step); }},
    {"bracketright", [](Controller& c) { c.playback().seek_by(Playback::key_step); }},
    {"backspace", [](Controller& c) { c.playback().go_on_from_here(); }},
    {"minus", [](Controller& c) { c.driver().set_speed(std::max(0.02, c.driver().speed() / 2)); }},
    {"equal", [](Controller& c) { c.driver().set_speed(std::min(1.0, c.driver().speed() * 2)); }},
};

const Key of_tools[] = {
    {"g",
     [](Controller& c) {
       c.hand.tool = ToolKind::fire;
       c.hand.shot = Shot();
     }},
    {"b", hold<ToolKind::swing>},
    {"z", hold<ToolKind::burn>},
    {"j", hold<ToolKind::cut>},
    {"m", hold<ToolKind::remove>},
    {"k", hold<ToolKind::charge>},
    {"l", hold<ToolKind::path>},
    {"t", hold<ToolKind::support>},
    {"v", hold<ToolKind::select>},
    {"6", hold<ToolKind::explosion>},
    {"period", hold<ToolKind::thermite>},
    {"comma", hold<ToolKind::hook>},
    {"enter", [](Controller& c) { c.click(c.size() / 2.0); }},
    {"f8",
     [](Controller& c) {
       try {
         c.shake();
       } catch (const std::exception& failed) {
         c.message = failed.what();
       }
     }},
};

const Key of_what_is_drawn[] = {
    {"x", [](Controller& c) { c.show(c.options.slab_opacity_now() < 0.5F ? "panels" : "frame"); }},
    {"c",
     [](Controller& c) {
       c.options.colouring = static_cast<Colouring>((static_cast<int>(c.options.colouring) + 1) % 6);
     }},
    {"i", [](Controller& c) { c.options.diagram = c.options.diagram == 5 ? -1 : c.options.diagram + 1; }},
    {"o", [](Controller& c) { c.options.loads = c.options.reactions = c.options.contacts = !c.options.loads; }},
    {"1", toggle<&PartSwitches::posts>},
    {"2", toggle<&PartSwitches::beams>},
    {"3", toggle<&PartSwitches::slabs>},
    {"4", toggle<&PartSwitches::walls>},
    {"5", toggle<&PartSwitches::braces>},
    {"f7", [](Controller& c) { c.window.photo = !c.window.photo; }},
    {"escape", [](Controller& c) { c.window.asks_to_leave = !c.window.asks_to_leave; }},
    {"h", [](Controller& c) { c.window.help = !c.window.help; }},
};

const Key of_the_camera[] = {
    {"f", [](Controller& c) { c.frame_building(); }},
    {"7", [](Controller& c) { c.view_from(-glm::half_pi<double>(), 0.05); }},
    {"8", [](Controller& c) { c.view_from(0, 0.05); }},
    {"9", [](Controller& c) { c.view_from(-0.95, 0.9); }},
    {"0", [](Controller& c) { c.view_from(2.2, 0.3); }},
    {"left", [](Controller& c) { drag_along(c, -dragged, 0); }},
    {"right", [](Controller& c) { drag_along(c, dragged, 0); }},
    {"up", [](Controller& c) { drag_along(c, 0, dragged); }},
    {"down", [](Controller& c) { drag_along(c, 0, -dragged); }},
    {"f5",
     [](Controller& c) {
       c.path().add(c.camera);
       c.message = std::to_string(c.path().size()) + " views in the camera's path";
     }},
    {"f6",
     [](Controller& c) {
       if (!c.path().fly()) c.message = "a path needs two views or more: F5 adds what is seen";
     }},
};

template <class Visit>
void each_key(const Visit& visit) {
  for (const Key& key : of_the_run) visit(key);
  for (const Key& key : of_tools) visit(key);
  for (const Key& key : of_what_is_drawn) visit(key);
  for (const Key& key : of_the_camera) visit(key);
}

}  // namespace

bool Controller::key(const std::string& name) {
  const Key* found = nullptr;
  each_key([&](const Key& key) {
    if (name == key.name) found = &key;
  });
  if (found != nullptr) found->press(*this);
  return found != nullptr;
}

std::vector<std::string> Controller::key_names() {
  std::vector<std::string> names;
  each_key([&](const Key& key) { names.emplace_back(key.name); });
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace topple::viewer
