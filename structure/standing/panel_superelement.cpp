#include "standing/panel_superelement.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>

#include "mesh/panel_cells.h"
#include "model/index_of.h"
#include "standing/turned.h"
#include "topple/fracture/polygon.h"

namespace topple::structure {

namespace {

/// Elements of a broken membrane: about this long, m, and at most so many along an edge.
constexpr double membrane_element = 0.5;
constexpr int most_elements = 12;
/// Nearer to a line of an opening than this share of their distance, they are left out.
constexpr double least_gap = 0.4;
/// An element with less of its area stands no more.
constexpr double least_share = 0.05;

/// Lines of about this distance, and through the openings' vertices.
PanelLines membrane_lines(const PanelSurface& surface, const Panel& panel, PanelId id) {
  PanelLines lines{id, {}};
  for (std::size_t way = 0; way < 2; ++way) {
    const double length = std::max(surface.edge_length(way), surface.edge_length(way + 2));
    const int count = std::clamp(static_cast<int>(std::ceil(length / membrane_element)), 1, most_elements);
    std::vector<double>& at = lines.at[way];
    at = {0, 1};
    const auto add = [&](double line, double apart) {
      if (std::none_of(at.begin(), at.end(), [&](double other) { return std::abs(other - line) < apart; }))
        at.push_back(line);
    };
    for (const auto& opening : panel.openings)
      for (const Vec2& vertex : opening) add(surface.parameters(vertex)(static_cast<Eigen::Index>(way)), same_line);
    for (int i = 1; i < count; ++i) add(static_cast<double>(i) / count, least_gap / count);
    std::sort(at.begin(), at.end());
  }
  return lines;
}

/// The edge on which a point of the mesh lies and how far along, from 0 to 1; -1 for one inside.
std::pair<int, double> edge_place(const Vec2& st) {
  constexpr double border = 1e-8;
  const auto along = [&](double value) { return value < border ? 0.0 : value > 1 - border ? 1.0 : value; };
  const double s = along(st.x()), t = along(st.y());
  if (t == 0) return {0, s};
  if (s == 1) return {1, t};
  if (t == 1) return {2, 1 - s};
  if (s == 0) return {3, 1 - t};
  return {-1, 0};
}

struct Box2 {
  Vec2 low, high;
  [[nodiscard]] bool overlaps(const Box2& other) const {
    return (other.high - low).minCoeff() > 0 && (high - other.low).minCoeff() > 0;
  }
};

Box2 box_of(const std::vector<Vec2>& polygon) {
  Box2 box{polygon.front(), polygon.front()};
  for (const Vec2& corner : polygon) {
    box.low = box.low.cwiseMin(corner);
    box.high = box.high.cwiseMax(corner);
  }
  return box;
}

}  // namespace

PanelSuperelement::PanelSuperelement(const Building& building, const Frame& frame, PanelId id,
                                     std::shared_ptr<ShellOperators> operators)
    : axes_(building[id].axes),
      origin_(building[building[id].nodes[0]].position),
      turn_(Mat3::Identity()),
      thickness_(building[id].thickness),
      operators_(std::move(operators)) {
  const PanelMesh& mesh = frame.meshes[index_of(id)];
  solver::Superelement::Patch patch;
  std::map<int, int> place;
  const auto local = [&](int node) {
    const auto [entry, made] = place.emplace(node, static_cast<int>(patch.nodes.size()));
    if (made) patch.nodes.push_back(frame.model.nodes[static_cast<std::size_t>(node)]);
    return entry->second;
  };
  for (const NodeId node : building[id].all_nodes()) node_.push_back(local(node.index));
  for (std::size_t k = 0; k < mesh.elements.size(); ++k) {
    solver::Shell shell = frame.model.shells[static_cast<std::size_t>(mesh.first_shell) + k];
    for (int& node : shell.node) node = local(node);
    patch.shells.push_back(shell);
  }
  for (std::size_t edge = 0; edge < 4; ++edge)
    if (building[id].joined[edge])
      for (const int node : mesh.edge_nodes[edge]) bearing_edge_[edge].push_back(local(node));
  for (const EdgeSupport& support : building.edge_supports) {
    if (support.panel != id) continue;
    std::vector<int>& bearing = bearing_edge_[static_cast<std::size_t>(support.edge)];
    bearing.clear();
    for (const int node : mesh.edge_nodes[static_cast<std::size_t>(support.edge)]) {
      bearing.push_back(local(node));
      if (std::find(node_.begin(), node_.end(), local(node)) == node_.end())
        patch.supports.push_back({local(node), support.stiffness});
    }
  }
  collect_nodes(building[id]);
  for (std::size_t n = 0; n < node_.size(); ++n)
    if (held_at(n)) patch.kept.push_back(node_[n]);
  begin(std::move(patch));
}

void PanelSuperelement::begin(solver::Superelement::Patch patch) {
  share_.assign(patch.shells.size(), 1);
  patch_.emplace(std::move(patch));
  for (const solver::Shell& shell : patch_->patch().shells)
    element_.push_back(&operators_->of(shell, patch_->patch().nodes));
  find_places();
  load_evenly();
}

PanelSuperelement::PanelSuperelement(const Building& building, PanelId id, std::shared_ptr<ShellOperators> operators)
    : axes_(building[id].axes),
      origin_(building[building[id].nodes[0]].position),
      turn_(building[id].axes),
      thickness_(building[id].thickness),
      operators_(std::move(operators)) {
  const Panel& panel = building[id];
  const PanelSurface surface(building, panel);
  const PanelLines lines = membrane_lines(surface, panel, id);
  const PanelCells cells = panel_cells(surface, panel, lines, cuts_cells(surface, panel, lines));
  solver::Superelement::Patch patch;
  // Its mean plane, as the one element of a whole membrane. The corners are there even where an opening takes them.
  const auto add_node = [&](const Vec2& st) {
    const Vec2 place = surface.local(st);
    patch.nodes.emplace_back(place.x(), place.y(), 0);
  };
  for (int corner = 0; corner < 4; ++corner) {
    node_.push_back(corner);
    patch.kept.push_back(corner);
    add_node(PanelSurface::on_edge(static_cast<std::size_t>(corner), 0));
  }
  std::vector<int> number;
  for (const Vec2& point : cells.points) {
    const auto [edge, along] = edge_place(point);
    if (edge >= 0 && (along == 0 || along == 1)) {
      number.push_back((edge + (along == 1 ? 1 : 0)) % 4);
      continue;
    }
    number.push_back(static_cast<int>(patch.nodes.size()));
    add_node(point);
    if (edge >= 0) patch.ties.push_back({number.back(), {edge, (edge + 1) % 4}, along, false});
  }
  solver::Shell shell;
  shell.youngs_modulus = building[panel.material].youngs_modulus;
  shell.poisson_ratio = building[panel.material].poisson_ratio;
  shell.thickness = panel.thickness;
  for (const auto& cell : cells.quadrilaterals) {
    for (std::size_t i = 0; i < 4; ++i) shell.node[i] = number[static_cast<std::size_t>(cell[i])];
    patch.shells.push_back(shell);
  }
  collect_nodes(panel);
  begin(std::move(patch));
}

/// The mesh of a membrane lies in the axes of its panel.
PanelSuperelement::PanelSuperelement(const PanelSuperelement& whole, const Building& building, PanelId id)
    : PanelSuperelement(whole) {
  axes_ = turn_ = building[id].axes;
  origin_ = building[building[id].nodes[0]].position;
}

/// The edges on which the panel's nodes lie.
void PanelSuperelement::collect_nodes(const Panel& panel) {
  edge_.assign(4, -1);
  if (panel.model != PanelModel::shell) return;
  for (std::size_t edge = 0; edge < 4; ++edge)
    edge_.insert(edge_.end(), panel.edge_nodes[edge].size(), static_cast<int>(edge));
}

void PanelSuperelement::find_places() {
  const std::vector<int>& kept = patch_->patch().kept;
  place_.clear();
  for (const int node : node_) {
    const auto found = std::find(kept.begin(), kept.end(), node);
    place_.push_back(found == kept.end() ? -1 : static_cast<int>(found - kept.begin()));
  }
}

/// By its edge; at a corner by either of its edges that something lies along, where there is none by either.
bool PanelSuperelement::held_at(std::size_t node) const {
  if (edge_[node] >= 0) return holds_[static_cast<std::size_t>(edge_[node])];
  const std::array<std::size_t, 2> edges{node, (node + 3) % 4};
  const bool bears = !bearing_edge_[edges[0]].empty() || !bearing_edge_[edges[1]].empty();
  return std::any_of(edges.begin(), edges.end(),
                     [&](std::size_t edge) { return holds_[edge] && (!bears || !bearing_edge_[edge].empty()); });
}

/// Place of a patch node in the panel's plane.
Vec2 PanelSuperelement::flat(int node) const {
  const Vec3& place = patch_->patch().nodes[static_cast<std::size_t>(node)];
  if (turn_.isIdentity(0)) return (axes_ * (place - origin_)).head<2>();
  return place.head<2>();
}

void PanelSuperelement::fracture(const PanelRemains& remains) {
  const auto& shells = patch_->patch().shells;
  lost_.resize(shells.size(), 0);
  std::vector<fracture::Polygon> elements;
  std::vector<Box2> boxes;
  for (const solver::Shell& shell : shells) {
    fracture::Polygon& element = elements.emplace_back();
    for (const int node : shell.node) element.push_back(flat(node));
    boxes.push_back(box_of(element));
  }
  // Holes come in the order in which they were made: those of earlier hits are counted.
  for (; holes_counted_ < remains.holes.size(); ++holes_counted_) {
    const std::vector<Vec2>& hole = remains.holes[holes_counted_];
    const Box2 box = box_of(hole);
    for (std::size_t k = 0; k < shells.size(); ++k) {
      if (!box.overlaps(boxes[k])) continue;
      fracture::LabelledPolygon both{hole, std::vector<int>(hole.size(), 0)};
      for (std::size_t i = 0; i < 4 && !both.vertices.empty(); ++i) {
        const Vec2 along = elements[k][(i + 1) % 4] - elements[k][i];
        fracture::clip(both, elements[k][i], Vec2(along.y(), -along.x()), 0);
      }
      if (both.vertices.size() > 2) lost_[k] += fracture::area(both.vertices);
    }
  }
  for (std::size_t k = 0; k < shells.size(); ++k) share_[k] = std::max(0.0, 1 - lost_[k] / fracture::area(elements[k]));
  keep_shares(gone());
}

void PanelSuperelement::keep_shares(const std::vector<int>& lost_elements) {
  std::vector<double> standing = share_;
  for (double& share : standing)
    if (share < least_share) share = 0;
  for (const int element : lost_elements) standing[static_cast<std::size_t>(element)] = 0;
  patch_->keep(standing);
  load_evenly();
}

/// What each node gets of a unit traction along each axis of the patch.
void PanelSuperelement::load_evenly() {
  const auto& shells = patch_->patch().shells;
  unit_traction_.assign(patch_->patch().nodes.size(), Eigen::Matrix<double, 6, 3>::Zero());
  for (std::size_t k = 0; k < shells.size(); ++k) {
    if (share_[k] <= 0) continue;
    const Eigen::Matrix<double, 24, 3> own = share_[k] * element_[k]->loads;
    if (patch_->stands(static_cast<int>(k))) {
      for (int n = 0; n < 4; ++n)
        unit_traction_[static_cast<std::size_t>(shells[k].node[static_cast<std::size_t>(n)])] +=
            own.middleRows<6>(6 * n);
      continue;
    }
    Vec3 centre = Vec3::Zero();
    for (const int node : shells[k].node) {
      const Vec2 corner = flat(node);
      centre += Vec3(corner.x(), corner.y(), 0) / 4;
    }
    const Grip held = grip(Vec2(centre.head<2>()));
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 sum = Vec3::Zero();
      for (int n = 0; n < 4; ++n) sum += own.block<3, 1>(6 * n, axis);
      held.each(sum,
                [&](int node, const Vec6& load) { unit_traction_[static_cast<std::size_t>(node)].col(axis) += load; });
    }
  }
}

