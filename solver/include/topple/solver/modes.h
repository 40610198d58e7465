#pragma once
// Natural frequencies and modes of a frame with its shells.
#include <array>
#include <stdexcept>
#include <vector>

#include "topple/solver/frame_model.h"
#include "topple/solver/second_order.h"
#include "topple/solver/static_analysis.h"

namespace topple::solver {

/// How elements' own masses reach the nodes: by their shape functions, or in equal parts.
enum class MassDistribution { consistent, lumped };

/// What resists a spin of a beam about its axis, per length: density times the polar moment Iy + Iz, or times J.
enum class TorsionalMass { polar, torsion_constant };

/// Mass at a node beside the elements' own; inertias about the global axes through the node.
struct NodeMass {
  int node = -1;                ///< index in FrameModel::nodes
  double mass = 0;              ///< in all three directions
  Vec3 inertia = Vec3::Zero();  ///< about x, y, z
};

/// How the frame's mass is modelled. Units as in FrameModel.
struct MassModel {
  MassDistribution distribution = MassDistribution::consistent;  ///< of beams and shells
  TorsionalMass torsional = TorsionalMass::polar;                ///< of beams
  /// Rotary inertia of beams' sections in bending, density times Iy and Iz.
  bool rotary_inertia = false;
  std::vector<NodeMass> nodes;  ///< masses beside those of elements
  /// Per beam: the length over which its mass, as great as it is, lies, its ends going with its rigid ends as if they
  /// stood that far apart; 0, or an empty list: its own length.
  std::vector<double> beam_lengths;
  std::vector<JointedShell> jointed;  ///< in order of shells
};

/// One natural mode.
struct VibrationMode {
  double angular_frequency = 0;  ///< rad/s
  /// Effective mass along x, y, z and moment of inertia about x, y, z through the centre of mass, as a share of what is
  /// free to move: over all modes each adds up to 1. 0 where nothing can move.
  std::array<double, 6> mass_share{};
  std::vector<Vec6> shape;  ///< per node; largest translation 1 (largest rotation, where nothing translates)
};

/// Answer of natural_modes().
struct ModalAnswer {
  std::vector<VibrationMode> modes;  ///< lowest first; fewer than asked for when the mass has no more
  Vec3 moving_mass = Vec3::Zero();   ///< along x, y, z: what is free to move
};

/// The lowest modes of K x = omega^2 M x, by block Krylov subspaces of K^-1 M, so that equal frequencies are all found;
/// a Sturm count (negative pivots of K - s M) proves that none is missed. `tangent`: axial forces under which the frame
/// vibrates; null: without load. Throws Instability when K is not stable, std::invalid_argument when there is no mass,
/// std::runtime_error when the iteration does not converge or the count disagrees.
[[nodiscard]] ModalAnswer natural_modes(const FrameModel& model, const MassModel& masses, int count,
                                        const AnalysisOptions& options = {}, const AxialState* tangent = nullptr);

}  // namespace topple::solver
