#include "simulation/fracture/breakable_panels.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "loads/placed_load.h"
#include "simulation/debris/debris_settings.h"
#include "topple/structure/error.h"

namespace topple::structure {

namespace {

bool lies_on_edge(const Panel& panel, int edge, NodeId node) {
  const auto e = static_cast<std::size_t>(edge);
  const std::vector<NodeId>& inside = panel.edge_nodes[e];
  return panel.nodes[e] == node || panel.nodes[(e + 1) % 4] == node ||
         std::find(inside.begin(), inside.end(), node) != inside.end();
}

}  // namespace

BreakablePanels::BreakablePanels(Scene& scene, Debris& debris) : scene_(scene), debris_(debris) {
  for (std::size_t i = 0; i < scene_.building.panels.size(); ++i) {
    const Panel& panel = scene_.building.panels[i];
    const Material& material = scene_.building[panel.material];
    const auto& settings = panel.fracture      ? panel.fracture
                           : material.fracture ? material.fracture
                                               : scene_.scenario.fracture;
    BreakablePanel breakable;
    if (settings) {
      if (!material.compressive_strength)
        throw InputError(scene_.building.file + ", materials." + material.name +
                         ".compressive_strength: missing; expected, because panel \"" + panel.name +
                         "\" of this material can break (fracture)");
      breakable.settings = *settings;
      BrokenPanel::expect_fit(scene_.building, panel, *settings);
      any_ = true;
      scene_.frame->expect_fracture(PanelId(i));
      // Every panel has a pattern of its own (splitmix64's increment keeps their seeds far apart).
      breakable.settings->seed = scene_.scenario.seed + (i + 1) * 0x9e3779b97f4a7c15u;
      const double density = material.density > 0
                                 ? material.density
                                 : debris_.masses.of(PanelId(i)).mass / panel_volume(scene_.building, panel);
      // Where it is not given: that of concrete of this compressive strength (EN 1992-1-1, table 3.1).
      breakable.tensile_strength =
          material.tensile_strength.value_or(0.3e6 * std::pow(*material.compressive_strength / 1e6, 2.0 / 3.0));
      breakable.compressive_strength = *material.compressive_strength;
      breakable.breaking_speed = *material.compressive_strength / std::sqrt(material.youngs_modulus * density);
    }
    panels_.push_back(std::move(breakable));
  }
}

void BreakablePanels::open() {
  for (std::size_t p = 0; p < scene_.building.panels.size(); ++p)
    if (!scene_.building.panels[p].openings.empty())
      debris_.shapes.set_broken(PanelId(p), breaking(PanelId(p)).hulls());
}

PanelId BreakablePanels::breakable_of(const Body& one) const {
  if (!one.members.empty() || one.panels.size() != 1) return {};
  const PanelId panel = one.panels.front();
  // A node that carries a point mass of its own cannot go with any one chunk.
  if (std::abs(one.rest.mass - debris_.masses.of(panel).mass) > 1e-12 * one.rest.mass) return {};
  return of(panel).settings ? panel : PanelId();
}

const BrokenPanel* BreakablePanels::broken(PanelId panel) const {
  const auto found = broken_.find(panel);
  return found == broken_.end() ? nullptr : &found->second;
}

BrokenPanel& BreakablePanels::breaking(PanelId panel) {
  if (const auto found = broken_.find(panel); found != broken_.end()) return found->second;
  const auto& settings = of(panel).settings;
  return broken_
      .emplace(panel, BrokenPanel(scene_.building, panel, debris_.masses.of(panel).mass, debris_.shapes.corners(panel),
                                  settings.value_or(fracture::PanelSettings()), held(panel)))
      .first->second;
}

const std::array<BreakablePanels::EdgeBearers, 4>& BreakablePanels::bearers(PanelId shell) {
  const auto [known, made] = edge_bearers_.try_emplace(shell);
  if (!made) return known->second;
  for (int edge = 0; edge < 4; ++edge) {
    EdgeBearers& own = known->second[static_cast<std::size_t>(edge)];
    const auto on_edge = [&](NodeId node) { return lies_on_edge(scene_.building[shell], edge, node); };
    for (const EdgeSupport& support : scene_.building.edge_supports)
      own.supported = own.supported || (support.panel == shell && support.edge == edge);
    for (const NodeSupport& support : scene_.building.supports) own.supported = own.supported || on_edge(support.node);
    for (std::size_t m = 0; m < scene_.building.members.size(); ++m)
      for (int end = 0; end < 2; ++end)
        if (on_edge(scene_.building.members[m].nodes[static_cast<std::size_t>(end)]))
          own.joints.push_back(scene_.building.joint(MemberId(m), end));
    for (std::size_t p = 0; p < scene_.building.panels.size(); ++p) {
      const Panel& other = scene_.building.panels[p];
      if (PanelId(p) == shell || other.model != PanelModel::shell) continue;
      for (int of_other = 0; of_other < 4; ++of_other) {
        const std::vector<NodeId> nodes = other.all_nodes();
        if (std::any_of(nodes.begin(), nodes.end(),
                        [&](NodeId node) { return lies_on_edge(other, of_other, node) && on_edge(node); }))
          own.joints.push_back(scene_.building.joint(PanelId(p), of_other));
      }
    }
  }
  return known->second;
}

std::array<bool, 4> BreakablePanels::held(PanelId panel) {
  const bool shell = scene_.building[panel].model == PanelModel::shell;
  std::array<bool, 4> edges{};
  for (int edge = 0; edge < 4; ++edge) {
    bool& holds = edges[static_cast<std::size_t>(edge)];
    holds = scene_.frame->intact(scene_.building.joint(panel, edge));
    if (!holds || !shell) continue;
    const EdgeBearers& there = bearers(panel)[static_cast<std::size_t>(edge)];
    holds = there.supported || std::any_of(there.joints.begin(), there.joints.end(), [&](JointId joint) {
              const Joint& other = scene_.building[joint];
              return scene_.frame->intact(joint) &&
                     (other.member.valid() ? scene_.frame->stands(other.member) : scene_.frame->stands(other.panel));
            });
  }
  return edges;
}

double BreakablePanels::punching_force(PanelId id, const Vec3& along, double radius) const {
  const Panel& panel = scene_.building[id];
  const BreakablePanel& breakable = of(id);
  if (!breakable.settings || std::abs(panel.axes.row(2).dot(along)) < debris_settings.flattest_punch) return unlimited;
  return breakable.tensile_strength * M_PI * panel.thickness * (2 * radius + panel.thickness);
}

double BreakablePanels::punching_energy(PanelId panel, const Vec3& at, const Vec3& along, double radius) const {
  const double bears = punching_force(panel, along, radius);
  return bears * bears * panel_bending_compliance(scene_.building, panel, at, along) / 2 +
         bears * scene_.building[panel].thickness / 2;
}

Body chunk_body(const Building& building, PanelId panel, PanelChunk chunk, int number) {
  Body piece;
  piece.name = building[panel].name + "#" + std::to_string(number);
  piece.rest = chunk.rest;
  piece.volume = chunk.volume;
  piece.hull = std::move(chunk.hull);
  piece.chunk_of = piece_kind(building[panel].kind);
  piece.mesh = std::move(chunk.mesh);
  for (const Vec3& corner : piece.hull) piece.bounds.add(corner);
  return piece;
}

}  // namespace topple::structure
