#include "app/controller.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <future>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <map>
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

structure::Vec3 to_eigen(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

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

void Controller::click(glm::dvec2 pixel) {
  if (tool == ToolKind::fire) return fire(pixel);
  const auto found = pick_at(pixel);
  if (!found || !found->joint.valid()) {
    message = std::string(tool_names[static_cast<std::size_t>(tool)]) + ": nothing of the building is there";
    return;
  }
  if (tool == ToolKind::select) return select(*found);
  if (looking_at_) go_on_from_here();
  use(*found);
}

void Controller::use(const Pick& found) {
  const auto said = [&](const std::string& what) { message = what; };
  switch (tool) {
    case ToolKind::cut:
      driver_.apply(structure::CutTool{{found.joint}});
      return said("cut " + building_[found.joint].name);
    case ToolKind::remove: {
      structure::RemoveTool gone;
      if (found.member.valid()) gone.members = {found.member};
      if (found.panel.valid()) gone.panels = {found.panel};
      driver_.apply(gone);
      return said("removed " + (found.member.valid() ? building_[found.member].name : building_[found.panel].name));
    }
    case ToolKind::support:
      return remove_support_at(found);
    case ToolKind::charge:
      driver_.apply(structure::ChargeTool{to_eigen(found.point), charge_radius, 0, 1});
      return said("charge at " + building_[found.joint].name);
    case ToolKind::swing:
      return swing_at(found);
    case ToolKind::burn:
      return burn_at(found);
    case ToolKind::explosion:
      return explode_at(found);
    case ToolKind::thermite: {
      if (!found.member.valid()) return said("thermite: click a post, beam or brace");
      const Thermite thermite{found.joint, thermite_over};
      driver_.order_and_show([thermite](Session& session) { session.burn_through(thermite); });
      return said("thermite at " + building_[found.joint].name);
    }
    case ToolKind::hook:
      return pull_at(found);
    case ToolKind::path: {
      const structure::ContactPlace place{found.member, found.panel, to_eigen(found.point)};
      driver_.order_and_show([place](Session& session) { session.find_path(place); });
      options.colouring = Colouring::path;
      return said("the way of a downward force on " + building_[found.joint].name);
    }
    default:
      return;
  }
}

void Controller::remove_support_at(const Pick& found) {
  if (!found.member.valid()) {
    message = "remove support: click a member that stands on one";
    return;
  }
  const auto supported = [&](structure::NodeId node) {
    return std::any_of(building_.supports.begin(), building_.supports.end(),
                       [node](const structure::NodeSupport& s) { return s.node == node; });
  };
  for (const structure::NodeId node : building_[found.member].nodes) {
    if (!supported(node)) continue;
    driver_.apply(structure::RemoveTool{{}, {}, {node}});
    message = "removed the support of " + building_[node].name;
    return;
  }
  message = "remove support: " + building_[found.member].name + " stands on none";
}

/// The ball is lowest, and fastest, where it meets the place; it comes from the side of the eye.
void Controller::swing_at(const Pick& found) {
  glm::dvec2 way(found.point.x - camera.eye.x, found.point.y - camera.eye.y);
  way = glm::length(way) > 1e-9 ? glm::normalize(way) : glm::dvec2(1, 0);
  const glm::dvec3 ahead(way, 0);
  const glm::dvec3 lowest = found.point - swing.radius * ahead;
  const glm::dvec3 anchor = lowest + glm::dvec3(0, 0, swing.cable);
  structure::WreckingBall ball;
  ball.anchor = to_eigen(anchor);
  ball.from =
      to_eigen(anchor - swing.cable * (std::sin(swing.angle) * ahead + glm::dvec3(0, 0, std::cos(swing.angle))));
  // Taut, whatever rounding has made of the place.
  ball.cable = std::max(swing.cable, (ball.anchor - ball.from).norm());
  ball.mass = swing.mass;
  ball.radius = swing.radius;
  driver_.apply(ball);
  message = "a ball swings at " + building_[found.joint].name;
}

/// The charge hangs half a metre before what is seen.
void Controller::explode_at(const Pick& found) {
  constexpr double before = 0.5;
  const glm::dvec3 back = glm::normalize(camera.eye - found.point);
  const Explosion explosion{to_eigen(found.point + before * back), explosive};
  driver_.order_and_show([explosion](Session& session) { session.explode(explosion); });
  char text[48];
  std::snprintf(text, sizeof text, "%.3g kg of TNT explode at ", explosive);
  message = text + building_[found.joint].name;
}

/// At the nearest end of the member, or corner of the panel; the winch stands on the ground as far away as the building
/// is high, and half of that more.
void Controller::pull_at(const Pick& found) {
  const auto place_of = [&](structure::NodeId node) { return building_[node].position; };
  structure::NodeId nearest;
  const auto look_at_node = [&](structure::NodeId node) {
    const structure::Vec3 point = to_eigen(found.point);
    if (!nearest.valid() || (place_of(node) - point).norm() < (place_of(nearest) - point).norm()) nearest = node;
  };
  if (found.member.valid())
    for (const structure::NodeId node : building_[found.member].nodes) look_at_node(node);
  if (found.panel.valid())
    for (const structure::NodeId node : building_[found.panel].nodes) look_at_node(node);
  if (!nearest.valid()) return;
  glm::dvec2 way(camera.eye.x - found.point.x, camera.eye.y - found.point.y);
  way = glm::length(way) > 1e-9 ? glm::normalize(way) : glm::dvec2(1, 0);
  const structure::Vec3 at = place_of(nearest);
  const double away = 5 + 1.5 * std::max(0.0, at.z() - ground_);
  const Pull pull{nearest, {at.x() + away * way.x, at.y() + away * way.y, ground_}, hauling.force, hauling.over};
  driver_.order_and_show([pull](Session& session) { session.pull(pull); });
  message = "a winch pulls at " + building_[nearest].name;
}

void Controller::shake() {
  auto ground = std::make_shared<structure::TimeHistory>(shaking.file.empty()
                                                             ? strong_motion(shaking.peak, shaking.over)
                                                             : structure::read_time_history(shaking.file, building_));
  require_ground(*ground);
  if (looking_at_) go_on_from_here();
  const Earthquake earthquake{std::move(ground)};
  driver_.order_and_show([earthquake](Session& session) { session.shake(earthquake); });
  message = "the ground shakes";
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

void Controller::burn_at(const Pick& found) {
  structure::WeakenTool fire;
  const structure::Vec3 place = to_eigen(found.point);
  const auto near = [&](const structure::Vec3& p) { return (p - place).norm() <= burning.reach; };
  for (std::size_t m = 0; m < building_.members.size(); ++m) {
    const structure::Member& member = building_.members[m];
    const structure::Vec3 ends[] = {building_[member.nodes[0]].position, building_[member.nodes[1]].position};
    if (near((ends[0] + ends[1]) / 2)) fire.members.emplace_back(m);
    for (int end = 0; end < 2; ++end)
      if (near(ends[end])) fire.joints.push_back(building_.joint(structure::MemberId(m), end));
  }
  std::sort(fire.joints.begin(), fire.joints.end());
  if (fire.members.empty() && fire.joints.empty()) {
    message = "burn: nothing is within " + std::to_string(burning.reach) + " m";
    return;
  }
  fire.strength = burning.strength;
  fire.stiffness = burning.stiffness;
  fire.over = burning.over;
  fire.stages = burning_stages;
  message = std::to_string(fire.members.size()) + " members and " + std::to_string(fire.joints.size()) +
            " joints burn around " + building_[found.joint].name;
  driver_.apply(fire);
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

void Controller::fire(glm::dvec2 pixel) {
  const Ray ray = camera.ray(pixel, size_);
  const auto target = pick_at(pixel);
  if (looking_at_) go_on_from_here();
  const double distance = target ? target->distance : camera.distance();
  const double flight = distance / shot.speed;
  const glm::dvec3 velocity =
      shot.speed * ray.direction + glm::dvec3(0, 0, building_.gravity * flight / 2);  // falls g t^2/2 on the way
  structure::Projectile projectile;
  projectile.from = to_eigen(ray.origin);
  projectile.velocity = to_eigen(velocity);
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

void Controller::hover(glm::dvec2 pixel) {
  hovered_ = pick_at(pixel);
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
