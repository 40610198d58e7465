#include "mesh/usual_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

#include "model/index_of.h"
#include "topple/structure/error.h"

namespace topple::structure {

namespace {

constexpr int elements_of_span = 12, least_elements = 2, most_elements = 64;
constexpr double degree = std::numbers::pi / 180, most_turn = 2.5 * degree, widest_fold = 30 * degree;
constexpr double square_enough = 0.95;             // sine of a corner: 18 degrees off square
constexpr std::int64_t most_mesh_nodes = 500'000;  // their equations and factor take some 10 GB

/// Where a walk over panels arrives.
struct Neighbour {
  std::size_t panel = 0, edge = 0;
  double fold = 0;  ///< angle between the normals
};

class UsualMeshes {
 public:
  explicit UsualMeshes(const Building& building)
      : b_(building),
        held_(building.nodes.size(), 0),
        has_member_(building.nodes.size(), 0),
        edges_held_(building.panels.size()),
        shells_at_(building.nodes.size()) {
    for (const Member& member : b_.members)
      for (const NodeId node : member.nodes) held_[index_of(node)] = has_member_[index_of(node)] = 1;
    for (const NodeSupport& support : b_.supports) held_[index_of(support.node)] = 1;
    for (const Diaphragm& diaphragm : b_.diaphragms)
      for (const NodeId node : diaphragm.nodes) held_[index_of(node)] = 1;
    for (const EdgeSupport& support : b_.edge_supports)
      edges_held_[index_of(support.panel)][static_cast<std::size_t>(support.edge)] = true;
    for (const Joint& joint : b_.joints)
      if (joint.panel.valid() && !(joint.stiffness.array() == unlimited).all())
        edges_held_[index_of(joint.panel)][static_cast<std::size_t>(joint.end)] = true;
    for (std::size_t p = 0; p < b_.panels.size(); ++p)
      if (b_.panels[p].model != PanelModel::cladding)
        for (std::size_t edge = 0; edge < 4; ++edge) {
          at_[key(p, edge)].push_back({p, edge, 0});
          if (b_.panels[p].model == PanelModel::shell) shells_at_[index_of(node(p, edge))].push_back({p, edge});
        }
  }

  [[nodiscard]] std::array<int, 2> mesh(std::size_t panel) const {
    const std::array<Span, 2> spans{span(panel, 1), span(panel, 2)};
    const double size = std::min(spans[0].length, spans[1].length) / (elements_of_span * refinement(panel));
    std::array<int, 2> mesh{};
    for (std::size_t way = 0; way < 2; ++way) {
      constexpr double rounding = 1e-9;
      const double by_size = std::ceil(side(panel, way) / size - rounding);
      const double by_turn = std::ceil(spans[way].turn / most_turn - rounding);
      mesh[way] =
          static_cast<int>(std::clamp(std::max(by_size, by_turn), double{least_elements}, double{most_elements}));
    }
    return mesh;
  }

  [[nodiscard]] std::vector<ShellFold> folds(double least) const {
    std::vector<ShellFold> found;
    for (std::size_t p = 0; p < b_.panels.size(); ++p) {
      if (b_.panels[p].model != PanelModel::shell) continue;
      for (std::size_t edge = 0; edge < 4; ++edge)
        if (const std::optional<Neighbour> next = beyond(p, edge); next && next->panel > p && next->fold > least)
          found.push_back({PanelId(p), PanelId(next->panel), next->fold});
    }
    return found;
  }

 private:
  struct Span {
    double length = 0;
    double turn = 0;  ///< of this panel: what its folds leave to it
  };

  [[nodiscard]] NodeId node(std::size_t panel, std::size_t corner) const { return b_.panels[panel].nodes[corner % 4]; }
  [[nodiscard]] std::pair<int, int> key(std::size_t panel, std::size_t edge) const {
    return std::minmax(node(panel, edge).index, node(panel, edge + 1).index);
  }
  /// Along local x (way 0: edges 0 and 2) or y: the longer of both edges.
  [[nodiscard]] double side(std::size_t panel, std::size_t way) const {
    const auto edge = [&](std::size_t e) {
      return (b_[node(panel, e + 1)].position - b_[node(panel, e)].position).norm();
    };
    return std::max(edge(way), edge(way + 2));
  }

  [[nodiscard]] double angle(std::size_t panel, std::size_t corner) const {
    const Vec3 at = b_[node(panel, corner)].position;
    const Vec3 next = b_[node(panel, corner + 1)].position - at, last = b_[node(panel, corner + 3)].position - at;
    return std::atan2(next.cross(last).norm(), next.dot(last));
  }

