#include "analysis/damaged_frame.h"

#include <algorithm>

#include "analysis/resultants/shell_results.h"
#include "failure/panel_demand.h"
#include "mesh/shell_edges.h"
#include "model/index_of.h"
#include "model/panel_area.h"
#include "standing/statics/displaced_rest.h"
#include "topple/solver/geometric_forces.h"
#include "topple/structure/error.h"

namespace topple::structure {

namespace {

[[noreturn]] void refuse(const Building& building, const std::string& asked, const std::string& what,
                         const std::string& accepted) {
  throw InputError(building.file + ": " + asked + " do not go with " + what + " yet; accepted: " + accepted);
}

}  // namespace

void refuse_what_is_not_built(const Building& building, const std::string& asked) {
  for (const Member& member : building.members)
    if (member.axial != AxialAction::both)
      refuse(building, asked, "members of one sign (" + member.name + ")", "\"axial\": \"both\"");
  for (const Joint& joint : building.joints)
    if (joint.panel.valid() && (joint.stiffness.array() != unlimited).any())
      refuse(building, asked, "a shell's edge that gives (joint " + joint.name + ")",
             "an edge joint without `stiffness`");
}

void refuse_loads_that_are_not_built(const Building& building, CombinationId combination, const PartLoads& loads,
                                     const std::string& asked) {
  const std::string place = " in combination " + building[combination].name;
  if (!loads.settlements.empty()) refuse(building, asked, "settlements" + place, "a combination without them");
  for (std::size_t p = 0; p < building.panels.size(); ++p)
    if (loads.panels[p].strain != 0 && building.panels[p].model != PanelModel::cladding)
      refuse(building, asked, "a heated panel (" + building.panels[p].name + ")" + place, "a combination without it");
}

DamagedFrame::DamagedFrame(const DividedBuilding& divided, const std::vector<MemberId>& candidates,
                           const solver::AnalysisOptions& options)
    : divided_(divided),
      building_(divided.building()),
      frame_(make_frame(building_)),
      edges_(building_),
      whole_(building_, edges_),
      bearings_(whole_),
      shells_(building_),
      hold_node_(building_.nodes.size(), 0),
      ground_(building_.nodes.size(), -1) {
  hang_shells();
  for (const Member& member : building_.members)
    for (const NodeId node : member.nodes) ++hold_node_[index_of(node)];
  for (const MemberId member : candidates)
    for (const NodeId node : nodes_left_bare(member)) {
      if (ground_[index_of(node)] >= 0) continue;
      ground_[index_of(node)] = static_cast<int>(frame_.model.supports.size());
      frame_.model.supports.push_back({node.index, Vec6::Zero()});
    }
  analysis_ = std::make_unique<solver::Reanalysis>(frame_.model, options);
}

/// One element for each, between the nodes that it hangs on, instead of its mesh.
void DamagedFrame::hang_shells() {
  solver::FrameModel& model = frame_.model;
  const std::size_t nodes = building_.nodes.size();
  model.shells.resize(static_cast<std::size_t>(
      std::count_if(frame_.shell_of_panel.begin(), frame_.shell_of_panel.end(), [](int shell) { return shell >= 0; })));
  // Those of edges, inside a mesh, are within its superelement.
  std::erase_if(model.supports, [&](const solver::Support& s) { return static_cast<std::size_t>(s.node) >= nodes; });
  for (std::size_t p = 0; p < building_.panels.size(); ++p) {
    if (building_.panels[p].model != PanelModel::shell) continue;
    const PanelSuperelement& shell = *shells_.of(PanelId(p));
    const std::vector<NodeId> at = building_.panels[p].all_nodes();
    solver::Patch patch;
    for (std::size_t n = 0; n < at.size(); ++n) {
      patch.node.push_back(at[n].index);
      hold_node_[index_of(at[n])] += shell.stands_at(n) ? 1 : 0;
    }
    patch.stiffness = shell.stiffness();
    intact_[PanelId(p)] = intact_edges(frame_, PanelId(p));
    model.patches.push_back(std::move(patch));
  }
  model.nodes.resize(nodes);
}

/// Nothing but this member holds them.
std::vector<NodeId> DamagedFrame::nodes_left_bare(MemberId member) const {
  std::vector<NodeId> ends, bare;
  for (const MemberId piece : divided_.pieces(member))
    ends.insert(ends.end(), building_[piece].nodes.begin(), building_[piece].nodes.end());
  std::sort(ends.begin(), ends.end());
  for (auto node = ends.begin(); node != ends.end();) {
    const auto next = std::upper_bound(node, ends.end(), *node);
    if (hold_node_[index_of(*node)] == next - node) bare.push_back(*node);
    node = next;
  }
  return bare;
}

void DamagedFrame::load(const PartLoads& loads) {
  loads_.emplace(building_, loads, bearings_, shells_);
  write_loads();
}

void DamagedFrame::write_loads() {
  const FrameLoads::Changed changed = loads_->extract_changed();
  for (const MemberId member : changed.members) {
    std::vector<solver::BeamLoad> on = loads_->on(member);
    for (solver::BeamLoad& load : on) load.beam = member.index;
    analysis_->set_beam_loads(member.index, std::move(on));
  }
  for (const NodeId node : changed.nodes) write_load(node);
}

void DamagedFrame::write_load(NodeId node) {
  const bool bare = std::find(bare_.begin(), bare_.end(), node) != bare_.end();
  Vec6 load = bare ? Vec6::Zero() : loads_->on(node);
  if (!geometric_.empty()) load += geometric_[index_of(node)];
  analysis_->set_node_load(node.index, load);
}

/// From the first-order answer each time, so that no answer hangs on the one before it.
const solver::ReanalysisAnswer& DamagedFrame::solve() {
  settled_ = true;
  if (!geometric_.empty()) {
    geometric_.clear();
    for (std::size_t n = 0; n < building_.nodes.size(); ++n) write_load(NodeId(n));
  }
  const solver::ReanalysisAnswer& answer = analysis_->solve();
  if (!second_order_ || !answer.stable) return answer;
  settled_ = displace();
  return analysis_->solve();
}

/// What the axial force that the member has in the answer does to it at these displacements.
solver::Vec12 DamagedFrame::geometric_forces(int beam, const std::vector<Vec6>& displacements) const {
  const solver::Beam& own = analysis_->model().beams[static_cast<std::size_t>(beam)];
  return solver::geometric_forces(own, analysis_->beam_end_forces(beam),
                                  displacements[static_cast<std::size_t>(own.node[0])],
                                  displacements[static_cast<std::size_t>(own.node[1])]);
}

bool DamagedFrame::displace() {
  const auto answer = [&](const std::vector<Vec6>& at) -> const std::vector<Vec6>* {
    geometric_.assign(building_.nodes.size(), Vec6::Zero());
    for (std::size_t m = 0; m < building_.members.size(); ++m) {
      if (!stands(MemberId(m))) continue;
      const solver::Beam& own = analysis_->model().beams[m];
      const solver::Vec12 push = solver::node_forces(own, geometric_forces(static_cast<int>(m), at));
      for (std::size_t end = 0; end < 2; ++end)
        geometric_[static_cast<std::size_t>(own.node[end])] -= push.segment<6>(static_cast<Eigen::Index>(6 * end));
    }
    for (std::size_t n = 0; n < building_.nodes.size(); ++n) write_load(NodeId(n));
    return analysis_->solve().stable ? &analysis_->displacements() : nullptr;
  };
  return find_displaced_rest(analysis_->displacements(), answer) != DisplacedRest::none;
}

solver::Vec12 DamagedFrame::beam_end_forces(int beam) const {
  solver::Vec12 forces = analysis_->beam_end_forces(beam);
  if (!geometric_.empty() && stands(MemberId(static_cast<std::size_t>(beam))))
    forces += geometric_forces(beam, analysis_->displacements());
  return forces;
}

/// A node that nothing holds any longer is out of the structure: it is kept in place by springs as stiff as the member
/// that left, so that the equations keep their condition, and bears no load.
void DamagedFrame::set_ground(NodeId node, bool held) {
  Vec6 spring = Vec6::Zero();
  if (held) {
    const solver::Beam& beam = frame_.model.beams[index_of(lost_)];  // its first piece
    spring.head<3>().setConstant(beam.youngs_modulus * beam.area / beam.length);
    spring.tail<3>().setConstant(beam.youngs_modulus * std::max(beam.Iy, beam.Iz) / beam.length);
  }
  analysis_->set_support_stiffness(ground_[index_of(node)], spring);
  write_load(node);
}

void DamagedFrame::lose(MemberId member) {
  lost_ = member;
  bare_ = nodes_left_bare(member);
  PanelBearings::Left left;
  for (const MemberId piece : divided_.pieces(member)) left.members.emplace_back(piece, -1);
  for (const NodeId node : bare_) left.nodes.emplace_back(node, -1);
  changes_ = bearings_.leave(left);
  for (const MemberId piece : divided_.pieces(member)) analysis_->remove_beam(piece.index);
  for (const PanelId panel : changes_.lost_membrane) analysis_->remove_shell(frame_.shell_of_panel[index_of(panel)]);
  for (const PanelId panel : changes_.lost_edge) loads_->hand_on_anew(panel);
  for (const PanelId panel : changes_.fell) loads_->hand_on_anew(panel);
  write_loads();
  for (const NodeId node : bare_) set_ground(node, true);
}

void DamagedFrame::restore() {
  if (!lost_.valid()) return;
  bearings_.become(whole_);
  for (const MemberId piece : divided_.pieces(lost_)) analysis_->restore_beam(piece.index);
  for (const PanelId panel : changes_.lost_membrane) analysis_->restore_shell(frame_.shell_of_panel[index_of(panel)]);
  for (const PanelId panel : changes_.lost_edge) loads_->hand_on_anew(panel);
  for (const PanelId panel : changes_.fell) loads_->hand_on_anew(panel);
  const std::vector<NodeId> bare = std::exchange(bare_, {});
  for (const NodeId node : bare) set_ground(node, false);
  write_loads();
  lost_ = MemberId();
}

void DamagedFrame::expect(std::span<const MemberId> members) {
  std::vector<int> beams;
  for (const MemberId member : members)
    if (divided_.pieces(member).size() == 1) beams.push_back(member.index);
  analysis_->expect_losses(beams);
}

/// What lies along them holds the panel: supports, members that stand, other shells.
std::array<bool, 4> DamagedFrame::edges_that_bear(PanelId shell) const {
  std::array<bool, 4> bear{};
  for (int edge = 0; edge < 4; ++edge) {
    const std::vector<MemberId>& along = edges_.of(shell, edge);
    const auto lost = [&](MemberId piece) { return !stands(piece); };
    // An edge that bore by the lost member alone: no support, no other shell at its nodes.
    bool other = std::any_of(building_.edge_supports.begin(), building_.edge_supports.end(),
                             [&](const EdgeSupport& s) { return s.panel == shell && s.edge == edge; });
    other = other || along.empty() || !std::all_of(along.begin(), along.end(), lost) ||
            borders_shell(building_, shell, edge);
    bear[static_cast<std::size_t>(edge)] = other && edge_bears(building_, shell, edge);
  }
  return bear;
}

std::array<Vec6, 4> DamagedFrame::edge_demands(PanelId shell, const Motion& motion) const {
  std::vector<Vec6> at_nodes;
  for (const NodeId node : building_[shell].all_nodes()) at_nodes.push_back(motion.displacements()[index_of(node)]);
  const Vec3 traction = motion.rates ? Vec3::Zero() : loads_->traction(shell);
  return shells_.of(shell)->edge_demands(at_nodes, {traction, {}}, intact_.at(shell), edges_that_bear(shell));
}

namespace {

class AtRest : public DamagedFrame::Motion {
 public:
  explicit AtRest(const DamagedFrame& frame) : frame_(frame), analysis_(frame.analysis()) {}
  [[nodiscard]] solver::Vec12 beam_end_forces(int beam) const override { return frame_.beam_end_forces(beam); }
  [[nodiscard]] std::array<Vec6, 4> shell_corner_forces(int shell) const override {
    return analysis_.shell_corner_forces(shell);
  }
  [[nodiscard]] const std::vector<Vec6>& displacements() const override { return analysis_.displacements(); }

