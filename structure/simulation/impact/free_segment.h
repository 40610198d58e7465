#pragma once
// What the joints of a free body bear: a segment in flight under contact forces and gravity, held in balance by the
// inertia of its parts (inertia relief). The accelerations of translation and rotation are those at which all of it is
// in balance, gyroscopic moment included; every part then pushes with its mass times minus its own acceleration,
//   a + alpha x r + w x (w x r),
// and the frame is solved held at one node, whose reaction is nothing. Panels that are no shells stiffen nothing and
// hang in it by their edges (free_panel_edges.h); what a shell's edges bear is what its stiffness takes up.
#include <Eigen/Core>
#include <functional>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "simulation/impact/free_panel_edges.h"
#include "topple/solver/beam_diagram.h"
#include "topple/solver/static_analysis.h"
#include "topple/structure/building.h"

namespace topple::structure {

/// Of a body made of the building's parts; masses in kg. Members' masses lie evenly along them, panels' at their
/// corners.
struct FreeSegmentParts {
  std::vector<MemberId> members;
  std::vector<PanelId> panels;
  std::vector<NodeId> nodes;
  std::vector<double> member_mass, panel_mass, node_mass;
};
template <class Archive>
void serialize(Archive& archive, FreeSegmentParts& parts) {
  auto& [members, panels, nodes, member_mass, panel_mass, node_mass] = parts;
  archive(members, panels, nodes, member_mass, panel_mass, node_mass);
}

/// A force on the body, at the place and in the axes of the undeformed building.
struct FreePush {
  MemberId member;  ///< valid: on a member, else on a panel
  PanelId panel;
  Vec3 point = Vec3::Zero(), force = Vec3::Zero();
};

class FreeSegment {
 public:
  /// `holds`: whether a joint of the members is intact. `shell_stiffness`: of a shell panel as its nodes
  /// (Panel::all_nodes()) feel it; without it shells are mass alone. `edges`: of panels that can come off in flight.
  FreeSegment(const Building& building, FreeSegmentParts parts, const std::function<bool(JointId)>& holds,
              const std::function<Eigen::MatrixXd(PanelId)>& shell_stiffness = nullptr,
              const FreePanelEdges& edges = nullptr);
  /// One that is to be loaded.
  explicit FreeSegment(const Building& building) : building_(building) {}

  /// False when no joint inside it could break. One that can move within itself is asked nothing of its members.
  [[nodiscard]] bool can_break() const { return can_break_; }

  struct Answer {
    /// Of each intact joint with a capacity, in order of id; those of panels per length.
    std::vector<std::pair<JointId, Vec6>> demands;
    Vec3 acceleration = Vec3::Zero();  ///< of the centre
    Vec3 angular_acceleration = Vec3::Zero();
    double imbalance = 0;  ///< reaction of the node that holds it, over the largest force on it
  };
  /// `spin` and `gravity` in the axes of the undeformed building. Only when it can break.
  [[nodiscard]] Answer bear(std::span<const FreePush> pushes, const Vec3& spin, const Vec3& gravity);

  /// How the body gives way to forces at several places, and what they add to its joints.
  struct Flexibility {
    /// m/N: by how much place i moves along its force, beyond the rigid motion of the whole, for each newton of force
    /// j; symmetric.
    Eigen::MatrixXd compliance;
    /// For each newton at each place, one column a place; joints in order of id, those of panels per length.
    std::vector<std::pair<JointId, Eigen::Matrix<double, 6, Eigen::Dynamic>>> demands;
  };
  /// `unit_pushes`: unit vectors. Each is held in balance by the inertia of the whole (free flexibility by inertia
  /// relief: Felippa and Park, "A direct flexibility method", 1997, whose A' K^+ A this is). A panel that is struck
  /// adds its own bending as a strip between two edges (placed_load.h). Where the body can move within itself nothing
  /// is known of its members, and what is struck is as stiff as its own part.
  [[nodiscard]] Flexibility flexibility(std::span<const FreePush> unit_pushes);

  /// All of it: joints may have broken since it was made, and more may lie on it.
  template <class Archive>
  void save(Archive& archive) const {
    auto& [building, parts, joints, node_number, point_mass, shells, hung, model, mass, centre, inertia, held_at,
           is_mechanism, can_break, analysis] = *this;
    archive(parts, joints, node_number, point_mass, shells, hung, model, mass, centre, inertia, held_at, is_mechanism,
            can_break, analysis != nullptr);
  }
  template <class Archive>
  void load(Archive& archive) {
    bool analysed = false;
    archive(parts_, joints_, node_number_, point_mass_, shells_, hung_, model_, mass_, centre_, inertia_, held_at_,
            is_mechanism_, can_break_, analysed);
    if (analysed) analysis_ = std::make_unique<solver::StaticAnalysis>(model_);
  }

