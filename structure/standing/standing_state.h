#pragma once
// What a StandingFrame is made of, and its inner steps: damage goes to every part that must know (damage), what lost
// its hold leaves (release), changed components are solved (solve), joints are checked (check).
#include <map>
#include <utility>
#include <variant>

#include "failure/bracing.h"
#include "failure/buckling_bracing.h"
#include "failure/ductile_joints.h"
#include "failure/edge_demands.h"
#include "failure/joint_states.h"
#include "failure/moving_part.h"
#include "failure/segmentation.h"
#include "loads/frame_loads.h"
#include "standing/energy_account.h"
#include "standing/frame_statics.h"
#include "standing/panel_superelements.h"
#include "topple/structure/standing_frame.h"

namespace topple::structure {

struct StandingFrame::State {
  State(const Building& building, CombinationId combination, const FailureRules& rules, int threads);

  // Changes that wait for the next settle().
  struct BreakJoint {
    JointId joint;
    BreakCause cause;
  };
  struct RemoveSupport {
    NodeId node;
  };
  struct EventLoad {
    NodeId node;
    Vec6 load;
  };
  struct Gravity {
    Vec3 gravity;
  };
  class Watch;  ///< reads joints while they are brought up to date
  using Change = std::variant<BreakJoint, MemberId, PanelId, RemoveSupport, EventLoad, Gravity>;

  // Queries.
  [[nodiscard]] bool stands(MemberId member) const { return segments.label(member) >= 0; }
  [[nodiscard]] bool stands(PanelId panel) const;
  [[nodiscard]] bool stands(NodeId node) const { return segments.label(node) >= 0; }
  [[nodiscard]] bool stands(const ContactPlace& place) const;
  [[nodiscard]] bool holds(JointId joint) const;
  [[nodiscard]] int component(JointId joint) const;
  [[nodiscard]] int label(JointId joint) const;
  void set_contact(const ContactLoad& load);
  void remove_contact(std::int64_t key);
  [[nodiscard]] Vec6 demand(JointId joint) const;
  [[nodiscard]] Vec6 solved_demand(JointId joint) const;  ///< read from the solver; the joint must hold
  [[nodiscard]] Vec3 position(JointId joint) const;
  [[nodiscard]] std::array<Vec6, 4> edge_demands(PanelId panel) const;
  [[nodiscard]] PlacedLoad place(const ContactPlace& place, const Vec3& force, const Vec3& moment = Vec3::Zero()) const;

  // Shell panels (standing_shells.cpp).
  [[nodiscard]] PlacedLoad place_on_shell(const ContactPlace& place, const Vec3& force) const;
  [[nodiscard]] PanelLoading loading(PanelId panel) const;
  /// Of a panel's nodes (Panel::all_nodes()).
  [[nodiscard]] std::vector<Vec6> node_displacements(PanelId panel) const;
  [[nodiscard]] std::vector<Vec6> node_displacements(PanelId panel, const FrameStatics::Response& response) const;
  [[nodiscard]] std::array<Vec6, 4> shell_edge_demands(PanelId panel, const std::vector<Vec6>& at_nodes,
                                                       const PanelLoading& loading) const;
  [[nodiscard]] std::optional<PanelStress> stress(PanelId panel) const;
  void replace_stiffness(PanelId panel, const Eigen::MatrixXd& before);
  void fracture_shell(PanelId panel, const PanelRemains& remains);
  void lose_shell_edge(PanelId panel, int edge);
  void lose_edge_supports(PanelId panel, int edge);
  void leave_shell(PanelId panel);
  void let_go_of_bare_nodes(PanelId panel);
  void release_moving_shells(const std::vector<NodeId>& moving);

  /// Number of each label among the standing segments, in order of their least node.
  const std::vector<int>& numbered_segments() const;