 private:
  const DamagedFrame& frame_;
  const solver::Reanalysis& analysis_;
};

}  // namespace

void DamagedFrame::read_demands(std::vector<Vec6>& demand, std::vector<JointId>& holding) const {
  read_demands(AtRest(*this), demand, holding);
}

void DamagedFrame::read_demands(const Motion& motion, std::vector<Vec6>& demand, std::vector<JointId>& holding) const {
  demand.resize(building_.joints.size());
  holding.clear();
  for (std::size_t m = 0; m < building_.members.size(); ++m) {
    if (!stands(MemberId(m))) continue;
    const JointId first = building_.joint(MemberId(m), 0), second = building_.joint(MemberId(m), 1);
    if (!building_[first].capacity.breakable && !building_[second].capacity.breakable) continue;
    const solver::Vec12 forces = motion.beam_end_forces(static_cast<int>(m));
    for (const JointId joint : {first, second}) {
      if (!building_[joint].capacity.breakable) continue;
      demand[index_of(joint)] = member_joint_demand(forces, building_[joint].end);
      holding.push_back(joint);
    }
  }
  for (std::size_t p = 0; p < building_.panels.size(); ++p) {
    const PanelId panel(p);
    const bool shell = !bearings_.tracks(panel);
    if (!shell && !bearings_.stands(panel)) continue;
    const std::array<bool, 4> holds = shell ? std::array{true, true, true, true} : bearings_.holds(panel);
    std::optional<std::array<Vec6, 4>> corners;
    if (bearings_.membrane(panel)) corners = motion.shell_corner_forces(frame_.shell_of_panel[p]);
    std::array<Vec6, 4> of_edges{Vec6::Zero(), Vec6::Zero(), Vec6::Zero(), Vec6::Zero()};
    if (shell)
      of_edges = edge_demands(panel, motion);
    else if (!motion.rates)
      of_edges = panel_edge_demands(building_, bearings_, *loads_, panel, corners);
    else if (corners)
      of_edges = membrane_edge_demands(building_, panel, *corners);
    for (int edge = 0; edge < 4; ++edge) {
      const JointId joint = building_.joint(panel, edge);
      const auto e = static_cast<std::size_t>(edge);
      if (!building_[joint].capacity.breakable || !holds[e]) continue;
      demand[index_of(joint)] = of_edges[e];
      holding.push_back(joint);
    }
  }
}

/// Panels whose weight is not among the loads bring their material's mass where their weight would go; those of shells
/// lie at their corners.
void DamagedFrame::weigh_panels(MovingFrame& moving, std::vector<double>& mass) const {
  for (std::size_t p = 0; p < building_.panels.size(); ++p) {
    const PanelId panel(p);
    const Panel& own = building_.panels[p];
    const bool shell = !bearings_.tracks(panel);
    const double weighed = loads_->mass(panel), density = building_[own.material].density;
    if (shell) {
      const double total = weighed > 0 ? weighed : density * panel_area(building_, own, true) * own.thickness;
      for (const NodeId node : own.nodes) moving.masses.nodes.push_back({node.index, total / 4, Vec3::Zero()});
      continue;
    }
    if (weighed > 0 || !bearings_.stands(panel) || !(density > 0)) continue;
    PanelAction weight;
    weight.body_force = Vec3(0, 0, -density * own.thickness);
    const TributaryLoads handed =
        tributary_loads(building_, edges_, panel, weight, bearings_.holds(panel), bearings_.member_stands());
    for (const solver::NodeLoad& load : handed.nodes)
      moving.masses.nodes.push_back({load.node, std::max(0.0, -load.load.z()), Vec3::Zero()});
    for (const solver::BeamLoad& load : handed.beams) {
      const auto down = [&](const Vec6& local) {
        return -(building_.members[static_cast<std::size_t>(load.beam)].axes.transpose() * local.head<3>()).z();
      };
      const double amount = load.kind == solver::BeamLoad::Kind::point
                                ? down(load.first)
                                : (down(load.first) + down(load.last)) / 2 * (load.to - load.from);
      mass[static_cast<std::size_t>(load.beam)] += amount;
    }
  }
}

solver::LoadSet DamagedFrame::loads_of_case(LoadCaseId load_case) const {
  Building alone = building_;
  const std::string name = building_[load_case].name;
  alone.combinations = {{name, {{load_case, 1.0}}}};
  const PartLoads parts = part_loads(alone, CombinationId(0));
  refuse_loads_that_are_not_built(alone, CombinationId(0), parts, "loads that go with time");
  for (std::size_t p = 0; p < building_.panels.size(); ++p)
    if (!bearings_.tracks(PanelId(p)) && (parts.panels[p].pressure != 0 || !parts.panels[p].body_force.isZero(0)))
      refuse(building_, "loads that go with time", "a load on a shell panel (" + building_.panels[p].name + ")",
             "load cases on nodes, members and other panels");
  return load_set(alone, edges_, parts);
}

MovingFrame DamagedFrame::moving_frame(std::vector<solver::NodeMass> given) const {
  if (!(building_.gravity > 0))
    throw InputError(building_.file + ": what moves has its mass by weight over gravity, which must be above 0");
  MovingFrame moving;
  moving.model = frame_.model;
  moving.masses.nodes = std::move(given);
  std::vector<double> mass(building_.members.size());
  for (std::size_t m = 0; m < building_.members.size(); ++m) {
    moving.beam_loads.push_back(loads_->on(MemberId(m)));
    mass[m] = moving_mass(building_, building_.members[m], moving.beam_loads.back());
  }
  for (solver::Shell& shell : moving.model.shells) shell.density = 0;
  weigh_panels(moving, mass);
  for (std::size_t n = 0; n < building_.nodes.size(); ++n) {
    const bool bare = std::find(bare_.begin(), bare_.end(), NodeId(n)) != bare_.end();
    moving.node_loads.push_back(bare ? Vec6::Zero() : loads_->on(NodeId(n)));
    if (bare) moving.model.supports.push_back({static_cast<int>(n), Vec6::Constant(solver::rigid)});
    const double weight = -moving.node_loads.back().z();
    if (weight > 0) moving.masses.nodes.push_back({static_cast<int>(n), weight / building_.gravity, Vec3::Zero()});
  }
  for (std::size_t m = 0; m < building_.members.size(); ++m) {
    solver::Beam& beam = moving.model.beams[m];
    beam.density = mass[m] / (beam.area * beam.length);
    if (!stands(MemberId(m))) beam.end_stiffness = {Vec6::Zero(), Vec6::Zero()};
  }
  if (lost_.valid())
    for (const PanelId panel : changes_.lost_membrane)
      moving.model.shell_stiffness[frame_.shell_of_panel[index_of(panel)]].setZero();
  return moving;
}

}  // namespace topple::structure