  /// True where shells of about the panel's plane go round a corner of it by more than half a turn and leave a gap, as
  /// at the inner corner of an L. Without a member there: beams along the edges of slabs take what is singular.
  [[nodiscard]] bool inner_corner(std::size_t panel, std::size_t corner) const {
    constexpr double margin = 10 * degree;
    const std::size_t at = index_of(node(panel, corner));
    if (has_member_[at] != 0) return false;
    double round = 0;
    for (const auto& [other, own_corner] : shells_at_[at])
      if (std::abs(b_.panels[panel].axes.row(2).dot(b_.panels[other].axes.row(2))) > std::cos(widest_fold))
        round += angle(other, own_corner);
    return round > std::numbers::pi + margin && round < 2 * std::numbers::pi - margin;
  }

  /// How many times as many elements as on a rectangle: stresses are singular at the blunt corners of skew slabs and
  /// at inner corners, and meshes of one size converge slowly there.
  [[nodiscard]] double refinement(std::size_t panel) const {
    double sine = 1;
    for (std::size_t corner = 0; corner < 4; ++corner) {
      if (inner_corner(panel, corner)) return 2;
      sine = std::min(sine, std::sin(angle(panel, corner)));
    }
    return sine > square_enough ? 1 : std::min(2.0, 1 / sine);
  }

  [[nodiscard]] std::optional<Neighbour> beyond(std::size_t panel, std::size_t edge) const {
    const std::vector<Neighbour>& both = at_.at(key(panel, edge));
    if (both.size() != 2 || held_[index_of(node(panel, edge))] != 0 || held_[index_of(node(panel, edge + 1))] != 0)
      return std::nullopt;
    Neighbour next = both[0].panel == panel ? both[1] : both[0];
    if (next.panel == panel || b_.panels[next.panel].model != PanelModel::shell) return std::nullopt;
    if (edges_held_[panel][edge] || edges_held_[next.panel][next.edge]) return std::nullopt;
    // Panels that go round alike run along the common edge in opposite senses.
    const bool alike = node(panel, edge) != node(next.panel, next.edge);
    const double cosine = b_.panels[panel].axes.row(2).dot(b_.panels[next.panel].axes.row(2)) * (alike ? 1 : -1);
    next.fold = std::acos(std::clamp(cosine, -1.0, 1.0));
    if (next.fold > widest_fold) return std::nullopt;
    return next;
  }

  /// Across `edge` and the one opposite to it, to where nothing goes on; a ring ends where it began.
  [[nodiscard]] Span span(std::size_t panel, std::size_t edge) const {
    Span found{side(panel, (edge + 1) % 2), 0};
    for (const std::size_t first : {edge, (edge + 2) % 4}) {
      std::size_t at = panel, through = first;
      for (std::size_t steps = 0; steps < b_.panels.size(); ++steps) {
        const std::optional<Neighbour> next = beyond(at, through);
        if (!next) break;
        if (at == panel) found.turn = std::max(found.turn, next->fold);
        if (next->panel == panel) return found;
        found.length += side(next->panel, (next->edge + 1) % 2);
        at = next->panel;
        through = (next->edge + 2) % 4;
      }
    }
    return found;
  }

  const Building& b_;
  std::vector<char> held_, has_member_;
  std::vector<std::array<bool, 4>> edges_held_;
  std::vector<std::vector<std::pair<std::size_t, std::size_t>>> shells_at_;  ///< per node: panel, corner
  std::map<std::pair<int, int>, std::vector<Neighbour>> at_;
};

}  // namespace

void set_usual_meshes(Building& building) {
  const auto not_given = [](const Panel& panel) {
    return panel.model == PanelModel::shell && panel.mesh == mesh_not_given;
  };
  if (std::none_of(building.panels.begin(), building.panels.end(), not_given)) return;
  const UsualMeshes usual(building);
  std::int64_t nodes = 0;
  std::vector<std::pair<std::size_t, std::array<int, 2>>> found;
  for (std::size_t p = 0; p < building.panels.size(); ++p) {
    if (building.panels[p].model != PanelModel::shell) continue;
    const bool sought = not_given(building.panels[p]);
    const std::array<int, 2> mesh = sought ? usual.mesh(p) : building.panels[p].mesh;
    if (sought) found.emplace_back(p, mesh);
    nodes += (std::int64_t{mesh[0]} + 1) * (std::int64_t{mesh[1]} + 1);
  }
  if (nodes > most_mesh_nodes)
    throw InputError(building.file + ", panels: the meshes of shells come to " + std::to_string(nodes) +
                     " nodes, where those without `mesh` have what their spans need; accepted: at most " +
                     std::to_string(most_mesh_nodes) + " in the whole model");
  for (const auto& [p, mesh] : found) building.panels[p].mesh = mesh;
}

std::vector<ShellFold> shell_folds(const Building& building, double least) {
  return UsualMeshes(building).folds(least);
}

}  // namespace topple::structure
