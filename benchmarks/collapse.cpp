// Step times of a collapse by stage: percentiles with and without the collision engine's own time, and the slowest
// steps with what they did.
//   bench_collapse [SCENARIO] [--seconds S] [--steps FILE] [--against OTHER]
// SCENARIO: a shipped one's name, or a file (default seed_hit). --seconds: stop after so much simulated time. --steps:
// every step that worked, as CSV. --against: only compares it with another scenario, whose steps are taken in turns.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <numeric>
#include <string>
#include <vector>

#include "support/provenance.h"
#include "topple/structure/error.h"
#include "topple/structure/formats/files.h"
#include "topple/structure/simulation.h"

namespace {

using namespace topple;
using structure::SimulationCounters;

struct Step {
  std::int64_t number = 0;
  std::array<double, 6> stages{};  ///< s
  double engine = 0;               ///< s, within the stages
  std::uint64_t solves = 0, low_rank = 0, refactorisations = 0, events = 0, impacts = 0;
  std::size_t bodies = 0, awake = 0;
  [[nodiscard]] double whole() const { return std::accumulate(stages.begin(), stages.end(), 0.0); }
  [[nodiscard]] double own() const { return whole() - engine; }
};

double percentile(std::vector<double> values, double share) {
  const auto at = std::min(values.size() - 1, static_cast<std::size_t>(share * static_cast<double>(values.size())));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(at), values.end());
  return values[at];
}

void print_row(const char* name, const std::vector<double>& seconds) {
  double sum = 0;
  for (double s : seconds) sum += s;
  std::printf("  %-10s %9.3f %9.3f %9.3f %9.3f %9.3f\n", name, 1e3 * sum / static_cast<double>(seconds.size()),
              1e3 * percentile(seconds, 0.5), 1e3 * percentile(seconds, 0.95), 1e3 * percentile(seconds, 0.99),
              1e3 * *std::max_element(seconds.begin(), seconds.end()));
}

void print_percentiles(const std::vector<Step>& steps) {
  std::printf("ms           %9s %9s %9s %9s %9s   of %zu steps that worked\n", "mean", "p50", "p95", "p99", "max",
              steps.size());
  const auto row = [&](const char* name, const auto& value) {
    std::vector<double> seconds;
    for (const Step& step : steps) seconds.push_back(value(step));
    print_row(name, seconds);
  };
  for (std::size_t i = 0; i < structure::stage_names.size(); ++i)
    row(structure::stage_names[i], [i](const Step& step) { return step.stages[i]; });
  row("engine", [](const Step& step) { return step.engine; });
  row("whole", [](const Step& step) { return step.whole(); });
  row("own", [](const Step& step) { return step.own(); });
}

/// What one answer costs, whichever way a collapse takes: ways differ by rounding, and with them the number of answers.
void print_cost_of_answers(const std::vector<Step>& steps) {
  std::uint64_t solves = 0, impacts = 0;
  double seconds = 0;
  for (const Step& step : steps) {
    solves += step.solves;
    impacts += step.impacts;
    seconds += step.stages[static_cast<std::size_t>(structure::Stage::break_)];
  }
  std::printf("break: %llu solves and %llu impacts in %.1f ms, %.3f ms each\n", static_cast<unsigned long long>(solves),
              static_cast<unsigned long long>(impacts), 1e3 * seconds,
              1e3 * seconds / static_cast<double>(std::max<std::uint64_t>(1, solves + impacts)));
}

void print_slowest(std::vector<Step> steps) {
  constexpr std::size_t shown = 12;
  std::sort(steps.begin(), steps.end(), [](const Step& a, const Step& b) { return a.own() > b.own(); });
  steps.resize(std::min(steps.size(), shown));
  std::puts(
      "slowest without the engine:\n    step      ms   sense    load   break release    move    book  "
      "solves  low rank  new factors  impacts  events");
  for (const Step& step : steps) {
    std::printf("  %6lld %7.2f", static_cast<long long>(step.number), 1e3 * step.own());
    for (double s : step.stages) std::printf(" %7.2f", 1e3 * s);
    std::printf(" %7llu %9llu %12llu %8llu %7llu\n", static_cast<unsigned long long>(step.solves),
                static_cast<unsigned long long>(step.low_rank), static_cast<unsigned long long>(step.refactorisations),
                static_cast<unsigned long long>(step.impacts), static_cast<unsigned long long>(step.events));
  }
}

void write_steps(const std::string& path, const std::vector<Step>& steps) {
  std::ofstream file(path);
  file << "step,sense,load,break,release,move,book,engine,solves,low_rank,new_factors,impacts,events,bodies,awake\n";
  for (const Step& step : steps) {
    file << step.number;
    for (double s : step.stages) file << ',' << s;
    file << ',' << step.engine << ',' << step.solves << ',' << step.low_rank << ',' << step.refactorisations << ','
         << step.impacts << ',' << step.events << ',' << step.bodies << ',' << step.awake << '\n';
  }
}

structure::Simulation make(const std::string& name) {
  auto [building, scenario] = structure::read_scenario(structure::find_scenario(name));
  return structure::Simulation(std::move(building), std::move(scenario));
}

/// Seconds of a whole run, with and without the engine.
struct Cost {
  double whole = 0, own = 0;
};

