#pragma once
// The equations of a frame model as it stands: assembly from what is there. What
// is solved is the scaled matrix S K S, S a diagonal of powers of two that brings every diagonal entry near 1:
// translations and rotations compare, and no digit is touched.
#include <Eigen/Core>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "assembly/assembly_map.h"
#include "assembly/frame_elements.h"
#include "assembly/inert_motions.h"
#include "topple/solver/frame_model.h"
#include "topple/solver/static_analysis.h"

namespace topple::solver {

/// Why a model cannot stand, found without factorising.
struct Defect {
  std::string message;
  Mechanism motion;
  template <class Archive>
  void serialize(Archive& archive) {
    auto& [what, moves] = *this;
    archive(what, moves);
  }
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
  template <class Archive>
  void serialize(Archive& archive) {
    auto& [on_equations, imposed, of_beams, of_shells, on_nodes, unbalanced] = *this;
    archive(on_equations, imposed, of_beams, of_shells, on_nodes, unbalanced);
  }
};

class FrameSystem : public FrameElements {
 public:
  explicit FrameSystem(FrameModel model);

  /// Takes a model of the same elements between the same nodes, held in the same freedoms, whose numbers are others, in
  /// the place of its own: numbering and pattern stay; what comes next is assemble(). False for any other model, which
  /// is left as it was given. Throws std::invalid_argument as the constructor does. From then on the stiffness of each
  /// shell is kept as long as its numbers are the same.
  [[nodiscard]] bool replace_numbers(FrameModel& given);

  // After a change of what stands call reassemble() with the nodes that it touched; a support may only change between
  // springs. Inertia is to be set before assemble().
  [[nodiscard]] const AssemblyMap& assembly_map() const { return assembly_map_; }
  [[nodiscard]] const SparseSymmetric& matrix() const { return matrix_; }
  [[nodiscard]] std::span<const double> scale() const { return scale_; }
  /// M in the scaled equations, on the same pattern; without inertia its values are not there.
  [[nodiscard]] const SparseSymmetric& mass() const { return mass_; }
  /// Stiffness of all supports of a node together (rigid wins, springs add).
  [[nodiscard]] const Vec6& support_at(std::size_t node) const { return support_[node]; }

  /// Elimination order of the equations: nodes by nested dissection, the equations of a node together.
  [[nodiscard]] std::vector<int> elimination_order() const;
  /// Assembles everything and sets the scale; the same to the bit on any number of threads.
  void assemble(int threads = 1);
  /// Assembles anew every entry in the rows and columns of these nodes (and the diaphragms they belong to); the scale
  /// stays.
  void reassemble(std::span<const int> nodes);
  /// A spring that takes the place of a support's; rigid components stay. Call reassemble() with its node.
  void set_support(int support, const Vec6& stiffness);
  /// Freedoms without any stiffness, beams that can move by themselves; of the whole, or of these nodes and their
  /// beams.
  [[nodiscard]] std::optional<Defect> defect() const;
  [[nodiscard]] std::optional<Defect> defect(std::span<const int> nodes) const;

  /// What a node has besides its elements (support springs, held inert motions), in its six components, not scaled.
  [[nodiscard]] Mat6 supports_and_inert_motions(int node) const;
  using NodeMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, 6>;
  /// The same, scaled, in the node's own equations. For nodes of no diaphragm.
  [[nodiscard]] NodeMatrix own_stiffness(int node) const;

  /// A moment on a node that nothing keeps from turning, or a load on a loose part; empty when there is none. A moment
  /// counts as none when the largest force would make it with a lever of this share of the longest beam.
  [[nodiscard]] std::optional<Defect> unbalanced_load(const LoadVector& load, double lever_share = 0) const;
  /// Takes away the moments on nodes that nothing keeps from turning: as if each node had turned until they are none.
  /// Of a frame that moves also the forces in directions with neither stiffness nor mass.
  void drop_idle_loads(LoadVector& load) const { inert_.drop(dofs(), {}, load.force); }
  /// Sets a motion (scaled equations) to zero in the directions in which a node has neither stiffness nor mass.
  void drop_idle_motion(Eigen::VectorXd& scaled) const { inert_.drop(dofs(), scale_, scaled); }

  /// Per node, from the scaled solution of the equations, with nothing held displaced; into a vector with a place for
  /// each node.
  void node_displacements_of_scaled(const Eigen::VectorXd& solution, std::vector<Vec6>& result) const;
  [[nodiscard]] Vec6 node_displacement_of_scaled(int node, const Eigen::VectorXd& solution) const;

  /// Of a system of the same model, with the same inertia. What its own members are not named for follows from the
  /// model (supports, pattern), or is scratch.
  template <class Archive>
  void serialize(Archive& archive) {
    FrameElements::serialize(archive);
    bool has_mass = !mass_.start.empty();
    archive(matrix_.value, scale_, inert_, has_mass);
    if (has_mass && mass_.start.empty()) mass_ = assembly_map_.empty_matrix();
    if (has_mass) archive(mass_.value);
  }

 private:
  void add_element(std::size_t element, const std::vector<char>& wanted);
  void add_beams(int threads);
  void request_node(int node);
  void request_vertices_of(std::span<const int> nodes);
  void finish_node(int node);
  void finish_diaphragms(const std::vector<char>& wanted);
  /// Springs of the node's supports, and with inertia factor times its own masses.
  [[nodiscard]] Vec6 own_springs(int node) const;
  void add_element_mass(std::size_t element, const std::vector<char>& wanted);
  void add_diagonal(int node, const Vec6& diagonal, SparseSymmetric& matrix) const;
  void hold_inert_motions(int node, InertMotions::Kind kind);
  void set_scale();
  [[nodiscard]] std::optional<Defect> defect(std::span<const int> nodes, std::span<const int> beams) const;
  [[nodiscard]] std::optional<Defect> unheld_freedoms(std::span<const int> nodes) const;
  [[nodiscard]] std::optional<Defect> loose_beams(std::span<const int> beams) const;
  [[nodiscard]] double& entry(int equation, int other);
  void clear_mass(std::span<const int> nodes, std::span<const int> elements);
  void scale_mass();

  std::vector<Vec6> support_;
  AssemblyMap assembly_map_;
  SparseSymmetric matrix_, mass_;
  std::vector<double> scale_;
  InertMotions inert_;
  // Scratch of reassemble() and defect(): what changes once a break must not ask for memory.
  std::vector<char> wanted_;  ///< per vertex; all 0 between calls
  std::vector<int> wanted_nodes_, wanted_elements_;
  mutable std::vector<int> judged_nodes_, judged_beams_;
};

/// "node 3, node 7 and 12 more".
[[nodiscard]] std::string list_nodes(std::span<const int> nodes);

}  // namespace topple::solver
