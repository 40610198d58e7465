#include "standing_building.h"

#include <algorithm>
#include <cmath>
#include <iostream>

namespace topple::bench {

namespace {

using reference::Extended;

/// Root mean square of differences over that of the reference.
class RelativeError {
 public:
  void add(double value, Extended exact) {
    const Extended difference = Extended(value) - exact;
    difference_ += difference * difference;
    exact_ += exact * exact;
  }
  [[nodiscard]] double value() const { return exact_ > 0 ? static_cast<double>(std::sqrt(difference_ / exact_)) : 0; }

 private:
  Extended difference_ = 0, exact_ = 0;
};

std::vector<int> roof_nodes(const structure::Building& building) {
  double height = -1e300;
  for (const structure::Node& node : building.nodes) height = std::max(height, node.position.z());
  std::vector<int> roof;
  for (std::size_t n = 0; n < building.nodes.size(); ++n) {
    if (building.nodes[n].position.z() > height - 1e-6) roof.push_back(static_cast<int>(n));
  }
  return roof;
}

}  // namespace

StandingBuilding::StandingBuilding(structure::Building given, bool frame_only) : building(std::move(given)) {
  structure::PartLoads parts = part_loads(building, structure::CombinationId(0));
  if (frame_only) {
    for (structure::PanelAction& action : parts.panels) action = {};
  }
  frame = make_frame(building);
  loads = load_set(building, parts);
  roof = roof_nodes(building);
}

Errors measure(const StandingBuilding& standing, const solver::StaticSolution& answer, const Exact& exact) {
  Errors errors;
  Extended sag = 0, exact_sag = 0, sum = 0, exact_sum = 0;
  for (const int node : standing.roof) {
    sag -= answer.displacements[static_cast<std::size_t>(node)].z() / Extended(standing.roof.size());
    exact_sag -= exact.displacements[static_cast<std::size_t>(node)][2] / Extended(standing.roof.size());
  }
  RelativeError reactions, posts, shears, moments;
  for (std::size_t s = 0; s < standing.frame.model.supports.size(); ++s) {
    const double reaction = answer.reactions[s].z();
    const auto share = static_cast<double>(reaction / exact.reactions[s][2]);
    reactions.add(reaction, exact.reactions[s][2]);
    sum += reaction;
    exact_sum += exact.reactions[s][2];
    errors.least_share = std::min(errors.least_share, share);
    errors.largest_share = std::max(errors.largest_share, share);
  }
  for (std::size_t b = 0; b < standing.building.members.size(); ++b) {
    const bool post = standing.building.members[b].kind == structure::MemberKind::post;
    for (std::size_t c = 0; c < 12; ++c) {
      const double value = answer.beam_end_forces[b][static_cast<Eigen::Index>(c)];
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

void print(const Errors& e) {
  std::cout << "{\"sag\": " << e.sag << ", \"sag_error\": " << e.sag_error << ", \"reaction_sum\": " << e.reaction_sum
            << ", \"least_share\": " << e.least_share << ", \"largest_share\": " << e.largest_share
            << ", \"reaction_error\": " << e.reactions << ", \"post_force_error\": " << e.posts
            << ", \"beam_shear_error\": " << e.shears << ", \"beam_moment_error\": " << e.moments << "}";
}

solver::StaticSolution state_of(const solver::Reanalysis& standing) {
  solver::StaticSolution state;
  state.displacements = standing.displacements();
  for (std::size_t s = 0; s < standing.model().supports.size(); ++s)
    state.reactions.push_back(standing.reaction(static_cast<int>(s)));
  for (std::size_t b = 0; b < standing.model().beams.size(); ++b)
    state.beam_end_forces.push_back(standing.beam_end_forces(static_cast<int>(b)));
  return state;
}

void apply(solver::Reanalysis& standing, const solver::LoadSet& loads) {
  std::vector<std::vector<solver::BeamLoad>> by_beam(standing.model().beams.size());
  for (const solver::BeamLoad& load : loads.beams) by_beam[static_cast<std::size_t>(load.beam)].push_back(load);
  for (std::size_t b = 0; b < by_beam.size(); ++b) standing.set_beam_loads(static_cast<int>(b), std::move(by_beam[b]));
  for (const solver::NodeLoad& load : loads.nodes) standing.set_node_load(load.node, load.load);
}

}  // namespace topple::bench
