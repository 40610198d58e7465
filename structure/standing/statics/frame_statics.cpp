#include "standing/statics/frame_statics.h"

namespace topple::structure {

FrameStatics::FrameStatics(const Building& building, const PanelSuperelements& shells, int threads)
    : FrameStatics(building, make_frame(building), shells, threads) {}

FrameStatics::FrameStatics(const Building& building, const Frame& frame, const PanelSuperelements& shells, int threads)
    : FrameAnswers(building, frame, {}, threads), geometric_(building.nodes.size(), Vec6::Zero()) {
  for (std::size_t p = 0; p < building.panels.size(); ++p)
    if (const PanelSuperelement* shell = shells.of(PanelId(p))) set_stiffness(PanelId(p), shell->stiffness());
}

void FrameStatics::break_joint(MemberId member, int end) {
  const Place& place = member_place_[index(member)];
  change(place, [&](auto& frame) { frame.set_end_stiffness(place.local, end, Vec6::Zero()); });
  const auto found = hinges_.find(member);
  if (found == hinges_.end()) return;
  found->second.held.segment<6>(6 * end).setZero();
  found->second.plastic_rotation.segment<6>(6 * end).setZero();
  found->second.stiffness[static_cast<std::size_t>(end)].setZero();
  write_loads(member);
}

void FrameStatics::remove(MemberId member) {
  const Place& place = member_place_[index(member)];
  change(place, [&](auto& frame) { frame.remove_beam(place.local); });
  if (hinges_.erase(member) == 0) return;
  const solver::Beam& beam = at(place).model().beams[static_cast<std::size_t>(place.local)];
  for (const int local : beam.node) write_load(nodes(place.component)[static_cast<std::size_t>(local)]);
}

void FrameStatics::remove_membrane(PanelId panel) {
  const Place& place = panel_place_[index(panel)];
  stiff_[index(panel)] = 0;
  if (place.component < 0) return;
  if (!is_patch(panel)) return change(place, [&](auto& frame) { frame.remove_shell(place.local); });
  const Eigen::Index size = at(place).patch_stiffness(place.local).rows();
  change(place, [&](auto& frame) { frame.set_patch_stiffness(place.local, Eigen::MatrixXd::Zero(size, size)); });
}

void FrameStatics::set_stiffness(PanelId panel, const Eigen::MatrixXd& stiffness) {
  const Place& place = panel_place_[index(panel)];
  if (is_patch(panel))
    change(place, [&](auto& frame) { frame.set_patch_stiffness(place.local, stiffness); });
  else
    change(place, [&](auto& frame) { frame.set_shell_stiffness(place.local, stiffness); });
}

void FrameStatics::lose_support(std::size_t support) {
  const Place& place = support_place_[support];
  change(place, [&](auto& frame) { frame.set_support_stiffness(place.local, Vec6::Zero()); });
}

void FrameStatics::remove_support(NodeId node) {
  for (std::size_t s = 0; s < support_node_.size(); ++s)
    if (support_node_[s] == node) lose_support(s);
}

void FrameStatics::remove_support(NodeId node, std::size_t edge_support) {
  for (std::size_t s = 0; s < support_node_.size(); ++s)
    if (support_node_[s] == node && support_edge_[s] == static_cast<int>(edge_support)) lose_support(s);
}

void FrameStatics::set_stiffness(MemberId member, double factor) {
  const Place& place = member_place_[index(member)];
  change(place, [&](auto& frame) { frame.set_beam_stiffness_factor(place.local, factor); });
  member_stiffness_[index(member)] = factor;
}

void FrameStatics::drop(const std::vector<NodeId>& nodes) {
  for (NodeId node : nodes) {
    const Place& place = node_place_[index(node)];
    const int local[] = {place.local};
    change(place, [&](auto& frame) { frame.drop_nodes(local); });
  }
}

void FrameStatics::set_loads(MemberId member, std::vector<solver::BeamLoad> loads) {
  member_loads_[index(member)] = std::move(loads);
  write_loads(member);
}

void FrameStatics::set_load(NodeId node, const Vec6& load) {
  node_loads_[index(node)] = load;
  write_load(node);
}

void FrameStatics::forget(int number) {
  Component& component = components_[static_cast<std::size_t>(number)];
  component.changed = false;
  component.gone = true;
}

/// A component's beams and shells as members and membranes.
class FrameStatics::Adapter : public solver::UtilisationWatch {
 public:
  Adapter(const FrameStatics& statics, int component, MemberWatch& watch)
      : statics_(statics), component_(component), watch_(watch) {}
  double beam_utilisation(int beam) override {
    const MemberId member = statics_.members(component_)[static_cast<std::size_t>(beam)];
    statics_.read_end_forces(member);
    return watch_.member_utilisation(member, statics_.end_forces_[index(member)]);
  }
  double shell_utilisation(int shell) override {
    return watch_.membrane_utilisation(membrane(shell),
                                       statics_.state(component_).analysis->shell_corner_forces(shell));
  }
  double beam_growth(int beam, const double (&root)[12]) override {
    return watch_.member_growth(statics_.members(component_)[static_cast<std::size_t>(beam)],
                                Eigen::Map<const solver::Vec12>(root));
  }
  double shell_growth(int shell, const double (&root)[24]) override {
    std::array<Vec6, 4> corners;
    for (std::size_t corner = 0; corner < 4; ++corner) corners[corner] = Eigen::Map<const Vec6>(root + 6 * corner);
    return watch_.membrane_growth(membrane(shell), corners);
  }

