#include "standing/statics/frame_numbers.h"

#include <numeric>

namespace topple::structure {

namespace {

/// Component number of each node: connected by members, panels and diaphragms, numbered in order of the least node.
std::vector<int> components_of(const Building& building, const Frame& frame) {
  std::vector<std::size_t> parent(building.nodes.size());
  std::iota(parent.begin(), parent.end(), std::size_t{0});
  const auto find = [&](std::size_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  const auto join = [&](int a, int b) {
    parent[find(static_cast<std::size_t>(a))] = find(static_cast<std::size_t>(b));
  };
  for (const solver::Beam& beam : frame.model.beams) join(beam.node[0], beam.node[1]);
  // Any panel: what lies on it goes to all of its edges.
  for (const Panel& panel : building.panels)
    for (const NodeId node : panel.all_nodes()) join(panel.nodes[0].index, node.index);
  for (const solver::Diaphragm& diaphragm : frame.model.diaphragms)
    for (int node : diaphragm.nodes) join(diaphragm.nodes.front(), node);
  std::vector<int> number(parent.size(), -1), answer(parent.size());
  int count = 0;
  for (std::size_t n = 0; n < parent.size(); ++n) {
    int& component = number[find(n)];
    if (component < 0) component = count++;
    answer[n] = component;
  }
  return answer;
}

}  // namespace

FrameNumbers::FrameNumbers(const Building& building, const Frame& frame, std::vector<solver::FrameModel>& models)
    : patch_(building.panels.size(), 0) {
  const std::vector<int> number = components_of(building, frame);
  const auto local = [&](int node) { return node_place_[static_cast<std::size_t>(node)].local; };
  const auto component = [&](int node) { return static_cast<std::size_t>(number[static_cast<std::size_t>(node)]); };
  for (std::size_t n = 0; n < building.nodes.size(); ++n) {
    const auto c = component(static_cast<int>(n));
    if (c == models.size()) {
      models.emplace_back();
      parts_.emplace_back();
    }
    node_place_.push_back({static_cast<int>(c), static_cast<int>(models[c].nodes.size())});
    models[c].nodes.push_back(frame.model.nodes[n]);
    parts_[c].nodes.push_back(NodeId(n));
  }
  for (std::size_t m = 0; m < building.members.size(); ++m) {
    solver::Beam beam = frame.model.beams[m];
    const auto c = component(beam.node[0]);
    beam.node = {local(beam.node[0]), local(beam.node[1])};
    member_place_.push_back({static_cast<int>(c), static_cast<int>(models[c].beams.size())});
    models[c].beams.push_back(beam);
    parts_[c].members.push_back(MemberId(m));
  }
  number_panels(building, frame, models);
  number_supports(building, frame, models);
  for (solver::Diaphragm diaphragm : frame.model.diaphragms) {
    const auto c = component(diaphragm.nodes.front());
    for (int& node : diaphragm.nodes) node = local(node);
    models[c].diaphragms.push_back(std::move(diaphragm));
  }
}

/// Membranes as the frame has them; a shell panel as one element between its nodes, with the stiffness that its
/// superelement will give it.
void FrameNumbers::number_panels(const Building& building, const Frame& frame,
                                 std::vector<solver::FrameModel>& models) {
  const auto local = [&](int node) { return node_place_[static_cast<std::size_t>(node)].local; };
  const auto component = [&](int node) {
    return static_cast<std::size_t>(node_place_[static_cast<std::size_t>(node)].component);
  };
  panel_place_.resize(building.panels.size());
  for (std::size_t p = 0; p < building.panels.size(); ++p) {
    if (building.panels[p].model == PanelModel::shell) {
      solver::Patch patch;
      for (const NodeId node : building.panels[p].all_nodes()) patch.node.push_back(local(node.index));
      const auto size = static_cast<Eigen::Index>(6 * patch.node.size());
      patch.stiffness = Eigen::MatrixXd::Zero(size, size);
      patch_[p] = 1;
      const auto c = component(building.panels[p].nodes[0].index);
      panel_place_[p] = {static_cast<int>(c), static_cast<int>(models[c].patches.size())};
      models[c].patches.push_back(std::move(patch));
      parts_[c].shells.push_back(PanelId(p));
      continue;
    }
    if (frame.shell_of_panel[p] < 0) continue;
    solver::Shell shell = frame.model.shells[static_cast<std::size_t>(frame.shell_of_panel[p])];
    const auto c = component(shell.node[0]);
    for (int& node : shell.node) node = local(node);
    panel_place_[p] = {static_cast<int>(c), static_cast<int>(models[c].shells.size())};
    models[c].shells.push_back(shell);
    parts_[c].membranes.push_back(PanelId(p));
  }
}

void FrameNumbers::number_supports(const Building& building, const Frame& frame,
                                   std::vector<solver::FrameModel>& models) {
  const auto local = [&](int node) { return node_place_[static_cast<std::size_t>(node)].local; };
  const auto component = [&](int node) {
    return static_cast<std::size_t>(node_place_[static_cast<std::size_t>(node)].component);
  };
  std::vector<int> edge_of(frame.model.supports.size(), -1);
  for (std::size_t e = 0; e < frame.edge_supports.size(); ++e)
    for (const int s : frame.edge_supports[e]) edge_of[static_cast<std::size_t>(s)] = static_cast<int>(e);
  for (std::size_t s = 0; s < frame.model.supports.size(); ++s) {
    solver::Support support = frame.model.supports[s];
    if (static_cast<std::size_t>(support.node) >= building.nodes.size()) continue;  // inside a superelement
    support_edge_.push_back(edge_of[s]);
    const auto c = component(support.node);
    support_node_.push_back(NodeId(static_cast<std::size_t>(support.node)));
    support.node = local(support.node);
    support_place_.push_back({static_cast<int>(c), static_cast<int>(models[c].supports.size())});
    models[c].supports.push_back(support);
  }
}

solver::LoadSet FrameNumbers::local(const ResponseLoads& loads) const {
  solver::LoadSet set;
  for (const auto& [node, load] : loads.nodes) set.nodes.push_back({node_place_[index(node)].local, load});
  for (const auto& [member, load] : loads.members) {
    set.beams.push_back(load);
    set.beams.back().beam = member_place_[index(member)].local;
  }
  return set;
}

}  // namespace topple::structure
