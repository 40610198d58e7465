#pragma once
// The equations of a frame model as it stands: assembly from what is there, right-hand sides, recovery of forces. What
// is solved is the scaled matrix S K S, S a diagonal of powers of two that brings every diagonal entry near 1:
// translations and rotations compare, and no digit is touched.
#include <Eigen/Core>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "assembly/assembly_map.h"
#include "assembly/dof_map.h"
#include "assembly/element_masses.h"
#include "elements/beam.h"
#include "elements/shell.h"
#include "topple/solver/frame_model.h"
#include "topple/solver/second_order.h"
#include "topple/solver/static_analysis.h"

namespace topple::solver {

/// Why a model cannot stand, found without factorising.
struct Defect {
  std::string message;
  Mechanism motion;
};
/// Throws it as Instability, where there is one.
void require_none(const std::optional<Defect>& defect);

/// One right-hand side, not scaled, with what recovery needs again.
struct LoadVector {
  Eigen::VectorXd force;              ///< per equation, then per held freedom
  Eigen::VectorXd held_displacement;  ///< per held freedom
  std::vector<Vec12> beam_fixed_end;  ///< per beam, local axes; empty when no beam is loaded
  std::vector<Vec24> shell_fixed;     ///< per shell, global; empty when no shell is loaded
  std::vector<Vec6> node_load;        ///< per node, as given; empty when none
  std::vector<int> unbalanced_beams;  ///< loaded in a motion that nothing resists
};

class FrameSystem {
 public:
  explicit FrameSystem(FrameModel model);
  FrameSystem(const FrameSystem&) = delete;
  FrameSystem& operator=(const FrameSystem&) = delete;

  /// Takes a model of the same elements between the same nodes, held in the same freedoms, whose numbers are others, in
  /// the place of its own: numbering and pattern stay; what comes next is assemble(). False for any other model, which
  /// is left as it was given. Throws std::invalid_argument as the constructor does. From then on the stiffness of each
  /// shell is kept as long as its numbers are the same.
  [[nodiscard]] bool take_numbers(FrameModel& given);

  // What stands. After a change call reassemble() with the nodes that it touched; a support may only change between
  // springs.
  FrameModel model;
  std::vector<double> beam_factor;  ///< on E and G
  std::vector<char> beam_stands, shell_stands, node_stands;
  /// Axial forces that act on the displaced beams; null: first order. Loads given later must be those of this state.
  const AxialState* second_order = nullptr;
  /// Of a frame that moves: the matrix is K + factor M, and M is kept beside it. To be set before assemble(); not with
  /// shells that hang on patches. Null: K alone.
  const SystemInertia* inertia = nullptr;

  [[nodiscard]] const DofMap& dofs() const { return dofs_; }
  [[nodiscard]] const AssemblyMap& assembly_map() const { return assembly_map_; }
  [[nodiscard]] const SparseSymmetric& matrix() const { return matrix_; }
  [[nodiscard]] std::span<const double> scale() const { return scale_; }
  /// M in the scaled equations, on the same pattern; without inertia its values are not there.
  [[nodiscard]] const SparseSymmetric& mass() const { return mass_; }

  /// Beams that reach a node, standing or not, in order.
  [[nodiscard]] std::span<const int> beams_of_node(int node) const;
  [[nodiscard]] std::vector<int> shells_of_node(int node) const;
  [[nodiscard]] std::vector<int> patches_of_node(int node) const;
  /// Elements (numbers of the assembly map) that reach a vertex: those of a node, of all nodes of a diaphragm.
  void elements_of_vertex(int vertex, std::vector<int>& elements) const;
  /// Elimination order of the equations: nodes by nested dissection, the equations of a node together.
  [[nodiscard]] std::vector<int> elimination_order() const;
  /// Assembles everything and sets the scale; the same to the bit on any number of threads.
  void assemble(int threads = 1);
  /// Assembles anew every entry in the rows and columns of these nodes (and the diaphragms they belong to); the scale
  /// stays.
  void reassemble(std::span<const int> nodes);
  /// Freedoms without any stiffness, beams that can move by themselves; of the whole, or of these nodes and their
  /// beams.
  [[nodiscard]] std::optional<Defect> defect() const;
  [[nodiscard]] std::optional<Defect> defect(std::span<const int> nodes) const;

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
  /// Takes a matrix from the freedoms of these nodes to those of their diaphragms.
  void add_diaphragm_arms(std::span<const int> nodes, Eigen::Ref<Eigen::MatrixXd> K) const;
  /// K of an element that is no beam, by its number in the assembly map, in its freedoms; zero where it does not stand.
  [[nodiscard]] Eigen::MatrixXd plate_stiffness(std::size_t element) const;
  /// Numbers in the assembly map.
  [[nodiscard]] std::size_t element_of_shell(int shell) const {
    return model.beams.size() + static_cast<std::size_t>(shell);
  }
  [[nodiscard]] std::size_t element_of_patch(int patch) const {
    return model.beams.size() + model.shells.size() + static_cast<std::size_t>(patch);
  }
  /// Nodes of an element that is no beam.
  [[nodiscard]] std::span<const int> plate_nodes(std::size_t element) const;
  /// What a node has besides its elements (support springs, held inert motions), in its six components, not scaled.
  [[nodiscard]] Mat6 supports_and_inert_motions(int node) const;
  using NodeMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, 6>;
  /// The same, scaled, in the node's own equations. For nodes of no diaphragm.
  [[nodiscard]] NodeMatrix own_stiffness(int node) const;

