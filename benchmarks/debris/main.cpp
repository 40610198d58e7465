// Debris that falls, lies and sleeps under a contact solver: what a step costs, how far things are inside each other,
// when they rest, how true the forces are, energy, momentum, and whether two runs agree to the bit. One line of JSON
// for each scene as it is done.
//   bench_debris [--engine small-steps|sequential-impulse] [--seed N] [--runs N] [--threads N] [--clock] [SCENE]...
// --seed: of places and turns (default 1); --runs: how often a scene runs again for its times and bits (default 1);
// --threads: that share a step (default 1); --clock: times by the clock, as always with threads, not of the processor;
// scenes: default all, by the names that --scenes lists.
#include <cinttypes>
#include <cstdio>
#include <iostream>
#include <stdexcept>
#include <string>

#include "measures.h"
#include "support/measure.h"
#include "topple/collision/sequential_impulse.h"
#include "topple/collision/small_steps.h"
#include "topple/solver/thread_pool.h"

namespace {

using namespace topple::bench;

struct Options {
  std::string engine = "small-steps";
  unsigned seed = 1;
  int runs = 1, threads = 1;
  bool clock = false;
  std::vector<std::string> scenes;
};

MakeWorld engine_of(const std::string& name) {
  if (name == "small-steps") return topple::collision::make_small_steps_world;
  if (name == "sequential-impulse") return topple::collision::make_sequential_impulse_world;
  throw std::invalid_argument("no engine " + name + "; accepted: small-steps, sequential-impulse");
}

MakeWorld on_threads(MakeWorld make_world, int threads) {
  if (threads == 1) return make_world;
  const auto pool = std::make_shared<topple::solver::ThreadPool>(threads);
  return [make_world, pool] {
    auto world = make_world();
    world->set_parallel_for([pool](std::size_t count, const auto& work) { pool->run(count, work); }, pool->threads());
    return world;
  };
}

unsigned count_of(const std::string& option, const std::string& text) {
  std::size_t read = 0;
  const unsigned long value = text.empty() || text[0] == '-' ? 0 : std::stoul(text, &read);
  if (read != text.size() || value < 1 || value > 1000000)
    throw std::invalid_argument(option + " " + text + "; accepted: 1 to 1000000");
  return static_cast<unsigned>(value);
}

void number(const char* key, std::optional<double> value) {
  if (value)
    std::printf(", \"%s\": %.6g", key, *value);
  else
    std::printf(", \"%s\": null", key);
}

void residuals(const std::string& when, const Residuals& of) {
  const auto told = [&](const char* what, double value) {
    number((when + what).c_str(), of.count > 0 ? std::optional(value) : std::nullopt);
  };
  told("_force_worst", of.worst_force);
  told("_force_rms", of.rms_force());
  told("_moment_worst", of.worst_moment);
  told("_moment_rms", of.rms_moment());
}

void print(const DebrisScene& scene, const Options& options, const DebrisMeasures& first, const Spread& times,
           bool same_bits) {
  std::printf(
      "{\"scene\": \"%s\", \"what\": \"%s\", \"engine\": \"%s\", \"seed\": %u, \"threads\": %d, \"bodies\": %zu",
      scene.name.c_str(), scene.what.c_str(), options.engine.c_str(), options.seed, options.threads, first.bodies);
  number("milliseconds", times.median);
  number("low", times.low);
  number("high", times.high);
  number("worst_milliseconds", first.worst_milliseconds);
  std::printf(", \"awake_steps\": %zu, \"over_10_mm\": %d, \"over_20_mm\": %d", first.awake_steps,
              first.at_end.over_10_mm, first.at_end.over_20_mm);
  number("deepest_mm", 1e3 * first.deepest);
  number("deepest_end_mm", 1e3 * first.at_end.deepest);
  number("settled_at", first.settled_at);
  number("rest", first.rest);
  number("height", first.height);
  residuals("awake", first.awake);
  residuals("asleep", first.asleep);
  number("created", first.created);
  number("momentum", first.momentum);
  number("angular_momentum", first.angular);
  std::printf(", \"bits\": \"%016" PRIx64 "\", \"same_bits\": %s}\n", first.bits, same_bits ? "true" : "false");
  std::fflush(stdout);
}

void measure(const std::string& name, const Options& options) {
  const DebrisScene scene = debris_scene(name, options.seed);
  const MakeWorld make_world = on_threads(engine_of(options.engine), options.threads);
  const DebrisMeasures first = measure_debris(scene, make_world);
  std::vector<double> times;
  bool same_bits = true;
  for (int i = 0; i < options.runs; ++i) {
    const DebrisMeasures again =
        time_debris(scene, make_world, options.threads > 1 || options.clock ? StepTime::clock : StepTime::processor);
    times.push_back(again.milliseconds);
    same_bits = same_bits && again.bits == first.bits;
  }
  print(scene, options, first, spread_of(times), same_bits);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    Options options;
    for (int i = 1; i < argc; ++i) {
      const std::string option = argv[i];
      if (option == "--engine" && i + 1 < argc) {
        options.engine = argv[++i];
      } else if (option == "--seed" && i + 1 < argc) {
        options.seed = count_of(option, argv[++i]);
      } else if (option == "--runs" && i + 1 < argc) {
        options.runs = static_cast<int>(count_of(option, argv[++i]));
      } else if (option == "--threads" && i + 1 < argc) {
        options.threads = static_cast<int>(count_of(option, argv[++i]));
      } else if (option == "--clock") {
        options.clock = true;
      } else if (option == "--scenes") {
        for (const std::string& name : debris_scene_names()) std::cout << name << '\n';
        return 0;
      } else if (option.starts_with("-")) {
        throw std::invalid_argument(
            "usage: bench_debris [--engine small-steps|sequential-impulse] [--seed N] [--runs N] [--threads N] "
            "[--clock] "
            "[--scenes] [SCENE]...");
      } else {
        options.scenes.push_back(option);
      }
    }
    if (options.scenes.empty()) options.scenes = debris_scene_names();
    for (const std::string& name : options.scenes) measure(name, options);
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "bench_debris: " << error.what() << '\n';
    return 2;
  }
}
