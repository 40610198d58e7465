// Topple on one building: errors of sag, reactions and joint forces against a solution in extended precision, and what
// a step costs when nothing changes, when a load changes at every step, when a joint breaks and when it starts; its own
// ways beside CHOLMOD's factorisations under the same orders. All take turns. Writes one JSON object.
//   bench_topple MODEL [--repeats N] [--frame-only] [--push NEWTON]
// --push: downwards on the first node of the roof, half and one and a half of it at alternate steps.
#include <algorithm>
#include <array>
#include <iostream>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include "standing_building.h"
#include "support/measure.h"
#include "support/steel_utilisations.h"
#include "topple/solver/blas_kernel.h"
#include "topple/structure/formats/files.h"

namespace {

using namespace topple;
using namespace topple::bench;
using solver::Factorisation;
using solver::Reanalysis;
using solver::StaticAnalysis;

/// One way to an answer: its times, and the errors of its last answer.
struct Way {
  std::string name;
  std::vector<double> times{};  ///< s
  Errors errors{};
  double bound = 0;  ///< that the answer told of its displacements
};

constexpr std::array kinds{Factorisation::automatic, Factorisation::simplicial, Factorisation::supernodal};
constexpr std::array kind_names{"own", "simplicial", "supernodal"};

class Measurement {
 public:
  Measurement(const StandingBuilding& standing, double push) : standing_(standing), push_(push) {}

  std::vector<Way> from_nothing(int repeats);
  std::vector<Way> nothing_changes(int repeats);
  std::vector<Way> a_load_changes(int repeats);
  std::vector<Way> a_joint_breaks(int repeats);

 private:
  [[nodiscard]] std::unique_ptr<Reanalysis> stand() const;
  [[nodiscard]] solver::LoadSet loads_of_step(int step) const;
  void finish(Way& way, const solver::StaticSolution& state, double bound, const Exact& exact) const;

