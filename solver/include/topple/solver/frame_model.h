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
/// tip of its arm is the node that the beam's end is joined to, by its springs and releases.
struct Beam {
  std::array<int, 2> node{-1, -1};  ///< indices in FrameModel::nodes, first and second end
  /// Rigid arm from each node to the member's end, global axes.
  std::array<Vec3, 2> offset{Vec3::Zero(), Vec3::Zero()};
  /// Rows are the local axes x (along the member), y, z in global components.
  Mat3 axes = Mat3::Identity();
  /// Distance between the member's ends (after the rigid arms).
  double length = 0;
  double youngs_modulus = 0;  ///< E
  double shear_modulus = 0;   ///< G
  double area = 0;            ///< of the section
  double shear_area_y = 0;    ///< 0: no shear deformation for forces along local y
  double shear_area_z = 0;    ///< 0: no shear deformation for forces along local z
  double Iy = 0;              ///< about local y: bending in the local x-z plane
  double Iz = 0;              ///< about local z: bending in the local x-y plane
  double J = 0;               ///< Saint-Venant torsion constant
  double density = 0;         ///< for mass matrices only; weight comes in as loads
  /// Stiffness between each end and its node, local components: `rigid`, 0 (released) or a spring.
  std::array<Vec6, 2> end_stiffness{Vec6::Constant(rigid), Vec6::Constant(rigid)};
  AxialAction axial = AxialAction::both;  ///< which sign of axial force it can carry
};

/// Four-node flat shell: membrane with a true drilling freedom and, when `bending`, a plate with shear. Nodes go round
/// (counter-clockwise seen against the normal).
struct Shell {
  std::array<int, 4> node{-1, -1, -1, -1};  ///< indices in FrameModel::nodes
  double youngs_modulus = 0;                ///< E
  double poisson_ratio = 0;                 ///< nu
  double thickness = 0;                     ///< of the plate and membrane
  double density = 0;                       ///< mass per volume, for mass matrices only
  bool bending = false;                     ///< false: a membrane without plate stiffness
};

/// What a support does to one node: per component `rigid` (held), 0 (free) or a spring stiffness, global axes.
struct Support {
  int node = -1;                  ///< index in FrameModel::nodes
  Vec6 stiffness = Vec6::Zero();  ///< x y z rx ry rz
};

/// Nodes that move together as a rigid body in the global x-y plane (x, y, rz).
struct Diaphragm {
  std::vector<int> nodes;  ///< indices in FrameModel::nodes
};

/// Stiffness between any number of nodes, made elsewhere (a superelement condensed to the nodes that others see):
/// symmetric, positive semidefinite, in the six global freedoms of each node in order. It bears no loads of its own.
struct Patch {
  std::vector<int> node;      ///< indices in FrameModel::nodes
  Eigen::MatrixXd stiffness;  ///< square, six rows for each node
  Eigen::MatrixXd mass = {};  ///< the same, symmetric, of what moves (kg, kg m, kg m2); empty: it has none
};

/// All that the solver is given of a structure. Indices point into these arrays.
struct FrameModel {
  std::vector<Vec3> nodes;            ///< positions, global axes
  std::vector<Beam> beams;            ///< beam-columns
  std::vector<Shell> shells;          ///< four-node shells
  std::vector<Support> supports;      ///< held or sprung nodes
  std::vector<Diaphragm> diaphragms;  ///< floors that are rigid in their plane
  /// Of shells whose stiffness comes from elsewhere (a superelement condensed to their nodes), by index: symmetric,
  /// positive semidefinite, in the global freedoms of the four nodes.
  std::map<int, Eigen::Matrix<double, 24, 24>> shell_stiffness;
  std::vector<Patch> patches;  ///< stiffness made elsewhere
};

/// Load on one beam in its local axes. Distances are from the beam's first end (after its arm).
struct BeamLoad {
  /// What acts: a line load, a load at a place, or a temperature.
  enum class Kind { distributed, point, temperature };
  int beam = -1;                  ///< index in FrameModel::beams
  Kind kind = Kind::distributed;  ///< which of the members below count
  double from = 0;                ///< distance from the first end
  double to = 0;                  ///< distributed: extent; point: `from` is the place
  Vec6 first = Vec6::Zero();      ///< line load at `from`; load at a point; temperature: kink (rad) at the first end
  Vec6 last = Vec6::Zero();       ///< line load at `to`, linear between; temperature: kink at the second end
  double strain = 0;              ///< temperature: free axial strain alpha dT
  double curvature_y = 0;         ///< temperature: alpha dT/dy, free curvature from a gradient along local y
  double curvature_z = 0;         ///< temperature: alpha dT/dz
};

/// Load on one node.
struct NodeLoad {
  int node = -1;             ///< index in FrameModel::nodes
  Vec6 load = Vec6::Zero();  ///< global axes
};

/// Uniform traction on a shell, global axes, force per area; and a free in-plane strain (alpha dT).
struct ShellLoad {
  int shell = -1;                ///< index in FrameModel::shells
  Vec3 traction = Vec3::Zero();  ///< force per area, global axes
  double strain = 0;             ///< free strain in the plane, alpha dT
};

/// Displacement imposed on a supported freedom (a settlement), global axes.
struct Settlement {
  int node = -1;      ///< index in FrameModel::nodes
  int component = 0;  ///< 0 to 5: x y z rx ry rz
  double value = 0;   ///< length, or rad
};

/// One right-hand side.
struct LoadSet {
  std::vector<NodeLoad> nodes;          ///< loads on nodes
  std::vector<BeamLoad> beams;          ///< loads on beams
  std::vector<ShellLoad> shells;        ///< loads on shells
  std::vector<Settlement> settlements;  ///< displacements imposed on supports
};

}  // namespace topple::solver
