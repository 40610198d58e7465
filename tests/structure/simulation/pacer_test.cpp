// A simulation on a thread of its own: every pace comes to the same bits, pictures lie between the last two states, and
// the ratio tells how simulated time runs.
#include "topple/structure/pacer.h"

#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <future>
#include <set>
#include <stdexcept>
#include <thread>

#include "simulation_run.h"
#include "topple/structure/formats/files.h"
#include "topple/structure/step_thread.h"

using namespace topple::structure;

namespace {

using Clock = std::chrono::steady_clock;
constexpr double as_fast_as_steps_are_made = unlimited;

void sleep(double seconds) { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); }
double since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

Simulation shipped(const char* name, double duration) {
  auto [building, scenario] = read_scenario(find_scenario(name));
  scenario.duration = duration;
  return Simulation(std::move(building), std::move(scenario));
}

Projectile ball_at(double height) {
  Projectile ball;
  ball.from = Vec3(-40, 0, height);
  ball.velocity = Vec3(60, 0, 0);
  return ball;
}

/// What a host knows of the pieces, from its frames alone.
struct Host {
  std::set<std::int64_t> pieces;
  void take(const PacedFrame& frame) {
    for (const std::int64_t handle : frame.gone) CHECK(pieces.erase(handle) == 1);
    for (const PacedPiece& piece : frame.made) CHECK(pieces.insert(piece.handle).second);
    REQUIRE(pieces == std::set<std::int64_t>(frame.handles.begin(), frame.handles.end()));
    REQUIRE(frame.poses.size() == 7 * frame.handles.size());
  }
};

/// Steps that take so long.
StepThread::Work lasting(double seconds, std::atomic<int>& steps) {
  StepThread::Work work;
  work.step = [seconds, &steps] {
    sleep(seconds);
    ++steps;
    return true;
  };
  work.publish = [](bool) {};
  return work;
}

}  // namespace

TEST_CASE("every pace comes to the same bits, and the host hears of every piece once") {
  constexpr double seconds = 3;
  Simulation direct = shipped("house_hit", seconds);
  topple::test::run(direct);
  REQUIRE(direct.bodies().size() > 3);
  for (const bool hurried : {true, false}) {
    Pacer pacer(shipped("house_hit", seconds), true);
    CHECK(pacer.ratio() == 0);
    pacer.set_speed(hurried ? as_fast_as_steps_are_made : 8);
    pacer.set_paused(false);
    Host host;
    bool finished = false;
    for (int frames = 0; !finished; ++frames) {
      const PacedFrame& frame = pacer.frame();
      host.take(frame);
      finished = frame.finished;
      pacer.set_paused(frames % 16 == 5);
      sleep(hurried ? 0 : 0.004);
    }
    CHECK(pacer.error() == "");
    const Simulation paced = pacer.stop();
    CHECK(paced.steps() == direct.steps());
    CHECK(paced.hash() == direct.hash());
    CHECK(host.pieces.size() == direct.bodies().size());
  }
}

TEST_CASE("a frame's events are all of them, in order, each once") {
  Pacer pacer(shipped("house_hit", 2.5));
  pacer.set_speed(20);
  std::vector<SimulationEvent> heard;
  for (bool finished = false; !finished; sleep(0.01)) {
    const PacedFrame& frame = pacer.frame();
    heard.insert(heard.end(), frame.events.begin(), frame.events.end());
    finished = frame.finished;
  }
  const Simulation paced = pacer.stop();
  REQUIRE(heard.size() == paced.events().size());
  REQUIRE(heard.size() > 10);
  for (std::size_t i = 0; i < heard.size(); ++i) {
    CHECK(heard[i].step == paced.events()[i].step);
    CHECK(heard[i].name == paced.events()[i].name);
    CHECK(heard[i].kind == paced.events()[i].kind);
  }
}

