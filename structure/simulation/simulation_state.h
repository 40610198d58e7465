#pragma once
// What a Simulation is made of, and its stages. Each stage has a file of its own.
#include <map>

#include "simulation/body.h"
#include "simulation/broken_panel.h"
#include "simulation/free_segment.h"
#include "simulation/indentation.h"
#include "simulation/obstacles.h"
#include "simulation/part_masses.h"
#include "simulation/resting_loads.h"
#include "simulation/stage_timer.h"
#include "topple/structure/simulation.h"

namespace topple::structure {

struct Simulation::State {
  State(Building the_building, Scenario the_scenario, SimulationOptions the_options);

  // tools.cpp: what acts in this step, before anything else.
  void use_tools();
  void use(const Tool& tool);
  void use(const Projectile& projectile);
  void use(const CutTool& cut);
  void use(const RemoveTool& remove);
  void use(const ChargeTool& charge);
  void use(const GravityTool& tool);
  void use(const LoadTool& load);

  // sense.cpp
  [[nodiscard]] std::vector<collision::Contact> sense();
  [[nodiscard]] Bounds swept_bounds(const Body& body) const;

  // strike.cpp: the law of impact for one contact with what stands.
  void load();
  void strike_all(const std::vector<collision::Contact>& contacts);
  struct Strike;
  void strike(const collision::Contact& contact);
  [[nodiscard]] std::optional<Strike> aim(const collision::Contact& contact);
  [[nodiscard]] double rebound(const Indentation& pushing) const;
  [[nodiscard]] bool bears(Strike& hit, double weight);
  void push_in(Strike& hit);
  static void tell_loss(Strike& hit);
  void send_on(const Strike& hit);
  void break_generations();

  /// Momentum that an impact gave to what it broke off, handed over when that part becomes a body.
  struct Knock {
    Part part;
    Vec3 impulse, point;
    double speed = 0;  ///< of the contact place along the impulse: no part is thrown faster
    collision::BodyId by;
  };

  // release.cpp: what left the frame becomes bodies.
  void release();
  void release(const Detached& part);
  void part_is_gone(Part part);
  [[nodiscard]] Body describe(const Detached& part) const;
  collision::BodyId add_body(Body body, const Vec3& velocity, const Vec3& spin, const Vec3& displacement);
  void knock(const Body& body, Vec3& velocity, Vec3& spin);
  [[nodiscard]] static bool was_struck(const Knock& given, const Body& one);
  [[nodiscard]] std::vector<collision::BodyId> breakers_of(const Body& one) const;
  collision::BodyId add_body(Body body, const collision::BodyState& state);
  void remove_body(collision::BodyId id, bool keep_weight);
  void keep_limit();

  // shatter.cpp: panels that came off break into chunks.
  void find_breakable_panels();
  [[nodiscard]] const BrokenPanel* broken_panel(PanelId panel) const;
  [[nodiscard]] PanelId breakable_of(const Body& one) const;
  [[nodiscard]] Body chunk_body(PanelId panel, PanelChunk chunk, int number) const;
  std::vector<collision::BodyId> shatter(collision::BodyId id, const Vec3& point, std::optional<double> radius,
                                         std::size_t& out);
  void push_whole(collision::BodyId id);
  void shatter_struck(collision::BodyId id);
  void shatter_landed();

  // break_standing.cpp: panels that break where they stand.
  [[nodiscard]] double punching_force(const Strike& hit) const;
  bool punch_at_once(Strike& hit, double force);
  /// Returns the mass that the hit broke out; 0 when nothing can break there.
  double break_out(Strike& hit);
  void push_chunks(const Strike& hit);
  BrokenPanel& breaking(PanelId panel);
  [[nodiscard]] std::array<bool, 4> held(PanelId panel) const;
  std::vector<collision::BodyId> break_standing(PanelId panel, std::vector<PanelChunk> chunks);
  void drop_loose_pieces();
  void crack_panels();
  void open_panels();

  // break_up.cpp: bodies of several members that are hit hard fall apart.
  void break_up_landed();
  [[nodiscard]] std::map<std::int64_t, std::vector<FreePush>> blows();
  std::vector<collision::BodyId> fall_apart(collision::BodyId id, const std::vector<FreePush>& pushes, int generation);
  std::vector<collision::BodyId> split(collision::BodyId id, const std::vector<FreeSegmentParts>& parts);
  [[nodiscard]] bool holds_in_debris(JointId joint) const;
  [[nodiscard]] FreeSegmentParts parts_of(const Body& one) const;

  // book.cpp
  void move();
  void book();
  void book_body(Body& body);
  void book_contacts();
  void update_views();
  [[nodiscard]] bool rests() const;
  void tell_rest_and_end();
  void account_now();

  // Small things.
  [[nodiscard]] bool nothing_to_do() const;
  [[nodiscard]] bool finished() const;
  [[nodiscard]] double time() const { return static_cast<double>(step) * scenario.step; }
  [[nodiscard]] VelocityReading reading() const { return {gravity * scenario.step / 2}; }
  [[nodiscard]] bool stands(Part part) const {
    return part.member.valid() ? frame->stands(part.member) : frame->stands(part.panel);
  }
  [[nodiscard]] Vec3 joint_position(JointId joint) const;
  SimulationEvent& tell(SimulationEvent::Kind kind, const std::string& name);
  void tell(const JointBreak& broken);
  void call_listeners();
  Body* body(collision::BodyId id);

  Building building;
  Scenario scenario;
  SimulationOptions options;
  Vec3 gravity;
  std::unique_ptr<StandingFrame> frame;
  std::unique_ptr<collision::World> world;
  PartMasses masses;
  PartShapes shapes;
  PartGrid grid;
  Obstacles obstacles;
  RestingLoads resting;
  std::vector<double> strength_factors;  ///< per joint
  std::map<std::int64_t, Body> bodies;
  std::vector<std::int64_t> body_of_part;  ///< by part number; -1 stands, -2 gone

  struct BreakablePanel {
    std::optional<fracture::PanelSettings> settings;                        ///< none: it never breaks
    double breaking_speed = unlimited;                                      ///< change of speed that breaks it, m/s
    double tensile_strength = unlimited, compressive_strength = unlimited;  ///< Pa
  };
  std::vector<BreakablePanel> breakable_panels;  ///< per panel
  std::map<PanelId, BrokenPanel> broken_panels;  ///< those that are broken in part: standing, or whole bodies

  std::vector<char> debris_broken;                                     ///< per joint: broke after it had left the frame
  std::map<std::int64_t, std::unique_ptr<FreeSegment>> free_segments;  ///< by body, made when it is first hit hard

  std::vector<Knock> knocks;
  /// Where in this step a body that has struck something stands in time: see strike.cpp.
  struct StruckClock {
    double at = 0;    ///< time of its last impact, as sensed
    double base = 0;  ///< the same in the body's own time since its state
  };
  std::map<std::int64_t, StruckClock> struck;

  std::int64_t step = 0;
  std::size_t next_event = 0;
  std::vector<Tool> asked;
  std::int64_t projectiles = 0;
  bool was_at_rest = false, done_told = false;

  std::vector<SimulationEvent> events;
  std::vector<std::function<void(const SimulationEvent&)>> listeners;
  std::size_t events_heard = 0;
  Ledger ledger;
  double body_gravity_work = 0, body_work_put_in = 0;
  SimulationCounters counters;
  StageTimer timer;
  std::vector<BodyView> views;
};

}  // namespace topple::structure
