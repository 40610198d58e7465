// How a panel's superelement takes loads, and what it tells of its inside from what the panel's nodes do: motion,
// demands of edges, stress.
#include <algorithm>
#include <cmath>

#include "standing/panel_superelement.h"
#include "standing/turned.h"
#include "topple/fracture/polygon.h"

namespace topple::structure {

namespace {

/// Stress is looked at where so much of an element is there.
constexpr double share_with_stress = 0.5;

/// Larger and smaller principal value of a plane symmetric tensor (xx, yy, xy).
std::array<double, 2> principal(const Vec3& s) {
  const double mean = (s(0) + s(1)) / 2, radius = std::hypot((s(0) - s(1)) / 2, s(2));
  return {mean + radius, mean - radius};
}

}  // namespace

/// On the element that holds the point by its bilinear shapes; in a hole, on the nearest node that stands, with the
/// moment that keeps its line of action.
PanelSuperelement::Grip PanelSuperelement::grip(const Vec2& at) const {
  const auto& shells = patch_->patch().shells;
  Grip held;
  double least = unlimited;
  fracture::Polygon corners(4);
  for (std::size_t k = 0; k < shells.size(); ++k) {
    if (!patch_->stands(static_cast<int>(k))) continue;
    for (std::size_t n = 0; n < 4; ++n) {
      corners[n] = flat(shells[k].node[n]);
      const double away = (corners[n] - at).norm();
      if (away < least) held.node[0] = shells[k].node[n];
      least = std::min(least, away);
    }
    if (!fracture::contains(corners, at)) continue;
    // Newton's method on the bilinear map; two steps are exact in a parallelogram.
    Vec2 place = Vec2::Zero();
    for (int i = 0; i < 20; ++i) {
      const Vec2 a = corners[0] + corners[1] + corners[2] + corners[3],
                 b = corners[1] + corners[2] - corners[0] - corners[3];
      const Vec2 c = corners[2] + corners[3] - corners[0] - corners[1],
                 d = corners[0] + corners[2] - corners[1] - corners[3];
      const Vec2 residual = at - (a + place.x() * b + place.y() * c + place.x() * place.y() * d) / 4;
      Eigen::Matrix2d slope;
      slope << (b + place.y() * d) / 4, (c + place.x() * d) / 4;
      const double determinant = slope(0, 0) * slope(1, 1) - slope(0, 1) * slope(1, 0);
      const Vec2 step((slope(1, 1) * residual.x() - slope(0, 1) * residual.y()) / determinant,
                      (slope(0, 0) * residual.y() - slope(1, 0) * residual.x()) / determinant);
      place = (place + step).cwiseMax(-1).cwiseMin(1);
      if (step.norm() < 1e-14) break;
    }
    constexpr std::array<std::array<double, 2>, 4> sign{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
    for (std::size_t n = 0; n < 4; ++n) {
      held.node[n] = shells[k].node[n];
      held.share[n] = (1 + sign[n][0] * place.x()) * (1 + sign[n][1] * place.y()) / 4;
    }
    return held;
  }
  if (held.node[0] < 0) return held;
  held.share[0] = 1;
  const Vec2 arm = at - flat(held.node[0]);
  held.lever = turn_ * (axes_.transpose() * Vec3(arm.x(), arm.y(), 0));
  return held;
}

void PanelSuperelement::add_force(const PanelForce& one, std::vector<Vec6>& loads) const {
  const Vec3 place = axes_ * (one.point - origin_);
  grip(Vec2(place.head<2>())).each(turn_ * one.force, [&](int node, const Vec6& load) {
    loads[static_cast<std::size_t>(node)] += load;
  });
}

std::vector<Vec6> PanelSuperelement::node_loads(const PanelLoading& loading) const {
  std::vector<Vec6> loads(patch_->patch().nodes.size(), Vec6::Zero());
  const Vec3 traction = turn_ * loading.traction;
  if (!traction.isZero(0))
    for (std::size_t n = 0; n < loads.size(); ++n) loads[n] = unit_traction_[n] * traction;
  for (const PanelForce& one : loading.forces) add_force(one, loads);
  return loads;
}

std::vector<Vec6> PanelSuperelement::loads_at_nodes(const PanelLoading& loading) const {
  const Eigen::VectorXd condensed = patch_->condense(node_loads(loading));
  std::vector<Vec6> loads(node_.size(), Vec6::Zero());
  for (std::size_t n = 0; n < loads.size(); ++n)
    if (place_[n] >= 0) loads[n] = turned(turn_.transpose(), condensed.segment<6>(6 * place_[n]));
  return loads;
}

std::vector<Vec6> PanelSuperelement::recover(const std::vector<Vec6>& at_nodes, const PanelLoading& loading) const {
  Eigen::VectorXd kept(static_cast<Eigen::Index>(6 * patch_->patch().kept.size()));
  for (std::size_t n = 0; n < node_.size(); ++n)
    if (place_[n] >= 0) kept.segment<6>(6 * place_[n]) = turned(turn_, at_nodes[n]);
  return patch_->recover(kept, node_loads(loading));
}

double PanelSuperelement::compliance(const PanelForce& unit) const {
  PanelLoading loading;
  loading.forces = {unit};
  const std::vector<Vec6> loads = node_loads(loading);
  const std::vector<Vec6> u =
      patch_->recover(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(6 * patch_->patch().kept.size())), loads);
  double work = 0;
  for (std::size_t n = 0; n < u.size(); ++n) work += u[n].dot(loads[n]);
  return work;
}

double PanelSuperelement::mean_square_motion(const std::vector<Vec6>& at_nodes, const PanelLoading& loading) const {
  const std::vector<Vec6> u = recover(at_nodes, loading);
  double sum = 0, area = 0;
  for (std::size_t k = 0; k < share_.size(); ++k) {
    if (!patch_->stands(static_cast<int>(k))) continue;
    fracture::Polygon element;
    double squares = 0;
    for (const int node : patch_->patch().shells[k].node) {
      element.push_back(flat(node));
      squares += u[static_cast<std::size_t>(node)].head<3>().squaredNorm() / 4;
    }
    const double own = share_[k] * fracture::area(element);
    sum += own * squares;
    area += own;
  }
  return area > 0 ? sum / area : 0;
}

std::array<Vec6, 4> PanelSuperelement::edge_demands(const std::vector<Vec6>& at_nodes, const PanelLoading& loading,
                                                    const std::array<double, 4>& length,
                                                    const std::array<bool, 4>& bear) const {
  std::array<Vec6, 4> demands{Vec6::Zero(), Vec6::Zero(), Vec6::Zero(), Vec6::Zero()};
  const auto bears = [&](std::size_t edge) { return bear[edge] && holds_[edge] && !bearing_edge_[edge].empty(); };
  const std::vector<Vec6> reactions = patch_->reactions(recover(at_nodes, loading), node_loads(loading));
  std::array<std::vector<int>, 4> of_edge;
  std::vector<int> edges_at(reactions.size(), 0);  // a corner between two edges that bear is shared
  for (std::size_t edge = 0; edge < 4; ++edge) {
    if (bears(edge)) of_edge[edge] = bearing_edge_[edge];
    for (const int node : of_edge[edge]) ++edges_at[static_cast<std::size_t>(node)];
  }
  for (std::size_t corner = 0; corner < 4; ++corner) {  // and so is one where none does, a post's under a flat slab
    if (edges_at[static_cast<std::size_t>(node_[corner])] > 0 || !stands_at(corner)) continue;
    for (const std::size_t edge : {corner, (corner + 3) % 4}) {
      if (!holds_[edge]) continue;
      of_edge[edge].push_back(node_[corner]);
      ++edges_at[static_cast<std::size_t>(node_[corner])];
    }
  }
  for (std::size_t edge = 0; edge < 4; ++edge) {
    if (of_edge[edge].empty() || !(length[edge] > 0)) continue;
    const auto place = [&](std::size_t corner) { return flat(node_[corner % 4]); };
    const Vec2 along = (place(edge + 1) - place(edge)).normalized();
    Mat3 own;  // rows: outwards, along, normal
    own << along.y(), -along.x(), 0, along.x(), along.y(), 0, 0, 0, 1;
    const Mat3 to_edge = own * axes_ * turn_.transpose();
    Vec6 sum = Vec6::Zero();
    for (const int node : of_edge[edge]) {
      const auto n = static_cast<std::size_t>(node);
      sum += reactions[n] / edges_at[n];
    }
    demands[edge] = turned(to_edge, sum) / length[edge];
  }
  return demands;
}

PanelStress PanelSuperelement::worst_stress(const std::vector<Vec6>& at_nodes, const PanelLoading& loading) const {
  const std::vector<Vec6> u = recover(at_nodes, loading);
  const auto& shells = patch_->patch().shells;
  PanelStress worst;
  for (std::size_t k = 0; k < shells.size(); ++k) {
    if (!patch_->stands(static_cast<int>(k)) || share_[k] < share_with_stress) continue;
    Eigen::Matrix<double, 24, 1> own;
    for (int n = 0; n < 4; ++n)
      own.segment<6>(6 * n) = u[static_cast<std::size_t>(shells[k].node[static_cast<std::size_t>(n)])];
    const Vec6 r = element_[k]->resultants * own;
    for (const double face : {-1.0, 1.0}) {
      const Vec3 stress = r.head<3>() / thickness_ + face * 6 * r.tail<3>() / (thickness_ * thickness_);
      const auto [larger, smaller] = principal(stress);
      if (larger <= worst.tension && -smaller <= worst.compression) continue;
      Vec2 centre = Vec2::Zero();
      for (const int node : shells[k].node) centre += flat(node) / 4;
      const Vec3 at = origin_ + axes_.transpose() * Vec3(centre.x(), centre.y(), 0);
      if (larger > worst.tension) {
        worst.tension = larger;
        worst.tension_at = at;
      }
      if (-smaller > worst.compression) {
        worst.compression = -smaller;
        worst.compression_at = at;
      }
    }
  }
  return worst;
}

}  // namespace topple::structure
