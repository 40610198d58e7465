// Topple on one building: errors of sag, reactions and joint forces against a solution in extended precision, and what
// a step costs when nothing changes, when a load changes at every step, and when it starts. Writes one JSON object.
//   bench_topple MODEL [--repeats N] [--frame-only]
#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>
#include <optional>
#include <stdexcept>
#include <string>

#include "extended_frame.h"
#include "topple/solver/blas_kernel.h"
#include "topple/solver/reanalysis.h"
#include "topple/structure/files.h"
#include "topple/structure/frame.h"

namespace {

using namespace topple;
using namespace topple::structure;
using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

struct Spread {
  double median = 0, low = 0, high = 0;  // quartiles
};

Spread spread(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) {
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
  };
  return {at(0.5), at(0.25), at(0.75)};
}

/// Root mean square of differences over that of the reference.
class RelativeError {
 public:
  void add(double value, reference::Real exact) {
    const reference::Real difference = reference::Real(value) - exact;
    difference_ += difference * difference;
    exact_ += exact * exact;
  }
  [[nodiscard]] double value() const { return exact_ > 0 ? static_cast<double>(std::sqrt(difference_ / exact_)) : 0; }

 private:
  reference::Real difference_ = 0, exact_ = 0;
};

std::vector<int> roof_nodes(const Building& building) {
  double height = -1e300;
  for (const Node& node : building.nodes) height = std::max(height, node.position.z());
  std::vector<int> roof;
  for (std::size_t n = 0; n < building.nodes.size(); ++n) {
    if (building.nodes[n].position.z() > height - 1e-6) roof.push_back(static_cast<int>(n));
  }
  return roof;
}

/// Gives the standing structure its loads; the reanalysis keeps those of each beam and node.
void apply(solver::Reanalysis& standing, const solver::LoadSet& loads, std::size_t beams) {
  std::vector<std::vector<solver::BeamLoad>> by_beam(beams);
  for (const solver::BeamLoad& load : loads.beams) by_beam[static_cast<std::size_t>(load.beam)].push_back(load);
  for (std::size_t b = 0; b < beams; ++b) standing.set_beam_loads(static_cast<int>(b), std::move(by_beam[b]));
  for (const solver::NodeLoad& load : loads.nodes) standing.set_node_load(load.node, load.load);
}

void report(const char* name, const Spread& time) {
  std::cout << ", \"" << name << "\": " << time.median << ", \"" << name << "_quartiles\": [" << time.low << ", "
            << time.high << "]";
}

struct Errors {
  double sag = 0, sag_error = 0, reaction_sum = 0, least_share = 1e300, largest_share = -1e300;
  double reactions = 0, posts = 0, shears = 0, moments = 0;
};

/// The standing frame's answer against the reference: the measures of the baseline.
Errors measure(const Building& building, const solver::FrameModel& model, const solver::Reanalysis& standing,
               const reference::Answer& exact, const std::vector<int>& roof) {
  Errors errors;
  reference::Real sag = 0, exact_sag = 0, sum = 0, exact_sum = 0;
  for (const int node : roof) {
    sag -= standing.displacements()[static_cast<std::size_t>(node)].z() / reference::Real(roof.size());
    exact_sag -= exact.displacements[static_cast<std::size_t>(node)][2] / reference::Real(roof.size());
  }
  RelativeError reactions, posts, shears, moments;
  for (std::size_t s = 0; s < model.supports.size(); ++s) {
    const double reaction = standing.reaction(static_cast<int>(s)).z();
    const double share = static_cast<double>(reaction / exact.reactions[s][2]);
    reactions.add(reaction, exact.reactions[s][2]);
    sum += reaction;
    exact_sum += exact.reactions[s][2];
    errors.least_share = std::min(errors.least_share, share);
    errors.largest_share = std::max(errors.largest_share, share);
  }
  for (std::size_t b = 0; b < building.members.size(); ++b) {
    const auto force = standing.beam_end_forces(static_cast<int>(b));
    const bool post = building.members[b].kind == MemberKind::post;
    for (std::size_t c = 0; c < 12; ++c) {
      const double value = force[static_cast<Eigen::Index>(c)];
      if (post && c == 0) posts.add(value, exact.beam_end_forces[b][c]);
      if (!post && c % 6 == 2) shears.add(value, exact.beam_end_forces[b][c]);
      if (!post && c % 6 > 2) moments.add(value, exact.beam_end_forces[b][c]);
    }
  }
  errors.sag = static_cast<double>(sag);
  errors.sag_error = static_cast<double>(std::abs(sag - exact_sag) / std::abs(exact_sag));
  errors.reaction_sum = static_cast<double>(sum / exact_sum);
  errors.reactions = reactions.value();
  errors.posts = posts.value();
  errors.shears = shears.value();
  errors.moments = moments.value();
  return errors;
}

