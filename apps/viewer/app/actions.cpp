#include "app/actions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "topple/structure/error.h"
#include "topple/structure/formats/input_files.h"
#include "topple/structure/number_range.h"

namespace topple::viewer {
namespace {

using nlohmann::json;
using structure::InputError;

/// A value of the file with the place it stands at.
class Value {
 public:
  Value(const json& value, std::string place) : value_(value), place_(std::move(place)) {}

  [[noreturn]] void refuse(const std::string& why) const { throw InputError(place_ + ": " + why); }

  void only(const std::set<std::string>& keys) const {
    if (!value_.is_object()) refuse("not an object");
    for (const auto& [key, unused] : value_.items()) {
      if (keys.count(key) != 0) continue;
      std::string accepted;
      for (const std::string& k : keys) accepted += (accepted.empty() ? "" : ", ") + k;
      refuse("unknown key '" + key + "'; accepted: " + accepted);
    }
  }
  [[nodiscard]] bool has(const std::string& key) const { return value_.is_object() && value_.contains(key); }
  [[nodiscard]] Value operator[](const std::string& key) const {
    if (!value_.is_object() || !value_.contains(key)) refuse("'" + key + "' is missing");
    return {value_[key], place_ + "." + key};
  }
  [[nodiscard]] Value item(std::size_t i) const { return {value_[i], place_ + "[" + std::to_string(i) + "]"}; }
  [[nodiscard]] std::size_t count(std::size_t expected) const {
    if (!value_.is_array()) refuse("not a list");
    if (expected != 0 && value_.size() != expected) refuse("not a list of " + std::to_string(expected));
    return value_.size();
  }
  [[nodiscard]] double number() const { return in(structure::ranges::force); }
  [[nodiscard]] double in(const structure::NumberRange& range) const {
    if (!value_.is_number() || !range.contains(value_.get<double>())) refuse("not " + range.text());
    return value_.get<double>();
  }
  [[nodiscard]] double positive() const {
    if (number() <= 0) refuse("not above zero");
    return number();
  }
  [[nodiscard]] bool yes_or_no() const {
    if (!value_.is_boolean()) refuse("not true or false");
    return value_.get<bool>();
  }
  [[nodiscard]] bool is_text() const { return value_.is_string(); }
  [[nodiscard]] std::vector<std::string> keys() const {
    if (!value_.is_object()) refuse("not an object");
    std::vector<std::string> names;
    for (const auto& [key, unused] : value_.items()) names.push_back(key);
    return names;
  }
  /// Which of the names it is.
  template <std::size_t n>
  [[nodiscard]] std::size_t choice(const std::array<const char*, n>& names) const {
    const auto found = std::find(names.begin(), names.end(), text());
    if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
    std::string accepted;
    for (const char* name : names) accepted += (accepted.empty() ? "" : ", ") + std::string(name);
    refuse("'" + text() + "': accepted: " + accepted);
  }
  [[nodiscard]] std::string text() const {
    if (!value_.is_string()) refuse("not a text");
    return value_.get<std::string>();
  }
  [[nodiscard]] glm::dvec2 pixel() const {
    (void)count(2);
    constexpr structure::NumberRange pixels{-1e6, 1e6};
    return {item(0).in(pixels), item(1).in(pixels)};
  }
  [[nodiscard]] glm::dvec3 point() const {
    (void)count(3);
    const auto coordinate = [&](std::size_t i) { return item(i).in(structure::ranges::place); };
    return {coordinate(0), coordinate(1), coordinate(2)};
  }

