#include "app/controller.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <map>

#include "renderer/instances.h"

namespace topple::viewer {
namespace {

/// A drag across the picture's height turns the view by half a turn.
constexpr double turn_per_height = glm::pi<double>();
constexpr double zoom_per_click = 0.88;
/// A drawn mode's largest translation, as a share of the building's radius, and its pace: every mode at the same one.
constexpr double mode_share = 0.05, swings_per_second = 0.5;

}  // namespace

Controller::Controller(Driver& driver, const Scene& scene, double ground, glm::dvec2 size)
    : driver_(driver),
      building_(*scene.building),
      modes_(scene.building, scene.scenario.combination.value_or(structure::CombinationId(0u))),
      ground_(ground),
      size_(size) {
  frame_building();
}

void Controller::frame_building() { camera = frame(bounds_of(building_), size_.x / size_.y); }

void Controller::fire(glm::dvec2 pixel) {
  const Ray ray = camera.ray(pixel, size_);
  const auto target = pick(building_, *driver_.moment().later, options, ground_, ray);
  const double distance = target ? target->distance : camera.distance();
  const double flight = distance / shot.speed;
  const glm::dvec3 velocity =
      shot.speed * ray.direction + glm::dvec3(0, 0, building_.gravity * flight / 2);  // falls g t^2/2 on the way
  structure::Projectile projectile;
  projectile.from = {ray.origin.x, ray.origin.y, ray.origin.z};
  projectile.velocity = {velocity.x, velocity.y, velocity.z};
  projectile.mass = shot.mass;
  projectile.radius = shot.radius;
  driver_.apply(projectile);
}

void Controller::drag(glm::dvec2 from, glm::dvec2 to) {
  const glm::dvec2 by = turn_per_height * (to - from) / size_.y;
  const double radius = bounds_of(building_).radius();
  camera.orbit(-by.x, by.y, ground_ + 0.01 * radius);
}

void Controller::drag_to_pan(glm::dvec2 from, glm::dvec2 to) {
  const glm::dvec2 by = (to - from) / size_.y;
  camera.pan(-by.x, by.y);
}

void Controller::scroll(double clicks) { camera.zoom(std::pow(zoom_per_click, clicks)); }

bool Controller::key(const std::string& name) {
  const std::map<std::string, std::function<void()>> meanings{
      {"space", [&] { driver_.set_paused(!driver_.paused()); }},
      {"n", [&] { driver_.single_step(); }},
      {"r", [&] { driver_.restart(); }},
      {"u", [&] { driver_.undo(); }},
      {"f", [&] { frame_building(); }},
      {"c", [&] { options.colouring = static_cast<Colouring>((static_cast<int>(options.colouring) + 1) % 5); }},
      {"1", [&] { options.shown.posts = !options.shown.posts; }},
      {"2", [&] { options.shown.beams = !options.shown.beams; }},
      {"3", [&] { options.shown.slabs = !options.shown.slabs; }},
      {"4", [&] { options.shown.walls = !options.shown.walls; }},
      {"h", [&] { help = !help; }}};
  const auto meaning = meanings.find(name);
  if (meaning == meanings.end()) return false;
  meaning->second();
  return true;
}

void Controller::show(const std::string& words) { viewer::show(words, options, mode); }

void Controller::update() {
  const Wanted wanted{options.diagram >= 0, options.loads || options.reactions || options.contacts};
  if (wanted == wanted_) return;
  wanted_ = wanted;
  driver_.want(wanted);
}

Snapshot Controller::drawn(Snapshot moment, double seconds, bool wait) {
  if (!mode.kind) return moment;
  const auto* known = wait ? &modes_.wait(*mode.kind) : modes_.find(*mode.kind);
  if (known == nullptr || known->empty()) return moment;
  const auto number = std::min(static_cast<std::size_t>(mode.number), known->size() - 1);
  moment.shape = (*known)[number].shape;
  const double swing = std::cos(glm::two_pi<double>() * seconds * swings_per_second);
  moment.shape_scale = static_cast<float>(mode_share * bounds_of(building_).radius() * swing) * mode.scale;
  return moment;
}

void Controller::hover(glm::dvec2 pixel) {
  hovered_ = pick(building_, *driver_.moment().later, options, ground_, camera.ray(pixel, size_));
  options.hovered_member = hovered_ ? hovered_->member : structure::MemberId();
  options.hovered_panel = hovered_ ? hovered_->panel : structure::PanelId();
}

}  // namespace topple::viewer
