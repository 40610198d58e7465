#pragma once
// What a Simulation is made of, and its stages. Each stage has a file of its own.
#include <map>

#include "simulation/accounts/event_log.h"
#include "simulation/accounts/running_sums.h"
#include "simulation/debris/debris.h"
#include "simulation/debris/hinges.h"
#include "simulation/debris/release_impulses.h"
#include "simulation/fracture/breakable_panels.h"
#include "simulation/impact/free_segment.h"
#include "simulation/impact/impact.h"
#include "simulation/impact/indentation.h"
#include "simulation/impact/pressing_forces.h"
#include "simulation/impact/rigid_mobility.h"
#include "simulation/impact/struck_joints.h"
#include "simulation/scene.h"

namespace topple::structure {

struct Simulation::State {
  State(Building the_building, Scenario the_scenario, SimulationOptions the_options);
  ~State();

  // tools.cpp: what acts in this step, before anything else.
  void use_tools();
  void use_at(double instant, const Tool& tool);
  void use(const Projectile& projectile);
  void use(const WreckingBall& ball);
  collision::BodyId launch(const std::string& kind, const Vec3& from, double mass, double radius, const Vec3& velocity);
  void use(const CutTool& cut);
  void use(const RemoveTool& remove);
  void use(const ChargeTool& charge);
  void use(const WeakenTool& tool);
  void use(const GravityTool& tool);
  void use(const LoadTool& load);

  // weakening.cpp: what loses strength and stiffness over time.
  struct Weakening {
    WeakenTool tool;
    double begin = 0;
    int stage = 0;  ///< stages that have come
    [[nodiscard]] bool over() const { return stage == tool.stages; }
    [[nodiscard]] double next() const { return begin + tool.over * (stage + 1) / tool.stages; }
    /// Factor after some stages, `last` being the one after all of them.
    [[nodiscard]] double after(int stages, double last) const { return 1 + (last - 1) * stages / tool.stages; }
  };
  void use_stages();
  void use_stage(Weakening& weakening);
  void weaken(JointId joint, double change);

  // sweep.cpp
  [[nodiscard]] std::vector<collision::Contact> sweep();
  [[nodiscard]] Bounds swept_bounds(const Body& body, const collision::BodyState& state) const;
  struct Sweep {
    Vec3 travel;
    double turned_by;
  };
  [[nodiscard]] Sweep sweep_of(const collision::BodyState& state, double radius) const;
  [[nodiscard]] bool stays(const BodyMotion& one, const collision::BodyState& state) const;
  void approach(BodyMotion& one, const collision::BodyState& state);

  // strike.cpp: the law of impact for one contact with what stands.
  void load();
  void strike_all(const std::vector<collision::Contact>& contacts);
  struct Strike;
  void strike(const collision::Contact& contact);
  [[nodiscard]] std::optional<Strike> aim(const collision::Contact& contact);
  [[nodiscard]] double rebound(const Indentation& pushing) const;
  [[nodiscard]] bool bears(Strike& hit, double weight, double punching);
  void push_in(Strike& hit);
  static void record_loss(Strike& hit);
  void send_on(const Strike& hit);
  void record_impact(const Strike& hit);
  struct PointImpulse;
  void keep_release_impulse(const Strike& hit);
  void move_on(const Strike& hit, collision::BodyState after, std::span<const PointImpulse> impulses);
  void check_momentum(const Strike& hit, std::span<const PointImpulse> impulses);
  // strike_together.cpp: several of them at one instant.
  struct SimultaneousImpact;
  [[nodiscard]] bool strike_together(std::span<const collision::Contact* const> contacts);
  [[nodiscard]] bool take_up(SimultaneousImpact& pushed) const;
  [[nodiscard]] bool bears(SimultaneousImpact& pushed);
  void push_in(SimultaneousImpact& pushed);
  void go_on(SimultaneousImpact& pushed, const Eigen::VectorXd& shift);
  void send_on(SimultaneousImpact& pushed);
  void break_generations();