  [[nodiscard]] LoadVector load_vector(const LoadSet& loads) const;
  /// Several at once: what they share of the elements is worked out once.
  [[nodiscard]] std::vector<LoadVector> load_vectors(std::span<const LoadSet> sets) const;
  /// A moment on a node that nothing keeps from turning, or a load on a loose part; empty when there is none. A moment
  /// counts as none when the largest force would make it with a lever of this share of the longest beam.
  [[nodiscard]] std::optional<Defect> unbalanced_load(const LoadVector& load, double lever_share = 0) const;
  /// Takes away the moments on nodes that nothing keeps from turning: as if each node had turned until they are none.
  /// Of a frame that moves also the forces in directions with neither stiffness nor mass.
  void drop_idle_loads(LoadVector& load) const;
  /// Sets a motion (scaled equations) to zero in the directions in which a node has neither stiffness nor mass.
  void drop_idle_motion(Eigen::VectorXd& scaled) const;

  [[nodiscard]] FixedEndForces fixed_end_forces(int beam, std::span<const BeamLoad> loads) const;
  /// Adds the reverse of a beam's fixed-end forces to the right-hand side of the equations.
  void add_fixed_end(int beam, const Vec12& fixed_end, Eigen::VectorXd& force) const;
  /// A spring that takes the place of a support's; rigid components stay. Call reassemble() with its node.
  void set_support(int support, const Vec6& stiffness);

  /// Per node, from the displacements of the equations (not scaled) and those of held freedoms.
  [[nodiscard]] std::vector<Vec6> node_displacements(const Eigen::VectorXd& displacement,
                                                     const Eigen::VectorXd& held) const;
  /// The same from the scaled solution of the equations, with nothing held displaced; into a vector with a place for
  /// each node.
  void node_displacements_of_scaled(const Eigen::VectorXd& solution, std::vector<Vec6>& result) const;
  [[nodiscard]] Vec6 node_displacement_of_scaled(int node, const Eigen::VectorXd& solution) const;
  /// A vector of scaled equations as a shape: its largest translation 1 (rotation, where nothing translates), and the
  /// first component of that size positive.
  [[nodiscard]] std::vector<Vec6> shape(const Eigen::VectorXd& scaled) const;
  [[nodiscard]] Vec12 end_forces(int beam, const std::vector<Vec6>& displacements, const Vec12& fixed_end) const;
  /// Displacements, forces and reactions of several right-hand sides, the solution of each (not scaled) in a column.
  /// Their quality is left to the caller. The loads' `beam_fixed_end` are used up.
  [[nodiscard]] std::vector<StaticSolution> recover(std::span<LoadVector> loads, const Eigen::MatrixXd& displacements,
                                                    int threads = 1) const;
  /// Per corner: what the node does to the shell, global; `fixed` as in LoadVector. Of a hanging shell only the part
  /// that its membrane forces have in the second order.
  [[nodiscard]] std::array<Vec6, 4> corner_forces(int shell, const std::vector<Vec6>& displacements,
                                                  const Vec24& fixed) const;
  /// M of a patch that has mass, in the global freedoms of its nodes.
  [[nodiscard]] Eigen::MatrixXd patch_node_mass(std::size_t patch) const;
  /// The same in the freedoms of its element.
  [[nodiscard]] Eigen::MatrixXd patch_mass(std::size_t patch) const;
  /// Per node of the patch: what the node does to it, global.
  [[nodiscard]] std::vector<Vec6> patch_forces(int patch, const std::vector<Vec6>& displacements) const;
  /// Per support: what it does to the structure.
  [[nodiscard]] std::vector<Vec6> reactions(const std::vector<Vec6>& displacements,
                                            const std::vector<Vec12>& beam_end_forces,
                                            const std::vector<std::array<Vec6, 4>>& shell_corner_forces,
                                            const std::vector<Vec6>& node_loads) const;

