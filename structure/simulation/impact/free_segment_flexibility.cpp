// How a free body gives way where it is struck.
#include <algorithm>
#include <array>

#include "loads/placed_load.h"
#include "model/index_of.h"
#include "simulation/debris/mass_properties.h"
#include "simulation/impact/free_segment.h"
#include "topple/solver/beam_diagram.h"

namespace topple::structure {

namespace {

/// Gauss-Legendre with four points: exact to degree seven. A line load is linear along a member and the deflection
/// under another one of degree five.
constexpr std::array<std::pair<double, double>, 4> gauss{{{0.06943184420297371, 0.17392742256872692},
                                                          {0.33000947820757187, 0.32607257743127308},
                                                          {0.66999052179242813, 0.32607257743127308},
                                                          {0.93056815579702629, 0.17392742256872692}}};

/// Of the nodes at a beam's ends, in its own axes, after its arms.
solver::Vec12 at_ends(const solver::Beam& beam, const std::vector<Vec6>& displacements) {
  solver::Vec12 local;
  for (std::size_t end = 0; end < 2; ++end) {
    const Vec6& node = displacements[static_cast<std::size_t>(beam.node[end])];
    const Vec3 turn = node.tail<3>();
    local.segment<3>(static_cast<Eigen::Index>(6 * end)) = beam.axes * (node.head<3>() + turn.cross(beam.offset[end]));
    local.segment<3>(static_cast<Eigen::Index>(6 * end + 3)) = beam.axes * turn;
  }
  return local;
}

}  // namespace

std::vector<solver::BeamDiagram> FreeSegment::diagrams_of(const solver::StaticSolution& solution,
                                                          const solver::LoadSet& loads) const {
  std::vector<std::vector<solver::BeamLoad>> own(model_.beams.size());
  for (const solver::BeamLoad& load : loads.beams) own[static_cast<std::size_t>(load.beam)].push_back(load);
  std::vector<solver::BeamDiagram> diagrams;
  diagrams.reserve(own.size());
  for (std::size_t b = 0; b < own.size(); ++b)
    diagrams.emplace_back(model_.beams[b], solution.beam_end_forces[b], own[b]);
  return diagrams;
}

/// What a solved state moves of the body's mass: sums of mass times displacement, and of their moments about its
/// centre.
struct FreeSegment::MovedMass {
  Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
};

/// How a place on a member or node moves in a solved state, along its push.
double FreeSegment::moved(const solver::LoadSet& push, const std::vector<solver::BeamDiagram>& diagrams,
                          const std::vector<Vec6>& displacements) const {
  double sum = 0;
  for (const solver::NodeLoad& load : push.nodes)
    sum += load.load.dot(displacements[static_cast<std::size_t>(load.node)]);
  for (const solver::BeamLoad& load : push.beams) {
    const auto b = static_cast<std::size_t>(load.beam);
    sum += load.first.dot(diagrams[b].displacement(load.from, at_ends(model_.beams[b], displacements)));
  }
  return sum;
}

FreeSegment::MovedMass FreeSegment::moved_mass(const std::vector<solver::BeamDiagram>& diagrams,
                                               const std::vector<Vec6>& displacements) const {
  MovedMass sum;
  for (std::size_t b = 0; b < parts_.members.size(); ++b) {
    const Member& member = building_[parts_.members[b]];
    const solver::BeamDiagram& diagram = diagrams[b];
    const solver::Vec12 ends = at_ends(model_.beams[b], displacements);
    const Vec3 first = member_start(building_, member), along = member.axes.row(0);
    const double per_length = parts_.member_mass[b] / member.length, turning = polar(parts_.members[b]);
    std::vector<double> cuts = diagram.breaks();
    cuts.insert(cuts.begin(), 0.0);
    cuts.push_back(member.length);
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i)
      for (const auto& [at, weight] : gauss) {
        const double x = cuts[i] + at * (cuts[i + 1] - cuts[i]);
        const double mass = per_length * weight * (cuts[i + 1] - cuts[i]);
        const Vec6 here = diagram.displacement(x, ends);
        const Vec3 moved = member.axes.transpose() * here.head<3>();
        sum.linear += mass * moved;
        sum.angular += mass * (first + x * along - centre_).cross(moved) + mass * turning * here(3) * along;
      }
  }
  for (std::size_t n = 0; n < point_mass_.size(); ++n) {
    const Vec3 moved = displacements[n].head<3>();
    sum.linear += point_mass_[n] * moved;
    sum.angular += point_mass_[n] * (model_.nodes[n] - centre_).cross(moved);
  }
  return sum;
}