  // strike_bodies.cpp: the law of impact between bodies, and of bodies on the ground and on what stands firm.
  struct BodyImpact;
  struct ImpactSide;
  void strike_bodies(const std::vector<collision::Contact>& contacts);
  [[nodiscard]] std::optional<collision::Contact> contact_now(const collision::Contact& swept) const;
  void strike_bodies_at(const std::vector<collision::Contact>& contacts);
  void push_bodies(BodyImpact& impact);
  [[nodiscard]] bool may_break(collision::BodyId id) const;
  [[nodiscard]] ImpactSide side_at(collision::BodyId id, double time) const;
  [[nodiscard]] double time_since_state(collision::BodyId id, double swept_at) const;
  [[nodiscard]] ImpactSide side_again(const ImpactSide& side, collision::BodyId id) const;
  void set_side(const ImpactSide& side);
  void find_flexibility(ImpactSide& side, const std::vector<ImpactPlace>& places, double sign);
  void find_held(ImpactSide& side, const std::vector<ImpactPlace>& places);
  void leave_with_restitution(BodyImpact& impact);
  [[nodiscard]] bool take_up(BodyImpact& impact);
  [[nodiscard]] Impact begin_push(const BodyImpact& impact, bool follows) const;
  [[nodiscard]] Impact::Utilisation note_uses(const std::vector<StruckJoint>& joints, std::vector<double>& uses) const;
  [[nodiscard]] double deepest_push(const BodyImpact& impact) const;
  [[nodiscard]] static Eigen::VectorXd carried_over(const ImpactSide& before, const Eigen::VectorXd& moved,
                                                    const ImpactSide& now);
  [[nodiscard]] std::vector<StruckJoint> struck_joints(const BodyImpact& impact) const;
  std::size_t record_body_impact(const BodyImpact& impact, double speed_in);
  void give_impulses(BodyImpact& impact, const Eigen::VectorXd& impulses);
  bool break_bodies(BodyImpact& impact, Impact& push, const std::vector<JointBreak>& broken);

  // release.cpp: what left the frame becomes bodies.
  void release();
  void release(const Detached& part);
  // cut_in_two.cpp: the pieces of a post that buckled inside.
  void release_in_two(const Detached& part);
  [[nodiscard]] Body piece_of(MemberId member, int end, double cut) const;
  [[nodiscard]] Body describe(const Detached& part) const;
  void check_momentum(const Body& body, const std::optional<Detached::Motion>& motion);
  void remove_body(collision::BodyId id, bool keep_weight);
  void keep_limit();

  // shatter.cpp: panels that came off break into chunks.
  std::vector<collision::BodyId> shatter(collision::BodyId id, const Vec3& point, std::optional<double> radius,
                                         std::size_t& out);
  void push_whole(collision::BodyId id);
  void shatter_struck(collision::BodyId id);
  void shatter_landed();
  /// The hardest impact on a panel that came down: change of speed, m/s, and where, in the body's axes from its centre.
  struct Landing {
    double speed = 0;
    Vec3 at = Vec3::Zero();
  };

  // crumble.cpp: panels of bodies with other parts break where these come down hard on them.
  struct PanelImpact {
    double energy = 0;       ///< of the approach, J
    Vec3 at = Vec3::Zero();  ///< in the undeformed building
    double radius = 0;       ///< of the ball that hit it
  };
  [[nodiscard]] std::map<PanelId, PanelImpact> impacts_on_panels() const;
  [[nodiscard]] double inverse_effective_mass(const Body& one, const ContactRecord& contact) const;
  void crumble(const std::map<PanelId, PanelImpact>& impacts);
  std::vector<Body> break_out_in_flight(PanelId panel, const PanelImpact& impact);
  [[nodiscard]] std::array<bool, 4> held_in_flight(PanelId panel, const Body& one) const;

  // break_standing.cpp: panels that break where they stand.
  [[nodiscard]] double punching_force(const Strike& hit) const;
  [[nodiscard]] double speed_through(const Strike& hit, double force) const;
  bool punch_at_once(Strike& hit, double force, double left);
  /// Returns the mass that the hit broke out; 0 when nothing can break there.
  double break_out(Strike& hit);
  void push_chunks(const Strike& hit);
  // punch_moving.cpp: the same where what stands moves. False when the contact is no punch.
  [[nodiscard]] bool punch_moving(const collision::Contact& contact);
  [[nodiscard]] bool joint_fails_below(const StandingFrame::HeldResponse& response, double force) const;
  std::vector<collision::BodyId> break_standing(PanelId panel, std::vector<PanelChunk> chunks);
  void drop_loose_pieces();
  void crack_panels();