/// Costs of both, step by step in turns, so that what else the machine does falls on both. `first` (0 or 1) steps
/// first: it finds the program's code and data colder than the other does.
std::array<Cost, 2> in_turns(const std::array<std::string, 2>& names, double seconds, std::size_t first) {
  std::array<structure::Simulation, 2> both{make(names[0]), make(names[1])};
  std::array<Cost, 2> costs;
  for (structure::Simulation& simulation : both) simulation.step();
  const auto runs = [&](const structure::Simulation& one) { return !one.finished() && one.time() < seconds; };
  while (runs(both[0]) || runs(both[1]))
    for (const std::size_t i : {first, 1 - first}) {
      if (!runs(both[i])) continue;
      both[i].step();
      const auto& stages = both[i].stage_seconds();
      const double sum = std::accumulate(stages.begin(), stages.end(), 0.0);
      costs[i].whole += sum;
      costs[i].own += sum - both[i].collision_engine_seconds();
    }
  return costs;
}

/// Each pair of runs is two, in which either goes first once.
void compare(const std::string& name, const std::string& other, double seconds) {
  constexpr std::size_t pairs = 7;
  std::array<std::vector<double>, 2> whole, own;
  std::array<std::vector<double>, 2> ratios;
  for (std::size_t r = 0; r < pairs; ++r) {
    const std::array<Cost, 2> a = in_turns({name, other}, seconds, 0), b = in_turns({name, other}, seconds, 1);
    for (std::size_t i = 0; i < 2; ++i) {
      whole[i].push_back((a[i].whole + b[i].whole) / 2);
      own[i].push_back((a[i].own + b[i].own) / 2);
    }
    ratios[0].push_back(whole[0].back() / whole[1].back());
    ratios[1].push_back(own[0].back() / own[1].back());
  }
  std::printf("medians of %zu pairs      %12s %12s  ratio (quartiles)\n", pairs, name.c_str(), other.c_str());
  const auto row = [&](const char* what, const std::array<std::vector<double>, 2>& times,
                       const std::vector<double>& ratio) {
    std::printf("%-25s %12.2f %12.2f  %5.3f (%.3f to %.3f)\n", what, 1e3 * percentile(times[0], 0.5),
                1e3 * percentile(times[1], 0.5), percentile(ratio, 0.5), percentile(ratio, 0.25),
                percentile(ratio, 0.75));
  };
  row("all steps, ms", whole, ratios[0]);
  row("without the engine, ms", own, ratios[1]);
}

std::vector<Step> run(structure::Simulation& simulation, double seconds) {
  std::vector<Step> steps;
  SimulationCounters before = simulation.counters();
  while (!simulation.finished() && simulation.time() < seconds) {
    simulation.skip_idle();
    const std::size_t told = simulation.events().size();
    simulation.step();
    const SimulationCounters now = simulation.counters();
    if (now.steps_idle == before.steps_idle) {
      Step step{simulation.steps(), simulation.stage_seconds(), simulation.collision_engine_seconds()};
      step.solves = now.solves - before.solves;
      step.low_rank = now.low_rank - before.low_rank;
      step.refactorisations = now.refactorisations - before.refactorisations;
      step.events = simulation.events().size() - told;
      for (const auto& event : simulation.events().subspan(told))
        step.impacts += event.kind == structure::SimulationEvent::Kind::impact ? 1 : 0;
      step.bodies = simulation.bodies().size();
      step.awake = simulation.changes().moved.size();
      steps.push_back(step);
    }
    before = now;
  }
  return steps;
}

}  // namespace

int main(int argc, char** argv) {
  solver::prepare_blas(argv);
  std::string scenario_name = "seed_hit", steps_file, other;
  double seconds = structure::unlimited;
  for (int i = 1; i < argc; ++i) {
    const bool more = i + 1 < argc;
    if (std::strcmp(argv[i], "--seconds") == 0 && more)
      seconds = std::atof(argv[++i]);
    else if (std::strcmp(argv[i], "--steps") == 0 && more)
      steps_file = argv[++i];
    else if (std::strcmp(argv[i], "--against") == 0 && more)
      other = argv[++i];
    else
      scenario_name = argv[i];
  }
  try {
    bench::print_provenance(("Step times of " + scenario_name).c_str(), 1);
    if (!other.empty()) {
      compare(scenario_name, other, seconds);
      return 0;
    }
    structure::Simulation simulation = make(scenario_name);
    const std::vector<Step> steps = run(simulation, seconds);
    if (steps.empty()) return 1;
    print_percentiles(steps);
    print_cost_of_answers(steps);
    print_slowest(steps);
    std::size_t down = 0;
    for (std::size_t m = 0; m < simulation.building().members.size(); ++m)
      down += simulation.frame().stands(structure::MemberId(m)) ? 0 : 1;
    std::printf("%llu impacts were borne by a bound alone\n",
                static_cast<unsigned long long>(simulation.counters().impacts_bounded));
    double last = 0;
    for (const auto& event : simulation.events())
      if (event.kind == structure::SimulationEvent::Kind::detached) last = event.time;
    std::printf("the last part came off at %.2f s\n", last);
    std::printf("%.3f s simulated, %s, %zu members down, hash %016llx\n", simulation.time(),
                simulation.at_rest() ? "at rest" : "not at rest", down,
                static_cast<unsigned long long>(simulation.hash()));
    if (!steps_file.empty()) write_steps(steps_file, steps);
  } catch (const structure::InputError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
  return 0;
}
