#pragma once
// Second-order (P-Delta) analysis of a frame: axial forces and the membrane forces of shells act on the displaced
// structure, tension stiffens it, compression softens it. Iterated to convergence, and accepted only where the tangent
// stiffness is positive definite. Displacements stay small: lengths and directions of members are those of the
// undeformed structure.
#include <memory>

#include "topple/solver/beam_diagram.h"
#include "topple/solver/frame_model.h"
#include "topple/solver/jointed_shell.h"
#include "topple/solver/static_analysis.h"

namespace topple::solver {

enum class SecondOrder {
  none,
  /// Consistent geometric stiffness of the cubic shape functions: exact for small N L2/(E I), 1 % off for large ones.
  /// Torsion takes N J/(A L), loads along a member their first-order fixed-end forces.
  cubic,
  /// The beam-column's differential equation itself, shear by Engesser, loads along the member and the change of axial
  /// force under them included: one member for each column is enough. Torsion is not affected.
  exact,
  /// Cubic with Frame3DD's own choices, for comparison with it: the tangent goes with the axial force at each element's
  /// first end; the end forces given are those that it prints, whose geometric part goes with the axial force of the
  /// elastic strain (wrong for heated elements). Displacements and reactions are in equilibrium.
  frame3dd
};

/// The forces that one second-order solution rests on: axial forces of beams, membrane forces of shells.
struct AxialState {
  SecondOrder mode = SecondOrder::none;      ///< that was used
  std::vector<double> first_axial;           ///< per beam: tension at its first end
  std::vector<std::vector<BeamLoad>> loads;  ///< per beam
  /// Shells' membrane forces are `shell_factor` times those of these displacements (per node; empty: none) and free
  /// strains (per shell; empty: none).
  std::vector<Vec6> shell_displacements;
  std::vector<double> shell_strain;   ///< per shell; see shell_displacements
  double shell_factor = 1;            ///< see shell_displacements
  std::vector<JointedShell> jointed;  ///< in order of shells and of patches
};

/// A second-order answer with the forces that it rests on.
struct SecondOrderSolution {
  StaticSolution solution;  ///< displacements, reactions and end forces in the displaced structure
  AxialState axial;         ///< at which the iteration ended
  int iterations = 0;       ///< of the axial forces
};

/// Thrown when the loads are at or beyond what the structure bears before it buckles.
class Buckled : public Instability {
 public:
  /// As Instability's: the motion is the shape in which the structure buckles.
  using Instability::Instability;
};

/// One ordering for any number of load sets; each costs two factorisations where its axial forces settle fast.
class SecondOrderAnalysis {
 public:
  /// Throws Instability where a freedom has no stiffness at all.
  SecondOrderAnalysis(const FrameModel& model, SecondOrder mode, const AnalysisOptions& options = {},
                      std::vector<JointedShell> jointed = {});
  ~SecondOrderAnalysis();
  /// Moves: what is moved from may only be destroyed or assigned to.
  SecondOrderAnalysis(SecondOrderAnalysis&&) noexcept;
  /// Moves, as the constructor does.
  SecondOrderAnalysis& operator=(SecondOrderAnalysis&&) noexcept;

  /// `first_order`: the linear answer to the same loads. Throws Buckled when the structure is not stable under the
  /// loads, std::runtime_error when the axial forces do not settle.
  [[nodiscard]] SecondOrderSolution solve(const LoadSet& loads, const StaticSolution& first_order);
  /// Sizes and times so far.
  [[nodiscard]] const AnalysisStatistics& statistics() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Along one beam in its second-order state: as BeamDiagram, moments with axial force times deflection. For `cubic` the
/// shears are those across the displaced chord and moments lie between the end values as without axial force.
class SecondOrderDiagram {
 public:
  /// `rigid_end_displacements`: of the rigid ends at the beam's ends, local axes.
  SecondOrderDiagram(const Beam& beam, const AxialState& axial, int index, const Vec12& end_forces,
                     const Vec12& rigid_end_displacements);
  ~SecondOrderDiagram();
  /// Moves: what is moved from may only be destroyed or assigned to.
  SecondOrderDiagram(SecondOrderDiagram&&) noexcept;
  /// Moves, as the constructor does.
  SecondOrderDiagram& operator=(SecondOrderDiagram&&) noexcept;
  /// As BeamDiagram's.
  [[nodiscard]] std::array<double, 8> values(double distance, bool beyond = false) const;
  /// As BeamDiagram::breaks().
  [[nodiscard]] std::vector<double> breaks() const;
  /// As BeamDiagram::extremes().
  [[nodiscard]] BeamDiagram::Range extremes(BeamDiagram::Quantity quantity) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Displacements of the rigid ends at a beam's ends (after its arms), local axes, from those of all nodes.
[[nodiscard]] Vec12 beam_rigid_end_displacements(const Beam& beam, const std::vector<Vec6>& node_displacements);

}  // namespace topple::solver
