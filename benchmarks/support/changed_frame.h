#pragma once
// The regular frame under a Reanalysis: how it stands, which members change, and how far its answers are from fresh
// ones.
#include <cstdlib>
#include <memory>
#include <random>

#include "support/regular_frame.h"
#include "topple/solver/reanalysis.h"
#include "topple/solver/static_analysis.h"

namespace topple::bench {

/// Under its loads and solved; ends the program when it is unstable.
inline std::unique_ptr<solver::Reanalysis> stand(const RegularFrame& frame) {
  auto standing = std::make_unique<solver::Reanalysis>(frame.model);
  for (const solver::BeamLoad& load : frame.loads.beams) standing->set_beam_loads(load.beam, {load});
  if (!standing->solve().stable) std::exit(1);
  return standing;
}

/// Members with one joint to break each, never two at one node, so that the frame stays stable. Fewer than `count` when
/// no more are found.
inline std::vector<int> random_members(const RegularFrame& frame, std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<int> members;
  std::vector<char> taken(frame.model.nodes.size(), 0);
  for (std::size_t tries = 0; members.size() < count && tries < 100 * count; ++tries) {
    const int beam = static_cast<int>(random() % frame.model.beams.size());
    const auto& node = frame.model.beams[static_cast<std::size_t>(beam)].node;
    char& a = taken[static_cast<std::size_t>(node[0])];
    char& b = taken[static_cast<std::size_t>(node[1])];
    if (a != 0 || b != 0) continue;
    a = b = 1;
    members.push_back(beam);
  }
  return members;
}

/// Largest difference of displacements to a fresh analysis of `model`, relative to the largest displacement.
inline double difference_to_fresh(const solver::FrameModel& model, const solver::LoadSet& loads,
                                  const solver::Reanalysis& standing) {
  solver::StaticAnalysis fresh(model);
  const auto answer = fresh.solve(std::span(&loads, 1)).front();
  double largest = 0, difference = 0;
  for (std::size_t n = 0; n < answer.displacements.size(); ++n) {
    largest = std::max(largest, answer.displacements[n].cwiseAbs().maxCoeff());
    difference = std::max(difference, (answer.displacements[n] - standing.displacements()[n]).cwiseAbs().maxCoeff());
  }
  return difference / largest;
}

}  // namespace topple::bench
