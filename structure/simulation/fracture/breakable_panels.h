#pragma once
// Which panels of the building can break, what they bear, and how those are broken that are: standing, or in bodies.
#include <array>
#include <map>
#include <optional>
#include <vector>

#include "model/index_of.h"
#include "simulation/debris/debris.h"
#include "simulation/fracture/broken_panel.h"

namespace topple::structure {

struct BreakablePanel {
  std::optional<fracture::PanelSettings> settings;                        ///< none: it never breaks
  double breaking_speed = unlimited;                                      ///< change of speed that breaks it, m/s
  double tensile_strength = unlimited, compressive_strength = unlimited;  ///< Pa
};

class BreakablePanels {
 public:
  /// Looks up what each panel bears. Throws InputError where a strength is missing. Both must outlive it.
  BreakablePanels(Scene& scene, Debris& debris);
  /// Panels that have openings from the start have the shape of what is there.
  void open();

  [[nodiscard]] const BreakablePanel& of(PanelId panel) const { return panels_[index_of(panel)]; }
  [[nodiscard]] bool can_break(PanelId panel) const { return of(panel).settings.has_value(); }
  [[nodiscard]] bool any() const { return any_; }
  /// The panel that a body consists of, when nothing else belongs to it and it can break.
  [[nodiscard]] PanelId breakable_of(const Body& one) const;

  /// Null while it is whole.
  [[nodiscard]] const BrokenPanel* broken(PanelId panel) const;
  /// The panel as it is broken now, whole at first.
  BrokenPanel& breaking(PanelId panel);
  [[nodiscard]] std::map<PanelId, BrokenPanel>& all_broken() { return broken_; }
  /// Which edges hold a panel that stands. A joint holds an edge where something is there to hold it: of a shell, which
  /// joins at its corners, at supported edges and where members or other shells lie along it, that is not so for every
  /// edge.
  [[nodiscard]] std::array<bool, 4> held(PanelId panel);

  /// What punches it for a body of this radius, N; `along` in the axes of the undeformed building.
  [[nodiscard]] double punching_force(PanelId panel, const Vec3& along, double radius) const;
  /// What bends the panel to that force, and punches it then, J: elastic energy, and the force over half the thickness.
  [[nodiscard]] double punching_energy(PanelId panel, const Vec3& at, const Vec3& along, double radius) const;

  /// What panels bear, and what there is to hold their edges, is the building's.
  template <class Archive>
  void save(Archive& archive) const {
    auto& [scene, debris, panels, any, all_broken, edge_bearers] = *this;
    archive(all_broken.size());
    for (const auto& [panel, broken] : all_broken) archive(panel, broken);
  }
  /// After the debris: a panel is made of the corners of its shape.
  template <class Archive>
  void load(Archive& archive) {
    std::size_t count = 0;
    archive(count);
    for (; count > 0; --count) {
      PanelId panel;
      archive(panel);
      archive(breaking(panel));
    }
  }

 private:
  /// What is there, in the whole building, to hold an edge of a shell: supports, and joints of members and other
  /// shells.
  struct EdgeBearers {
    bool supported = false;
    std::vector<JointId> joints;
  };
  const std::array<EdgeBearers, 4>& bearers(PanelId shell);

  Scene& scene_;
  Debris& debris_;
  std::vector<BreakablePanel> panels_;
  bool any_ = false;
  std::map<PanelId, BrokenPanel> broken_;                       ///< those that are broken in part
  std::map<PanelId, std::array<EdgeBearers, 4>> edge_bearers_;  ///< looked up when first asked for
};

/// A chunk as a body, the panel's `number`-th.
[[nodiscard]] Body chunk_body(const Building& building, PanelId panel, PanelChunk chunk, int number);

}  // namespace topple::structure