  const StandingBuilding& standing_;
  double push_;
};

std::unique_ptr<Reanalysis> Measurement::stand() const {
  auto result = std::make_unique<Reanalysis>(standing_.frame.model);
  apply(*result, standing_.loads);
  if (!result->solve().stable) throw std::runtime_error("the building does not stand");
  return result;
}

solver::LoadSet Measurement::loads_of_step(int step) const {
  solver::LoadSet loads = standing_.loads;
  solver::NodeLoad push{standing_.roof.front(), solver::Vec6::Zero()};
  push.load[2] = -push_ * (step % 2 == 0 ? 1.5 : 0.5);
  loads.nodes.push_back(push);
  return loads;
}

void Measurement::finish(Way& way, const solver::StaticSolution& state, double bound, const Exact& exact) const {
  way.errors = measure(standing_, state, exact);
  way.bound = bound;
}

std::vector<Way> Measurement::from_nothing(int repeats) {
  std::vector<Way> ways;
  const Exact exact = reference::solve<reference::Extended>(standing_.frame.model, standing_.loads);
  for (const char* name : kind_names) ways.push_back({name});
  ways.push_back({"standing"});
  solver::StaticSolution state;
  for (int i = 0; i < repeats; ++i) {
    for (std::size_t k = 0; k < kinds.size(); ++k) {
      ways[k].times.push_back(seconds([&] {
        StaticAnalysis analysis(standing_.frame.model, {.factorisation = kinds[k]});
        state = analysis.solve(std::span(&standing_.loads, 1)).front();
      }));
      finish(ways[k], state, state.quality.error_bound, exact);
    }
    std::unique_ptr<Reanalysis> made;
    ways.back().times.push_back(seconds([&] { made = stand(); }));
    finish(ways.back(), state_of(*made), made->solve().quality.error_bound, exact);
  }
  return ways;
}

std::vector<Way> Measurement::nothing_changes(int repeats) {
  Way way{"standing"};
  const auto standing = stand();
  for (int i = 0; i < repeats; ++i) way.times.push_back(seconds([&] { (void)standing->solve(); }));
  finish(way, state_of(*standing), standing->solve().quality.error_bound,
         reference::solve<reference::Extended>(standing_.frame.model, standing_.loads));
  return {way};
}

std::vector<Way> Measurement::a_load_changes(int repeats) {
  const auto standing = stand(), part = stand();
  SteelUtilisations uses(*part);
  (void)part->solve(uses);
  std::vector<StaticAnalysis> fresh;
  std::vector<Way> ways{{"standing"}, {"restricted"}};
  for (std::size_t k = 0; k < kinds.size(); ++k) {
    fresh.emplace_back(standing_.frame.model, solver::AnalysisOptions{.factorisation = kinds[k]});
    (void)fresh.back().solve(std::span(&standing_.loads, 1));  // estimates the condition, once
    ways.push_back({kind_names[k]});
  }
  std::vector<solver::StaticSolution> states(fresh.size());
  for (int i = 0; i < repeats; ++i) {
    const solver::LoadSet loads = loads_of_step(i);
    const solver::NodeLoad& push = loads.nodes.back();
    ways[0].times.push_back(seconds([&] {
      standing->set_node_load(push.node, push.load);
      (void)standing->solve();
    }));
    ways[1].times.push_back(seconds([&] {
      part->set_node_load(push.node, push.load);
      (void)part->solve(uses);
    }));
    for (std::size_t k = 0; k < fresh.size(); ++k)
      ways[2 + k].times.push_back(
          seconds([&] { states[k] = std::move(fresh[k].solve(std::span(&loads, 1)).front()); }));
  }
  const Exact exact = reference::solve<reference::Extended>(standing_.frame.model, loads_of_step(repeats - 1));
  finish(ways[0], state_of(*standing), standing->solve().quality.error_bound, exact);
  finish(ways[1], state_of(*part), part->solve().quality.error_bound, exact);
  for (std::size_t k = 0; k < fresh.size(); ++k) finish(ways[2 + k], states[k], states[k].quality.error_bound, exact);
  return ways;
}

/// The second end of one beam after the other is broken, each in an undamaged frame.
std::vector<Way> Measurement::a_joint_breaks(int repeats) {
  std::vector<int> beams;
  for (std::size_t b = 0; b < standing_.building.members.size(); ++b) {
    if (standing_.building.members[b].kind == structure::MemberKind::beam) beams.push_back(static_cast<int>(b));
  }
  const auto standing = stand(), part = stand();
  SteelUtilisations uses(*part);
  (void)part->solve(uses);
  std::vector<Way> ways{{"low rank"}, {"restricted"}, {"own"}};
  solver::FrameModel broken = standing_.frame.model;
  const solver::Vec6 whole = solver::Vec6::Constant(solver::rigid);
  const auto count = static_cast<std::size_t>(repeats);
  for (std::size_t i = 0; i < count; ++i) {
    const int beam = beams[(i * 7919) % beams.size()];
    broken = standing_.frame.model;
    broken.beams[static_cast<std::size_t>(beam)].end_stiffness[1].setZero();
    standing->set_end_stiffness(beam, 1, solver::Vec6::Zero());
    part->set_end_stiffness(beam, 1, solver::Vec6::Zero());
    ways[0].times.push_back(seconds([&] { (void)standing->solve(); }));
    ways[1].times.push_back(seconds([&] { (void)part->solve(uses); }));
    solver::StaticSolution state;
    ways[2].times.push_back(seconds([&] {
      StaticAnalysis analysis(broken);
      state = analysis.solve(std::span(&standing_.loads, 1)).front();
    }));
    if (i + 1 == count) {
      const Exact exact = reference::solve<reference::Extended>(broken, standing_.loads);
      finish(ways[0], state_of(*standing), standing->solve().quality.error_bound, exact);
      finish(ways[1], state_of(*part), part->solve().quality.error_bound, exact);
      finish(ways[2], state, state.quality.error_bound, exact);
      break;
    }
    standing->set_end_stiffness(beam, 1, whole);
    part->set_end_stiffness(beam, 1, whole);
    (void)standing->solve();
    (void)part->solve();
    (void)part->solve(uses);
  }
  return ways;
}

void print_ways(const char* title, std::vector<Way> ways) {
  std::cout << ", \"" << title << "\": {";
  for (std::size_t i = 0; i < ways.size(); ++i) {
    const Spread spread = spread_of(std::move(ways[i].times));
    std::cout << (i > 0 ? ", " : "") << "\"" << ways[i].name << "\": {\"milliseconds\": " << 1e3 * spread.median
              << ", \"low\": " << 1e3 * spread.low << ", \"high\": " << 1e3 * spread.high
              << ", \"runs\": " << spread.runs << ", \"error_bound\": " << ways[i].bound << ", \"errors\": ";
    print(ways[i].errors);
    std::cout << "}";
  }
  std::cout << "}";
}

void run(const StandingBuilding& standing, int repeats, double push) {
  const std::size_t free = standing.frame.model.nodes.size() - standing.frame.model.supports.size();
  const int fewer = std::max(3, repeats / 20);
  Measurement measurement(standing, push);
  std::cout.precision(9);
  std::cout << "{\"blas_kernel\": \"" << solver::blas_kernel() << "\", \"freedoms\": " << 6 * free;
  print_ways("from nothing", measurement.from_nothing(fewer));
  print_ways("nothing changes", measurement.nothing_changes(repeats));
  print_ways("a load changes", measurement.a_load_changes(repeats));
  print_ways("a joint breaks", measurement.a_joint_breaks(fewer));
  std::cout << "}\n";
}

}  // namespace

int main(int argc, char** argv) {
  solver::prepare_blas(argv);
  try {
    if (argc < 2) throw std::runtime_error("usage: bench_topple MODEL [--repeats N] [--frame-only] [--push NEWTON]");
    int repeats = 200;
    bool frame_only = false;
    double push = 1e5;
    for (int i = 2; i < argc; ++i) {
      const std::string option = argv[i];
      if (option == "--frame-only") {
        frame_only = true;
      } else if (option == "--repeats" && i + 1 < argc) {
        repeats = std::max(1, std::stoi(argv[++i]));
      } else if (option == "--push" && i + 1 < argc) {
        push = std::stod(argv[++i]);
      } else {
        throw std::runtime_error("unknown option " + option);
      }
    }
    run(StandingBuilding(structure::read_model(structure::find_model(argv[1])), frame_only), repeats, push);
    return 0;
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