  // break_up.cpp: bodies of several members that are hit hard fall apart.
  /// What presses on a body, its spin and gravity do to it, in the axes of the undeformed building.
  struct BodyActions {
    collision::BodyId on;
    std::vector<FreePush> pushes;
    Vec3 spin, gravity;
    int generation = 0;  ///< of its breaks, so far
  };
  void break_up_landed();
  [[nodiscard]] std::vector<BodyActions> pressed_hard();
  [[nodiscard]] bool spins_hard(const Body& one, const Vec3& spin) const;
  [[nodiscard]] std::vector<BodyActions> handed_on(const BodyActions& loading,
                                                   const std::vector<collision::BodyId>& pieces) const;
  [[nodiscard]] FreeSegment& free_segment_of(const Body& one);
  bool break_joints_of(const BodyActions& loading);
  std::vector<collision::BodyId> come_apart(collision::BodyId id);
  void record_breaks_in_debris(const Body& one, const std::vector<std::pair<JointId, Utilisation>>& broken,
                               int generation);
  /// `chunks`: of panels that broke out of it, which move on with it.
  std::vector<collision::BodyId> split(collision::BodyId id, const std::vector<FreeSegmentParts>& parts,
                                       std::vector<Body> chunks = {});
  [[nodiscard]] bool holds_in_debris(JointId joint) const;
  [[nodiscard]] std::optional<std::array<double, 4>> free_panel_edges(PanelId panel) const;
  [[nodiscard]] bool may_fall_apart(const Body& one) const;
  [[nodiscard]] FreeSegmentParts parts_of(const Body& one) const;

  // account.cpp
  void move();
  void account();
  void account_body(BodyMotion& one);
  void account_contacts();
  void watch_overlaps();
  [[nodiscard]] BodyView view_of(const Body& one) const;
  void update_views();
  void record_changes(std::span<const std::int64_t> before);
  [[nodiscard]] bool rests() const;
  void record_rest_and_end();
  void account_now();

  // save_and_restore.cpp
  void require_parts(const Snapshot::Action& action) const;
  [[nodiscard]] Building building_at_start() const;

  // host_contacts.cpp: bodies that the host owns.
  void strike_by_host();
  void strike_by_host(const HostContact& contact, Part part, HostImpulse& felt);
  void push_debris(const HostContact& contact, HostImpulse& felt);

  // queries.cpp
  [[nodiscard]] std::vector<Carrier> what_carries(const ContactPlace& place) const;

  // Small things.
  [[nodiscard]] bool nothing_to_do() const;
  /// When the next event or stage acts; unlimited when none is to come.
  [[nodiscard]] double next_instant() const;
  [[nodiscard]] bool finished() const;

  Scene scene;
  EventLog log;
  RunningSums sums;
  Debris debris;
  Hinges hinges;
  BreakablePanels panels;
  std::vector<ContactRecord> contact_records;  ///< of the last collision step
  PressingForces pressing;

  std::vector<char> debris_broken;                                     ///< per joint: broke after it had left the frame
  std::map<std::int64_t, std::unique_ptr<FreeSegment>> free_segments;  ///< by body, made when it is first hit hard

  ReleaseImpulses release_impulses;
  /// Where in this step a body that has struck something stands in time: see strike.cpp.
  struct StruckClock {
    double at = 0;    ///< time of its last impact, as swept
    double base = 0;  ///< the same in the body's own time since its state
  };
  std::map<std::int64_t, StruckClock> struck;

  std::size_t next_event = 0;
  std::vector<Weakening> weakenings;      ///< those with stages to come
  std::vector<double> stiffness_factors;  ///< per member
  double used_at = 0;                     ///< the instant of the tool that acts
  std::vector<Tool> asked;
  std::vector<Snapshot::Action> actions;              ///< all that was asked for so far
  std::map<JointId, JointCapacity> given_capacities;  ///< of joints that were given others, as the building had them
  std::vector<HostContact> touches;                   ///< to come in the next step
  std::vector<HostImpulse> host_impulses;
  std::map<std::string, int> launched;  ///< balls by kind
  std::int64_t last_hinge_load = 0;     ///< keys of their loads go down from -1
  bool was_at_rest = false, done_told = false;

  collision::OverlapWatch overlap_watch;
  BodyOverlaps overlaps;
  std::vector<BodyView> views;
  std::shared_ptr<std::vector<double>> poses = std::make_shared<std::vector<double>>();
  PieceChanges changes;
};

}  // namespace topple::structure
