#include "app/actions.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "topple/structure/error.h"

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
  [[nodiscard]] bool has(const std::string& key) const { return value_.contains(key); }
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
  [[nodiscard]] double number() const {
    if (!value_.is_number() || !std::isfinite(value_.get<double>())) refuse("not a finite number");
    return value_.get<double>();
  }
  [[nodiscard]] double positive() const {
    if (number() <= 0) refuse("not above zero");
    return number();
  }
  [[nodiscard]] std::string text() const {
    if (!value_.is_string()) refuse("not a text");
    return value_.get<std::string>();
  }
  [[nodiscard]] glm::dvec2 pixel() const {
    (void)count(2);
    return {item(0).number(), item(1).number()};
  }
  [[nodiscard]] glm::dvec3 point() const {
    (void)count(3);
    return {item(0).number(), item(1).number(), item(2).number()};
  }

 private:
  const json& value_;
  std::string place_;
};

Camera camera_of(const Value& value) {
  value.only({"eye", "target", "field_of_view"});
  Camera camera;
  camera.eye = value["eye"].point();
  camera.target = value["target"].point();
  if (camera.eye == camera.target) value.refuse("eye and target are one point");
  if (value.has("field_of_view")) camera.field_of_view = value["field_of_view"].positive();
  return camera;
}

FireAction fire_of(const Value& value) {
  value.only({"pixel", "speed", "mass", "radius"});
  FireAction fire{value["pixel"].pixel(), {}};
  if (value.has("speed")) fire.shot.speed = value["speed"].positive();
  if (value.has("mass")) fire.shot.mass = value["mass"].positive();
  if (value.has("radius")) fire.shot.radius = value["radius"].positive();
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

Action action_of(const Value& value) {
  value.only({"at", "camera", "click", "fire", "key", "drag", "set", "show", "screenshot", "quit"});
  Action action;
  action.at = value["at"].number();
  if (value.has("camera"))
    action.what = CameraAction{camera_of(value["camera"])};
  else if (value.has("click"))
    action.what = ClickAction{value["click"].pixel()};
  else if (value.has("fire"))
    action.what = fire_of(value["fire"]);
  else if (value.has("key"))
    action.what = KeyAction{value["key"].text()};
  else if (value.has("set"))
    action.what = change_of(value["set"]);
  else if (value.has("show"))
    action.what = ShowAction{value["show"].text()};
  else if (value.has("screenshot"))
    action.what = ScreenshotAction{value["screenshot"].text()};
  else if (value.has("drag")) {
    const Value drag = value["drag"];
    (void)drag.count(2);
    action.what = DragAction{drag.item(0).pixel(), drag.item(1).pixel()};
  } else if (value.has("quit"))
    action.what = QuitAction{};
  else
    value.refuse("no action; accepted: one of camera, click, fire, key, drag, set, show, screenshot, quit");
  return action;
}

}  // namespace

Script read_script(const std::string& file) {
  std::ifstream stream(file);
  if (!stream) throw InputError(file + ": cannot be read");
  json document;
  try {
    document = json::parse(stream);
  } catch (const json::parse_error& error) {
    throw InputError(file + ": not JSON at byte " + std::to_string(error.byte));
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
