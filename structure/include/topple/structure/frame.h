#pragma once
// From the building to the solver's arrays: the frame model, the loads of a combination kept apart by the part that
// brings them, and what panels hand to the members along their edges.
#include <array>
#include <vector>

#include "topple/solver/frame_model.h"
#include "topple/structure/building.h"

namespace topple::structure {

/// One of the beams of a member that is divided at the nodes of a mesh.
struct MemberPiece {
  int beam = -1;     ///< index in FrameModel::beams
  double start = 0;  ///< distance of its first end from the member's
};

/// Elements of one shell panel; element k is shell `first_shell` + k.
struct PanelMesh {
  int first_shell = -1;                        ///< index in FrameModel::shells; -1: the panel is no shell
  std::vector<std::array<int, 4>> elements;    ///< frame nodes, counter-clockwise against the panel's normal
  std::array<std::vector<int>, 4> edge_nodes;  ///< frame nodes along edge i, from the panel's node i to i + 1
};

/// The panel's side of a joint that gives at one node of an edge. Its six freedoms are its motion against `rigid_end`,
/// along the columns of `translations` and about those of `rotations`.
struct SemiRigidNode {
  int node = -1;                         ///< of the frame, with its freedoms
  int rigid_end = -1;                    ///< node of the frame that it moves against
  Mat3 translations = Mat3::Identity();  ///< columns: unit directions, global
  Mat3 rotations = Mat3::Identity();     ///< columns: unit axes, global
};
/// An element of a shell panel with a corner at a joint that gives: a patch over its four nodes and the semi-rigid
/// ones. The shell of the same number is left for its mass.
struct SemiRigidElement {
  int shell = -1;                                      ///< index in FrameModel::shells
  std::array<int, 4> semi_rigid_node{-1, -1, -1, -1};  ///< of each corner, in Frame::semi_rigid_nodes
  Eigen::Matrix<double, 24, 24> stiffness;             ///< in the absolute freedoms of its corners
};

/// Node i of the building is node i of the frame, support i is support i; nodes of meshes and supports of panel edges
/// come after them. Member i is beam i, or the first of its pieces. Panels of model `membrane` become shells without
/// bending while all four edge joints hold: `shell_of_panel` gives their index, or -1.
struct Frame {
  solver::FrameModel model;                           ///< nodes, beams, shells and supports
  std::vector<int> shell_of_panel;                    ///< per panel
  std::vector<PanelMesh> meshes;                      ///< per panel; without elements when it is no shell
  std::vector<std::vector<MemberPiece>> pieces;       ///< per member, in order; empty when it is one beam
  std::vector<std::vector<int>> edge_supports;        ///< per Building::edge_supports: supports of the frame
  std::vector<SemiRigidNode> semi_rigid_nodes;        ///< their nodes and supports come last
  std::vector<SemiRigidElement> semi_rigid_elements;  ///< in order of their shells
};
/// Throws InputError for openings that leave nothing of a shell panel.
[[nodiscard]] Frame make_frame(const Building& building);

/// What acts on a panel as a whole in one combination.
struct PanelAction {
  Vec3 body_force = Vec3::Zero();  ///< self weight: force per area of panel, global
  double pressure = 0;             ///< per area, against the normal
  double strain = 0;               ///< alpha dT
};

/// One combination's loads, factors included, by the part that carries them.
struct PartLoads {
  std::vector<std::vector<solver::BeamLoad>> members;  ///< per member: self weight and member loads, local axes
  std::vector<PanelAction> panels;                     ///< per panel
  std::vector<Vec6> nodes;                             ///< per node, global
  std::vector<solver::Settlement> settlements;         ///< of supports, global
};
/// Loads in the frame `projected` count each component per length of the member seen along that global axis; moments
/// always per length of member.
[[nodiscard]] PartLoads part_loads(const Building& building, CombinationId combination);

/// Members along each edge of each panel: the member between its two nodes, or the collinear ones between them in
/// order; empty where an edge has none. Built once.
class EdgeMembers {
 public:
  /// Throws nothing. The building's nodes and members must not change afterwards.
  explicit EdgeMembers(const Building& building);
  /// In order along the edge (0 to 3), from its first node.
  [[nodiscard]] const std::vector<MemberId>& of(PanelId panel, int edge) const {
    return members_[4 * static_cast<std::size_t>(panel.index) + static_cast<std::size_t>(edge)];
  }

 private:
  std::vector<std::vector<MemberId>> members_;
};

/// What a membrane or cladding panel hands on, given which of its edge joints hold and which members still stand
/// (`member_stands` empty: all). Force and moments are those of the panel's action, exactly.
struct TributaryLoads {
  std::vector<solver::BeamLoad> beams;  ///< with `beam` the member's number
  std::vector<solver::NodeLoad> nodes;  ///< global axes
  std::array<Vec3, 4> edge_force;       ///< resultant over each edge, global (the demand of the edge joints)
};
/// Nothing is handed over when no opposite pair of edges holds (the panel leaves), nor by a shell.
[[nodiscard]] TributaryLoads tributary_loads(const Building& building, const EdgeMembers& edges, PanelId panel,
                                             const PanelAction& action, const std::array<bool, 4>& edge_holds,
                                             const std::vector<bool>& member_stands = {});

/// The whole combination, everything standing, with loads on whole members and without what acts on shell panels.
/// A settlement of a spring support becomes the push of that spring on its node.
[[nodiscard]] solver::LoadSet load_set(const Building& building, const EdgeMembers& edges, const PartLoads& loads);
[[nodiscard]] solver::LoadSet load_set(const Building& building, const PartLoads& loads);
/// A load set of whole members as a right-hand side of the frame: loads of divided members by piece, and what acts on
/// shell panels by element.
[[nodiscard]] solver::LoadSet on_frame(const Building& building, const Frame& frame, const PartLoads& loads,
                                       const solver::LoadSet& whole);

}  // namespace topple::structure
