// How a free body gives way where it is struck.
#include <algorithm>
#include <array>

#include "loads/placed_load.h"
#include "model/index_of.h"
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

std::vector<solver::BeamLoad> loads_on(const solver::LoadSet& loads, std::size_t beam) {
  std::vector<solver::BeamLoad> own;
  for (const solver::BeamLoad& load : loads.beams)
    if (load.beam == static_cast<int>(beam)) own.push_back(load);
  return own;
}

/// Of the hubs at a beam's ends, in its own axes, after its arms.
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

/// Of these loads through the displacements that others (`of_solution`) cause.
double FreeSegment::work(const solver::LoadSet& loads, const solver::StaticSolution& through,
                         const solver::LoadSet& of_solution) const {
  double sum = 0;
  for (const solver::NodeLoad& load : loads.nodes)
    sum += load.load.dot(through.displacements[static_cast<std::size_t>(load.node)]);
  for (std::size_t b = 0; b < model_.beams.size(); ++b) {
    const solver::Beam& beam = model_.beams[b];
    const std::vector<solver::BeamLoad> own = loads_on(loads, b);
    const solver::BeamDiagram diagram(beam, through.beam_end_forces[b], loads_on(of_solution, b));
    const solver::Vec12 ends = at_ends(beam, through.displacements);
    std::vector<double> cuts = diagram.breaks();
    cuts.insert(cuts.begin(), 0.0);
    cuts.push_back(beam.length);
    for (const solver::BeamLoad& load : own) {
      if (load.kind == solver::BeamLoad::Kind::point) {
        sum += load.first.dot(diagram.displacement(load.from, ends));
        continue;
      }
      for (std::size_t i = 0; i + 1 < cuts.size(); ++i)
        for (const auto& [at, weight] : gauss) {
          const double x = cuts[i] + at * (cuts[i + 1] - cuts[i]), share = x / beam.length;
          const Vec6 here = (1 - share) * load.first + share * load.last;
          sum += weight * (cuts[i + 1] - cuts[i]) * here.dot(diagram.displacement(x, ends));
        }
    }
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
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index j = 0; j <= i; ++j) {
        const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
        result.compliance(i, j) = result.compliance(j, i) = work(loads[a], solutions[b], loads[b]);
      }
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
