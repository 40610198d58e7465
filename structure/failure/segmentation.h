#pragma once
// Which parts of a building hang together, and which still reach a support. Vertices are nodes, members and shell
// panels, edges are intact joints. Membrane and cladding panels are no vertices: they belong to what carries them and
// never join.
//
// Breaking a joint searches from its two sides in turn and stops as soon as one side is exhausted or both have met, so
// that the cost is that of the smaller side (Even and Shiloach 1981, for one deletion).
#include <cstdint>
#include <vector>

#include "model/index_of.h"
#include "topple/structure/building.h"

namespace topple::structure {

class Segmentation {
 public:
  /// A connected part without a support.
  struct Part {
    std::vector<NodeId> nodes;  ///< each list in order of id
    std::vector<MemberId> members;
    std::vector<PanelId> panels;  ///< shell panels
  };

  explicit Segmentation(const Building& building);

  /// No effect on a joint that is broken already or belongs to a membrane or cladding panel.
  void break_joint(JointId joint);
  /// Breaks the part's joints and takes it out of the graph.
  void remove(MemberId member);
  void remove(PanelId panel);
  void remove_support(NodeId node);
  /// A supported edge of a shell panel holds it no more.
  void remove_support(PanelId panel);
  /// Nothing of a shell panel is left at one of its nodes.
  void detach(PanelId shell, NodeId node);

  /// Parts that have lost their last support since the last call, in order of their least vertex; they leave the graph.
  [[nodiscard]] std::vector<Part> extract_unanchored();

  [[nodiscard]] bool holds(JointId joint) const { return joint_holds_[index_of(joint)] != 0; }
  /// Label of the segment that holds a vertex, -1 when it left. Labels are small integers, never used again.
  [[nodiscard]] int label(NodeId node) const { return label_[index_of(node)]; }
  [[nodiscard]] int label(MemberId member) const { return label_[static_cast<std::size_t>(vertex(member))]; }
  /// Of a shell panel; -1 for other panels.
  [[nodiscard]] int label(PanelId panel) const;
  /// One above the largest label.
  [[nodiscard]] int labels() const { return static_cast<int>(segments_.size()); }
  [[nodiscard]] bool anchored(int label) const { return segments_[static_cast<std::size_t>(label)].supports > 0; }
  /// Joints that still hold a node to its members and shell panels.
  [[nodiscard]] int degree(NodeId node) const { return degree_[index_of(node)]; }

  /// Joint breaks that were searched, and vertices that the searches looked at.
  [[nodiscard]] std::uint64_t searches() const { return searches_; }
  [[nodiscard]] std::uint64_t vertices_searched() const { return vertices_searched_; }

  template <class Archive>
  void serialize(Archive& archive) {
    auto& [nodes, members, shell_vertex, shell_panels, edges, first_edge_of_joint, joint_holds, first_incident,
           incident, label, degree, supported, segments, lost_support, mark, stamp, searches, vertices_searched] =
        *this;
    // The graph follows from the building. No search looks at marks of one before.
    archive(edges, joint_holds, label, degree, supported, segments, lost_support, searches, vertices_searched);
  }

 private:
  struct Edge {
    int first, second;
    bool holds;
  };
  struct Segment {
    int supports = 0;
    int a_vertex = -1;  ///< one of its vertices, to walk from
    bool gone = false;
  };
  template <class Archive>
  friend void serialize(Archive& archive, Edge& edge) {
    auto& [first, second, holds] = edge;
    archive(holds);  // its vertices follow from the building
  }
  template <class Archive>
  friend void serialize(Archive& archive, Segment& segment) {
    auto& [supports, a_vertex, gone] = segment;
    archive(supports, a_vertex, gone);
  }

  [[nodiscard]] int vertex(MemberId member) const { return nodes_ + member.index; }
  void build_adjacency();
  void label_all();
  void cut(int edge);
  void split_off(const std::vector<int>& side, int old_label, int stays);
  bool step(std::vector<int>& queue, std::size_t& next, std::uint64_t mine, std::uint64_t theirs);
  void remove_vertex(int vertex_index);
  [[nodiscard]] std::vector<int> walk(int from);
  [[nodiscard]] Part part_of(const std::vector<int>& vertices) const;

  int nodes_ = 0, members_ = 0;
  std::vector<int> shell_vertex_;  ///< per panel, -1: not a vertex
  std::vector<PanelId> shell_panels_;
  std::vector<Edge> edges_;
  std::vector<int> first_edge_of_joint_;  ///< per joint and one more
  std::vector<char> joint_holds_;
  std::vector<int> first_incident_, incident_;
  std::vector<int> label_, degree_;
  void lose_support(int vertex);
  std::vector<int> supported_;  ///< per vertex: supports of a node (at most one), supported edges of a shell panel
  std::vector<Segment> segments_;
  std::vector<int> lost_support_;  ///< labels to hand out
  std::vector<std::uint64_t> mark_;
  std::uint64_t stamp_ = 0, searches_ = 0, vertices_searched_ = 0;
};

}  // namespace topple::structure
