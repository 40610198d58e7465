#pragma once
// One run of a building as a person steers it: the simulation with the actions taken, so that it can be started again,
// the last action be taken back, and the run be taken up again at any step that it has passed.
#include <cstdint>
#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include "app/tools/earthquake.h"
#include "app/tools/explosion.h"
#include "app/tools/winch.h"
#include "renderer/recording.h"
#include "renderer/snapshot_taker.h"
#include "topple/structure/joint_tuning.h"
#include "topple/structure/simulation.h"
#include "topple/structure/state_store.h"

namespace topple::viewer {

/// What a run is started with beside the building's geometry.
struct RunRules {
  structure::FailureRules failure;
  /// How panels break that say nothing of their own; none: they stay whole.
  std::optional<fracture::PanelSettings> fracture;
  /// The same parts with other strengths; null: as the session has it.
  std::shared_ptr<const structure::Building> building;
};

class Session {
 public:
  /// The scenario's end is put off: a person may act at any time. `drawn`: around the building; null: nothing.
  /// `recording`: what snapshots are added to. `states`: where those of saved runs are kept; none: they are done again
  /// when they are loaded. Throws as structure::Simulation and structure::VisualMesh do.
  Session(std::shared_ptr<const structure::Building> building, structure::Scenario scenario,
          std::shared_ptr<const std::vector<structure::DrawnMesh>> drawn = nullptr,
          std::shared_ptr<Recording> recording = std::make_shared<Recording>(),
          std::optional<structure::StateStore> states = {});

  void step();
  void apply(const structure::Tool& tool);
  /// Its wave acts in the next step, on what stands.
  void explode(const Explosion& explosion);
  /// The ground begins to shake; what shook it before ends.
  void shake(const Earthquake& earthquake);
  void pull(const Pull& pull);
  void burn_through(const Thermite& thermite);
  /// Changes capacities at once. Throws structure::InputError for a change that means no joint.
  void tune(const structure::JointChange& change);
  /// Back to the beginning; actions are forgotten, rules stay.
  void restart();
  /// The same, by other rules. Throws as structure::Simulation does.
  void restart(const RunRules& rules);
  /// Back to just before the last action, by running again what came before it (the same bits, as runs are
  /// deterministic). False when there was none.
  bool undo();
  /// Back to a step that has been made; later actions are forgotten.
  void return_to(std::int64_t step);
  /// The moment as bytes of structure::Snapshot; the scene's own model and scenario have to be there to load it.
  [[nodiscard]] std::string save() const;
  /// Takes the run up where it was saved: at once where its state is kept, else by doing what was done then. When that
  /// does not lead there (another model, other rules), the run begins anew and its events say so.
  void load(const structure::Snapshot& saved);
  /// Runs again from the beginning where that was not recorded (a state was loaded), so that it can be looked back at;
  /// no effect where it was.
  void record_past();
  /// Finds which share of a downward force put here goes through each joint; snapshots carry it from now on.
  void find_path(const structure::ContactPlace& place);

  [[nodiscard]] const structure::Building& building() const { return *building_; }
  [[nodiscard]] const structure::Scenario& scenario() const { return scenario_; }
  [[nodiscard]] const structure::Simulation& simulation() const { return *simulation_; }
  [[nodiscard]] std::shared_ptr<const Snapshot> snapshot();
  /// All snapshots that were taken; may be read on any thread.
  [[nodiscard]] const std::shared_ptr<Recording>& recording() const { return recording_; }
  /// What the next snapshots hold beside poses and demands.
  void set_wanted(Wanted wanted) { taker_.set_wanted(wanted_ = wanted); }
  [[nodiscard]] std::size_t actions() const { return actions_.size(); }

 private:
  struct Action {
    std::int64_t step;
    std::variant<structure::Tool, structure::JointChange, structure::CapacityChange, structure::HostContact, Explosion,
                 Earthquake, Pull, Thermite>
        what;
  };
  /// What acts for a while, step after step.
  struct Shaking {
    Earthquake earthquake;
    double from = 0;  ///< s
  };
  struct Pulling {
    Pull pull;
    double from = 0;  ///< s
    int given = 0;    ///< increments so far
  };
  void begin();
  void watch(const structure::Tool& tool, double at);
  void act_on();
  void keep(const Action& action, const std::string& told);
  [[nodiscard]] structure::Vec3 gravity_at_rest() const;
  [[nodiscard]] bool is_told(const structure::SimulationEvent& event);
  void remember(const structure::Snapshot& saved);
  [[nodiscard]] bool take_up_state(const structure::Snapshot& saved);
  void end_shaking();
  void report_restart(const std::string& why);
  void report_capacities();
  void carry_out(const Action& action);
  /// What is drawn of it, and shown of capacities: `at` s since the start.
  void follow(const structure::Tool& tool, double at);
  void follow(const structure::CapacityChange& change);
  /// `record`: what is passed on the way is not in the recording yet.
  void run_again(std::int64_t until, bool record = false);
  /// The ground shakes, or a rope is pulled.
  [[nodiscard]] bool is_acted_on() const;
  void record_events();

  std::shared_ptr<const structure::Building> building_, given_;  ///< given_: with the strengths that it came with
  structure::Scenario scenario_;
  std::shared_ptr<const std::vector<structure::DrawnMesh>> drawn_meshes_;
  std::unique_ptr<structure::Simulation> simulation_;
  std::unique_ptr<structure::VisualMesh> drawn_;
  std::unique_ptr<structure::JointTuning> tuning_;
  std::shared_ptr<const TunedJoints> tuned_;
  std::shared_ptr<const std::vector<float>> path_;
  SnapshotTaker taker_;
  Wanted wanted_;
  std::vector<Action> actions_;
  std::shared_ptr<Recording> recording_;
  std::optional<structure::StateStore> states_;
  std::size_t events_recorded_ = 0;
  std::optional<Shaking> shaking_;
  std::vector<Pulling> pulling_;
  std::optional<structure::Vec3> gravity_;   ///< as a person has set it
  std::array<double, 2> last_told_{-1, -1};  ///< s: a gravity, a load among the events
};

}  // namespace topple::viewer
