#include "standing/held_push.h"

#include <algorithm>
#include <cmath>

#include "failure/panel_demand.h"
#include "standing/beam_as_it_holds.h"
#include "standing/shell_reading.h"
#include "topple/solver/held_beam.h"

namespace topple::structure {
namespace {

/// m/N: what the section itself is pressed in by, as deep as it is wide; the least that any place gives way.
double squeeze(const solver::Beam& beam) { return std::sqrt(beam.area) / (beam.youngs_modulus * beam.area); }

}  // namespace

solver::Beam HeldPush::beam(MemberId member) const { return beam_as_it_holds(from_.statics, from_.parts, member); }

HeldPush::Pushed HeldPush::push(const ContactPlace& place, const Vec3& direction) const {
  Pushed pushed;
  pushed.placed = from_.response.load_at(place, direction);
  for (const auto& [member, load] : pushed.placed.members) {
    const auto same = [id = member](const auto& one) { return one.first == id; };
    auto own = std::find_if(pushed.members.begin(), pushed.members.end(), same);
    if (own == pushed.members.end()) own = pushed.members.insert(own, {member, {}});
    own->second.push_back(load);
  }
  return pushed;
}

/// Of one push through the way that members give under the other.
double HeldPush::work(const Pushed& by, const Pushed& through) const {
  double sum = 0;
  for (const auto& [member, loads] : through.members) {
    const solver::Beam own = beam(member);
    for (const auto& [pushed, load] : by.placed.members) {
      if (pushed != member) continue;
      const Vec3 force = own.axes.transpose() * load.first.head<3>();
      sum += force.dot(solver::held_displacement(own, load.from, loads));
    }
  }
  return sum;
}

void HeldPush::add_demands(const Pushed& pushed, Eigen::Index place, StandingFrame::HeldResponse& answer) const {
  const Building& building = from_.parts.building();
  const auto add = [&](JointId joint, const Vec6& demand) {
    if (!building[joint].capacity.breakable || !from_.parts.standing(joint) || demand.isZero(0)) return;
    const auto same = [joint](const auto& one) { return one.first == joint; };
    auto own = std::find_if(answer.demands.begin(), answer.demands.end(), same);
    if (own == answer.demands.end())
      own = answer.demands.insert(own,
                                  {joint, Eigen::Matrix<double, 6, Eigen::Dynamic>::Zero(6, answer.compliance.rows())});
    own->second.col(place) += demand;
  };
  for (const auto& [member, loads] : pushed.members) {
    const solver::HeldBeam held = solver::hold_beam(beam(member), loads);
    for (int end = 0; end < 2; ++end) {
      add(building.joint(member, end), member_joint_demand(held.end_forces, end));
      answer.at_nodes[static_cast<std::size_t>(place)].emplace_back(
          building[member].nodes[static_cast<std::size_t>(end)], held.on_nodes[static_cast<std::size_t>(end)]);
    }
  }
  const PanelId panel = pushed.placed.panel;
  if (!panel.valid()) return;
  if (!from_.parts.bearings.tracks(panel)) {
    const PanelSuperelement& shell = *from_.shells.of(panel);
    const std::vector<Vec6> held(shell.nodes(), Vec6::Zero());
    const std::array<Vec6, 4> demands =
        shell_edge_demands(shell, from_.parts.bearings, panel, held, {Vec3::Zero(), {pushed.placed.on_shell}});
    for (int edge = 0; edge < 4; ++edge) add(building.joint(panel, edge), demands[static_cast<std::size_t>(edge)]);
    return;
  }
  for (int edge = 0; edge < 4; ++edge)
    add(building.joint(panel, edge), handed_edge_demand(building, from_.parts.bearings, panel, edge,
                                                        pushed.placed.edge_force[static_cast<std::size_t>(edge)]));
}

StandingFrame::HeldResponse HeldPush::respond(std::span<const ContactPlace> places,
                                              std::span<const Vec3> directions) const {
  const auto n = static_cast<Eigen::Index>(places.size());
  StandingFrame::HeldResponse answer;
  answer.compliance = answer.mobility = Eigen::MatrixXd::Zero(n, n);
  answer.speed = Eigen::VectorXd::Zero(n);
  answer.at_nodes.resize(places.size());
  std::vector<Pushed> pushed;
  for (std::size_t i = 0; i < places.size(); ++i) pushed.push_back(push(places[i], directions[i]));
  for (Eigen::Index i = 0; i < n; ++i) {
    const Pushed& own = pushed[static_cast<std::size_t>(i)];
    for (Eigen::Index j = 0; j < i; ++j)
      answer.compliance(i, j) = answer.compliance(j, i) = work(own, pushed[static_cast<std::size_t>(j)]);
    answer.compliance(i, i) = work(own, own) + own.placed.bending_compliance;
    for (const auto& [member, loads] : own.members) answer.compliance(i, i) += squeeze(beam(member));
    for (const auto& [node, load] : own.placed.nodes)
      answer.at_nodes[static_cast<std::size_t>(i)].emplace_back(node, load);
    add_demands(own, i, answer);
  }
  return answer;
}

}  // namespace topple::structure
