#pragma once
// The mesh of a shell panel, or of a membrane that is broken in part, condensed to the panel's four corners: what a
// standing frame sees of it. A hole costs this panel's condensation and nothing else.
//
// An element's stiffness and its share of the panel's load go with its area that is there. What is left in elements of
// which next to nothing is, hangs on the nearest node that stands. The edges of a membrane stay straight, as those of
// the one element that it is while whole; those of a shell bend freely between the corners, and supports of an edge act
// on all of its nodes.
#include <array>
#include <optional>
#include <vector>

#include "topple/solver/superelement.h"
#include "topple/structure/frame.h"
#include "topple/structure/standing_frame.h"

namespace topple::structure {

using Mat24 = Eigen::Matrix<double, 24, 24>;

/// A force (global) at a point of the panel.
struct PanelForce {
  Vec3 point = Vec3::Zero(), force = Vec3::Zero();
};
/// What acts on a panel between its corners.
struct PanelLoading {
  Vec3 traction = Vec3::Zero();  ///< global, per area of what is there
  std::vector<PanelForce> forces;
};

class PanelSuperelement {
 public:
  /// A shell panel as the frame meshes it.
  PanelSuperelement(const Building& building, const Frame& frame, PanelId id);
  /// A membrane panel, meshed here, less its openings.
  PanelSuperelement(const Building& building, PanelId id);

  /// Only this remains.
  void fracture(const PanelRemains& remains);
  /// The supports of an edge hold it no more.
  void release_edge(int edge);

  /// Corners in order, global axes.
  [[nodiscard]] Mat24 stiffness() const;
  [[nodiscard]] std::array<Vec6, 4> corner_loads(const PanelLoading& loading) const;
  /// False when nothing of the panel is left at a corner.
  [[nodiscard]] bool corner_stands(int corner) const;
  /// How far the place of a unit force gives way along it while the corners are held, m/N.
  [[nodiscard]] double compliance(const PanelForce& unit) const;

  /// Mean of the squared translation over what is there.
  [[nodiscard]] double mean_square_motion(const std::array<Vec6, 4>& corners, const PanelLoading& loading) const;

  /// Mean over each edge of what its supports do to the panel, per `length`, in the axes of the edge; zero for an edge
  /// without supports. `corners`: displacements; `corner_reactions`: of the supports at the corners themselves.
  [[nodiscard]] std::array<Vec6, 4> edge_demands(const std::array<Vec6, 4>& corners, const PanelLoading& loading,
                                                 const std::array<double, 4>& length) const;
  /// In either face, at the centres of the elements that stand.
  [[nodiscard]] PanelStress worst_stress(const std::array<Vec6, 4>& corners, const PanelLoading& loading) const;

 private:
  void keep_shares();
  [[nodiscard]] Vec2 flat(int node) const;
  [[nodiscard]] std::vector<Vec6> node_loads(const PanelLoading& loading) const;
  void add_force(const PanelForce& one, std::vector<Vec6>& loads) const;
  [[nodiscard]] std::vector<Vec6> recover(const std::array<Vec6, 4>& corners, const PanelLoading& loading) const;
  [[nodiscard]] solver::FrameModel model() const;

  Mat3 axes_;  ///< of the panel
  Vec3 origin_;
  Mat3 turn_;  ///< rows: axes of the patch in global components
  double thickness_;
  std::optional<solver::Superelement> patch_;
  std::vector<double> share_;                       ///< per element: of its area that is there
  std::array<std::vector<int>, 4> supported_edge_;  ///< patch nodes of edges with supports, corners included
};

}  // namespace topple::structure