 private:
  /// K of a beam in the local freedoms of its nodes.
  [[nodiscard]] Mat12 rigid_end_stiffness(std::size_t beam) const;
  void add_element(std::size_t element, const std::vector<char>& wanted);
  void add_beams(int threads);
  void want_node(int node);
  void want_vertices_of(std::span<const int> nodes);
  void finish_node(int node);
  void finish_diaphragms(const std::vector<char>& wanted);
  void add_support_springs(int node);
  /// Springs of the node's supports, and with inertia factor times its own masses.
  [[nodiscard]] Vec6 own_springs(int node) const;
  void add_element_mass(std::size_t element, const std::vector<char>& wanted);
  void add_node_mass(int node);
  void add_diagonal(int node, const Vec6& diagonal, SparseSymmetric& matrix) const;
  enum class Motion : std::size_t { translation, rotation };
  void hold_inert_motions(int node, Motion kind);
  void forget_inert_motions(std::size_t node);
  /// Takes away the parts of a vector of forces (not scaled) or scaled displacements along the inert directions.
  void drop_idle(Motion kind, std::size_t node, std::span<const double> scale, Eigen::VectorXd& values) const;
  void set_scale();
  [[nodiscard]] std::optional<Defect> defect(std::span<const int> nodes, std::span<const int> beams) const;
  [[nodiscard]] std::optional<Defect> unheld_freedoms(std::span<const int> nodes) const;
  [[nodiscard]] std::optional<Defect> loose_beams(std::span<const int> beams) const;
  /// Of the membrane forces in the second-order state; global freedoms of its corners.
  [[nodiscard]] Mat24 shell_geometric_stiffness(int shell) const;
  /// In the second-order state: null for a shell whose corners are its nodes.
  [[nodiscard]] const JointedShell* jointed(int shell) const;
  /// Of a shell's corners, global, by those of all nodes.
  [[nodiscard]] Vec24 corner_displacements(int shell, const std::vector<Vec6>& displacements) const;
  /// K of a patch in the global freedoms of its nodes.
  [[nodiscard]] Eigen::MatrixXd patch_node_stiffness(std::size_t patch) const;
  void leave_out_gone(std::span<const int> nodes, Eigen::MatrixXd& matrix) const;
  [[nodiscard]] std::vector<int> numbers_of_node(int node, std::size_t first, std::size_t count) const;
  [[nodiscard]] bool shells_pushed() const {
    return second_order != nullptr && !second_order->shell_displacements.empty();
  }
  void add_node_loads(const std::vector<NodeLoad>& loads, LoadVector& result) const;
  void add_beam_loads(std::span<const LoadSet> sets, std::vector<LoadVector>& result) const;
  void add_shell_loads(const std::vector<ShellLoad>& loads, LoadVector& result) const;
  void add_settlement_forces(LoadVector& result) const;
  [[nodiscard]] double& entry(int equation, int other);
  void clear_mass(std::span<const int> nodes, std::span<const int> elements);
  void scale_mass();
  void add_diaphragm_reactions(const std::vector<Vec6>& residual, std::vector<Vec6>& held_reaction) const;
  [[nodiscard]] Eigen::VectorXd held_displacements(std::span<const Settlement> settlements) const;

  std::vector<Vec6> support_;
  DofMap dofs_;
  AssemblyMap assembly_map_;
  std::vector<std::vector<int>> elements_of_node_;
  SparseSymmetric matrix_, mass_;
  std::vector<double> scale_;
  /// Directions in which a node moves without straining anything (columns), held at zero.
  struct InertNode {
    int count = 0;
    double stiffness = 0;
    Mat3 directions = Mat3::Zero();
  };
  std::array<std::vector<InertNode>, 2> inert_;  ///< per Motion and node
  std::array<int, 2> inert_nodes_{};             ///< with a count above 0
  // Scratch of reassemble() and defect(): what changes once a break must not ask for memory.
  std::vector<char> wanted_;  ///< per vertex; all 0 between calls
  std::vector<int> wanted_nodes_, wanted_elements_;
  mutable std::vector<int> judged_nodes_, judged_beams_;
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

/// "node 3, node 7 and 12 more".
[[nodiscard]] std::string list_nodes(std::span<const int> nodes);

}  // namespace topple::solver
