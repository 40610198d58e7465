#include "topple/structure/pacer.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "topple/structure/step_thread.h"

namespace topple::structure {

namespace {

PacedPiece piece_of(const BodyView& view) {
  PacedPiece piece;
  piece.handle = view.id.value;
  piece.name = view.name;
  piece.rest_centre = view.rest_centre;
  piece.mass = view.mass;
  piece.radius = view.radius;
  piece.members.assign(view.members.begin(), view.members.end());
  piece.panels.assign(view.panels.begin(), view.panels.end());
  piece.chunk = view.chunk;
  piece.chunk_of = view.chunk_of;
  return piece;
}

constexpr std::size_t numbers = 7;  ///< of a pose

/// Position straight, orientation by the shorter turn.
void interpolate(const double* from, const double* to, double share, double* pose) {
  if (std::equal(from, from + numbers, to)) {
    std::copy_n(to, numbers, pose);
    return;
  }
  for (std::size_t i = 0; i < 3; ++i) pose[i] = from[i] + share * (to[i] - from[i]);
  using Turn = Eigen::Map<const Eigen::Quaterniond>;
  Eigen::Map<Eigen::Quaterniond>(pose + 3) = Turn(from + 3).slerp(share, Turn(to + 3));
}

template <class T>
void append(std::vector<T>& to, std::vector<T>& from) {
  to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
  from.clear();
}

}  // namespace

struct Pacer::State {
  explicit State(Simulation given) : simulation(std::move(given)) {}

  /// The state after a step, as it is drawn.
  struct Moment {
    double time = 0;
    std::int64_t step = 0;
    bool at_rest = false, finished = false;
    std::vector<std::int64_t> handles;
    std::vector<double> poses;
  };
  /// What came with it.
  struct News {
    std::vector<PacedPiece> made;
    std::vector<SimulationEvent> events;
    std::vector<HostImpulse> impulses;
  };

  bool step();
  void read();
  void publish(bool follows);

  // Touched by the thread alone, but before it begins and after it has ended.
  Simulation simulation;
  std::vector<std::int64_t> known;  ///< handles of the last moment
  std::size_t events_read = 0;
  std::shared_ptr<const Moment> made;
  News made_news;
  // Handed over while nobody looks.
  std::shared_ptr<const Moment> earlier, later;
  News news;

  PacedFrame frame;  ///< the host's
  std::unique_ptr<StepThread> thread;
};

bool Pacer::State::step() {
  if (simulation.finished()) return false;
  simulation.step();
  const auto impulses = simulation.host_impulses();
  made_news.impulses.insert(made_news.impulses.end(), impulses.begin(), impulses.end());
  read();
  return true;
}

/// Of pieces that come and go between two frames no one hears.
void Pacer::State::read() {
  const auto moment = std::make_shared<Moment>();
  moment->time = simulation.time();
  moment->step = simulation.steps();
  moment->at_rest = simulation.at_rest();
  moment->finished = simulation.finished();
  moment->poses.assign(simulation.poses().begin(), simulation.poses().end());
  for (const BodyView& view : simulation.bodies()) {
    moment->handles.push_back(view.id.value);
    if (!std::binary_search(known.begin(), known.end(), view.id.value)) made_news.made.push_back(piece_of(view));
  }
  known = moment->handles;
  const auto events = simulation.events();
  events_read = std::min(events_read, events.size());  // an order may have gone back
  made_news.events.insert(made_news.events.end(), events.begin() + static_cast<std::ptrdiff_t>(events_read),
                          events.end());
  events_read = events.size();
  made = moment;
}

void Pacer::State::publish(bool follows) {
  earlier = follows ? later : nullptr;
  later = made;
  append(news.made, made_news.made);
  append(news.events, made_news.events);
  append(news.impulses, made_news.impulses);
}

Pacer::Pacer(Simulation simulation, bool paused) : state_(std::make_unique<State>(std::move(simulation))) {
  State* const s = state_.get();
  s->events_read = s->simulation.events().size();
  s->read();
  s->publish(false);
  s->thread = std::make_unique<StepThread>(StepThread::Work{s->simulation.scenario().step, [s] { return s->step(); },
                                                            [s](bool follows) { s->publish(follows); }, paused});
}

Pacer::~Pacer() = default;

void Pacer::apply(Tool tool) {
  state_->thread->order([s = state_.get(), tool = std::move(tool)] { s->simulation.apply(tool); });
}

void Pacer::touch(HostContact contact) {
  state_->thread->order([s = state_.get(), contact = std::move(contact)] { s->simulation.touch(contact); });
}

void Pacer::order(std::function<void(Simulation&)> what) {
  state_->thread->order(
      [s = state_.get(), what = std::move(what)] {
        what(s->simulation);
        s->read();
      },
      true);
}

const PacedFrame& Pacer::frame() {
  State& s = *state_;
  PacedFrame& frame = s.frame;
  std::shared_ptr<const State::Moment> earlier, later;
  State::News news;
  double share = 1;
  s.thread->inspect([&](double at) {
    earlier = s.earlier;
    later = s.later;
    std::swap(news, s.news);
    share = earlier ? at : 1;
  });
  const auto lives = [&](std::int64_t handle) {
    return std::binary_search(later->handles.begin(), later->handles.end(), handle);
  };
  std::erase_if(news.made, [&](const PacedPiece& piece) { return !lives(piece.handle); });
  // Where an order went back, a handle may have come to mean another piece.
  const auto made_anew = [&](std::int64_t handle) {
    return std::any_of(news.made.begin(), news.made.end(),
                       [handle](const PacedPiece& piece) { return piece.handle == handle; });
  };
  frame.gone.clear();
  std::copy_if(frame.handles.begin(), frame.handles.end(), std::back_inserter(frame.gone),
               [&](std::int64_t handle) { return !lives(handle) || made_anew(handle); });
  frame.made = std::move(news.made);
  frame.events = std::move(news.events);
  frame.impulses = std::move(news.impulses);
  frame.time = earlier ? earlier->time + share * (later->time - earlier->time) : later->time;
  frame.step = later->step;
  frame.at_rest = later->at_rest;
  frame.finished = later->finished;
  frame.handles = later->handles;
  frame.poses = later->poses;
  if (share == 1) return frame;
  std::size_t before = 0;
  for (std::size_t i = 0; i < later->handles.size(); ++i) {
    while (before < earlier->handles.size() && earlier->handles[before] < later->handles[i]) ++before;
    if (before == earlier->handles.size()) break;
    if (earlier->handles[before] == later->handles[i])
      interpolate(&earlier->poses[numbers * before], &later->poses[numbers * i], share, &frame.poses[numbers * i]);
  }
  return frame;
}

void Pacer::set_paused(bool paused) { state_->thread->set_paused(paused); }
bool Pacer::paused() const { return state_->thread->paused(); }
void Pacer::set_speed(double speed) { state_->thread->set_speed(speed); }
double Pacer::speed() const { return state_->thread->speed(); }
double Pacer::ratio() const { return state_->thread->ratio(); }
std::string Pacer::error() const { return state_->thread->error(); }

Simulation Pacer::stop() {
  state_->thread.reset();
  return std::move(state_->simulation);
}

}  // namespace topple::structure