void PanelSuperelement::release_edge(int edge) {
  holds_[static_cast<std::size_t>(edge)] = false;
  condense_anew(gone());
}

/// By what holds it; these elements are not there.
void PanelSuperelement::condense_anew(const std::vector<int>& lost_elements) {
  solver::Superelement::Patch patch = patch_->patch();
  for (std::size_t edge = 0; edge < 4; ++edge) {
    if (holds_[edge]) continue;
    const auto& nodes = bearing_edge_[edge];
    std::erase_if(patch.supports, [&](const solver::Support& support) {
      return std::find(nodes.begin(), nodes.end(), support.node) != nodes.end();
    });
  }
  patch.kept.clear();
  for (std::size_t n = 0; n < node_.size(); ++n)
    if (held_at(n)) patch.kept.push_back(node_[n]);
  patch_.emplace(std::move(patch), lost_elements);
  find_places();
  keep_shares(gone());
}

std::vector<int> PanelSuperelement::gone() const {
  std::vector<int> elements;
  for (std::size_t k = 0; k < share_.size(); ++k)
    if (!patch_->stands(static_cast<int>(k))) elements.push_back(static_cast<int>(k));
  return elements;
}

/// Of one that has lost nothing yet.
void PanelSuperelement::restore(const std::vector<int>& lost_elements) {
  if (!std::all_of(holds_.begin(), holds_.end(), [](bool held) { return held; })) return condense_anew(lost_elements);
  if (!lost_.empty()) keep_shares(lost_elements);
}

