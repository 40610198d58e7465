#pragma once
// What a StandingFrame is made of, and its inner steps: damage goes to every part that must know (damage), what lost
// its hold leaves (release), changed components are solved (solve), joints are checked (check).
#include <map>
#include <utility>
#include <variant>

#include "failure/bracing.h"
#include "failure/buckling_bracing.h"
#include "failure/edge_demands.h"
#include "failure/moving_part.h"
#include "loads/frame_loads.h"
#include "standing/component_parts.h"
#include "standing/contact_loads.h"
#include "standing/energy/energy_account.h"
#include "standing/frame_response.h"
#include "standing/motion/standing_motion.h"
#include "standing/panel_superelements.h"
#include "standing/standing_parts.h"
#include "standing/yielding_way.h"
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
  [[nodiscard]] bool stands(MemberId member) const { return parts.stands(member); }
  [[nodiscard]] bool stands(PanelId panel) const { return parts.stands(panel); }
  [[nodiscard]] bool stands(NodeId node) const { return parts.stands(node); }
  [[nodiscard]] bool stands(const ContactPlace& place) const;
  [[nodiscard]] Vec6 demand(JointId joint) const;
  [[nodiscard]] Vec6 solved_demand(JointId joint) const;  ///< read from the solver; the joint must hold
  [[nodiscard]] std::array<Vec6, 4> edge_demands(PanelId panel, bool in_motion = false) const;

  // Shell panels (standing_shells.cpp).
  [[nodiscard]] PanelLoading loading(PanelId panel) const;
  [[nodiscard]] std::optional<PanelStress> stress(PanelId panel) const;
  void replace_stiffness(PanelId panel, const Eigen::MatrixXd& before);
  void fracture_shell(PanelId panel, const PanelRemains& remains);
  void lose_shell_edge(PanelId panel, int edge);
  void lose_edge_supports(PanelId panel, int edge);
  void leave_shell(PanelId panel);
  void let_go_of_bare_nodes(PanelId panel);
  void release_moving_shells(const std::vector<NodeId>& moving);

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
  void drop_node(NodeId node);
  void hand_on_anew(PanelId panel);

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
  void complete(int component);
  void know_demands();
  void remember_demands(int c);
  void read_demands(int component, bool slow);
  void read_panel_demands(int component, bool slow, bool in_motion = false);

  // Motion (standing_sway.cpp).
  void move_on(const std::function<void()>& after_substep);
  void end_motion();
  void soften_at_rest();
  void begin_motion();
  void sway(int component);
  void break_in_motion(JointId joint, const Vec6& demand, double freed);
  void break_edges_over(int component);
  void follow_breaks();
  void leave_small_displacements(int component);
  void read_motion(int component);
  void look_for_rest(int component);
  [[nodiscard]] Detached::Motion motion_of(const Detached& part);
  [[nodiscard]] std::map<int, std::vector<Eigen::Index>> places_by_component(const HeldResponse& pushed) const;
  [[nodiscard]] bool moves(int component) const { return motion && motion->moves(component); }

  // Check.
  [[nodiscard]] std::vector<JointId> next_generation();
  void come_to_rest(int component);
  [[nodiscard]] bool buckles(int component);
  void snap_buckled();
  void cut_in_two(MemberId post, double inside);

  const Building& building;
  FailureRules rules;
  int threads;
  StandingParts parts;
  PanelSuperelements shells;
  FrameLoads loads;
  EdgeDemands edge_loads;
  FrameStatics statics;
  ComponentParts components;
  JointStates joints;
  std::optional<ClassicBracing> bracing;
  std::optional<BucklingBracing> buckling;
  std::vector<BuckledPost> buckled;                    ///< to break next
  std::map<MemberId, double> cut_inside;               ///< posts that are about to leave, cut in two
  std::vector<char> node_solved;                       ///< per node: the solver still holds it
  std::vector<std::vector<solver::BeamLoad>> applied;  ///< per member: loads that the solver has
  std::vector<Vec6> node_applied;                      ///< per node
  EnergyAccount account;
  YieldingWay yielding;
  FrameResponse response;
  ContactLoads contacts;

  std::vector<char> to_check;        ///< per component
  std::vector<char> demands_behind;  ///< per component: those of some joints
  std::vector<int> solved_nodes;     ///< per component: nodes that the solver still holds

  std::vector<Change> queue;
  bool pending = false;
  bool softened = false;            ///< stiffness factors changed since the last solve
  bool slowly = false;              ///< what changes now does so slowly: what is at rest goes on resting
  std::vector<char> in_mechanism;   ///< per member: it moves, and is about to leave
  std::vector<MemberId> half_held;  ///< members that have just lost one end
  std::vector<JointId> unbraced;
  std::vector<JointId> hanging;  ///< joints that let go of what moves, to be handed out with it
  std::vector<Detached> detached;
  std::vector<JointBreak> breaks;  ///< of the settle() or impact that runs
  int generation = 0;
  int selective_from = default_selective_from;  ///< nodes of a component
  std::unique_ptr<StandingMotion> motion;       ///< where what stands moves
  int substeps = 1;                             ///< of a move()
  Vec3 gravity = Vec3::Zero();                  ///< now, of what moves
  double rested_freed = 0;                      ///< J that the account of rest says were freed where motion had its own
  std::uint64_t idle_settles = 0;
  mutable FrameCounters counters;
};

}  // namespace topple::structure
