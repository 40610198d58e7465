#include "failure/segmentation.h"

#include <algorithm>

#include "mesh/shell_edges.h"
#include "model/index_of.h"

namespace topple::structure {

Segmentation::Segmentation(const Building& building)
    : nodes_(static_cast<int>(building.nodes.size())), members_(static_cast<int>(building.members.size())) {
  shell_vertex_.assign(building.panels.size(), -1);
  for (std::size_t p = 0; p < building.panels.size(); ++p) {
    if (building.panels[p].model != PanelModel::shell) continue;
    shell_vertex_[p] = nodes_ + members_ + static_cast<int>(shell_panels_.size());
    shell_panels_.push_back(PanelId(p));
  }
  joint_holds_.assign(building.joints.size(), 1);
  for (std::size_t j = 0; j < building.joints.size(); ++j) {
    const Joint& joint = building.joints[j];
    first_edge_of_joint_.push_back(static_cast<int>(edges_.size()));
    if (joint.member.valid()) {
      const NodeId node = building[joint.member].nodes[static_cast<std::size_t>(joint.end)];
      edges_.push_back({node.index, vertex(joint.member), true});
    } else if (const int shell = shell_vertex_[index_of(joint.panel)]; shell >= 0) {
      for (const NodeId node : nodes_of_edge(building, joint.panel, joint.end))
        edges_.push_back({node.index, shell, true});
    }
  }
  first_edge_of_joint_.push_back(static_cast<int>(edges_.size()));
  supported_.assign(static_cast<std::size_t>(nodes_ + members_) + shell_panels_.size(), 0);
  for (const NodeSupport& support : building.supports)
    if ((support.stiffness.array() > 0).any()) supported_[index_of(support.node)] = 1;
  for (const EdgeSupport& support : building.edge_supports)
    if (const int shell = shell_vertex_[index_of(support.panel)]; shell >= 0 && (support.stiffness.array() > 0).any())
      ++supported_[static_cast<std::size_t>(shell)];
  build_adjacency();
  label_all();
}

void Segmentation::build_adjacency() {
  const std::size_t vertices = static_cast<std::size_t>(nodes_ + members_) + shell_panels_.size();
  degree_.assign(vertices, 0);
  for (const Edge& edge : edges_) {
    ++degree_[static_cast<std::size_t>(edge.first)];
    ++degree_[static_cast<std::size_t>(edge.second)];
  }
  first_incident_.assign(vertices + 1, 0);
  for (std::size_t v = 0; v < vertices; ++v) first_incident_[v + 1] = first_incident_[v] + degree_[v];
  incident_.resize(2 * edges_.size());
  std::vector<int> fill(first_incident_.begin(), first_incident_.end() - 1);
  for (std::size_t e = 0; e < edges_.size(); ++e)
    for (int v : {edges_[e].first, edges_[e].second})
      incident_[static_cast<std::size_t>(fill[static_cast<std::size_t>(v)]++)] = static_cast<int>(e);
}

void Segmentation::label_all() {
  mark_.assign(degree_.size(), 0);
  label_.assign(degree_.size(), -1);
  for (std::size_t v = 0; v < label_.size(); ++v) {
    if (label_[v] >= 0) continue;
    const int label = labels();
    Segment& segment = segments_.emplace_back();
    segment.a_vertex = static_cast<int>(v);
    for (int w : walk(static_cast<int>(v))) {
      label_[static_cast<std::size_t>(w)] = label;
      segment.supports += supported_[static_cast<std::size_t>(w)];
    }
    if (segment.supports == 0) lost_support_.push_back(label);
  }
}

int Segmentation::label(PanelId panel) const {
  const int v = shell_vertex_[index_of(panel)];
  return v < 0 ? -1 : label_[static_cast<std::size_t>(v)];
}

void Segmentation::break_joint(JointId joint) {
  const auto j = index_of(joint);
  if (!joint_holds_[j]) return;
  const std::size_t first_of_panels = 2 * static_cast<std::size_t>(members_);
  if (j >= first_of_panels && shell_vertex_[(j - first_of_panels) / 4] < 0) return;
  joint_holds_[j] = 0;
  for (int e = first_edge_of_joint_[j]; e < first_edge_of_joint_[j + 1]; ++e)
    if (edges_[static_cast<std::size_t>(e)].holds) cut(e);
}

void Segmentation::detach(PanelId shell, NodeId node) {
  for (std::size_t edge = 0; edge < 4; ++edge) {
    const std::size_t j = 2 * static_cast<std::size_t>(members_) + 4 * index_of(shell) + edge;
    for (int e = first_edge_of_joint_[j]; e < first_edge_of_joint_[j + 1]; ++e)
      if (const Edge& own = edges_[static_cast<std::size_t>(e)]; own.holds && own.first == node.index) cut(e);
  }
}

void Segmentation::remove(MemberId member) {
  break_joint(JointId(static_cast<std::size_t>(2 * member.index)));
  break_joint(JointId(static_cast<std::size_t>(2 * member.index + 1)));
  remove_vertex(vertex(member));
}

void Segmentation::remove(PanelId panel) {
  const int v = shell_vertex_[index_of(panel)];
  if (v < 0) return;
  for (int edge = 0; edge < 4; ++edge)
    break_joint(JointId(static_cast<std::size_t>(2 * members_ + 4 * panel.index + edge)));
  remove_vertex(v);
}

void Segmentation::remove_support(NodeId node) { lose_support(node.index); }

void Segmentation::remove_support(PanelId panel) {
  if (const int v = shell_vertex_[index_of(panel)]; v >= 0) lose_support(v);
}

void Segmentation::lose_support(int vertex_index) {
  const auto v = static_cast<std::size_t>(vertex_index);
  if (supported_[v] == 0) return;
  --supported_[v];
  if (label_[v] < 0) return;
  if (--segments_[static_cast<std::size_t>(label_[v])].supports == 0) lost_support_.push_back(label_[v]);
}

/// A vertex whose joints are all broken is a segment of its own, which ends here.
void Segmentation::remove_vertex(int vertex_index) {
  int& label = label_[static_cast<std::size_t>(vertex_index)];
  if (label < 0) return;
  segments_[static_cast<std::size_t>(label)].gone = true;
  label = -1;
}

/// Breaks one edge and finds out whether its two sides still hang together.
void Segmentation::cut(int edge_index) {
  Edge& edge = edges_[static_cast<std::size_t>(edge_index)];
  edge.holds = false;
  --degree_[static_cast<std::size_t>(edge.first)];
  --degree_[static_cast<std::size_t>(edge.second)];
  const int old_label = label_[static_cast<std::size_t>(edge.first)];
  if (old_label < 0) return;  // in a part that left: nobody asks any more
  ++searches_;
  stamp_ += 2;
  const std::uint64_t first_mark = stamp_, second_mark = stamp_ + 1;
  std::vector<int> first{edge.first}, second{edge.second};
  mark_[static_cast<std::size_t>(edge.first)] = first_mark;
  mark_[static_cast<std::size_t>(edge.second)] = second_mark;
  std::size_t first_next = 0, second_next = 0;
  while (true) {
    // The member's side goes first: it is exhausted at once when its other end is broken.
    if (second_next == second.size()) return split_off(second, old_label, edge.first);
    if (step(second, second_next, second_mark, first_mark)) return;
    if (first_next == first.size()) return split_off(first, old_label, edge.second);
    if (step(first, first_next, first_mark, second_mark)) return;
  }
}

/// Visits the neighbours of the next vertex in the queue; true when the other search was met.
bool Segmentation::step(std::vector<int>& queue, std::size_t& next, std::uint64_t mine, std::uint64_t theirs) {
  const int v = queue[next++];
  ++vertices_searched_;
  for (int i = first_incident_[static_cast<std::size_t>(v)]; i < first_incident_[static_cast<std::size_t>(v) + 1];
       ++i) {
    const Edge& edge = edges_[static_cast<std::size_t>(incident_[static_cast<std::size_t>(i)])];
    if (!edge.holds) continue;
    const int w = edge.first == v ? edge.second : edge.first;
    std::uint64_t& mark = mark_[static_cast<std::size_t>(w)];
    if (mark == theirs) return true;
    if (mark == mine) continue;
    mark = mine;
    queue.push_back(w);
  }
  return false;
}

void Segmentation::split_off(const std::vector<int>& side, int old_label, int stays) {
  const int label = labels();
  Segment& fresh = segments_.emplace_back();
  fresh.a_vertex = side.front();
  for (int v : side) {
    label_[static_cast<std::size_t>(v)] = label;
    fresh.supports += supported_[static_cast<std::size_t>(v)];
  }
  Segment& old = segments_[static_cast<std::size_t>(old_label)];
  old.a_vertex = stays;
  const bool had_supports = old.supports > 0;
  old.supports -= fresh.supports;
  if (fresh.supports == 0) lost_support_.push_back(label);
  if (had_supports && old.supports == 0) lost_support_.push_back(old_label);
}

std::vector<int> Segmentation::walk(int from) {
  stamp_ += 2;
  std::vector<int> queue{from};
  mark_[static_cast<std::size_t>(from)] = stamp_;
  for (std::size_t next = 0; next < queue.size();) step(queue, next, stamp_, stamp_ + 1);
  return queue;
}

std::vector<Segmentation::Part> Segmentation::extract_unanchored() {
  std::vector<std::vector<int>> lost;
  for (int label : lost_support_) {
    Segment& segment = segments_[static_cast<std::size_t>(label)];
    if (segment.gone) continue;
    segment.gone = true;
    std::vector<int> vertices = walk(segment.a_vertex);
    for (int v : vertices) label_[static_cast<std::size_t>(v)] = -1;
    std::sort(vertices.begin(), vertices.end());
    lost.push_back(std::move(vertices));
  }
  lost_support_.clear();
  std::sort(lost.begin(), lost.end(), [](const auto& a, const auto& b) { return a.front() < b.front(); });
  std::vector<Part> parts;
  parts.reserve(lost.size());
  for (const auto& vertices : lost) parts.push_back(part_of(vertices));
  return parts;
}

Segmentation::Part Segmentation::part_of(const std::vector<int>& vertices) const {
  Part part;
  for (int v : vertices) {
    const auto index = static_cast<std::size_t>(v);
    const auto nodes = static_cast<std::size_t>(nodes_), members = static_cast<std::size_t>(members_);
    if (v < nodes_)
      part.nodes.push_back(NodeId(index));
    else if (index < nodes + members)
      part.members.push_back(MemberId(index - nodes));
    else
      part.panels.push_back(shell_panels_[index - nodes - members]);
  }
  return part;
}

}  // namespace topple::structure