TEST_CASE("what came in while it ran comes to the same bits when it is stepped again without a clock") {
  Simulation start = shipped("seed_idle", 60);
  std::promise<Snapshot> saved;  // outlives the pacer, whose thread sets it
  Pacer pacer(std::move(start));
  pacer.set_speed(4);
  pacer.apply(ball_at(2));
  while (pacer.frame().time < 0.4) sleep(0.001);
  pacer.apply(ball_at(5));
  while (pacer.frame().time < 1.5) sleep(0.001);
  pacer.order([&](Simulation& simulation) { saved.set_value(simulation.save()); });
  const Snapshot snapshot = saved.get_future().get();
  REQUIRE(snapshot.actions.size() == 2);
  CHECK(snapshot.actions[1].step > snapshot.actions[0].step);
  Simulation again = shipped("seed_idle", 60);
  again.restore(snapshot);
  CHECK(again.hash() == snapshot.hash);
}

TEST_CASE("frames lie between the last two states, at their own time") {
  // A ball that nothing stops: x = x0 + v t in every step, and so in every frame between.
  Pacer pacer(shipped("seed_idle", 60), true);
  pacer.apply(ball_at(200));
  pacer.set_speed(0.05);  // a step lasts a third of a second
  pacer.set_paused(false);
  double last = 0;
  std::set<double> between;
  const Clock::time_point start = Clock::now();
  while (since(start) < 1.5) {
    const PacedFrame& frame = pacer.frame();
    CHECK(frame.time >= last);
    last = frame.time;
    if (!frame.handles.empty() && frame.time > 1.0 / 60) {
      CHECK(frame.poses[0] == Approx(-40 + 60 * frame.time).margin(1e-9));
      between.insert(frame.time);
    }
    sleep(0.004);
  }
  CHECK(between.size() > 10);
  CHECK(last < 1.5 * 0.05 + 1.0 / 60);
}

TEST_CASE("while a step takes its time, frames do not wait, simulated time does, and the ratio falls") {
  Simulation simulation = shipped("seed_idle", 60);
  std::promise<void> begun, ends;
  simulation.on_event([&](const SimulationEvent& event) {
    if (event.kind != SimulationEvent::Kind::tool) return;
    begun.set_value();
    ends.get_future().wait();
  });
  Pacer pacer(std::move(simulation));
  pacer.apply(ball_at(200));
  begun.get_future().wait();
  const Clock::time_point start = Clock::now();
  const std::int64_t step = pacer.frame().step;
  int frames = 0;
  while (since(start) < 2) {
    CHECK(pacer.frame().step == step);  // of a step of two seconds nothing is seen before its end
    ++frames;
    sleep(1.0 / 60);
  }
  CHECK(frames > 1);
  // At most the second before it was made in time, and one step since.
  CHECK(pacer.ratio() < (1 + 2.0 / 60) / 3);
  ends.set_value();
  while (pacer.frame().step < step + 5) sleep(0.01);
  CHECK(pacer.frame().step >= step + 5);  // it goes on, a step at a time
}

TEST_CASE("the ratio is that of the steps made") {
  std::atomic<int> steps = 0;
  const double each = GENERATE(0.0, 0.05);
  CAPTURE(each);
  StepThread thread(lasting(each, steps));
  sleep(0.3);
  const int before = steps;
  const Clock::time_point start = Clock::now();
  sleep(1.5);
  const double made = (steps - before) / 60.0 / since(start), told = thread.ratio();
  // A step more or less, and what else the machine did in the half second that the ratio has forgotten.
  CHECK(told == Approx(made).margin(0.15));
  CHECK(told <= (each > 0 ? 1 / 60.0 / each + 0.02 : 1.0));
  thread.set_speed(0.5);
  CHECK(thread.ratio() <= 0.5);
  thread.set_paused(true);
  CHECK(thread.ratio() == 0);
  CHECK_THROWS_AS(thread.set_speed(0), std::invalid_argument);
}

TEST_CASE("what a step throws is told, and ends the run") {
  Simulation simulation = shipped("seed_idle", 60);
  simulation.on_event([](const SimulationEvent&) { throw std::runtime_error("no more"); });
  Pacer pacer(std::move(simulation));
  pacer.apply(ball_at(200));
  while (pacer.error().empty()) sleep(0.001);
  CHECK(pacer.error() == "no more");
  CHECK(pacer.ratio() == 0);
}
