#pragma once
// The mesh of a shell panel, or of a membrane that is broken in part, condensed to the nodes of the building that it
// hangs on: its corners and, of a shell, the nodes that it shares along its edges (join_shells.h). That is what a
// standing frame sees of it. A hole costs this panel's condensation and nothing else.
//
// An element's stiffness and its share of the panel's load go with its area that is there. What is left in elements of
// which next to nothing is, hangs on the nearest node that stands. The edges of a membrane stay straight, as those of
// the one element that it is while whole; those of a shell bend with what they are joined to, freely where that is
// nothing, and supports of an edge act on all of its nodes.
#include <Eigen/Geometry>
#include <array>
#include <optional>
#include <vector>

#include "standing/shell_operators.h"
#include "topple/solver/superelement.h"
#include "topple/structure/frame.h"
#include "topple/structure/standing_frame.h"

namespace topple::structure {

using Mat24 = Eigen::Matrix<double, 24, 24>;

/// A force (global) at a point of the panel.
struct PanelForce {
  Vec3 point = Vec3::Zero(), force = Vec3::Zero();
};
template <class Archive>
void serialize(Archive& archive, PanelForce& one) {
  auto& [point, force] = one;
  archive(point, force);
}
/// What acts on a panel between its corners.
struct PanelLoading {
  Vec3 traction = Vec3::Zero();  ///< global, per area of what is there
  std::vector<PanelForce> forces;
};

class PanelSuperelement {
 public:
  /// A shell panel as the frame meshes it. `operators`: those of elements met before, to be added to.
  PanelSuperelement(const Building& building, const Frame& frame, PanelId id,
                    std::shared_ptr<ShellOperators> operators = std::make_shared<ShellOperators>());
  /// A membrane panel, meshed here, less its openings.
  PanelSuperelement(const Building& building, PanelId id,
                    std::shared_ptr<ShellOperators> operators = std::make_shared<ShellOperators>());

  /// A membrane panel of the same shape, material and thickness as one that is whole.
  PanelSuperelement(const PanelSuperelement& whole, const Building& building, PanelId id);

  /// Only this remains; its holes begin with those of earlier calls.
  void fracture(const PanelRemains& remains);
  /// An edge is held no more, neither by its supports nor by what lies along it.
  void release_edge(int edge);

  // Of the panel's nodes in the order of Panel::all_nodes(), global axes. A node that the panel let go of, or at which
  // nothing of it is left, has zeros.
  [[nodiscard]] Eigen::MatrixXd stiffness() const;
  [[nodiscard]] std::vector<Vec6> loads_at_nodes(const PanelLoading& loading) const;
  /// Consistent mass for so many kilograms of what is there, evenly over its area; what lies between the nodes follows
  /// them statically (R. J. Guyan, AIAA Journal 3 (1965), 380). Rows and columns as stiffness() has them.
  [[nodiscard]] Eigen::MatrixXd mass(double kilograms) const;
  /// A motion of the panel: velocities of the nodes of its mesh, axes of the mesh, from those of its own nodes.
  [[nodiscard]] Eigen::VectorXd motion(const std::vector<Vec6>& at_nodes) const;
  /// What so many kilograms of what is there have of a motion that the panel had before it changed: impulses at its
  /// nodes, rows as stiffness() has them. Over mass(): of all motions it can have now, the nearest (what differs is
  /// lost).
  [[nodiscard]] Eigen::VectorXd momentum(double kilograms, const Eigen::VectorXd& motion) const;
  /// True while the panel is held at this node and something of it stands there.
  [[nodiscard]] bool stands_at(std::size_t node) const;
  [[nodiscard]] std::size_t nodes() const { return node_.size(); }