/// Of a member that nothing else holds.
double FreeSegment::compliance_of_part_alone(const FreePush& unit_push) const {
  const auto found = std::find(parts_.members.begin(), parts_.members.end(), unit_push.member);
  FreeSegmentParts alone;
  alone.members = {unit_push.member};
  alone.member_mass = {parts_.member_mass[static_cast<std::size_t>(found - parts_.members.begin())]};
  FreeSegment segment(building_, alone, [](JointId) { return false; });
  return segment.flexibility({&unit_push, 1}).compliance(0, 0);
}

FreeSegment::Flexibility FreeSegment::flexibility(std::span<const FreePush> unit_pushes) {
  if (!analysis_ && !is_mechanism_) analyse();
  const auto n = static_cast<Eigen::Index>(unit_pushes.size());
  Flexibility result;
  result.compliance = Eigen::MatrixXd::Zero(n, n);
  std::vector<solver::LoadSet> loads;
  std::vector<Answer> answers(unit_pushes.size());
  for (std::size_t i = 0; i < unit_pushes.size(); ++i)
    loads.push_back(balanced(unit_pushes.subspan(i, 1), Vec3::Zero(), Vec3::Zero(), answers[i]));
  std::vector<solver::StaticSolution> solutions;
  if (analysis_) {
    solutions = analysis_->solve(loads);
    std::vector<solver::LoadSet> alone;
    for (std::size_t i = 0; i < unit_pushes.size(); ++i) alone.push_back(loads_of(unit_pushes.subspan(i, 1)));
    for (Eigen::Index j = 0; j < n; ++j) {
      const auto b = static_cast<std::size_t>(j);
      const std::vector<solver::BeamDiagram> diagrams = diagrams_of(solutions[b], loads[b]);
      const MovedMass inertia = moved_mass(diagrams, solutions[b].displacements);
      // The work of force i and of the inertia that holds it in balance, through what force j moves.
      for (Eigen::Index i = 0; i < n; ++i) {
        const auto a = static_cast<std::size_t>(i);
        result.compliance(i, j) = moved(alone[a], diagrams, solutions[b].displacements) -
                                  answers[a].acceleration.dot(inertia.linear) -
                                  answers[a].angular_acceleration.dot(inertia.angular);
      }
    }
    // Symmetric but for rounding (Betti).
    result.compliance = (0.5 * (result.compliance + result.compliance.transpose())).eval();
  }
  for (std::size_t i = 0; i < unit_pushes.size(); ++i) {
    const FreePush& push = unit_pushes[i];
    const auto row = static_cast<Eigen::Index>(i);
    if (is_mechanism_ && push.member.valid()) result.compliance(row, row) = compliance_of_part_alone(push);
    if (!push.member.valid())
      result.compliance(row, row) += panel_bending_compliance(building_, push.panel, push.point, push.force);
    if (!can_break_) continue;
    read_demands(analysis_ ? &solutions[i] : nullptr, unit_pushes.subspan(i, 1), Vec3::Zero(), Vec3::Zero(),
                 answers[i]);
    // The same joints in the same order for each place.
    if (i == 0)
      for (const auto& [joint, demand] : answers[i].demands)
        result.demands.emplace_back(joint, Eigen::Matrix<double, 6, Eigen::Dynamic>::Zero(6, n));
    for (std::size_t k = 0; k < answers[i].demands.size(); ++k)
      result.demands[k].second.col(row) = answers[i].demands[k].second;
  }
  return result;
}

}  // namespace topple::structure
