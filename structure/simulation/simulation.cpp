// The step, as a table of contents, and what a host asks of a simulation.
#include "topple/structure/simulation.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "simulation/accounts/replay_hash.h"
#include "simulation/call_checks.h"
#include "simulation/simulation_state.h"
#include "simulation/step_clock.h"

namespace topple::structure {

void Simulation::step() {
  State& s = *state_;
  ++s.scene.step;
  s.scene.timer.start_step();
  s.views.start_step();
  s.hosts.start_step();
  if (s.progress.idle()) {
    ++s.sums.counters.steps_idle;
  } else {
    const auto timed = [&](Stage stage, const auto& work) {
      return s.scene.timer.stage(static_cast<std::size_t>(stage), work);
    };
    timed(Stage::load, [&] { s.tools.use(); });
    const auto contacts = timed(Stage::sweep, [&] { return s.sweep_step(); });
    timed(Stage::load, [&] { s.load(); });
    const std::int64_t newest = s.debris.bodies.newest();
    timed(Stage::break_, [&] {
      s.hosts.strike_all();
      s.strike(contacts, s.in_substeps ? s.first_substep() : s.scene.scenario.step);
      s.scene.sways() ? s.begin_motion() : s.break_generations();
    });
    timed(Stage::release, [&] {
      s.release.release();
      s.strike_released(newest);
    });
    timed(Stage::move, [&] { s.move(); });
    if (s.scene.sways()) timed(Stage::break_, [&] { s.end_motion(); });
    timed(Stage::account, [&] { s.account(); });
  }
  s.progress.record();
  s.log.call_listeners();
}

Simulation::State::State(Building the_building, Scenario the_scenario, SimulationOptions the_options)
    : StageParts(std::move(the_building), std::move(the_scenario), std::move(the_options)) {
  moving_parts = std::make_unique<MovingParts>(
      debris, hinges, sums, MovingParts::Substep{[this] { substep(); }, [this](double dt) { strike_between(dt); }});
  if (scene.sways()) scene.frame->let_move(scene.scenario.step, scene.scenario.motion);
  panels.open();
}

Simulation::State::~State() = default;

/// What is told of impacts is forgotten before the next contacts are found.
std::vector<collision::Contact> Simulation::State::sweep_bodies(double dt) {
  struck.clear();
  release_impulses.clear();
  return sweep.contacts(dt, scene.sways() && scene.world->steps_in_parts() ? moving_parts.get() : nullptr);
}

std::vector<collision::Contact> Simulation::State::sweep_step() {
  bodies.start_step();
  const double dt = scene.scenario.step;
  std::vector<collision::Contact> contacts = sweep_bodies(dt);
  if (!scene.sways() || !scene.world->steps_in_parts()) return contacts;
  const double first = first_substep();
  in_substeps =
      scene.frame->in_motion() || std::any_of(contacts.begin(), contacts.end(), [&](const auto& contact) {
        return contact.other.kind == collision::Touched::Kind::obstacle && body_impacts.comes_hard(contact, first);
      });
  if (in_substeps) std::erase_if(contacts, [&](const collision::Contact& contact) { return contact.time > first; });
  return contacts;
}

void Simulation::State::strike(const std::vector<collision::Contact>& contacts, double dt) {
  standing_impacts.strike_all(contacts);
  body_impacts.strike_all(contacts, dt);
}

void Simulation::State::load() {
  sums.counters.contacts_ignored +=
      debris.resting.lay(*scene.frame, scene.strength_factors, scene.sways(), [&](collision::BodyId id) {
        const Body* one = debris.find(id);
        return one ? one->rest.mass * scene.gravity.norm() : 0.0;
      });
}

void Simulation::State::record(const std::vector<JointBreak>& breaks) {
  for (const JointBreak& line : scene.frame->extract_yielded()) {
    SimulationEvent& event = log.record(SimulationEvent::Kind::joint_yielded, scene.building[line.joint].name);
    event.joint = line;
    event.position = line.position;
  }
  for (const JointBreak& broken : breaks) log.record(broken);
}

/// Until nothing is over capacity and no panel cracks.
void Simulation::State::break_generations() {
  if (!scene.frame->pending() && scene.step > 1) return;
  do {
    record(scene.frame->settle());
    if (panels.any()) standing_fracture.crack();
  } while (scene.frame->pending());
}

/// Tools, impacts and what lies on it act on what stands; panels that bear too much at rest crack, which moves them.
void Simulation::State::begin_motion() {
  if (!scene.frame->pending() && scene.step > 1) return;
  record(scene.frame->begin_move());
  if (panels.any()) standing_fracture.crack();
}

/// What broke is told, and what lost its hold by that leaves.
void Simulation::State::let_broken_go() {
  record(scene.frame->extract_breaks());
  release.release();
}

/// One substep of what stands; what lost its hold in it leaves at once.
void Simulation::State::substep() {
  const auto crack = panels.any() ? std::function<void()>([&] { standing_fracture.crack(); }) : std::function<void()>();
  scene.timer.within(static_cast<std::size_t>(Stage::move), static_cast<std::size_t>(Stage::break_),
                     [&] { scene.frame->move_on(crack); });
  if (!crack && !scene.frame->has_detached()) return;
  let_broken_go();
  let_holds_change();
}

/// Hinges on what moves are as heavy as that gives way: without what left.
void Simulation::State::let_holds_change() {
  if (!hinges.holds().any()) return;
  scene.frame->take_changes();
  if (!scene.frame->has_detached()) return;
  let_broken_go();
}

/// What debris comes upon in the next substep, of `dt`, strikes at its start as at that of a step. Else contacts would
/// press it into the frame within one substep, with forces that no part's own compliance lets through.
void Simulation::State::strike_between(double dt) {
  if (--substeps_left <= 0 || scene.world->awake_count() == 0 || !scene.world->steps_in_parts()) return;
  std::vector<collision::Contact> contacts;
  const auto move = static_cast<std::size_t>(Stage::move);
  scene.timer.within(move, static_cast<std::size_t>(Stage::sweep), [&] { contacts = sweep_bodies(dt); });
  scene.timer.within(move, static_cast<std::size_t>(Stage::break_), [&] { strike_on(std::move(contacts), dt); });
}

/// What an impact lets go is beside something from the beginning, and may come upon that before it has moved: it is
/// swept and strikes at once, until nothing more is let go.
void Simulation::State::strike_on(std::vector<collision::Contact> contacts, double dt) {
  const auto hard = [&](const collision::Contact& contact) { return body_impacts.comes_hard(contact, dt); };
  while (std::any_of(contacts.begin(), contacts.end(), hard)) {
    const std::int64_t newest = debris.bodies.newest();
    scene.frame->read_demands();
    strike(contacts, dt);
    let_broken_go();
    if (debris.bodies.newest() == newest) return;
    contacts = sweep_bodies(dt);
  }
}

/// What tools and impacts let go as the step began: as strike_on(), in the first substep.
void Simulation::State::strike_released(std::int64_t newest) {
  if (!scene.sways() || !scene.world->steps_in_parts() || debris.bodies.newest() == newest) return;
  strike_on(sweep_bodies(first_substep()), first_substep());
}

void Simulation::State::end_motion() {
  if (!scene.frame->pending() && scene.step > 1) return;
  record(scene.frame->end_move());
  scene.timer.engine([&] {
    debris.obstacles.follow(*scene.frame, *scene.world);
    hinges.holds().follow();
  });
}

/// The collision world moves what is awake, and what stands where it moves.
void Simulation::State::move() {
  bodies.start_motion();
  const double dt = scene.scenario.step;
  const bool together = in_substeps || scene.frame->in_motion();
  if (scene.world->awake_count() == 0 && !together) return;
  substeps_left = scene.frame->substeps();
  hinges.begin_motion();
  if (together) let_holds_change();
  scene.timer.engine(
      [&] { together ? scene.world->step(dt, scene.frame->substeps(), *moving_parts) : scene.world->step(dt); });
  overlaps.read();
  ++sums.counters.collision_steps;
}

/// Energies, events and counters; what came down hard breaks up.
void Simulation::State::account() {
  bodies.count_contacts();
  if (scene.frame->has_detached()) release.release();  // at the end of its motion
  hinges.pull();
  bodies.count_bodies();
  auto next = debris.bodies.motions().begin();  // asked for in order of id
  debris.resting.read(bodies.contacts(), debris.obstacles, scene.scenario.step, [&](collision::BodyId id) {
    while (next != debris.bodies.motions().end() && next->id < id.value) ++next;
    return next != debris.bodies.motions().end() && next->id == id.value && !scene.world->state(id).asleep;
  });
  const std::vector<ContactRecord> landings = debris_fracture.landings(bodies.contacts());
  if (debris_fracture.shatter_landed(landings)) release.keep_limit();
  const auto impacts = debris_fracture.impacts_on_panels(landings);
  break_up.break_landed(bodies.contacts());
  debris_fracture.crumble(impacts);
  release.keep_limit();  // some may have fallen asleep
  views.update();
}

Simulation::Simulation(Building building, Scenario scenario, SimulationOptions options) {
  require_scene(building, scenario);
  state_ = std::make_unique<State>(std::move(building), std::move(scenario), std::move(options));
}
Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;

std::int64_t Simulation::skip_idle() {
  return skip_idle_before(step_of(state_->scene.scenario.duration, state_->scene.scenario.step));
}

/// Passes over idle steps, at most to the one before `end`.
std::int64_t Simulation::skip_idle_before(std::int64_t end) {
  const std::int64_t passed = state_->progress.skip_idle_before(end);
  state_->sums.counters.steps_idle += static_cast<std::uint64_t>(passed);
  return passed;
}

bool Simulation::finished() const { return state_->progress.finished(); }
double Simulation::time() const { return state_->scene.time(); }
std::int64_t Simulation::steps() const { return state_->scene.step; }
bool Simulation::at_rest() const { return state_->progress.rests(); }
void Simulation::apply(const Tool& tool) {
  require_tool(state_->scene.building, tool);
  state_->tools.request(tool);
  state_->actions.add(tool);
}
void Simulation::touch(const HostContact& contact) {
  require_contact(state_->scene.building, contact);
  state_->hosts.add(contact);
  state_->actions.add(contact);
}
std::span<const HostImpulse> Simulation::host_impulses() const { return state_->hosts.impulses(); }
const BodyOverlaps& Simulation::overlaps() const { return state_->overlaps.told(); }
void Simulation::on_event(std::function<void(const SimulationEvent&)> listener) {
  state_->log.listen(std::move(listener));
}
std::span<const SimulationEvent> Simulation::events() const { return state_->log.events(); }
const Building& Simulation::building() const { return state_->scene.building; }
const Scenario& Simulation::scenario() const { return state_->scene.scenario; }
const StandingFrame& Simulation::frame() const { return *state_->scene.frame; }
std::span<const BodyView> Simulation::bodies() const { return state_->views.all(); }
std::span<const double> Simulation::poses() const { return *state_->views.poses(); }
std::shared_ptr<const std::vector<double>> Simulation::held_poses() const { return state_->views.poses(); }
const PieceChanges& Simulation::changes() const { return state_->views.changes(); }

collision::BodyId Simulation::body_of(MemberId member) const {
  require_id(state_->scene.building, member, "body_of");
  return {state_->debris.body_of(Part(member))};
}
collision::BodyId Simulation::body_of(PanelId panel) const {
  require_id(state_->scene.building, panel, "body_of");
  return {state_->debris.body_of(Part(panel))};
}

std::shared_ptr<const fracture::Mesh> Simulation::broken_panel(PanelId panel) const {
  require_id(state_->scene.building, panel, "broken_panel");
  const BrokenPanel* broken = state_->panels.broken(panel);
  return broken ? broken->mesh() : nullptr;
}

std::optional<Simulation::RayHit> Simulation::ray_cast(const Vec3& from, const Vec3& direction) const {
  constexpr double sight = 1e4;  // m, farther than any scene
  const State& s = *state_;
  const Vec3 n = direction.stableNormalized();
  if (!from.allFinite() || !(std::abs(n.norm() - 1) < 1e-9)) return std::nullopt;  // it looks nowhere
  RayHit nearest;
  nearest.distance = sight;
  bool found = false;
  for (std::size_t i = 0; i < part_count(s.scene.building); ++i) {
    const Part part = part_of_number(s.scene.building, static_cast<std::int64_t>(i));
    if (!s.scene.stands(part)) continue;
    const BrokenPanel* broken = part.panel.valid() ? s.panels.broken(part.panel) : nullptr;
    const auto distance = broken ? broken->ray(from, n) : s.debris.shapes.ray(part, from, n);
    if (!distance || *distance >= nearest.distance) continue;
    nearest.member = part.member;
    nearest.panel = part.panel;
    nearest.distance = *distance;
    found = true;
  }
  if (const auto hit = s.scene.world->ray_cast(from, from + sight * n); hit && hit->distance < nearest.distance) {
    const Part part =
        hit->what.kind == collision::Touched::Kind::obstacle ? s.debris.obstacles.part_of(hit->what.obstacle) : Part();
    nearest = {part.member, part.panel, hit->what.body, hit->point, hit->distance};
    return nearest;
  }
  if (!found) return std::nullopt;
  nearest.point = from + nearest.distance * n;
  return nearest;
}

const Ledger& Simulation::ledger() const {
  state_->bodies.bring_ledger_up_to_date();
  return state_->sums.ledger;
}

const SimulationCounters& Simulation::counters() const {
  const FrameCounters& frame = state_->scene.frame->counters();
  SimulationCounters& counters = state_->sums.counters;
  counters.solves = frame.solves;
  counters.low_rank = frame.low_rank;
  counters.refactorisations = frame.refactorisations;
  counters.segmentations = frame.segmentations;
  counters.selective = frame.selective;
  counters.background_factors = frame.background_factors;
  counters.late_factors = frame.late_factors;
  return counters;
}

const std::array<double, 6>& Simulation::stage_seconds() const { return state_->scene.timer.stages(); }
double Simulation::collision_engine_seconds() const { return state_->scene.timer.engine_seconds(); }

std::uint64_t Simulation::hash() const {
  const State& s = *state_;
  ReplayHash hash;
  const auto by_name = [](const auto& things) {
    std::vector<std::size_t> order(things.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](auto a, auto b) { return things[a].name < things[b].name; });
    return order;
  };
  for (const std::size_t i : by_name(s.scene.building.joints))
    if (!s.break_up.holds(JointId(i))) hash.add(s.scene.building.joints[i].name);
  for (const std::size_t i : by_name(s.scene.building.nodes)) {
    if (!s.scene.frame->stands(NodeId(i))) continue;
    hash.add(s.scene.building.nodes[i].name);
    hash.add(s.scene.frame->displacement(NodeId(i)));
  }
  std::map<std::string, const Body*> named;
  for (const auto& [id, body] : s.debris.bodies) named.emplace(body.name, &body);
  for (const auto& [name, body] : named) {
    const collision::BodyState state = s.scene.world->state(body->id);
    hash.add(name);
    hash.add(state.pose.position);
    hash.add(Eigen::Vector4d(state.pose.orientation.coeffs()));
    hash.add(state.velocity);
    hash.add(state.angular_velocity);
  }
  return hash.value();
}

}  // namespace topple::structure