Eigen::MatrixXd PanelSuperelement::stiffness() const { return of_all_nodes(patch_->stiffness()); }

/// From the nodes that the patch keeps, in its axes.
Eigen::MatrixXd PanelSuperelement::of_all_nodes(const Eigen::MatrixXd& kept) const {
  const auto size = static_cast<Eigen::Index>(6 * node_.size());
  Eigen::MatrixXd global = Eigen::MatrixXd::Zero(size, size);
  const bool turned = !turn_.isIdentity(0);
  for (std::size_t i = 0; i < 2 * node_.size(); ++i)
    for (std::size_t j = 0; j < 2 * node_.size(); ++j) {
      const int row = place_[i / 2], column = place_[j / 2];
      if (row < 0 || column < 0) continue;
      const auto at = [](std::size_t half, int node) { return static_cast<Eigen::Index>(6 * node + 3 * (half % 2)); };
      const Mat3 own = kept.block<3, 3>(at(i, row), at(j, column));
      auto block = global.block<3, 3>(static_cast<Eigen::Index>(3 * i), static_cast<Eigen::Index>(3 * j));
      if (turned)
        block = turn_.transpose() * own * turn_;
      else
        block = own;
    }
  return global;
}

Eigen::MatrixXd PanelSuperelement::weighed(double kilograms, const Eigen::MatrixXd& motions) const {
  const auto& shells = patch_->patch().shells;
  Eigen::MatrixXd inert = Eigen::MatrixXd::Zero(motions.rows(), motions.cols());
  double area = 0;
  for (std::size_t k = 0; k < shells.size(); ++k) {
    if (share_[k] <= 0) continue;
    const std::array<int, 4>& corner = shells[k].node;
    const double own_area = share_[k] * element_[k]->area;
    area += own_area;
    if (patch_->stands(static_cast<int>(k))) {
      const Mat24 own = share_[k] * element_[k]->mass;
      for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j)
          inert.middleRows<6>(6 * corner[static_cast<std::size_t>(i)]) +=
              own.block<6, 6>(6 * i, 6 * j) * motions.middleRows<6>(6 * corner[static_cast<std::size_t>(j)]);
      continue;
    }
    // What is left of it hangs on one node, as its load does.
    Vec2 centre = Vec2::Zero();
    for (const int node : corner) centre += flat(node) / 4;
    const Grip held = grip(centre);
    if (held.node[0] >= 0) inert.middleRows<3>(6 * held.node[0]) += own_area * motions.middleRows<3>(6 * held.node[0]);
  }
  if (!(area > 0)) return Eigen::MatrixXd::Zero(motions.rows(), motions.cols());
  return kilograms / area * inert;
}