  // Damage: tells every part; `breaks` gets what is listed as an event.
  void apply(const Change& change);
  void break_joint(JointId joint, BreakCause cause);
  void break_joints(std::span<const JointId> together, BreakCause cause);
  void tell(JointId joint, BreakCause cause);
  void damage(JointId joint, int told);
  void lose_member_joint(JointId joint, int told);
  void take(const PanelBearings::Changes& changes, std::vector<Detached>* parts);
  void fracture(PanelId panel, const PanelRemains& remains);
  void break_bare_edges(PanelId panel, const PanelRemains& remains);
  void condense(PanelId panel, const PanelRemains& remains);
  void remove(MemberId member);
  void remove(PanelId panel);
  template <class Gone>
  void drop_contacts(const Gone& gone);
  void drop_node(NodeId node);
  void hand_on_anew(PanelId panel);
  void place_contacts_again(PanelId panel);

  // Release: what hangs on nothing leaves.
  void release();
  void take_unanchored();
  bool release_loose_members();
  bool snap_unbraced();
  void release_mechanism(const FrameMechanism& mechanism);
  void let_hang(JointId joint);

  // Solve.
  void lay_contacts();
  void laid(int component, bool mechanism);
  [[nodiscard]] bool bears(int component) const;
  void bring_up_to_date();
  void settle(int generations);
  void write_loads();
  [[nodiscard]] bool solve_changed();
  void solved(int component, const std::optional<FrameMechanism>& mechanism);
  [[nodiscard]] std::optional<FrameMechanism> solve(int component);
  [[nodiscard]] std::optional<FrameMechanism> solve_slow(int component);
  void references_moved(int component);
  [[nodiscard]] bool may_restrict(int component) const;
  [[nodiscard]] bool one_segment(int component) const;
  void complete(int component);
  void know_demands();
  void read_demands(int component, bool slow);
  void read_panel_demands(int component, bool slow);

  // Yield: the way of a component whose joints turn before they break.
  enum class Way {
    unyielding,  ///< no hinge has formed since the last state of rest, and none will
    breaking,    ///< joints break in the state reached
    resting      ///< the static answer is reached and borne
  };
  [[nodiscard]] Way follow_yielding(int component, std::vector<JointId>& breaking);
  struct NextEvent;
  [[nodiscard]] NextEvent find_next_event(int component);
  [[nodiscard]] double end_of_way(int component, double energy);
  [[nodiscard]] double slip_in_answer(const PlasticHinge& hinge) const;
  [[nodiscard]] double demand_in_base(const PlasticHinge& hinge) const;
  bool turn_back(int component);
  void move_base(int component, double part, double energy);
  void let_flow(PlasticHinge& hinge, double held);
  void hold_again(PlasticHinge& hinge);
  void hold_all_again(int component);
  [[nodiscard]] bool turns_out_alone(PlasticHinge& hinge, double held);
  [[nodiscard]] bool swing(int component, const FrameMechanism& mechanism);
  void tell_yield(PlasticHinge& hinge, double held);

  // Check.
  [[nodiscard]] std::vector<JointId> next_generation();
  void come_to_rest(int component);
  [[nodiscard]] bool buckles(int component);
  void snap_buckled();
  void cut_in_two(MemberId post, double inside);

