#pragma once
// A frame model as it stands: what is there of it, and the matrices and forces of its elements, one at a time.
#include <Eigen/Core>
#include <span>
#include <vector>

#include "assembly/dof_map.h"
#include "assembly/element_masses.h"
#include "elements/beam.h"
#include "elements/shell.h"
#include "topple/solver/frame_model.h"
#include "topple/solver/second_order.h"

namespace topple::solver {

class FrameElements {
 public:
  /// All of it stands. Throws std::invalid_argument as checked_model() does.
  explicit FrameElements(FrameModel model);
  FrameElements(const FrameElements&) = delete;
  FrameElements& operator=(const FrameElements&) = delete;

  FrameModel model;
  std::vector<double> beam_factor;  ///< on E and G
  std::vector<char> beam_stands, shell_stands, node_stands;
  /// Axial forces that act on the displaced beams; null: first order. Loads given later must be those of this state.
  const AxialState* second_order = nullptr;
  /// Of a frame that moves: K + factor M takes the place of K. Not with shells that hang on patches. Null: K alone.
  const SystemInertia* inertia = nullptr;

  [[nodiscard]] const DofMap& dofs() const { return dofs_; }

  // Elements are numbered: beams, shells, patches, and one for each node of a diaphragm.
  [[nodiscard]] std::size_t element_of_shell(int shell) const {
    return model.beams.size() + static_cast<std::size_t>(shell);
  }
  [[nodiscard]] std::size_t element_of_patch(int patch) const {
    return model.beams.size() + model.shells.size() + static_cast<std::size_t>(patch);
  }
  /// Those that reach a node, standing or not, in order.
  [[nodiscard]] std::span<const int> elements_of_node(std::size_t node) const { return elements_of_node_[node]; }
  /// Beams of them.
  [[nodiscard]] std::span<const int> beams_of_node(int node) const;
  [[nodiscard]] std::vector<int> shells_of_node(int node) const;
  [[nodiscard]] std::vector<int> patches_of_node(int node) const;
  /// Elements that reach a vertex of the dof map: those of a node, of all nodes of a diaphragm.
  void elements_of_vertex(int vertex, std::vector<int>& elements) const;
  /// Nodes of an element that is no beam.
  [[nodiscard]] std::span<const int> plate_nodes(std::size_t element) const;

  /// Distance of the places where a beam's ends hang: its length, but for beams that are shorter (Frame3DD's radii).
  [[nodiscard]] double ends_apart(int beam) const;
  /// K of a beam in the 12 freedoms of its element (diaphragm arms included), K + factor M with inertia; zero where it
  /// does not stand.
  [[nodiscard]] Mat12 beam_stiffness(int beam) const;
  /// The same for a shell, 24 freedoms.
  [[nodiscard]] Mat24 shell_stiffness(int shell) const;
  /// K of a shell in the global freedoms of its nodes. The last one is kept, as floors repeat one panel. The reference
  /// holds until the next call.
  [[nodiscard]] const Mat24& shell_node_stiffness(int shell) const;
  /// The same for a patch, 6 freedoms for each of its nodes; a node that has left takes its rows along.
  [[nodiscard]] Eigen::MatrixXd patch_stiffness(int patch) const;
  /// K of an element that is no beam, in its freedoms; zero where it does not stand.
  [[nodiscard]] Eigen::MatrixXd plate_stiffness(std::size_t element) const;
  /// Takes a matrix from the freedoms of these nodes to those of their diaphragms.
  void add_diaphragm_arms(std::span<const int> nodes, Eigen::Ref<Eigen::MatrixXd> K) const;
  /// M of a patch that has mass, in the global freedoms of its nodes.
  [[nodiscard]] Eigen::MatrixXd patch_node_mass(std::size_t patch) const;
  /// The same in the freedoms of its element.
  [[nodiscard]] Eigen::MatrixXd patch_mass(std::size_t patch) const;

  [[nodiscard]] FixedEndForces fixed_end_forces(int beam, std::span<const BeamLoad> loads) const;
  [[nodiscard]] Vec12 end_forces(int beam, const std::vector<Vec6>& displacements, const Vec12& fixed_end) const;
  /// Per corner: what the node does to the shell, global; `fixed` as in LoadVector. Of a hanging shell only the part
  /// that its membrane forces have in the second order.
  [[nodiscard]] std::array<Vec6, 4> corner_forces(int shell, const std::vector<Vec6>& displacements,
                                                  const Vec24& fixed) const;
  /// Per node of the patch: what the node does to it, global.
  [[nodiscard]] std::vector<Vec6> patch_forces(int patch, const std::vector<Vec6>& displacements) const;
  /// In the second-order state: null for a shell whose corners are its nodes.
  [[nodiscard]] const JointedShell* jointed(int shell) const;

  /// What stands, and how stiff. The model is archived apart, and given to the constructor; numbers follow from it.
  template <class Archive>
  void serialize(Archive& archive) {
    // Axial state and inertia are the owner's; a shell's stiffness is found again with the same bits.
    auto& [of_model, of_beams, beams_stand, shells_stand, nodes_stand, axial_state, inertia_of_owner, numbers,
           elements_of, kept_stiffness] = *this;
    archive(of_beams, beams_stand, shells_stand, nodes_stand);
  }

 protected:
  /// Takes a model of the same elements and the same numbering in the place of its own; all of it stands, and the
  /// stiffness of each shell is kept as long as its numbers are the same. False for any other, which is left as it was
  /// given.
  [[nodiscard]] bool replace_model(FrameModel& given);

 private:
  /// K of a beam in the local freedoms of its nodes.
  [[nodiscard]] Mat12 rigid_end_stiffness(std::size_t beam) const;
  /// Of the membrane forces in the second-order state; global freedoms of its corners.
  [[nodiscard]] Mat24 shell_geometric_stiffness(int shell) const;
  /// Of a shell's corners, global, by those of all nodes.
  [[nodiscard]] Vec24 corner_displacements(int shell, const std::vector<Vec6>& displacements) const;
  /// K of a patch in the global freedoms of its nodes.
  [[nodiscard]] Eigen::MatrixXd patch_node_stiffness(std::size_t patch) const;
  void leave_out_gone(std::span<const int> nodes, Eigen::MatrixXd& matrix) const;
  [[nodiscard]] std::vector<int> numbers_of_node(int node, std::size_t first, std::size_t count) const;
  [[nodiscard]] bool shells_pushed() const {
    return second_order != nullptr && !second_order->shell_displacements.empty();
  }

  DofMap dofs_;
  std::vector<std::vector<int>> elements_of_node_;
  struct KeptShell {
    Shell shell;
    std::array<Vec3, 4> corners{};
    Mat24 stiffness;
  };
  /// The last one; per shell, where frames follow each other.
  mutable std::vector<KeptShell> kept_shells_ = std::vector<KeptShell>(1);
};

/// The model, or std::invalid_argument with what is wrong in it.
[[nodiscard]] FrameModel checked_model(FrameModel model);

}  // namespace topple::solver