 private:
  [[nodiscard]] PanelId membrane(int shell) const {
    return statics_.membranes(component_)[static_cast<std::size_t>(shell)];
  }

  const FrameStatics& statics_;
  int component_;
  MemberWatch& watch_;
};

std::optional<FrameMechanism> FrameStatics::solve(int number) {
  Component& component = components_[static_cast<std::size_t>(number)];
  const solver::ReanalysisAnswer& answer = component.analysis->solve();
  if (answer.stable) {
    component.unwatched = false;
    read_end_forces(number);
    if (second_order_) component.diverged = !displace(number);
    component.changed = false;
    return std::nullopt;
  }
  return told(number, answer);
}

std::optional<FrameMechanism> FrameStatics::solve(int number, MemberWatch& watch) {
  Component& component = components_[static_cast<std::size_t>(number)];
  Adapter adapter(*this, number, watch);
  const solver::ReanalysisAnswer& answer = component.analysis->solve(adapter);
  if (answer.stable) {
    component.partial = component.unwatched = component.analysis->selective_effort().selective;
    // A factor in the warning band serves no selective answers, and nothing was read.
    if (!component.partial && !component.analysis->uses_known()) {
      for (std::size_t beam = 0; beam < members(number).size(); ++beam)
        (void)adapter.beam_utilisation(static_cast<int>(beam));
      for (std::size_t shell = 0; shell < membranes(number).size(); ++shell)
        (void)adapter.shell_utilisation(static_cast<int>(shell));
    }
  }
  return told(number, answer);
}

void FrameStatics::complete(int number, MemberWatch& watch) {
  Component& component = components_[static_cast<std::size_t>(number)];
  if (!component.unwatched) return;
  Adapter adapter(*this, number, watch);
  component.analysis->complete(&adapter);
  component.partial = component.unwatched = false;
}

std::optional<FrameMechanism> FrameStatics::told(int number, const solver::ReanalysisAnswer& answer) {
  Component& component = components_[static_cast<std::size_t>(number)];
  component.changed = false;
  if (answer.stable) return std::nullopt;
  component.changed = true;
  FrameMechanism mechanism;
  mechanism.motion.assign(node_place_.size(), Vec6::Zero());
  for (int local : answer.mechanism.nodes) mechanism.nodes.push_back(nodes(number)[static_cast<std::size_t>(local)]);
  for (std::size_t i = 0; i < answer.mechanism.motion.size(); ++i)
    mechanism.motion[index(nodes(number)[i])] = answer.mechanism.motion[i];
  return mechanism;
}

}  // namespace topple::structure
