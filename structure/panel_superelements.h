#pragma once
// The superelements of a standing frame's panels: of its shells and of membranes with
// openings from the start, of other membranes once they are broken.
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <set>
#include <stdexcept>

#include "panel_superelement.h"

namespace topple::structure {

class PanelSuperelements {
 public:
  explicit PanelSuperelements(const Building& building) : building_(building), of_panel_(building.panels.size()) {
    for (std::size_t p = 0; p < building.panels.size(); ++p)
      if (building.panels[p].model == PanelModel::membrane && !building.panels[p].openings.empty()) make(PanelId(p));
    bool any = false;
    for (const Panel& panel : building.panels) any = any || panel.model == PanelModel::shell;
    if (!any) return;
    const Frame frame = make_frame(building);
    refuse_unready(building, frame);
    for (std::size_t p = 0; p < building.panels.size(); ++p)
      if (building.panels[p].model == PanelModel::shell)
        of_panel_[p] = std::make_unique<PanelSuperelement>(building, frame, PanelId(p), operators_);
  }

  /// Null for a panel that is one element, or none.
  [[nodiscard]] PanelSuperelement* of(PanelId panel) const {
    return of_panel_[static_cast<std::size_t>(panel.index)].get();
  }
  /// Finds the operators of a whole membrane's elements, which is most of what the first break of its shape would take.
  void know(PanelId panel) {
    const Panel& own = building_[panel];
    const auto corner = [&](std::size_t n) { return building_[own.nodes[n]].position; };
    std::array<std::int64_t, 8> shape{own.material.index, std::llround(1e9 * own.thickness)};
    for (std::size_t n = 0; n < 4; ++n) shape[2 + n] = std::llround(1e6 * (corner((n + 1) % 4) - corner(n)).norm());
    shape[6] = std::llround(1e6 * (corner(2) - corner(0)).norm());
    shape[7] = std::llround(1e6 * (corner(3) - corner(1)).norm());
    if (!of(panel) && known_.insert(shape).second) (void)PanelSuperelement(building_, panel, operators_);
  }
  PanelSuperelement& make(PanelId panel) {
    auto& own = of_panel_[static_cast<std::size_t>(panel.index)];
    if (!own) own = std::make_unique<PanelSuperelement>(building_, panel, operators_);
    return *own;
  }

 private:
  /// Members along edges that are not divided at the mesh would be left out.
  static void refuse_unready(const Building& building, const Frame& frame) {
    std::vector<std::size_t> panel_at(frame.model.nodes.size(), building.panels.size());
    for (std::size_t p = 0; p < building.panels.size(); ++p)
      for (const auto& edge : frame.meshes[p].edge_nodes)
        for (const int node : edge) {
          std::size_t& other = panel_at[static_cast<std::size_t>(node)];
          if (static_cast<std::size_t>(node) >= building.nodes.size() && other < building.panels.size() && other != p)
            throw std::invalid_argument("shells that share edges stand once the building is readied: join_shells()");
          other = p;
        }
    for (const auto& pieces : frame.pieces)
      if (!pieces.empty())
        throw std::invalid_argument("members along shells stand once the building is readied: join_shells()");
  }

  const Building& building_;
  std::shared_ptr<ShellOperators> operators_ = std::make_shared<ShellOperators>();
  std::vector<std::unique_ptr<PanelSuperelement>> of_panel_;
  std::set<std::array<std::int64_t, 8>> known_;  ///< shapes: material, thickness, edges and diagonals
};

}  // namespace topple::structure
