#include "analysis/lossy_frame.h"

#include <algorithm>

#include "index_of.h"
#include "panel_demand.h"

namespace topple::structure {

LossyFrame::LossyFrame(const Building& building, const std::vector<MemberId>& candidates,
                       const solver::AnalysisOptions& options)
    : building_(building),
      frame_(make_frame(building)),
      edges_(building),
      whole_(building, edges_),
      bearings_(whole_),
      shells_(building),
      members_at_node_(building.nodes.size(), 0),
      ground_(building.nodes.size(), -1) {
  for (const Member& member : building.members)
    for (const NodeId node : member.nodes) ++members_at_node_[index_of(node)];
  for (const MemberId member : candidates)
    for (const NodeId node : nodes_left_bare(member)) {
      if (ground_[index_of(node)] >= 0) continue;
      ground_[index_of(node)] = static_cast<int>(frame_.model.supports.size());
      frame_.model.supports.push_back({node.index, Vec6::Zero()});
    }
  analysis_ = std::make_unique<solver::Reanalysis>(frame_.model, options);
}

std::vector<NodeId> LossyFrame::nodes_left_bare(MemberId member) const {
  std::vector<NodeId> bare;
  for (const NodeId node : building_[member].nodes)
    if (members_at_node_[index_of(node)] == 1) bare.push_back(node);
  return bare;
}

void LossyFrame::load(const PartLoads& loads) {
  loads_.emplace(building_, loads, bearings_, shells_);
  write_loads();
}

void LossyFrame::write_loads() {
  const FrameLoads::Changed changed = loads_->take_changed();
  for (const MemberId member : changed.members) {
    std::vector<solver::BeamLoad> on = loads_->on(member);
    for (solver::BeamLoad& load : on) load.beam = member.index;
    analysis_->set_beam_loads(member.index, std::move(on));
  }
  for (const NodeId node : changed.nodes) {
    const bool bare = std::find(bare_.begin(), bare_.end(), node) != bare_.end();
    analysis_->set_node_load(node.index, bare ? Vec6::Zero() : loads_->on(node));
  }
}

/// A hub that nothing holds any longer is out of the structure: it is kept in place by springs as stiff as the member
/// that left, so that the equations keep their condition, and bears no load.
void LossyFrame::set_ground(NodeId node, bool held) {
  Vec6 spring = Vec6::Zero();
  if (held) {
    const solver::Beam& beam = frame_.model.beams[index_of(lost_)];
    spring.head<3>().setConstant(beam.youngs_modulus * beam.area / beam.length);
    spring.tail<3>().setConstant(beam.youngs_modulus * std::max(beam.Iy, beam.Iz) / beam.length);
  }
  analysis_->set_support_stiffness(ground_[index_of(node)], spring);
  analysis_->set_node_load(node.index, held ? Vec6::Zero() : loads_->on(node));
}

void LossyFrame::lose(MemberId member) {
  lost_ = member;
  bare_ = nodes_left_bare(member);
  PanelBearings::Left left{{{member, -1}}, {}};
  for (const NodeId node : bare_) left.nodes.emplace_back(node, -1);
  changes_ = bearings_.leave(left);
  analysis_->remove_beam(member.index);
  for (const PanelId panel : changes_.lost_membrane) analysis_->remove_shell(frame_.shell_of_panel[index_of(panel)]);
  for (const PanelId panel : changes_.lost_edge) loads_->hand_on_anew(panel);
  for (const PanelId panel : changes_.fell) loads_->hand_on_anew(panel);
  write_loads();
  for (const NodeId node : bare_) set_ground(node, true);
}

void LossyFrame::restore() {
  if (!lost_.valid()) return;
  bearings_.become(whole_);
  analysis_->restore_beam(lost_.index);
  for (const PanelId panel : changes_.lost_membrane) analysis_->restore_shell(frame_.shell_of_panel[index_of(panel)]);
  for (const PanelId panel : changes_.lost_edge) loads_->hand_on_anew(panel);
  for (const PanelId panel : changes_.fell) loads_->hand_on_anew(panel);
  const std::vector<NodeId> bare = std::exchange(bare_, {});
  for (const NodeId node : bare) set_ground(node, false);
  write_loads();
  lost_ = MemberId();
}

void LossyFrame::expect(std::span<const MemberId> members) {
  std::vector<int> beams;
  for (const MemberId member : members) beams.push_back(member.index);
  analysis_->expect_losses(beams);
}

void LossyFrame::read_demands(std::vector<Vec6>& demand, std::vector<JointId>& holding) const {
  demand.resize(building_.joints.size());
  holding.clear();
  for (std::size_t m = 0; m < building_.members.size(); ++m) {
    if (MemberId(m) == lost_) continue;
    const JointId first = building_.joint(MemberId(m), 0), second = building_.joint(MemberId(m), 1);
    if (!building_[first].capacity.breakable && !building_[second].capacity.breakable) continue;
    const solver::Vec12 forces = analysis_->beam_end_forces(static_cast<int>(m));
    for (const JointId joint : {first, second}) {
      if (!building_[joint].capacity.breakable) continue;
      demand[index_of(joint)] = member_joint_demand(forces, building_[joint].end);
      holding.push_back(joint);
    }
  }
  for (std::size_t p = 0; p < building_.panels.size(); ++p) {
    const PanelId panel(p);
    if (!bearings_.serves(panel) || !bearings_.stands(panel)) continue;
    std::optional<std::array<Vec6, 4>> corners;
    if (bearings_.membrane(panel)) corners = analysis_->shell_corner_forces(frame_.shell_of_panel[p]);
    const std::array<Vec6, 4> of_edges = panel_edge_demands(building_, bearings_, *loads_, panel, corners);
    for (int edge = 0; edge < 4; ++edge) {
      const JointId joint = building_.joint(panel, edge);
      const auto e = static_cast<std::size_t>(edge);
      if (!building_[joint].capacity.breakable || !bearings_.holds(panel)[e]) continue;
      demand[index_of(joint)] = of_edges[e];
      holding.push_back(joint);
    }
  }
}

}  // namespace topple::structure