 private:
  const json& value_;
  std::string place_;
};

CameraAction camera_of(const Value& value) {
  value.only({"eye", "target", "field_of_view", "over"});
  Camera camera;
  camera.eye = value["eye"].point();
  camera.target = value["target"].point();
  if (camera.eye == camera.target) value.refuse("eye and target are one point");
  if (value.has("field_of_view")) camera.field_of_view = value["field_of_view"].in({1e-3, 179});
  return {camera, value.has("over") ? value["over"].in(structure::ranges::instant) : 0};
}

ShakeAction shake_of(const Value& value) {
  value.only({"peak", "over", "file"});
  ShakeAction action;
  if (value.has("peak")) action.shake.peak = value["peak"].in({1e-3, 100});
  if (value.has("over")) action.shake.over = value["over"].in({0.1, 600});
  if (value.has("file")) action.shake.file = value["file"].text();
  return action;
}

FireAction fire_of(const Value& value) {
  value.only({"pixel", "speed", "mass", "radius"});
  FireAction fire{value["pixel"].pixel(), {}};
  if (value.has("speed")) fire.shot.speed = value["speed"].in(structure::ranges::speed);
  if (value.has("mass")) fire.shot.mass = value["mass"].in(structure::ranges::mass);
  if (value.has("radius")) fire.shot.radius = value["radius"].in(structure::ranges::radius);
  return fire;
}

structure::JointChange change_of(const Value& value) {
  std::set<std::string> keys{"joints", "strength"};
  for (const char* sense : structure::sense_names) keys.insert(sense);
  value.only(keys);
  structure::JointChange change;
  change.joints = value["joints"].text();
  if (value.has("strength")) change.strength = value["strength"].positive();
  for (std::size_t s = 0; s < 7; ++s)
    if (value.has(structure::sense_names[s])) change.capacity[s] = value[structure::sense_names[s]].positive();
  if (change.empty()) value.refuse("nothing to set; accepted: strength, or the capacity in a sense");
  return change;
}

std::pair<glm::dvec2, glm::dvec2> pixels_of(const Value& value) {
  (void)value.count(2);
  return {value.item(0).pixel(), value.item(1).pixel()};
}

ToolAction tool_of(const Value& value) {
  const std::size_t kind = value["name"].choice(tool_names);
  ToolAction tool{static_cast<ToolKind>(kind), {}};
  for (const std::string& key : value.keys())
    if (key != "name") tool.settings.emplace_back(key, value[key].positive());
  return tool;
}

RestartAction restart_of(const Value& value) {
  constexpr std::array bracings{"buckling", "classic", "none"};
  constexpr std::array methods{"voronoi", "quadrilateral", "local", "none"};
  constexpr std::array mechanisms{"hinge", "detach"};
  if (value.has("generations_per_second"))
    value["generations_per_second"].refuse(
        "nothing limits what may break in a step any more: a step computes all that happens in it, and the pace of the "
        "steps is the host's; leave the key out");
  value.only({"bracing", "mechanism", "sudden", "second_order", "fracture", "cell", "materials"});
  RestartAction restart;
  if (value.has("bracing")) restart.bracing = static_cast<structure::BracingRule>(value["bracing"].choice(bracings));
  if (value.has("mechanism"))
    restart.mechanism = static_cast<structure::MechanismRule>(value["mechanism"].choice(mechanisms));
  if (value.has("sudden")) restart.sudden = value["sudden"].in(structure::ranges::sudden);
  if (value.has("second_order")) restart.second_order = value["second_order"].yes_or_no();
  if (value.has("fracture")) {
    const std::size_t method = value["fracture"].choice(methods);
    restart.panels_stay_whole = method + 1 == methods.size();
    if (!restart.panels_stay_whole) restart.fracture = static_cast<fracture::Method>(method);
  }
  if (value.has("cell")) restart.cell = value["cell"].in({1e-3, 1e3});
  if (value.has("materials"))
    for (const std::string& name : value["materials"].keys())
      restart.materials.push_back({name, value["materials"][name].positive()});
  return restart;
}

LookAction look_of(const Value& value) {
  if (!value.is_text()) return {value.in(structure::ranges::instant)};
  constexpr std::array accepted{"present"};
  (void)value.choice(accepted);
  return {};
}

using Meaning = decltype(Action::what);
const std::map<std::string, std::function<Meaning(const Value&)>>& meanings() {
  static const std::map<std::string, std::function<Meaning(const Value&)>> all{
      {"camera", [](const Value& v) { return camera_of(v); }},
      {"click", [](const Value& v) { return ClickAction{v.pixel()}; }},
      {"fire", fire_of},
      {"key", [](const Value& v) { return KeyAction{v.text()}; }},
      {"drag",
       [](const Value& v) {
         const auto [from, to] = pixels_of(v);
         return DragAction{from, to};
       }},
      {"pan",
       [](const Value& v) {
         const auto [from, to] = pixels_of(v);
         return PanAction{from, to};
       }},
      {"zoom",
       [](const Value& v) {
         return ZoomAction{v.in({-1000, 1000})};
       }},
      {"fly", [](const Value& v) { return FlyAction{v.point()}; }},
      {"select", [](const Value& v) { return SelectAction{v.text()}; }},
      {"tool", tool_of},
      {"gravity", [](const Value& v) { return GravityAction{v.number()}; }},
      {"earthquake", shake_of},
      {"look_at", look_of},
      {"go_on", [](const Value&) { return GoOnAction{}; }},
      {"restart", restart_of},
      {"save", [](const Value& v) { return SaveAction{v.text()}; }},
      {"load", [](const Value& v) { return LoadAction{v.text()}; }},
      {"export", [](const Value& v) { return ExportAction{v.text()}; }},
      {"set", change_of},
      {"show", [](const Value& v) { return ShowAction{v.text()}; }},
      {"screenshot", [](const Value& v) { return ScreenshotAction{v.text()}; }},
      {"quit", [](const Value&) { return QuitAction{}; }}};
  return all;
}

Action action_of(const Value& value) {
  std::set<std::string> keys{"at"};
  std::string accepted;
  for (const auto& [name, unused] : meanings()) {
    keys.insert(name);
    accepted += (accepted.empty() ? "" : ", ") + name;
  }
  value.only(keys);
  Action action;
  action.at = value["at"].in(structure::ranges::instant);
  const std::vector<std::string> given = value.keys();
  if (given.size() != 2) value.refuse("one action beside 'at' is needed; accepted: " + accepted);
  const std::string& name = given[0] == "at" ? given[1] : given[0];
  action.what = meanings().at(name)(value[name]);
  return action;
}

}  // namespace

Script read_script(const std::string& file) {
  constexpr std::uintmax_t most = std::uintmax_t{1} << 24;
  json document;
  try {
    document = json::parse(structure::read_whole_file(file, most));
  } catch (const json::parse_error& error) {
    throw InputError(file + ": not JSON at byte " + std::to_string(error.byte));
  } catch (const json::out_of_range&) {
    throw InputError(file + ": a number that is too large to hold; accepted: finite numbers");
  }
  const Value root(document, file);
  root.only({"topple", "size", "actions"});
  if (root["topple"].number() != 1) root["topple"].refuse("format 1 is accepted");
  Script script;
  if (root.has("size")) {
    const glm::dvec2 size = root["size"].pixel();
    if (!(size.x >= 16 && size.y >= 16 && size.x <= 16384 && size.y <= 16384))
      root["size"].refuse("accepted: width and height from 16 to 16384");
    script.size = {static_cast<int>(size.x), static_cast<int>(size.y)};
  }
  const Value actions = root["actions"];
  for (std::size_t i = 0; i < actions.count(0); ++i) script.actions.push_back(action_of(actions.item(i)));
  std::stable_sort(script.actions.begin(), script.actions.end(),
                   [](const Action& a, const Action& b) { return a.at < b.at; });
  return script;
}

}  // namespace topple::viewer