  // `at_nodes`: displacements of the panel's nodes, as above.
  /// How far the place of a unit force gives way along it while the panel's nodes are held, m/N.
  [[nodiscard]] double compliance(const PanelForce& unit) const;
  /// Mean of the squared translation over what is there.
  [[nodiscard]] double mean_square_motion(const std::vector<Vec6>& at_nodes, const PanelLoading& loading) const;
  /// Mean over each edge of what its supports, and members and panels along it, do to the panel, per `length`, in the
  /// axes of the edge; zero for an edge without any, or that does not bear (`bear`). Corners are shared as edge_share()
  /// says.
  [[nodiscard]] std::array<Vec6, 4> edge_demands(const std::vector<Vec6>& at_nodes, const PanelLoading& loading,
                                                 const std::array<double, 4>& length,
                                                 const std::array<bool, 4>& bear = {true, true, true, true}) const;
  /// In either face, at the centres of the elements that stand.
  [[nodiscard]] PanelStress worst_stress(const std::vector<Vec6>& at_nodes, const PanelLoading& loading) const;

  /// Of one that was made alike: what has been lost. The rest is condensed anew.
  template <class Archive>
  void save(Archive& archive) const {
    const auto& [axes, origin, turn, thickness, patch, operators, element, unit_traction, lost, holes_counted, share,
                 node, edge, place, holds, bearing_edge] = *this;
    archive(lost, holes_counted, share, holds, gone());
  }
  template <class Archive>
  void load(Archive& archive) {
    std::vector<int> lost_elements;
    archive(lost_, holes_counted_, share_, holds_, lost_elements);
    restore(lost_elements);
  }

 private:
  void restore(const std::vector<int>& lost_elements);
  void condense_anew(const std::vector<int>& lost_elements);
  [[nodiscard]] std::vector<int> gone() const;
  void keep_shares(const std::vector<int>& lost_elements);
  void begin(solver::Superelement::Patch patch);
  void load_evenly();
  void collect_nodes(const Panel& panel);
  void find_places();
  [[nodiscard]] bool held_at(std::size_t node) const;
  [[nodiscard]] Vec2 flat(int node) const;
  [[nodiscard]] std::vector<Vec6> node_loads(const PanelLoading& loading) const;
  /// What takes up a force at a point: shares of it at nodes of the patch; `lever`: from the one node where it is no
  /// element (axes of the patch).
  struct Grip {
    std::array<int, 4> node{-1, -1, -1, -1};
    std::array<double, 4> share{};
    Vec3 lever = Vec3::Zero();
    /// Calls add(node, load) for a force in axes of the patch.
    template <class Add>
    void each(const Vec3& force, const Add& add) const {
      for (std::size_t n = 0; n < 4 && node[n] >= 0; ++n) {
        Vec6 load;
        load << share[n] * force, lever.cross(force);
        add(node[n], load);
      }
    }
  };
  [[nodiscard]] Grip grip(const Vec2& at) const;
  void add_force(const PanelForce& one, std::vector<Vec6>& loads) const;
  [[nodiscard]] Eigen::MatrixXd of_all_nodes(const Eigen::MatrixXd& kept) const;
  /// So many kilograms, evenly over what is there, times motions of the nodes of the mesh (a column each).
  [[nodiscard]] Eigen::MatrixXd weighed(double kilograms, const Eigen::MatrixXd& motions) const;
  [[nodiscard]] std::vector<Vec6> recover(const std::vector<Vec6>& at_nodes, const PanelLoading& loading) const;
  Mat3 axes_;  ///< of the panel
  Vec3 origin_;
  Mat3 turn_;  ///< rows: axes of the patch in global components
  double thickness_;
  std::optional<solver::Superelement> patch_;
  std::shared_ptr<ShellOperators> operators_;
  std::vector<const ShellOperators::Element*> element_;     ///< per element
  std::vector<Eigen::Matrix<double, 6, 3>> unit_traction_;  ///< per node: its loads, axes of the patch
  std::vector<double> lost_;                                ///< per element: of its area, m2
  std::size_t holes_counted_ = 0;
  std::vector<double> share_;  ///< per element: of its area that is there
  std::vector<int> node_;      ///< per node of the panel: that of the patch
  std::vector<int> edge_;      ///< the edge it is on; -1: a corner
  std::vector<int> place_;     ///< among those that the patch keeps; -1: let go of
  std::array<bool, 4> holds_{true, true, true, true};
  std::array<std::vector<int>, 4> bearing_edge_;  ///< patch nodes of edges that something holds, corners included
};

}  // namespace topple::structure
