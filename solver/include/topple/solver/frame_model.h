#pragma once
// What the solver analyses: nodes, beam-columns, flat shells and supports as plain arrays. It knows no buildings:
// members, joints, load cases and names are the business of the layer above. Units: any consistent set (Topple uses
// SI).
#include <array>
#include <map>
#include <vector>

#include "topple/solver/types.h"

namespace topple::solver {

/// Which axial forces a member can carry.
enum class AxialAction { both, tension_only, compression_only };

/// 3D Timoshenko beam-column between two nodes: 12 freedoms, rigid end arms, end releases and springs condensed
/// exactly. With shear area 0 the beam is Euler-Bernoulli in that plane. What moves with a node as a rigid body at the
/// tip of its arm is the hub that the beam's end is joined to, by its springs and releases.
struct Beam {
  std::array<int, 2> node{-1, -1};
  /// Rigid arm from each node to the member's end, global axes.
  std::array<Vec3, 2> offset{Vec3::Zero(), Vec3::Zero()};
  /// Rows are the local axes x (along the member), y, z in global components.
  Mat3 axes = Mat3::Identity();
  /// Distance between the member's ends (after the rigid arms).
  double length = 0;
  double youngs_modulus = 0, shear_modulus = 0;
  double area = 0;
  double shear_area_y = 0, shear_area_z = 0;  ///< 0: no shear deformation for forces along local y (z)
  double Iy = 0;                              ///< about local y: bending in the local x-z plane
  double Iz = 0;                              ///< about local z: bending in the local x-y plane
  double J = 0;                               ///< Saint-Venant torsion constant
  double density = 0;                         ///< for mass matrices only; weight comes in as loads
  /// Stiffness between each end and its node, local components: `rigid`, 0 (released) or a spring.
  std::array<Vec6, 2> end_stiffness{Vec6::Constant(rigid), Vec6::Constant(rigid)};
  AxialAction axial = AxialAction::both;
};

/// Four-node flat shell: membrane with a true drilling freedom and, when `bending`, a plate with shear. Nodes go round
/// (counter-clockwise seen against the normal).
struct Shell {
  std::array<int, 4> node{-1, -1, -1, -1};
  double youngs_modulus = 0, poisson_ratio = 0, thickness = 0, density = 0;
  bool bending = false;
};

/// What a support does to one node: per component `rigid` (held), 0 (free) or a spring stiffness, global axes.
struct Support {
  int node = -1;
  Vec6 stiffness = Vec6::Zero();
};

/// Nodes that move together as a rigid body in the global x-y plane (x, y, rz).
struct Diaphragm {
  std::vector<int> nodes;
};

/// Stiffness between any number of nodes, made elsewhere (a superelement condensed to the nodes that others see):
/// symmetric, positive semidefinite, in the six global freedoms of each node in order. It bears no loads of its own.
struct Patch {
  std::vector<int> node;
  Eigen::MatrixXd stiffness;
};

struct FrameModel {
  std::vector<Vec3> nodes;
  std::vector<Beam> beams;
  std::vector<Shell> shells;
  std::vector<Support> supports;
  std::vector<Diaphragm> diaphragms;
  /// Of shells whose stiffness comes from elsewhere (a superelement condensed to their nodes), by index: symmetric,
  /// positive semidefinite, in the global freedoms of the four nodes.
  std::map<int, Eigen::Matrix<double, 24, 24>> shell_stiffness;
  std::vector<Patch> patches;
};

/// Load on one beam in its local axes. Distances are from the beam's first end (after its arm).
struct BeamLoad {
  enum class Kind { distributed, point, temperature };
  int beam = -1;
  Kind kind = Kind::distributed;
  double from = 0, to = 0;    ///< distributed: extent; point: `from` is the place
  Vec6 first = Vec6::Zero();  ///< distributed: intensity at `from` (force, moment per length); point: the load
  Vec6 last = Vec6::Zero();   ///< distributed: intensity at `to`, linear between
  double strain = 0;          ///< temperature: free axial strain alpha dT
  double curvature_y = 0;     ///< temperature: alpha dT/dy, free curvature from a gradient along local y
  double curvature_z = 0;     ///< temperature: alpha dT/dz
};

struct NodeLoad {
  int node = -1;
  Vec6 load = Vec6::Zero();  ///< global axes
};

/// Uniform traction on a shell, global axes, force per area; and a free in-plane strain (alpha dT).
struct ShellLoad {
  int shell = -1;
  Vec3 traction = Vec3::Zero();
  double strain = 0;
};

/// Displacement imposed on a supported freedom (a settlement), global axes.
struct Settlement {
  int node = -1;
  int component = 0;
  double value = 0;
};

/// One right-hand side.
struct LoadSet {
  std::vector<NodeLoad> nodes;
  std::vector<BeamLoad> beams;
  std::vector<ShellLoad> shells;
  std::vector<Settlement> settlements;
};

}  // namespace topple::solver