void report(const char* name, const Errors& e) {
  std::cout << ", \"" << name << "\": {\"sag\": " << e.sag << ", \"sag_error\": " << e.sag_error
            << ", \"reaction_sum\": " << e.reaction_sum << ", \"least_share\": " << e.least_share
            << ", \"largest_share\": " << e.largest_share << ", \"reaction_error\": " << e.reactions
            << ", \"post_force_error\": " << e.posts << ", \"beam_shear_error\": " << e.shears
            << ", \"beam_moment_error\": " << e.moments << "}";
}

void run(const Building& building, int repeats, bool frame_only) {
  PartLoads parts = part_loads(building, CombinationId(0));
  if (frame_only) {
    for (PanelAction& action : parts.panels) action = {};
  }
  const Frame frame = make_frame(building);
  const solver::LoadSet loads = load_set(building, parts);
  std::vector<double> first, idle, changing;
  std::optional<solver::Reanalysis> standing;
  for (int i = 0; i < std::max(3, repeats / 20); ++i) {
    const auto start = Clock::now();
    standing.emplace(frame.model);
    apply(*standing, loads, frame.model.beams.size());
    if (!standing->solve().stable) throw std::runtime_error("the building does not stand");
    first.push_back(milliseconds_since(start));
  }

  const std::vector<int> roof = roof_nodes(building);
  const Errors at_rest = measure(building, frame.model, *standing, reference::solve(frame.model, loads), roof);

  solver::LoadSet pushed = loads;
  for (int i = 0; i < repeats; ++i) {
    auto start = Clock::now();
    static_cast<void>(standing->solve());
    idle.push_back(milliseconds_since(start));
    start = Clock::now();
    Vec6 push = Vec6::Zero();
    push[0] = 1e3 * (1 + i);
    const int node = roof[static_cast<std::size_t>(i) % roof.size()];
    standing->set_node_load(node, push);
    static_cast<void>(standing->solve());
    changing.push_back(milliseconds_since(start));
    std::erase_if(pushed.nodes, [&](const solver::NodeLoad& load) { return load.node == node; });
    pushed.nodes.push_back({node, push});
  }
  const Errors after_changes = measure(building, frame.model, *standing, reference::solve(frame.model, pushed), roof);
  std::cout.precision(9);
  std::cout << "{\"solver\": \"topple\", \"precision\": \"double\", \"blas_kernel\": \"" << solver::blas_kernel()
            << "\", \"freedoms\": " << 6 * (frame.model.nodes.size() - frame.model.supports.size())
            << ", \"error_bound\": " << standing->solve().quality.error_bound;
  report("at_rest", at_rest);
  report("after_changes", after_changes);
  report("first_milliseconds", spread(first));
  report("idle_milliseconds", spread(idle));
  report("changing_milliseconds", spread(changing));
  std::cout << "}\n";
}

}  // namespace

int main(int argc, char** argv) {
  solver::restart_with_better_blas_kernel(argv);
  try {
    if (argc < 2) throw std::runtime_error("usage: bench_topple MODEL [--repeats N] [--frame-only]");
    int repeats = 200;
    bool frame_only = false;
    for (int i = 2; i < argc; ++i) {
      const std::string option = argv[i];
      if (option == "--frame-only") {
        frame_only = true;
      } else if (option == "--repeats" && i + 1 < argc) {
        repeats = std::max(1, std::stoi(argv[++i]));
      } else {
        throw std::runtime_error("unknown option " + option);
      }
    }
    run(read_model(find_model(argv[1])), repeats, frame_only);
    return 0;
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
