#pragma once
// The superelements of a standing frame's panels: of its shells and of membranes with
// openings from the start, of other membranes once they are broken.
#include <memory>

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
    for (std::size_t p = 0; p < building.panels.size(); ++p)
      if (building.panels[p].model == PanelModel::shell)
        of_panel_[p] = std::make_unique<PanelSuperelement>(building, frame, PanelId(p));
  }

  /// Null for a panel that is one element, or none.
  [[nodiscard]] PanelSuperelement* of(PanelId panel) const {
    return of_panel_[static_cast<std::size_t>(panel.index)].get();
  }
  PanelSuperelement& make(PanelId panel) {
    auto& own = of_panel_[static_cast<std::size_t>(panel.index)];
    if (!own) own = std::make_unique<PanelSuperelement>(building_, panel);
    return *own;
  }

 private:
  const Building& building_;
  std::vector<std::unique_ptr<PanelSuperelement>> of_panel_;
};

}  // namespace topple::structure
