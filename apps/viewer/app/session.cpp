#include "app/session.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <thread>
#include <utility>

#include "app/event_text.h"

namespace topple::viewer {
namespace {

/// A person's session has no end of its own (s).
constexpr double endless = 1e9;

/// Drawing keeps a processor to itself. More threads than eight find little to do in a step.
int threads_for_steps() { return std::clamp(static_cast<int>(std::thread::hardware_concurrency()) - 1, 1, 8); }

}  // namespace

Session::Session(std::shared_ptr<const structure::Building> building, structure::Scenario scenario,
                 std::shared_ptr<const std::vector<structure::DrawnMesh>> drawn, std::shared_ptr<Recording> recording,
                 std::optional<structure::StateStore> states)
    : building_(std::move(building)),
      given_(building_),
      scenario_(std::move(scenario)),
      drawn_meshes_(std::move(drawn)),
      recording_(std::move(recording)),
      states_(std::move(states)) {
  scenario_.duration = endless;
  scenario_.until_rest = false;
  begin();
}

void Session::begin() {
  simulation_ = std::make_unique<structure::Simulation>(*building_, scenario_,
                                                        structure::SimulationOptions{threads_for_steps(), {}});
  drawn_.reset();
  if (drawn_meshes_ && !drawn_meshes_->empty())
    drawn_ = std::make_unique<structure::VisualMesh>(*building_, *drawn_meshes_);
  taker_ = SnapshotTaker();
  taker_.begin(*simulation_);
  taker_.set_wanted(wanted_);
  for (const structure::Event& event : scenario_.events) watch(event.tool, event.at);
  tuning_ = std::make_unique<structure::JointTuning>(*building_);
  tuned_ = nullptr;
  if (building_ != given_) report_capacities();
  path_ = nullptr;
  events_recorded_ = 0;
  shaking_.reset();
  pulling_.clear();
  gravity_.reset();
  last_told_ = {-1, -1};
}

/// What of it is drawn beside what the simulation tells.
void Session::watch(const structure::Tool& tool, double at) {
  if (const auto* fire = std::get_if<structure::WeakenTool>(&tool)) taker_.burn(*fire, at);
  if (const auto* gone = std::get_if<structure::RemoveTool>(&tool)) taker_.mark_removed_supports(gone->supports, at);
}

void Session::step() {
  act_on();
  simulation_->step();
}

/// As the person, the scenario or the model has it, without what shakes.
structure::Vec3 Session::gravity_at_rest() const {
  if (gravity_) return *gravity_;
  structure::Vec3 gravity(0, 0, -building_->gravity);
  for (const structure::Event& event : scenario_.events)
    if (const auto* other = std::get_if<structure::GravityTool>(&event.tool); other && event.at <= simulation_->time())
      gravity = other->gravity;
  return gravity;
}

void Session::act_on() {
  constexpr double rounding = 1e-9;
  const double now = simulation_->time();
  if (shaking_) {
    const structure::TimeHistory& ground = *shaking_->earthquake.ground;
    const double time = now - shaking_->from;
    simulation_->apply(structure::GravityTool{gravity_at_rest() - ground_acceleration(ground, time)});
    if (time > ground.times.back()) shaking_.reset();
  }
  for (Pulling& one : pulling_) {
    const int steps = pull_steps(one.pull);
    const structure::Vec3 way = one.pull.winch - (*building_)[one.pull.node].position;
    for (; one.given < steps && now - one.from >= one.given * pull_interval - rounding; ++one.given) {
      if (!simulation_->frame().stands(one.pull.node)) continue;
      structure::NodeLoad load;
      load.node = one.pull.node;
      load.load.head<3>() = one.pull.force / steps * way.normalized();
      simulation_->apply(structure::LoadTool{{load}});
    }
  }
}

/// Carries it out and remembers it; `told` among the events.
void Session::keep(const Action& action, const std::string& told) {
  carry_out(action);
  actions_.push_back(action);
  recording_->add_event({simulation_->time(), structure::SimulationEvent::Kind::tool, told});
}

void Session::shake(const Earthquake& earthquake) {
  require_ground(*earthquake.ground);
  double peak = 0;
  for (const double time : earthquake.ground->times)
    peak = std::max(peak, ground_acceleration(*earthquake.ground, time).norm());
  char text[64];
  std::snprintf(text, sizeof text, "earthquake, up to %.3g m/s2", peak);
  keep({simulation_->steps(), earthquake}, text);
}

void Session::pull(const Pull& pull) {
  char text[64];
  std::snprintf(text, sizeof text, "a winch pulls with up to %.4g kN at ", pull.force / 1e3);
  keep({simulation_->steps(), pull}, text + (*building_)[pull.node].name);
}

void Session::burn_through(const Thermite& thermite) {
  keep({simulation_->steps(), thermite}, "thermite at " + (*building_)[thermite.joint].name);
}

void Session::apply(const structure::Tool& tool) {
  carry_out({simulation_->steps(), tool});  // one that throws is not kept
  actions_.push_back({simulation_->steps(), tool});
}

void Session::explode(const Explosion& explosion) {
  carry_out({simulation_->steps(), explosion});
  actions_.push_back({simulation_->steps(), explosion});
  char text[64];
  std::snprintf(text, sizeof text, "explosion of %.3g kg of TNT", explosion.charge);
  recording_->add_event({simulation_->time(), structure::SimulationEvent::Kind::tool, text});
}

void Session::tune(const structure::JointChange& change) {
  carry_out({simulation_->steps(), change});
  actions_.push_back({simulation_->steps(), change});
}

void Session::carry_out(const Action& action) {
  if (const auto* tool = std::get_if<structure::Tool>(&action.what)) {
    simulation_->apply(*tool);
    return follow(*tool, simulation_->time());
  }
  if (const auto* earthquake = std::get_if<Earthquake>(&action.what)) {
    shaking_ = {*earthquake, simulation_->time()};
    return;
  }
  if (const auto* pull = std::get_if<Pull>(&action.what)) {
    pulling_.push_back({*pull, simulation_->time()});
    return;
  }
  if (const auto* thermite = std::get_if<Thermite>(&action.what)) {
    constexpr int stages = 10;
    const structure::WeakenTool melting{{thermite->joint}, {}, 0, 1, thermite->over, stages};
    simulation_->apply(melting);
    taker_.burn(melting, simulation_->time(), DustPuff::Kind::sparks);
    return;
  }
  if (const auto* change = std::get_if<structure::CapacityChange>(&action.what)) {
    simulation_->set_capacities(change->joints);
    return follow(*change);
  }
  if (const auto* contact = std::get_if<structure::HostContact>(&action.what)) return simulation_->touch(*contact);
  if (const auto* explosion = std::get_if<Explosion>(&action.what)) {
    for (const structure::HostContact& contact : blast_contacts(*simulation_, *explosion)) simulation_->touch(contact);
    taker_.blast(explosion->centre, explosion->charge);
    return;
  }
  std::vector<std::pair<structure::JointId, structure::JointCapacity>> capacities;
  for (const structure::JointId joint : tuning_->apply(std::get<structure::JointChange>(action.what)))
    capacities.emplace_back(joint, tuning_->capacity(joint));
  simulation_->set_capacities(capacities);
  report_capacities();
  taker_.forget_answer();
}

void Session::follow(const structure::Tool& tool, double at) {
  watch(tool, at);
  if (const auto* other = std::get_if<structure::GravityTool>(&tool)) gravity_ = other->gravity;
}

/// As a saved run tells it: capacities that are set already. What is shown and written names joint after joint.
void Session::follow(const structure::CapacityChange& change) {
  for (const auto& [joint, capacity] : change.joints) {
    structure::JointChange one;
    one.joints = (*building_)[joint].name;
    one.strength = 1;
    for (std::size_t s = 0; s < capacity.value.size(); ++s)
      if (std::isfinite(capacity.value[s]))
        one.capacity[s] =
            capacity.value[s] / structure::capacity_unit(*building_, joint, static_cast<structure::Sense>(s));
    (void)tuning_->apply(one);
  }
  report_capacities();
  taker_.forget_answer();
}

std::string Session::save() const {
  if (states_) (void)states_->keep(*simulation_);
  return structure::snapshot_bytes(simulation_->save());
}

void Session::load(const structure::Snapshot& saved) {
  constexpr std::int64_t longest = 10'000'000;  // steps that are made and kept on the way: 46 hours at 60 a second
  restart();
  if (saved.step > longest) return report_restart("is of more than 10000000 steps");
  if (saved.scene != simulation_->save().scene) return report_restart("is of another model, scenario or rules");
  remember(saved);
  if (take_up_state(saved)) return end_shaking();
  try {
    run_again(saved.step, true);
    end_shaking();
  } catch (const std::exception& error) {
    return report_restart(error.what());
  }
  if (simulation_->hash() != saved.hash) report_restart("does not lead to the state that it was taken in");
}

void Session::report_restart(const std::string& why) {
  restart();
  recording_->add_event(
      {0, structure::SimulationEvent::Kind::tool, "the saved run cannot be taken up: it " + why + "; begun anew"});
}

void Session::remember(const structure::Snapshot& saved) {
  for (const auto& action : saved.actions) {
    if (const auto* tool = std::get_if<structure::Tool>(&action.what)) actions_.push_back({action.step, *tool});
    if (const auto* change = std::get_if<structure::CapacityChange>(&action.what))
      actions_.push_back({action.step, *change});
    if (const auto* contact = std::get_if<structure::HostContact>(&action.what))
      actions_.push_back({action.step, *contact});
  }
}

/// False: it is not kept.
bool Session::take_up_state(const structure::Snapshot& saved) {
  if (!states_ || !states_->load(saved, *simulation_)) return false;
  for (const Action& action : actions_) {
    if (const auto* tool = std::get_if<structure::Tool>(&action.what))
      follow(*tool, static_cast<double>(action.step) * scenario_.step);
    if (const auto* change = std::get_if<structure::CapacityChange>(&action.what)) follow(*change);
  }
  return true;
}

/// What shook the ground when it was saved ends here: only what it did is in the file.
void Session::end_shaking() {
  if (!gravity_ || gravity_->head<2>().isZero(0)) return;
  apply(structure::GravityTool{structure::Vec3(0, 0, gravity_at_rest().z())});
}

void Session::record_past() {
  if (recording_->span()[0] <= 0) return;
  recording_->clear();
  run_again(simulation_->steps(), true);
}

/// What joints bear, for those who know the building only as it was given.
void Session::report_capacities() {
  auto tuned = std::make_shared<TunedJoints>();
  for (std::size_t j = 0; j < building_->joints.size(); ++j) {
    tuned->capacity.push_back(tuning_->capacity(structure::JointId(j)));
    tuned->strength.push_back(tuning_->strength(structure::JointId(j)));
  }
  tuned->changes = tuning_->changes();
  tuned_ = std::move(tuned);
}

void Session::restart() {
  actions_.clear();
  recording_->clear();
  begin();
}

void Session::restart(const RunRules& rules) {
  scenario_.failure = rules.failure;
  scenario_.fracture = rules.fracture;
  simulation_.reset();
  tuning_.reset();
  drawn_.reset();
  if (rules.building) building_ = rules.building;
  restart();
}

bool Session::undo() {
  if (actions_.empty()) return false;
  const std::int64_t until = actions_.back().step;
  actions_.pop_back();
  run_again(until);
  return true;
}

void Session::return_to(std::int64_t step) {
  std::erase_if(actions_, [step](const Action& action) { return action.step >= step; });
  run_again(step);
}

bool Session::is_acted_on() const {
  return shaking_ || std::any_of(pulling_.begin(), pulling_.end(),
                                 [](const Pulling& one) { return one.given < pull_steps(one.pull); });
}

void Session::run_again(std::int64_t until, bool record) {
  begin();
  auto next = actions_.begin();
  const auto act = [&] {
    for (; next != actions_.end() && next->step == simulation_->steps(); ++next) carry_out(*next);
  };
  bool rested = false;
  for (act(); simulation_->steps() < until; act()) {
    // A long run is mostly rest, of which the first and the last step are kept: nothing changes between them.
    const std::int64_t end = next == actions_.end() ? until : next->step;
    const bool changes = !rested || !simulation_->at_rest() || is_acted_on() || taker_.burns(simulation_->time());
    if (record && (changes || simulation_->steps() + 1 >= end)) (void)snapshot();
    rested = simulation_->at_rest();
    step();
  }
  if (record) return;
  events_recorded_ = simulation_->events().size();
}

void Session::find_path(const structure::ContactPlace& place) {
  const auto& frame = simulation_->frame();
  const bool stands = place.member.valid() ? frame.stands(place.member) : frame.stands(place.panel);
  path_ = nullptr;
  if (!stands) return;
  auto path = std::make_shared<std::vector<float>>(building_->joints.size(), 0.0F);
  for (const auto& [joint, demand] : frame.respond(place, {0, 0, -1}).demands)
    (*path)[static_cast<std::size_t>(joint.index)] = static_cast<float>(demand.head<3>().norm());
  path_ = std::move(path);
}

/// Steps of what goes on (a ground that shakes, a rope that is pulled) are one line where they begin.
bool Session::is_told(const structure::SimulationEvent& event) {
  constexpr double apart = 0.3;  // s
  if (event.kind != structure::SimulationEvent::Kind::tool) return true;
  const bool gravity = event.name == "gravity";
  if (!gravity && event.name != "load") return true;
  if (gravity ? shaking_.has_value() : !pulling_.empty()) return false;
  double& last = last_told_[gravity ? 0 : 1];
  const double before = std::exchange(last, event.time);
  return before < 0 || event.time - before > apart;
}

void Session::record_events() {
  const auto events = simulation_->events();
  for (; events_recorded_ < events.size(); ++events_recorded_) {
    const auto& event = events[events_recorded_];
    if (!is_told(event)) continue;
    recording_->add_event({event.time, event.kind, event_text(event)});
  }
}

std::shared_ptr<const Snapshot> Session::snapshot() {
  auto snapshot = std::make_shared<Snapshot>(taker_.capture(*simulation_, drawn_.get()));
  snapshot->tuned = tuned_;
  snapshot->path = path_;
  for (const Pulling& one : pulling_)
    if (const structure::NodeId node = one.pull.node; simulation_->frame().stands(node))
      snapshot->ropes.push_back(
          {(*building_)[node].position + simulation_->frame().displacement(node).head<3>(), one.pull.winch});
  snapshot->actions = static_cast<int>(std::count_if(actions_.begin(), actions_.end(), [](const Action& action) {
    const auto* tool = std::get_if<structure::Tool>(&action.what);
    if (tool != nullptr) return !std::holds_alternative<structure::GravityTool>(*tool);
    return !std::holds_alternative<structure::JointChange>(action.what);
  }));
  recording_->add(*snapshot);
  record_events();
  return snapshot;
}

}  // namespace topple::viewer
