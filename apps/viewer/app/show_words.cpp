#include "app/show_words.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <functional>
#include <map>

#include "topple/structure/error.h"

namespace topple::viewer {
namespace {

using structure::InputError;

const std::map<std::string, int>& components() {
  static const std::map<std::string, int> names{{"axial", 0},   {"tension", 0}, {"compression", 0}, {"shear_y", 1},
                                                {"shear_z", 2}, {"torsion", 3}, {"moment_y", 4},    {"moment_z", 5}};
  return names;
}

double number(const std::string& text, const std::string& words) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !(value >= 0 && value <= 1e6))
    throw InputError("show \"" + words + "\": '" + text + "' is no number from 0 to 1e6");
  return value;
}

using Plain = std::function<void(ViewOptions&, ModeView&)>;
/// "posts", "no posts": drawn or not; "coloured posts", "uncoloured posts": with their joints' colours or not.
void add_part_words(std::map<std::string, Plain>& words) {
  const std::pair<const char*, bool PartSwitches::*> parts[] = {{"posts", &PartSwitches::posts},
                                                                {"beams", &PartSwitches::beams},
                                                                {"braces", &PartSwitches::braces},
                                                                {"slabs", &PartSwitches::slabs},
                                                                {"walls", &PartSwitches::walls}};
  for (const auto& [name, part] : parts) {
    const auto set = [part = part](PartSwitches ViewOptions::*which, bool on) {
      return [=](ViewOptions& o, ModeView&) { o.*which.*part = on; };
    };
    words[name] = set(&ViewOptions::shown, true);
    words[std::string("no ") + name] = set(&ViewOptions::shown, false);
    words[std::string("coloured ") + name] = set(&ViewOptions::coloured, true);
    words[std::string("uncoloured ") + name] = set(&ViewOptions::coloured, false);
  }
}

const std::map<std::string, Plain>& plain_words() {
  const auto colour = [](Colouring c) { return [c](ViewOptions& o, ModeView&) { o.colouring = c; }; };
  const auto flag = [](bool ViewOptions::*what, bool on) { return [=](ViewOptions& o, ModeView&) { o.*what = on; }; };
  static const std::map<std::string, Plain> words = [&] {
    std::map<std::string, Plain> all{
        {"materials", colour(Colouring::materials)},
        {"plain", colour(Colouring::plain)},
        {"joints", colour(Colouring::joints)},
        {"utilisation", colour(Colouring::utilisation)},
        {"segments", colour(Colouring::segments)},
        {"path", colour(Colouring::path)},
        {"capacity", [](ViewOptions& o, ModeView&) { o.scale = Scale::capacity; }},
        {"largest", [](ViewOptions& o, ModeView&) { o.scale = Scale::largest_in_view; }},
        {"loads", flag(&ViewOptions::loads, true)},
        {"no loads", flag(&ViewOptions::loads, false)},
        {"reactions", flag(&ViewOptions::reactions, true)},
        {"no reactions", flag(&ViewOptions::reactions, false)},
        {"contacts", flag(&ViewOptions::contacts, true)},
        {"no contacts", flag(&ViewOptions::contacts, false)},
        {"dust", flag(&ViewOptions::dust, true)},
        {"no dust", flag(&ViewOptions::dust, false)},
        {"debris", flag(&ViewOptions::debris, true)},
        {"no debris", flag(&ViewOptions::debris, false)},
        {"drawn", flag(&ViewOptions::drawn, true)},
        {"no drawn", flag(&ViewOptions::drawn, false)},
        {"shadows", flag(&ViewOptions::shadows, true)},
        {"no shadows", flag(&ViewOptions::shadows, false)},
        {"occlusion", flag(&ViewOptions::ambient_occlusion, true)},
        {"no occlusion", flag(&ViewOptions::ambient_occlusion, false)},
        {"grid", flag(&ViewOptions::grid, true)},
        {"no grid", flag(&ViewOptions::grid, false)},
        {"failed", flag(&ViewOptions::failed_joints, true)},
        {"no failed", flag(&ViewOptions::failed_joints, false)},
        {"yielded", flag(&ViewOptions::yielded_joints, true)},
        {"no yielded", flag(&ViewOptions::yielded_joints, false)},
        {"colour-blind safe", flag(&ViewOptions::colour_blind_safe, true)},
        {"usual colours", flag(&ViewOptions::colour_blind_safe, false)},
        {"no motion-scale", [](ViewOptions& o, ModeView&) { o.motion_scale = ViewOptions::as_deflection; }},
        {"no diagram", [](ViewOptions& o, ModeView&) { o.diagram = -1; }},
        {"no mode", [](ViewOptions&, ModeView& m) { m.kind.reset(); }},
        {"frame", [](ViewOptions& o, ModeView&) { o.slab_opacity = o.wall_opacity = 0.06F; }},
        {"panels", [](ViewOptions& o, ModeView&) {
           o.slab_opacity = ViewOptions().slab_opacity;
           o.wall_opacity = ViewOptions().wall_opacity;
         }}};
    add_part_words(all);
    return all;
  }();
  return words;
}

