#pragma once
// What the edge joints of a standing frame's panels bear, kept: what a panel hands to its edges changes only with its
// bearings and loads, the traction of a membrane only with its corner forces.
#include <array>
#include <vector>

#include "failure/panel_demand.h"

namespace topple::structure {

class EdgeDemands {
 public:
  /// All must outlive this.
  EdgeDemands(const Building& building, const PanelBearings& bearings, const FrameLoads& loads);

  /// Of a membrane, as solved now.
  void set_corner_forces(PanelId membrane, const std::array<Vec6, 4>& forces);
  /// Something that the panel's edges bear may be other than when they were read last.
  [[nodiscard]] bool changed(PanelId panel) const;
  /// As panel_edge_demands().
  [[nodiscard]] const std::array<Vec6, 4>& read(PanelId panel);

  template <class Archive>
  void serialize(Archive& archive) {
    auto& [bearings, loads, building, edges, states] = *this;
    archive(states);  // where edges are follows from the building
  }

 private:
  struct State {
    int version = -1;  ///< of the loads on the edges, when they were read
    bool membrane = false, corners_read = false;
    std::array<Vec6, 4> corner_forces{Vec6::Zero(), Vec6::Zero(), Vec6::Zero(), Vec6::Zero()};
    std::array<Vec6, 4> handed{}, demands{};
  };
  template <class Archive>
  friend void serialize(Archive& archive, State& of_panel) {
    auto& [version, membrane, corners_read, corner_forces, handed, demands] = of_panel;
    archive(version, membrane, corners_read, corner_forces, handed, demands);
  }
  const PanelBearings& bearings_;
  const FrameLoads& loads_;
  const Building& building_;
  std::vector<PanelEdgeAxes> edges_;
  std::vector<State> states_;
};

}  // namespace topple::structure
