#pragma once
// The superelements of a standing frame's panels: of its shells and of membranes with
// openings from the start, of other membranes once they are broken.
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <stdexcept>

#include "model/index_of.h"
#include "standing/panel_superelement.h"

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
  [[nodiscard]] PanelSuperelement* of(PanelId panel) const { return of_panel_[index_of(panel)].get(); }
  /// Works out the superelement of a whole membrane of this shape: all that is left to do when one of them breaks is
  /// what its hole changes.
  void add(PanelId panel) {
    if (of(panel)) return;
    auto& whole = whole_[shape(panel)];
    if (!whole) whole = std::make_unique<PanelSuperelement>(building_, panel, operators_);
  }
  PanelSuperelement& make(PanelId panel) {
    auto& own = of_panel_[index_of(panel)];
    if (own) return *own;
    const auto like = building_[panel].openings.empty() ? whole_.find(shape(panel)) : whole_.end();
    own = like == whole_.end() ? std::make_unique<PanelSuperelement>(building_, panel, operators_)
                               : std::make_unique<PanelSuperelement>(*like->second, building_, panel);
    return *own;
  }

 private:
  /// Material, thickness, edges and diagonals, to a nanometre.
  using Shape = std::array<std::int64_t, 8>;
  [[nodiscard]] Shape shape(PanelId panel) const {
    const auto rounded = [](double length) { return std::llround(1e9 * length); };
    const Panel& own = building_[panel];
    const auto apart = [&](std::size_t m, std::size_t n) {
      return rounded((building_[own.nodes[n % 4]].position - building_[own.nodes[m]].position).norm());
    };
    Shape shape{own.material.index, rounded(own.thickness)};
    for (std::size_t n = 0; n < 4; ++n) shape[2 + n] = apart(n, n + 1);
    shape[6] = apart(0, 2);
    shape[7] = apart(1, 3);
    return shape;
  }
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
  std::map<Shape, std::unique_ptr<PanelSuperelement>> whole_;  ///< membranes without openings
};

}  // namespace topple::structure
