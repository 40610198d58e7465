#include "analysis/one_way_members.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <set>
#include <stdexcept>

#include "topple/solver/beam_diagram.h"

namespace topple::structure {

namespace {

/// The end at which a slack member lets go: the weight of a tie hangs on its upper end, that of a strut stands on its
/// lower one.
std::size_t loose_end(const solver::Beam& beam) {
  const bool rises = beam.axes(0, 2) > 0;
  return (beam.axial == solver::AxialAction::tension_only) == rises ? 0 : 1;
}

double sense(const solver::Beam& beam) { return beam.axial == solver::AxialAction::tension_only ? 1 : -1; }

/// Of the rigid ends at a beam's ends, local axes.
solver::Vec12 rigid_end_displacements(const solver::Beam& beam, const std::vector<solver::Vec6>& displacements) {
  solver::Vec12 rigid_ends;
  for (std::size_t end = 0; end < 2; ++end) {
    const solver::Vec6& node = displacements[static_cast<std::size_t>(beam.node[end])];
    const solver::Vec3 turned = node.tail<3>(), moved = node.head<3>() + turned.cross(beam.offset[end]);
    const auto first = static_cast<Eigen::Index>(6 * end);
    rigid_ends.segment<3>(first) = beam.axes * moved;
    rigid_ends.segment<3>(first + 3) = beam.axes * turned;
  }
  return rigid_ends;
}

double largest_axial_force(const solver::StaticSolution& solution) {
  double largest = 0;
  for (const solver::Vec12& forces : solution.beam_end_forces)
    largest = std::max({largest, std::abs(forces(0)), std::abs(forces(6))});
  return largest;
}

/// Turns over all that is violated, or only the first.
std::vector<char> turned_over(std::vector<char> active, const std::vector<std::size_t>& violated, bool only_first) {
  for (const std::size_t member : violated) {
    active[member] = active[member] == 0 ? 1 : 0;
    if (only_first) break;
  }
  return active;
}

[[noreturn]] void report_cycle(const std::vector<std::size_t>& violated, const std::vector<std::string>& names) {
  std::string list;
  for (const std::size_t member : violated) list += (list.empty() ? "" : ", ") + names[member];
  throw std::runtime_error("tension-only and compression-only members find no state that holds; they come round to " +
                           list + " again");
}

}  // namespace

solver::FrameModel carrying_both(solver::FrameModel model) {
  for (solver::Beam& beam : model.beams) beam.axial = solver::AxialAction::both;
  return model;
}

OneWayMembers::OneWayMembers(const solver::FrameModel& model) : model_(model) {
  for (std::size_t i = 0; i < model.beams.size(); ++i)
    if (model.beams[i].axial != solver::AxialAction::both) members_.push_back(i);
}

solver::FrameModel OneWayMembers::with_releases(const std::vector<char>& active, double trace) const {
  solver::FrameModel model = carrying_both(model_);
  for (const std::size_t i : members_) {
    solver::Beam& beam = model.beams[i];
    if (active[i] == 0)
      beam.end_stiffness[loose_end(model_.beams[i])](0) = trace * beam.youngs_modulus * beam.area / beam.length;
  }
  return model;
}

/// How far the member's state is wrong, as a force; 0 or less: it is right.
double OneWayMembers::violation(std::size_t i, const std::vector<char>& active,
                                const std::vector<std::vector<solver::BeamLoad>>& loads,
                                const std::vector<solver::Beam>& beams, const solver::StaticSolution& solution) const {
  const solver::Beam& beam = beams[i];
  const double sign = sense(model_.beams[i]);
  const std::size_t end = loose_end(model_.beams[i]);
  const solver::Vec12& forces = solution.beam_end_forces[i];
  const double tension = end == 0 ? -forces(0) : forces(6);
  if (active[i] != 0) return -sign * tension;
  const solver::Vec12 rigid_ends = rigid_end_displacements(beam, solution.displacements);
  const solver::BeamDiagram diagram(beam, forces, loads[i]);
  const double at_end = diagram.displacement(end == 0 ? 0 : beam.length, rigid_ends)(0);
  const double pulled = end == 0 ? at_end - rigid_ends(0) : rigid_ends(6) - at_end;
  return sign * pulled * beam.youngs_modulus * beam.area / beam.length;
}

OneWayAnswer OneWayMembers::all_taut(const solver::StaticSolution& solution) const {
  return {solution, carrying_both(model_).beams, std::vector<char>(model_.beams.size(), 1), 0, {}};
}

OneWayAnswer OneWayMembers::settle(const solver::LoadSet& loads, OneWayAnswer answer, const Solve& solve,
                                   const std::vector<std::string>& names, Mechanisms mechanisms) const {
  std::vector<std::vector<solver::BeamLoad>> by_beam(model_.beams.size());
  for (const solver::BeamLoad& load : loads.beams) by_beam[static_cast<std::size_t>(load.beam)].push_back(load);
  std::set<std::vector<char>> seen{answer.active};
  // All at once is quick but may swing between two wrong states; then one by one in order of index, which ends for
  // every stable structure (Murty's least-index rule for linear complementarity).
  bool one_by_one = false;
  // Of a slack member's stiffness while a mechanism is gone through; each time less, so that it ends.
  constexpr std::array<double, 2> traces{1e-6, 1e-9};
  std::size_t gone_through = 0;
  double trace = 0;
  const auto take = [&](const std::vector<char>& state) {
    const solver::FrameModel model = with_releases(state, trace);
    answer.active = state;
    answer.beams = model.beams;
    solve(model, answer);
    ++answer.iterations;
  };
  for (;;) {
    // Of the largest axial force; a trace of stiffness costs digits.
    const double rounding = trace > 0 ? 1e-6 : 1e-11, least = rounding * largest_axial_force(answer.solution);
    std::vector<std::size_t> violated;
    for (const std::size_t i : members_)
      if (violation(i, answer.active, by_beam, answer.beams, answer.solution) > least) violated.push_back(i);
    if (violated.empty()) {
      if (trace == 0) return answer;
      trace = 0;
      seen = {answer.active};
      take(std::vector<char>(answer.active));
      continue;
    }
    std::vector<char> next = turned_over(answer.active, violated, one_by_one);
    if (seen.count(next) != 0) {
      if (one_by_one) report_cycle(violated, names);
      one_by_one = true;
      seen = {answer.active};
      next = turned_over(answer.active, violated, true);
    }
    seen.insert(next);
    try {
      take(next);
    } catch (const solver::Instability&) {
      if (mechanisms == Mechanisms::end_it || trace > 0 || gone_through == traces.size()) throw;
      trace = traces[gone_through++];
      seen = {next};
      take(next);
    }
  }
}

}  // namespace topple::structure