 private:
  void analyse();
  [[nodiscard]] double compliance_of_part_alone(const FreePush& unit_push) const;
  struct MovedMass;
  [[nodiscard]] std::vector<solver::BeamDiagram> diagrams_of(const solver::StaticSolution& solution,
                                                             const solver::LoadSet& loads) const;
  [[nodiscard]] double moved(const solver::LoadSet& push, const std::vector<solver::BeamDiagram>& diagrams,
                             const std::vector<Vec6>& displacements) const;
  [[nodiscard]] MovedMass moved_mass(const std::vector<solver::BeamDiagram>& diagrams,
                                     const std::vector<Vec6>& displacements) const;
  [[nodiscard]] solver::LoadSet balanced(std::span<const FreePush> pushes, const Vec3& spin, const Vec3& gravity,
                                         Answer& answer) const;
  void read_demands(const solver::StaticSolution* solution, std::span<const FreePush> pushes, const Vec3& spin,
                    const Vec3& gravity, Answer& answer) const;
  [[nodiscard]] int node_at(NodeId node);
  /// A panel that hangs by edges that can break.
  struct Hung {
    PanelId panel;
    double mass = 0;
    std::array<double, 4> length{};
    int patch = -1;             ///< of a shell
    std::vector<NodeId> nodes;  ///< of the patch, in its order
  };
  template <class Archive>
  friend void serialize(Archive& archive, Hung& hung) {
    auto& [panel, mass, length, patch, nodes] = hung;
    archive(panel, mass, length, patch, nodes);
  }
  void add_members(const std::function<bool(JointId)>& holds);
  void add_point_masses();
  void add_shell(PanelId panel, const Eigen::MatrixXd& stiffness, const std::function<bool(JointId)>& holds);
  void find_hung_panels(const FreePanelEdges& edges);
  [[nodiscard]] std::vector<PanelPush> pushes_on(const Hung& hung, std::span<const FreePush> pushes,
                                                 const Answer& motion, const Vec3& spin, const Vec3& gravity) const;
  [[nodiscard]] std::array<Vec6, 4> shell_edge_demands(const Hung& hung, std::span<const PanelPush> pushes,
                                                       const std::vector<Vec6>& displacements) const;
  [[nodiscard]] double polar(MemberId member) const;
  void add_mass(const Vec3& at, double mass);
  [[nodiscard]] solver::LoadSet loads_of(std::span<const FreePush> pushes) const;
  void push_corners(PanelId panel, const Vec3& point, const Vec3& force, solver::LoadSet& loads) const;
  /// Whether a panel's mass, and what acts on it, is taken by this one of its corners.
  [[nodiscard]] bool includes(PanelId panel, NodeId corner) const;
  [[nodiscard]] Vec3 on(const Vec3& at, const Answer& motion, const Vec3& spin, const Vec3& gravity) const;

  const Building& building_;
  FreeSegmentParts parts_;
  std::vector<JointId> joints_;
  std::vector<int> node_number_;                                 ///< per node of the building, -1: not in the body
  std::vector<double> point_mass_;                               ///< per node of the model
  std::vector<std::pair<PanelId, std::vector<NodeId>>> shells_;  ///< per patch
  std::vector<Hung> hung_;
  solver::FrameModel model_;
  double mass_ = 0;
  Vec3 centre_ = Vec3::Zero();
  Mat3 inertia_ = Mat3::Zero();
  int held_at_ = -1;           ///< node of the model, -1: none that could hold it
  bool is_mechanism_ = false;  ///< it can move within itself
  bool can_break_ = false;
  std::unique_ptr<solver::StaticAnalysis> analysis_;
};

/// The connected parts that a body falls into when only these joints still hold: members, shell panels and nodes by
/// joints, each other panel with the part that has most of its corners (of equal ones the first), or, when its edges
/// can break in flight, with the part that holds two opposite ones, else by itself. In order of their least member,
/// node or panel.
[[nodiscard]] std::vector<FreeSegmentParts> connected_parts(const Building& building, const FreeSegmentParts& whole,
                                                            const std::function<bool(JointId)>& holds,
                                                            const FreePanelEdges& edges = nullptr);

}  // namespace topple::structure
