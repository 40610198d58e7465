#pragma once
// What panels share along their edges: an edge is cut into segments by the nodes of the model on it, and panels with
// the same segment share the mesh there.
#include <array>
#include <utility>
#include <vector>

#include "mesh/panel_surface.h"
#include "model/index_of.h"

namespace topple::structure {

struct EdgeNode {
  double at;  ///< along the edge, 0 to 1
  int node;   ///< of the building
};

/// Part of an edge between two neighbouring nodes of the model, the lesser node first.
using EdgeSegment = std::pair<int, int>;

struct EdgePlace {
  EdgeSegment segment;
  double at;  ///< from the segment's first node to its second, 0 to 1
};

/// Of the panels of model shell. A node is on an edge when one comes to it from an end of the edge along members and
/// panel edges that lie on it. What merely lies at the same place is not joined.
class PanelEdges {
 public:
  explicit PanelEdges(const Building& building);

  /// In order, both ends included; empty for other panels.
  [[nodiscard]] const std::vector<EdgeNode>& nodes(PanelId panel, std::size_t edge) const {
    return nodes_[4 * index_of(panel) + edge];
  }
  /// The segment that holds a place of the edge.
  [[nodiscard]] EdgePlace position(PanelId panel, std::size_t edge, double along) const;
  /// The other way round; `segment` must be one of the edge's.
  [[nodiscard]] double along(PanelId panel, std::size_t edge, const EdgePlace& place) const;

 private:
  std::vector<std::vector<EdgeNode>> nodes_;
};

}  // namespace topple::structure
