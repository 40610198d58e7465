#pragma once
// Hinges by which debris hangs. A part that moves as a mechanism stays joined to what stands, or to another body, by
// joints that still hold: they turn freely in the directions that are released and hold in the others. Their forces
// load what they hang on, and one that reaches its capacity breaks.
#include <map>
#include <span>
#include <vector>

#include "simulation/accounts/event_log.h"
#include "simulation/accounts/running_sums.h"
#include "simulation/debris/debris.h"
#include "simulation/debris/standing_holds.h"

namespace topple::structure {

class Hinges {
 public:
  /// All of it must outlive this.
  Hinges(Scene& scene, EventLog& log, RunningSums& sums, Debris& debris)
      : scene_(scene), log_(log), sums_(sums), debris_(debris), holds_(scene) {}

  /// The body, a part that left, hangs on by these joints; those that find nothing to hang on have lost their hold.
  void hang_on(const std::vector<JointId>& joints, collision::BodyId id);
  /// What held some has left the frame: they hang on the body that it became.
  void hang_on_what_left();
  /// After a body fell apart: what it hung by, and what hung on it, goes on with the piece that has its side.
  void hang_again(const std::vector<JointId>& joints);
  /// The body is about to go: it hangs on nothing any more, and nothing on it. Returns the joints of both kinds.
  std::vector<JointId> unhook(collision::BodyId id);
  /// For a substep of `dt`: what moves bears what these pull with, as it is. Returns those that act, each about its
  /// place. Those that bear no more go with break_over().
  std::vector<collision::HingePull> act(std::span<const collision::HingePull> pulls, double dt);
  /// After that substep, which they still acted in: those over their capacity are gone.
  void break_over();
  /// The world is about to move.
  void begin_motion() { moves_ = true; }
  /// After the world has moved: what those that act() did not see hold with, whether they bear that, and what they do
  /// to what stands at rest.
  void pull();
  /// Where they hold to what stands and moves.
  [[nodiscard]] StandingHolds& holds() { return holds_; }
  [[nodiscard]] const StandingHolds& holds() const { return holds_; }

  template <class Archive>
  void serialize(Archive& archive) {
    auto& [scene, log, sums, debris, holds, hinges, over, last_load, moves] = *this;
    archive(holds, hinges, last_load);  // between steps nothing moves or is over
  }

 private:
  struct Hung {
    JointId joint;
    collision::HingeId hinge;
    collision::BodyId body, holder;  ///< holder -1: what stands
    collision::ObstacleId place;     ///< of what stands, where that moves
    bool member_hangs = true;        ///< the joint's member is of the body, else its node
    Mat3 axes = Mat3::Identity();    ///< of the joint, in the holder's own frame
    std::int64_t load_key = 0;
    Vec3 felt = Vec3::Zero(), moment_felt = Vec3::Zero();  ///< by the joint: on the holder about it, less than impacts
    Vec3 force = Vec3::Zero(), moment = Vec3::Zero();      ///< on the holder about the joint, smoothed
    Vec3 applied = Vec3::Zero(), moment_applied = Vec3::Zero();
    bool acted = false;  ///< in substeps of this step: its smoothed pull does not act as well
  };
  template <class Archive>
  friend void serialize(Archive& archive, Hung& hung) {
    auto& [joint, hinge, body, holder, place, member_hangs, axes, load_key, felt, moment_felt, force, moment, applied,
           moment_applied, acted] = hung;
    archive(joint, hinge, body, holder, place, member_hangs, axes, load_key, felt, moment_felt, force, moment, applied,
            moment_applied, acted);
  }
  bool hang(JointId joint, collision::BodyId id);
  void unhook(const Hung& hung);
  void pass_what_holds(collision::BodyId id, const Vec3& point, collision::BodyId holder);
  void feel(Hung& hung, const Vec3& force, const Vec3& moment, double dt);
  void smooth(Hung& hung, const Vec3& force, const Vec3& moment) const;
  void load_by(Hung& hung);
  void load(Hung& hung, const Vec3& force, const Vec3& moment);
  [[nodiscard]] Utilisation utilisation_of(const Hung& hung) const;
  [[nodiscard]] ContactPlace hold_of(JointId joint, bool member_hangs) const;

  Scene& scene_;
  EventLog& log_;
  RunningSums& sums_;
  Debris& debris_;
  StandingHolds holds_;
  std::map<std::int64_t, Hung> hinges_;                     ///< by hinge
  std::vector<std::pair<std::int64_t, Utilisation>> over_;  ///< hinges that bear no more, to be gone
  std::int64_t last_load_ = 0;                              ///< keys of their loads go down from -1
  bool moves_ = false;  ///< the world moves: what they took out of bodies since is not accounted yet
};

}  // namespace topple::structure