using WithNumber = std::function<void(ViewOptions&, ModeView&, double)>;
const std::map<std::string, WithNumber>& numbered_words() {
  const auto mode = [](ModeKind kind) {
    return [kind](ViewOptions&, ModeView& m, double n) {
      m.kind = kind;
      m.number = static_cast<int>(n) - 1;
    };
  };
  static const std::map<std::string, WithNumber> words{
      {"deflection", [](ViewOptions& o, ModeView&, double n) { o.deflection_scale = static_cast<float>(n); }},
      {"motion-scale", [](ViewOptions& o, ModeView&, double n) { o.motion_scale = static_cast<float>(n); }},
      {"diagram-scale", [](ViewOptions& o, ModeView&, double n) { o.diagram_scale = static_cast<float>(n); }},
      {"arrow-scale", [](ViewOptions& o, ModeView&, double n) { o.arrow_scale = static_cast<float>(n); }},
      {"slab-opacity",
       [](ViewOptions& o, ModeView&, double n) { o.slab_opacity = std::min(1.0F, static_cast<float>(n)); }},
      {"wall-opacity",
       [](ViewOptions& o, ModeView&, double n) { o.wall_opacity = std::min(1.0F, static_cast<float>(n)); }},
      {"mode-scale", [](ViewOptions&, ModeView& m, double n) { m.scale = static_cast<float>(n); }},
      {"vibration", mode(ModeKind::vibration)},
      {"buckling", mode(ModeKind::buckling)}};
  return words;
}

[[noreturn]] void refuse(const std::string& words) {
  std::string accepted;
  for (const auto& [name, unused] : plain_words()) accepted += name + ", ";
  for (const auto& [name, unused] : components()) accepted += name + ", ";
  for (const auto& [name, unused] : numbered_words()) accepted += name + " NUMBER, ";
  throw InputError("show \"" + words + "\": no such view; accepted: " + accepted + "diagram COMPONENT");
}

}  // namespace

void show(const std::string& words, ViewOptions& options, ModeView& mode) {
  if (const auto plain = plain_words().find(words); plain != plain_words().end()) return plain->second(options, mode);
  if (const auto component = components().find(words); component != components().end()) {
    options.colouring = Colouring::component;
    options.component = component->second;
    return;
  }
  const auto space = words.find(' ');
  if (space == std::string::npos) refuse(words);
  const std::string first = words.substr(0, space), rest = words.substr(space + 1);
  if (first == "diagram") {
    const auto component = components().find(rest);
    if (component == components().end()) refuse(words);
    options.diagram = component->second;
    return;
  }
  const auto numbered = numbered_words().find(first);
  if (numbered == numbered_words().end()) refuse(words);
  const double value = number(rest, words);
  if ((first == "vibration" || first == "buckling") && (value < 1 || value > ModeShapes::count))
    throw InputError("show \"" + words + "\": modes are numbered from 1 to " + std::to_string(ModeShapes::count));
  numbered->second(options, mode, value);
}

}  // namespace topple::viewer