  // Response.
  [[nodiscard]] FrameStatics::ResponseLoads response_loads(const PlacedLoad& placed) const;
  [[nodiscard]] int component(const ContactPlace& place) const;
  [[nodiscard]] double compliance(const PlacedLoad& placed, const FrameStatics::Response& response) const;
  [[nodiscard]] UnitResponse respond(const ContactPlace& place, const Vec3& direction) const;
  [[nodiscard]] CoupledResponse respond(std::span<const ContactPlace> places, std::span<const Vec3> directions) const;
  [[nodiscard]] std::vector<std::pair<JointId, Vec6>> response_demands(int component, const PlacedLoad& placed,
                                                                       const FrameStatics::Response& response) const;
  [[nodiscard]] CoupledResponse couple(std::span<const ContactPlace> places, std::span<const Vec3> directions,
                                       bool near) const;
  /// Response to a force, and where the force is placed.
  struct Shape {
    const PlacedLoad& placed;
    const FrameStatics::Response& response;
  };
  [[nodiscard]] Eigen::MatrixXd inertia(int component, std::span<const Shape> shapes) const;
  void add_inertia_of_nodes(int component, std::span<const Shape> shapes, Eigen::MatrixXd& sum) const;
  // Response, as far as it is known at little cost (standing_bound.cpp).
  [[nodiscard]] CoupledResponse respond_near(std::span<const ContactPlace> places,
                                             std::span<const Vec3> directions) const;
  [[nodiscard]] Eigen::MatrixXd least_inertia(int component, std::span<const Shape> shapes) const;
  [[nodiscard]] std::vector<std::pair<JointId, Vec6>> near_demands(std::span<const Shape> shapes,
                                                                   std::size_t pushed) const;
  [[nodiscard]] static std::vector<MemberId> bearing_members(std::span<const Shape> shapes);
  [[nodiscard]] const std::vector<double>& certain_masses(int component) const;
  [[nodiscard]] double critical_energy(int component) const;
  [[nodiscard]] double critical_energy(JointId joint) const;
  void forget_bounds(int component);
  [[nodiscard]] double panel_mean_product(PanelId panel, const Shape& a, const Shape& b) const;
  [[nodiscard]] double displacement_along(const ContactPlace& place, const Vec3& direction) const;

  const Building& building;
  FailureRules rules;
  EdgeMembers edges;
  Segmentation segments;
  PanelBearings bearings;
  PanelSuperelements shells;
  FrameLoads loads;
  EdgeDemands edge_loads;
  FrameStatics statics;
  JointStates joints;
  DuctileJoints ductile;
  std::optional<ClassicBracing> bracing;
  std::optional<BucklingBracing> buckling;
  std::vector<BuckledPost> buckled;                    ///< to break next
  std::map<MemberId, double> cut_inside;               ///< posts that are about to leave, cut in two
  std::vector<char> node_solved;                       ///< per node: the solver still holds it
  std::vector<std::vector<solver::BeamLoad>> applied;  ///< per member: loads that the solver has
  std::vector<Vec6> node_applied;                      ///< per node
  EnergyAccount account;

  std::vector<std::vector<JointId>> checked_joints;    ///< per component: joints with a capacity
  std::vector<std::vector<JointId>> checked_edges;     ///< those of them that are edges of panels
  std::vector<std::vector<PanelId>> component_panels;  ///< per component
  std::vector<char> to_check;                          ///< per component
  std::vector<char> demands_behind;                    ///< per component: those of some joints
  /// Per component, of its state as solved last: critical energy (below 0: to be found), and per node the mass that
  /// moves with it whatever the others do (empty: to be found).
  mutable std::vector<double> critical_energies;
  mutable std::vector<std::vector<double>> certain;
  std::vector<int> solved_nodes;  ///< per component: nodes that the solver still holds

  std::vector<Change> queue;
  bool pending = false;
  bool softened = false;  ///< stiffness factors changed since the last solve
  std::map<std::int64_t, ContactLoad> contacts;
  std::vector<char> in_mechanism;   ///< per member: it moves, and is about to leave
  std::vector<MemberId> half_held;  ///< members that have just lost one end
  std::vector<JointId> unbraced;
  std::vector<JointId> hanging;  ///< joints that let go of what moves, to be handed out with it
  std::vector<Detached> detached;
  std::vector<JointBreak> yielded;  ///< to hand out
  std::vector<JointBreak> breaks;   ///< of the settle() or impact that runs
  int generation = 0;
  int restricted_from = default_restricted_from;  ///< nodes of a component
  std::uint64_t idle_settles = 0;
  mutable FrameCounters counters;
  mutable std::vector<int> segment_numbers;  ///< per label, made when asked for; empty: to be made
};

}  // namespace topple::structure
