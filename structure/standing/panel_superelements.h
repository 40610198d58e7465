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
  explicit PanelSuperelements(const Building& building)
      : building_(building), of_panel_(building.panels.size()), copied_(building.panels.size(), 0) {
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
    Whole& whole = whole_[shape(panel)];
    if (!whole.mesh) whole = {panel, std::make_unique<PanelSuperelement>(building_, panel, operators_)};
  }
  PanelSuperelement& make(PanelId panel) {
    auto& own = of_panel_[index_of(panel)];
    if (own) return *own;
    const auto like = building_[panel].openings.empty() ? whole_.find(shape(panel)) : whole_.end();
    return like == whole_.end() ? make_alone(panel) : make_like(panel, *like->second.mesh);
  }

  template <class Archive>
  void save(Archive& archive) const {
    const auto& [building, operators, of_panel, copied, whole] = *this;
    archive(whole.size());
    for (const auto& [shape, one] : whole) archive(one.of);
    for (std::size_t p = 0; p < of_panel.size(); ++p) {
      archive(of_panel[p] != nullptr, copied[p]);
      if (of_panel[p]) archive(*of_panel[p]);
    }
  }
  /// All come from what their panels are; what happened to them since is theirs.
  template <class Archive>
  void load(Archive& archive) {
    std::size_t count = 0;
    archive(count);
    for (std::size_t i = 0; i < count; ++i) {
      PanelId of;
      archive(of);
      Whole& whole = whole_[shape(of)];
      if (whole.of != of) whole = {of, std::make_unique<PanelSuperelement>(building_, of, operators_)};
    }
    for (std::size_t p = 0; p < of_panel_.size(); ++p) {
      bool is_there = false;
      char is_copied = 0;
      archive(is_there, is_copied);
      if (!is_there) continue;
      const PanelId panel(p);
      if (!of_panel_[p]) is_copied != 0 ? make_like(panel, *whole_.at(shape(panel)).mesh) : make_alone(panel);
      archive(*of_panel_[p]);
    }
  }

 private:
  PanelSuperelement& make_alone(PanelId panel) {
    return *(of_panel_[index_of(panel)] = std::make_unique<PanelSuperelement>(building_, panel, operators_));
  }
  PanelSuperelement& make_like(PanelId panel, const PanelSuperelement& whole) {
    copied_[index_of(panel)] = 1;
    return *(of_panel_[index_of(panel)] = std::make_unique<PanelSuperelement>(whole, building_, panel));
  }
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
  std::vector<char> copied_;  ///< per panel: its own is a copy of the whole one of its shape
  struct Whole {
    PanelId of;
    std::unique_ptr<PanelSuperelement> mesh;
  };
  std::map<Shape, Whole> whole_;  ///< membranes without openings
};

}  // namespace topple::structure
