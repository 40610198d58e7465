#pragma once
// A patch of shells of which only a few nodes are seen from outside: everything else is condensed out, exactly (static
// condensation, R. J. Guyan, AIAA Journal 3 (1965), 380; without mass there is no approximation). Elements can be taken
// out; then this patch alone is condensed anew.
#include <Eigen/Core>
#include <array>
#include <memory>
#include <span>
#include <vector>

#include "topple/solver/frame_model.h"

namespace topple::solver {

/// The condensed patch. Lengths, forces and angles in the units of its nodes and shells.
class Superelement {
 public:
  /// A node that moves with two kept ones: (1 - share) of the first and share of the second (places in `kept`).
  struct Tie {
    int node = -1;              ///< of the patch, not kept
    std::array<int, 2> kept{};  ///< places in Patch::kept
    double share = 0;           ///< 0 to 1
    bool turns = true;          ///< false: it turns as it likes
  };
  /// The patch before it is condensed. Indices point into `nodes`.
  struct Patch {
    std::vector<Vec3> nodes;        ///< positions, global axes
    std::vector<Shell> shells;      ///< with `node` into `nodes`
    std::vector<Support> supports;  ///< of nodes that are not kept
    std::vector<int> kept;          ///< nodes seen from outside
    std::vector<Tie> ties;          ///< of nodes that are not kept
  };
  /// `gone`: shells that are not there from the beginning. Throws std::invalid_argument for a kept node that does not
  /// exist, a shell that the formulas cannot use, and a patch that can move by itself while its kept nodes rest.
  explicit Superelement(Patch patch, std::span<const int> gone = {});
  /// From then on each loses its own shells. What does not change is shared: a copy costs far less than a new one.
  Superelement(const Superelement& other);
  ~Superelement();
  /// Moves: what is moved from may only be destroyed or assigned to.
  Superelement(Superelement&&) noexcept;
  /// Moves, as the constructor does.
  Superelement& operator=(Superelement&&) noexcept;

  /// Takes these shells out for good and condenses anew. So are shells that hang on nothing any more: on no kept, tied
  /// or supported node.
  void remove(std::span<const int> shells);
  /// Of each shell that stands only this share of its material is left, somewhere in it: its stiffness goes with it
  /// (as in the finite cell method, J. Parvizian, A. Duester, E. Rank, Computational Mechanics 41 (2007), 121). 0 takes
  /// it out. Throws std::invalid_argument unless there is a share from 0 to 1 for each shell.
  void keep(const std::vector<double>& share);
  /// False for a shell that was removed, or of which nothing is left.
  [[nodiscard]] bool stands(int shell) const;
  /// True while a shell stands at a node.
  [[nodiscard]] bool has_shells(int node) const;

  /// In the six freedoms of each kept node, global.
  [[nodiscard]] const Eigen::MatrixXd& stiffness() const;
  /// Loads on all nodes of the patch as loads on the kept ones.
  [[nodiscard]] Eigen::VectorXd condense(const std::vector<Vec6>& loads) const;
  /// Displacements of all nodes; zero where nothing stands.
  [[nodiscard]] std::vector<Vec6> recover(const Eigen::VectorXd& kept, const std::vector<Vec6>& loads) const;
  /// Displacements of all nodes (six rows each, global) for a unit of each freedom of the kept ones, without loads.
  [[nodiscard]] Eigen::MatrixXd shapes() const;
  /// What would have to act on each node, beside the loads, to keep it at these displacements: reactions of supports
  /// and of what holds the kept nodes; rounding elsewhere.
  [[nodiscard]] std::vector<Vec6> reactions(const std::vector<Vec6>& displacements,
                                            const std::vector<Vec6>& loads) const;
  /// As it was given.
  [[nodiscard]] const Patch& patch() const;

 private:
  struct Plan;
  struct State;
  std::unique_ptr<State> state_;
};

/// Consistent mass of a shell in the freedoms of its four nodes (kg, kg m, kg m2; global axes) for `per_area` (kg/m2):
/// by the bilinear shapes of its translations, and the rotary inertia of its thickness t, per_area t2/12: of rotations
/// about axes in its plane (R. D. Mindlin, Journal of Applied Mechanics 18 (1951), 31), and of drilling rotations
/// beyond the mean rotation of the plane, so that no freedom is without inertia and rigid motions have the plate's own.
[[nodiscard]] Eigen::Matrix<double, 24, 24> shell_mass(const FrameModel& model, int shell, double per_area);
/// Forces at a shell's nodes that do the work of a traction (global, per area).
[[nodiscard]] std::array<Vec6, 4> traction_loads(const FrameModel& model, int shell, const Vec3& traction);

}  // namespace topple::solver
