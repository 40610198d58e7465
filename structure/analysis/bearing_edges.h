#pragma once
// Which edges of shell panels something lies along: supports, members, other shells. The others are free.
#include <array>
#include <map>
#include <utility>
#include <vector>

#include "topple/structure/frame.h"

namespace topple::structure {

class BearingEdges {
 public:
  /// All must outlive this.
  BearingEdges(const Building& building, const Frame& frame, const EdgeMembers& members);

  [[nodiscard]] std::array<bool, 4> of(PanelId shell) const;

 private:
  [[nodiscard]] bool bears(PanelId shell, int edge) const;

  const Building& building_;
  const Frame& frame_;
  const EdgeMembers& members_;
  std::vector<int> panels_at_node_;             ///< per node of the frame: shells with an edge there
  std::map<std::pair<int, int>, int> between_;  ///< shells with an edge between two nodes, the lesser first
  std::vector<std::array<bool, 4>> supported_;  ///< per panel
};

}  // namespace topple::structure