Eigen::MatrixXd PanelSuperelement::mass(double kilograms) const {
  const Eigen::MatrixXd shapes = patch_->shapes();
  const Eigen::MatrixXd product = shapes.transpose() * weighed(kilograms, shapes);
  return of_all_nodes((product + product.transpose()) / 2);
}

Eigen::VectorXd PanelSuperelement::motion(const std::vector<Vec6>& at_nodes) const {
  Eigen::VectorXd kept = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(6 * patch_->patch().kept.size()));
  for (std::size_t n = 0; n < node_.size(); ++n)
    if (place_[n] >= 0) kept.segment<6>(6 * place_[n]) = turned(turn_, at_nodes[n]);
  return patch_->shapes() * kept;
}

Eigen::VectorXd PanelSuperelement::momentum(double kilograms, const Eigen::VectorXd& motion) const {
  const Eigen::VectorXd kept = patch_->shapes().transpose() * weighed(kilograms, motion);
  Eigen::VectorXd all = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(6 * node_.size()));
  for (std::size_t n = 0; n < node_.size(); ++n)
    if (place_[n] >= 0)
      all.segment<6>(static_cast<Eigen::Index>(6 * n)) =
          turned(turn_.transpose(), Vec6(kept.segment<6>(6 * place_[n])));
  return all;
}

bool PanelSuperelement::stands_at(std::size_t node) const {
  return place_[node] >= 0 && patch_->has_shells(node_[node]);
}

}  // namespace topple::structure
