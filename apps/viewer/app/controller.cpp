#include "app/controller.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <functional>
#include <future>
#include <glm/gtc/constants.hpp>
#include <stdexcept>

#include "app/output/gltf_scene.h"
#include "app/output/html_replay.h"
#include "app/output/usd_scene.h"
#include "app/target_building.h"
#include "renderer/instances.h"
#include "topple/structure/error.h"
#include "topple/structure/formats/output_files.h"

namespace topple::viewer {
namespace {

/// A drag across the picture's height turns the view by half a turn.
constexpr double turn_per_height = glm::pi<double>();
constexpr double zoom_per_click = 0.88;
/// A drawn mode's largest translation, as a share of the building's radius, and its pace: every mode at the same one.
constexpr double mode_share = 0.05, swings_per_second = 0.5;

using Export = std::function<void(const structure::Building&, const Recording&, const std::string&)>;
Export export_for(const std::string& file) {
  const std::string ending = std::filesystem::path(file).extension().string();
  if (ending == ".html") return write_html_replay;
  if (ending == ".usda")
    return [](const auto& building, const auto& run, const auto& to) { write_usd(building, run, to); };
  if (ending == ".glb")
    return [](const auto& building, const auto& run, const auto& to) { write_gltf(building, run, to); };
  throw structure::InputError("export to '" + file + "': accepted endings: .html, .usda, .glb");
}

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
      size_(size) {
  frame_building();
}

void Controller::frame_building() { camera = frame(bounds_to_ground(scene_, ground_), size_.x / size_.y); }

void Controller::view_from(double azimuth, double elevation) {
  camera = frame(bounds_to_ground(scene_, ground_), size_.x / size_.y, 0.12, azimuth, elevation);
}

Snapshot Controller::now() const {
  return looking_at_ ? driver_.recording().at(*looking_at_) : driver_.moment().interpolated();
}

std::optional<Pick> Controller::pick_at(glm::dvec2 pixel) const {
  return pick(building_, now(), options, ground_, camera.ray(pixel, size_));
}

void Controller::glide(const Camera& to, double over) {
  if (over > 0)
    flight_ = {{camera, to}, over, 0};
  else
    camera = to, flight_.reset();
}

void Controller::fly_path() {
  constexpr double leg = 3;  // s, between two views
  if (views_.size() < 2) {
    message = "a path needs two views or more: F5 adds what is seen";
    return;
  }
  flight_ = {views_, leg, 0};
}

void Controller::fly_on(double seconds) {
  if (!flight_) return;
  flight_->gone += seconds;
  camera = along_path(flight_->views, flight_->gone / flight_->leg);
  if (flight_->gone >= flight_->leg * static_cast<double>(flight_->views.size() - 1)) flight_.reset();
}

void Controller::save(const std::string& file) {
  const auto bytes = std::make_shared<std::promise<std::string>>();
  auto saved = bytes->get_future();
  driver_.order([bytes](Session& session) { bytes->set_value(session.save()); });
  // A run that has stopped with an error carries out no orders.
  if (saved.wait_for(std::chrono::seconds(30)) != std::future_status::ready)
    throw std::runtime_error("the run does not answer: nothing is saved");
  structure::write_file(file, saved.get());
  message = "saved to " + file;
}

void Controller::load(const std::string& file) {
  const structure::Snapshot saved = structure::read_snapshot(file);
  look_at_present();
  driver_.order_and_show([saved](Session& session) { session.load(saved); });
  message = "taken up from " + file;
}

void Controller::export_run(const std::string& file) {
  const Export write = export_for(file);
  if (exporting_.valid()) finish_export();
  const auto written = std::make_shared<std::promise<std::string>>();
  exporting_ = written->get_future();
  message = "writing " + file + " ...";
  // Between two steps: nothing is added to the recording meanwhile.
  driver_.order([written, write, file](Session& session) {
    try {
      write(session.building(), *session.recording(), file);
      written->set_value(file);
    } catch (...) {
      written->set_exception(std::current_exception());
    }
  });
}

void Controller::finish_export() {
  if (exporting_.valid()) message = "run written to " + exporting_.get();
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
  look_at_present();
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
  hovered_stood_ = hovered_ && stands(*hovered_, *now().membership);
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
  fly_on(seconds);
  if (exporting_.valid() && exporting_.wait_for(std::chrono::seconds(0)) == std::future_status::ready) {
    try {
      finish_export();
    } catch (const std::exception& failed) {
      message = failed.what();
    }
  }
  if (looking_at_ && replaying_) {
    const auto span = driver_.recording().span();
    looking_at_ = *looking_at_ + seconds * driver_.speed();
    if (*looking_at_ >= span[1]) {
      looking_at_ = span[1];
      replaying_ = false;
    }
  }
  const Wanted wanted{options.diagram >= 0, options.loads || options.reactions || options.contacts};
  if (wanted == wanted_) return;
  wanted_ = wanted;
  driver_.order_and_show([wanted](Session& session) { session.want(wanted); });
}

Snapshot Controller::shown(bool wait) {
  Snapshot moment = now();
  leave_what_came_off(moment);
  if (!mode.kind) return moment;
  const auto* known = wait ? &modes_.wait(*mode.kind) : modes_.find(*mode.kind);
  if (known == nullptr || known->empty()) return moment;
  const auto number = std::min(static_cast<std::size_t>(mode.number), known->size() - 1);
  moment.shape = (*known)[number].shape;
  moment.shape_bulge = (*known)[number].bulge;
  const double phase = std::cos(glm::two_pi<double>() * swing_ * swings_per_second);
  moment.shape_scale = static_cast<float>(mode_share * bounds_of(building_).radius() * phase) * mode.scale;
  return moment;
}

void Controller::look_at(double time) {
  const auto span = driver_.recording().span();
  looking_at_ = std::clamp(time, span[0], span[1]);
  driver_.set_paused(true);
}

void Controller::look_along(double seconds) {
  const std::array<double, 2> span = driver_.recording().span();
  const double time = looking_at_.value_or(span[1]) + seconds;
  time < span[1] ? look_at(std::max(time, span[0])) : look_at_present();
}

void Controller::look_at_present() {
  looking_at_.reset();
  replaying_ = false;
}

void Controller::go_on_from_here() {
  if (!looking_at_) return;
  const std::int64_t step = driver_.recording().at(*looking_at_).step;
  look_at_present();
  driver_.order_and_show([step](Session& session) { session.return_to(step); });
}

}  // namespace topple::viewer
