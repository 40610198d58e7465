#pragma once
// What a StandingFrame is made of, and its inner steps: damage goes to every part that must know (damage), what lost
// its hold leaves (release), changed components are solved (solve), joints are checked (check).
#include <deque>
#include <functional>
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
#include "topple/solver/paced_work.h"
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
  /// Of membranes that broke: what is left of their stiffness, before anything is solved for.
  [[nodiscard]] bool condense_broken();
  [[nodiscard]] Eigen::MatrixXd stiffness_of_membrane(PanelId panel) const;
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

  // Pace (standing_pace.cpp).
  /// Runs `work`, which changes nothing that anybody outside of the solver and the joints looks at, and `then`. False:
  /// `work` took more than the allowance; it goes on, and `then` follows, in go_on().
  [[nodiscard]] bool paced(std::function<void()> work, std::function<void()> then = {});
  /// False: the allowance is used up, and the same work is under way still.
  [[nodiscard]] bool go_on();
  /// There is no end to the allowance while `work` runs, after what is under way; what both spend beyond it is owed.
  template <class Work>
  void at_once(const Work& work) {
    finish_paced();
    const double left = std::exchange(allowance, unlimited);
    const double spent = counted(work);
    allowance = left - spent;
  }
  void finish_paced();
  static void spend_on_joints(std::size_t count);
  static void spend_on_elements(std::size_t count);
  void bill(double operations) {
    counters.operations += operations;
    allowance -= operations;
  }
  /// Returns what it spends, which the counters have once. What runs at a pace is counted as it is paid for.
  template <class Work>
  double counted(const Work& work) const {
    const bool here = !pace.runs_here();
    const double before = solver::spent_here();
    if (here) ++counting;
    work();
    if (here) --counting;
    const double spent = solver::spent_here() - before;
    if (here && counting == 0) counters.operations += spent;
    return spent;
  }
  /// For whoever asks from outside: what is under way is run to its end, and goes on to be paid for.
  void look() const { pace.run_out(); }
  /// The same, and then something is computed that counts, but is paid for by nobody.
  template <class Work>
  auto ask(const Work& work) const {
    look();
    decltype(work()) answer;
    counted([&] { answer = work(); });
    return answer;
  }
  [[nodiscard]] bool limited() const { return allowance < unlimited; }
  [[nodiscard]] bool used_up() const { return allowance <= 0; }

  // Solve.
  /// False: it is under way. So of all that return bool below, where nothing else is said.
  [[nodiscard]] bool lay_contacts();
  void lay_contacts_at_once();
  void laid(int component, bool mechanism);
  [[nodiscard]] bool bears(int component) const;
  [[nodiscard]] bool bring_up_to_date();
  void bring_up_to_date_at_once();
  [[nodiscard]] bool settle(int generations);
  void finish();
  [[nodiscard]] std::size_t parts_leaving() const;
  void write_loads();
  enum class Solved { yes, mechanism, under_way };
  [[nodiscard]] Solved solve_changed();
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
  enum class Tested { stands, buckles, under_way };
  [[nodiscard]] Tested buckles(int component);
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
  std::vector<BuckledPost> buckled;       ///< to break next
  std::map<MemberId, double> cut_inside;  ///< posts that are about to leave, cut in two
  bool test_goes_on = false;              ///< whether a post buckles is not known yet
  /// What a test for buckling found that the allowance cut in two, of the state solved for the so manieth time.
  struct TestedPost {
    int component = -1;
    std::uint64_t solves = 0;
    std::optional<BuckledPost> post;
  };
  TestedPost tested;
  bool check_goes_on = false;                          ///< which joints break next is not known yet
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
  std::deque<std::pair<PanelId, PanelRemains>> to_condense;  ///< membranes that broke
  bool pending = false;
  /// How far a settle() came that operations limit: contact loads are laid; what changed is applied, and what stands
  /// is not solved for.
  enum class Progress { none, laid, applied };
  Progress progress = Progress::none;
  bool softened = false;         ///< stiffness factors changed since the last solve
  bool laying = false;           ///< contact loads are written, and not all components solved for them
  mutable int counting = 0;      ///< depth of counted()
  double allowance = unlimited;  ///< operations that may still be spent
  bool yields = false;           ///< to others, after each answer
  mutable solver::PacedWork pace;
  std::function<void()> after_pace;
  std::optional<FrameMechanism> mechanism_found;  ///< by what runs at a pace
  /// Changes of contact loads that wait for it.
  std::vector<std::pair<std::int64_t, std::optional<ContactLoad>>> waiting_loads;
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
