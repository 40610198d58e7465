#include "judge.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include "support/regular_frame.h"

namespace topple::bench {

namespace {

using reference::Quad;

double size(Quad value) { return static_cast<double>(value < 0 ? -value : value); }

double mean_length(const solver::FrameModel& model) {
  double sum = 0;
  for (const solver::Beam& beam : model.beams) sum += beam.length;
  return sum / static_cast<double>(std::max<std::size_t>(1, model.beams.size()));
}

/// Largest difference over the largest value, of one kind of components.
struct Largest {
  double difference = 0, value = 0;
  void add(double found, Quad exact, double scale = 1) {
    difference = std::max(difference, scale * size(Quad(found) - exact));
    value = std::max(value, scale * size(exact));
  }
  [[nodiscard]] double ratio() const { return value > 0 ? difference / value : 0; }
};

Verdict named(const Case& c, const char* way) {
  return {.family = c.family, .what = c.what, .way = way, .parameter = c.parameter, .mechanism = c.mechanism};
}

Verdict judge_fresh(const Case& c, const Exact* exact) {
  Verdict verdict = named(c, "fresh");
  try {
    solver::StaticAnalysis analysis(c.model);
    const solver::StaticSolution answer = analysis.solve(std::span(&c.loads, 1)).front();
    verdict.warned = analysis.statistics().nearly_unstable || !answer.quality.converged;
    if (exact != nullptr) judge_answer(c.model, answer, *exact, verdict);
  } catch (const solver::Instability&) {
    verdict.refused = true;
  }
  return verdict;
}

Verdict judge_reanalysis(const Case& c, const Exact* exact) {
  Verdict verdict = named(c, "reanalysis");
  solver::Reanalysis standing(c.model);
  std::vector<std::vector<solver::BeamLoad>> by_beam(c.model.beams.size());
  for (const solver::BeamLoad& load : c.loads.beams) by_beam[static_cast<std::size_t>(load.beam)].push_back(load);
  for (std::size_t b = 0; b < by_beam.size(); ++b) standing.set_beam_loads(static_cast<int>(b), std::move(by_beam[b]));
  for (const solver::NodeLoad& load : c.loads.nodes) standing.set_node_load(load.node, load.load);
  const solver::ReanalysisAnswer& told = standing.solve();
  verdict.refused = !told.stable;
  if (!told.stable) return verdict;
  verdict.warned = told.nearly_unstable || !told.quality.converged;
  if (exact != nullptr) judge_standing(standing, told, *exact, verdict);
  return verdict;
}

}  // namespace

void judge_answer(const solver::FrameModel& model, const solver::StaticSolution& answer, const Exact& exact,
                  Verdict& verdict) {
  const double length = mean_length(model);
  Largest moved, force, moment;
  for (std::size_t n = 0; n < answer.displacements.size(); ++n) {
    for (int c = 0; c < 6; ++c)
      moved.add(answer.displacements[n][c], exact.displacements[n][static_cast<std::size_t>(c)], c < 3 ? 1 : length);
  }
  for (std::size_t b = 0; b < answer.beam_end_forces.size(); ++b) {
    for (int c = 0; c < 12; ++c)
      (c % 6 < 3 ? force : moment)
          .add(answer.beam_end_forces[b][c], exact.beam_end_forces[b][static_cast<std::size_t>(c)]);
  }
  verdict.error = moved.ratio();
  verdict.force_error = std::max(force.ratio(), moment.ratio());
  verdict.bound = answer.quality.error_bound;
  verdict.backward_error = answer.quality.backward_error;
  verdict.condition = answer.quality.condition;
}

void judge_standing(const solver::Reanalysis& standing, const solver::ReanalysisAnswer& told, const Exact& exact,
                    Verdict& verdict) {
  solver::StaticSolution state;
  state.displacements = standing.displacements();
  state.quality = told.quality;
  for (std::size_t b = 0; b < standing.model().beams.size(); ++b)
    state.beam_end_forces.push_back(standing.beam_end_forces(static_cast<int>(b)));
  judge_answer(standing.model(), state, exact, verdict);
}

std::vector<Verdict> judge(const Case& c) {
  if (c.mechanism) return {judge_fresh(c, nullptr), judge_reanalysis(c, nullptr)};
  const Exact exact = reference::solve<Quad>(c.model, c.loads);
  return {judge_fresh(c, &exact), judge_reanalysis(c, &exact)};
}

std::vector<Verdict> judge_damage_sequence(int changes) {
  constexpr std::size_t most_broken = 12;
  const RegularFrame frame = regular_frame(4, 5, 6);
  solver::FrameModel model = frame.model;
  solver::Reanalysis standing(model);
  for (const solver::BeamLoad& load : frame.loads.beams) standing.set_beam_loads(load.beam, {load});
  std::mt19937 random(11);
  std::vector<std::pair<std::size_t, std::size_t>> broken;  // beam and end, oldest first
  std::vector<Verdict> verdicts;
  int next = 1;
  const auto set = [&](std::pair<std::size_t, std::size_t> joint, double stiffness) {
    const solver::Vec6 value = solver::Vec6::Constant(stiffness);
    model.beams[joint.first].end_stiffness[joint.second] = value;
    standing.set_end_stiffness(static_cast<int>(joint.first), static_cast<int>(joint.second), value);
  };
  for (int change = 1; change <= changes; ++change) {
    if (broken.size() >= most_broken) {
      set(broken.front(), solver::rigid);
      broken.erase(broken.begin());
    } else {
      const std::pair<std::size_t, std::size_t> joint{random() % model.beams.size(), random() % 2};
      // A member that breaks at both ends is a mechanism of its own.
      if (std::any_of(broken.begin(), broken.end(), [&](const auto& b) { return b.first == joint.first; })) continue;
      set(joint, 0);
      broken.push_back(joint);
    }
    const solver::ReanalysisAnswer& told = standing.solve();
    if (!told.stable) {  // what broke last made a mechanism: it is mended
      set(broken.back(), solver::rigid);
      broken.pop_back();
      (void)standing.solve();
      continue;
    }
    if (change < next) continue;
    next *= 10;
    Verdict verdict{.family = "damage sequence", .what = "joints broken and mended", .way = "reanalysis"};
    verdict.parameter = change;
    verdict.warned = told.nearly_unstable || !told.quality.converged;
    judge_standing(standing, told, reference::solve<Quad>(model, frame.loads), verdict);
    verdicts.push_back(verdict);
  }
  return verdicts;
}

}  // namespace topple::bench
