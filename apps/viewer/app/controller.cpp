#include "app/controller.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "app/target_building.h"
#include "app/tools/use_tool.h"
#include "renderer/instances/scene_instances.h"
#include "topple/structure/error.h"

namespace topple::viewer {
namespace {

/// A drag across the picture's height turns the view by half a turn.
constexpr double turn_per_height = glm::pi<double>();
constexpr double zoom_per_click = 0.88;
/// A drawn mode's largest translation, as a share of the building's radius, and its pace: every mode at the same one.
constexpr double mode_share = 0.05, swings_per_second = 0.5;

/// What stands on piers is seen down to the ground.
Bounds bounds_to_ground(const Scene& scene, double ground) {
  Bounds bounds = bounds_of_target(*scene.building, scene.scenario);
  bounds.low.z = std::min(bounds.low.z, ground);
  return bounds;
}

/// The member or panel that was pointed at stands.
bool stands(const Pick& picked, const Membership& membership) {
  if (picked.member.valid()) return membership.member[static_cast<std::size_t>(picked.member.index)] == part_stands;
  return picked.panel.valid() && membership.panel[static_cast<std::size_t>(picked.panel.index)] == part_stands;
}

}  // namespace

Controller::Controller(Driver& driver, const Scene& scene, double ground, glm::dvec2 size)
    : driver_(driver),
      scene_(scene),
      building_(*scene.building),
      names_(*scene.building),
      modes_(scene.building, scene.scenario.combination.value_or(structure::CombinationId(0u))),
      ground_(ground),
      size_(size),
      playback_(driver),
      files_(driver, playback_, message) {
  frame_building();
}

void Controller::frame_building() { camera = frame(bounds_to_ground(scene_, ground_), size_.x / size_.y); }

void Controller::view_from(double azimuth, double elevation) {
  camera = frame(bounds_to_ground(scene_, ground_), size_.x / size_.y, 0.12, azimuth, elevation);
}

std::optional<Pick> Controller::pick_at(glm::dvec2 pixel) const {
  return pick(building_, playback_.now(), options, ground_, camera.ray(pixel, size_));
}

void Controller::glide(const Camera& to, double over) {
  path_.glide(camera, to, over);
  if (!(over > 0)) camera = to;
}

void Controller::click(glm::dvec2 pixel) {
  if (hand.tool == ToolKind::fire) return fire(pixel);
  const auto found = pick_at(pixel);
  if (!found || !found->joint.valid()) {
    message = std::string(tool_names[static_cast<std::size_t>(hand.tool)]) + ": nothing of the building is there";
    return;
  }
  if (hand.tool == ToolKind::select) return select(*found);
  playback_.go_on_from_here();
  if (hand.tool == ToolKind::path) options.colouring = Colouring::path;
  if (const auto said = ToolUse(driver_, building_, hand, camera, ground_).on(*found)) message = said;
}

void Controller::fire(glm::dvec2 pixel) {
  const auto target = pick_at(pixel);
  playback_.go_on_from_here();
  ToolUse(driver_, building_, hand, camera, ground_).fire(camera.ray(pixel, size_), target);
}

void Controller::shake() {
  auto ground = std::make_shared<structure::TimeHistory>(
      hand.shaking.file.empty() ? strong_motion(hand.shaking.peak, hand.shaking.over)
                                : structure::read_time_history(hand.shaking.file, building_));
  require_ground(*ground);
  playback_.go_on_from_here();
  const Earthquake earthquake{std::move(ground)};
  driver_.order_and_show([earthquake](Session& session) { session.shake(earthquake); });
  message = "the ground shakes";
}

void Controller::set_gravity(double downwards) {
  driver_.apply(structure::GravityTool{structure::Vec3(0, 0, -downwards)});
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

void Controller::show(const std::string& words) { viewer::show(words, options, mode); }

void Controller::restart(const RunRules& rules) {
  structure::Scenario scenario = scene_.scenario;
  scenario.failure = rules.failure;
  scenario.fracture = rules.fracture;
  // Refused here, where a person is told, and not on the simulation's thread.
  const structure::Simulation tried(rules.building ? *rules.building : building_, scenario);
  playback_.seek_present();
  driver_.order_and_show([rules](Session& session) { session.restart(rules); });
}

void Controller::tune(const structure::JointChange& change) {
  (void)structure::joints_of(building_, names_, change.joints);  // refused here, on the person's thread
  driver_.order_and_show([change](Session& session) { session.tune(change); });
}

void Controller::leave_what_came_off(const Snapshot& moment) {
  if (!hovered_ || !hovered_stood_ || stands(*hovered_, *moment.membership)) return;
  hovered_.reset();
  options.hovered_member = structure::MemberId();
  options.hovered_panel = structure::PanelId();
}

void Controller::hover(glm::dvec2 pixel) {
  hovered_ = pick_at(pixel);
  hovered_stood_ = hovered_ && stands(*hovered_, *playback_.now().membership);
  options.hovered_member = hovered_ ? hovered_->member : structure::MemberId();
  options.hovered_panel = hovered_ ? hovered_->panel : structure::PanelId();
}

void Controller::select(structure::JointId joint) {
  options.selected_joint = joint;
  options.selected_member = building_[joint].member;
  options.selected_panel = building_[joint].panel;
}

void Controller::select(const Pick& found) {
  if (found.joint.valid()) select(found.joint);
}

void Controller::select(const std::string& name) {
  if (const auto joint = names_.joint(name)) return select(*joint);
  if (const auto member = names_.member(name)) return select(building_.joint(*member, 0));
  if (const auto panel = names_.panel(name)) return select(building_.joint(*panel, 0));
  throw structure::InputError("select \"" + name + "\": no joint, member or panel has this name");
}

std::vector<structure::JointId> Controller::search(const std::string& text, std::size_t most) const {
  std::vector<structure::JointId> found;
  if (text.empty()) return found;
  const bool joints = text.find(':') != std::string::npos, pattern = text.find('*') != std::string::npos;
  const auto fits = [&](const std::string& name) {
    return pattern ? structure::matches_pattern(text, name) : name.find(text) != std::string::npos;
  };
  for (std::size_t j = 0; j < building_.joints.size() && found.size() < most; ++j) {
    const structure::Joint& joint = building_.joints[j];
    const std::string& owner = joint.member.valid() ? building_[joint.member].name : building_[joint.panel].name;
    if (joints ? fits(joint.name) : joint.end == 0 && fits(owner)) found.emplace_back(j);
  }
  return found;
}

void Controller::update(double seconds) {
  swing_ += seconds;
  if (const std::optional<Camera> flown = path_.advance(seconds)) camera = *flown;
  files_.print_exported();
  playback_.advance(seconds);
  const Wanted wanted{options.diagram >= 0, options.loads || options.reactions || options.contacts};
  if (wanted == wanted_) return;
  wanted_ = wanted;
  driver_.order_and_show([wanted](Session& session) { session.set_wanted(wanted); });
}

Snapshot Controller::shown(bool wait) {
  Snapshot moment = playback_.now();
  leave_what_came_off(moment);
  if (!mode.kind) return moment;
  const auto* known = wait ? &modes_.wait_for(*mode.kind) : modes_.find(*mode.kind);
  if (known == nullptr || known->empty()) return moment;
  const auto number = std::min(static_cast<std::size_t>(mode.number), known->size() - 1);
  moment.shape = (*known)[number].shape;
  moment.shape_bulge = (*known)[number].bulge;
  const double phase = std::cos(glm::two_pi<double>() * swing_ * swings_per_second);
  moment.shape_scale = static_cast<float>(mode_share * bounds_of(building_).radius() * phase) * mode.scale;
  return moment;
}

}  // namespace topple::viewer
