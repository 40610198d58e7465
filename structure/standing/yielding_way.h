#pragma once
// The way of a component whose joints turn before they break, from one state of rest to the next: see yielding_way.cpp,
// and plastic_mechanism.cpp for mechanisms of hinges.
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "failure/ductile_joints.h"
#include "failure/joint_states.h"
#include "standing/component_parts.h"
#include "standing/energy/energy_account.h"
#include "standing/standing_parts.h"

namespace topple::structure {

class YieldingWay {
 public:
  /// What it looks at and moves on; all of it must outlive it.
  struct Sources {
    const StandingParts& parts;
    const ComponentParts& components;
    const FrameLoads& loads;
    const std::vector<std::vector<solver::BeamLoad>>& applied;  ///< per member: what the solver has
    const std::vector<char>& node_solved;                       ///< per node: the solver holds it
    FrameStatics& statics;
    JointStates& joints;
    EnergyAccount& account;
    double sudden = 1;      ///< factor of a sudden loss
    const int& generation;  ///< that runs
    std::function<void()> bring_up_to_date;
  };
  explicit YieldingWay(Sources sources);

  /// The component has joints that can turn.
  [[nodiscard]] bool any(int component) const { return ductile_.any(component); }
  /// The joint broke.
  void lose(JointId joint, int component) { ductile_.lose(joint, component); }
  /// The answer as solved now is where the next way begins.
  void rest(int component) {
    if (any(component)) ductile_.base_is_answer(component);
  }

  // While the component moves, its hinges turn within substeps (solver::FrameDynamics), and no way is followed.
  /// Those that have not broken, in order of joint.
  [[nodiscard]] const std::vector<PlasticHinge>& hinges(int component) { return ductile_.hinges(component); }
  /// What a hinge holds at most, as strong as its joint is now, N m.
  [[nodiscard]] double capacity(const PlasticHinge& hinge) const;
  /// The hinge at this place in hinges() has turned as far as that (rad), under what it holds (N m, of its sign).
  void turned_in_motion(int component, std::size_t hinge, double plastic_rotation, double held);
  /// The next static answer is that of the plastic rotations reached.
  void lay_rotations(int component);
  /// Whether a hinge would turn in the static answer.
  [[nodiscard]] bool yields_in_answer(int component);

  enum class End {
    unyielding,  ///< no hinge has formed since the last state of rest, and none will
    breaking,    ///< joints break in the state reached
    resting      ///< the static answer is reached and borne
  };
  /// Follows the way of a component that is solved for, from event to event; `breaking` gets the joints that break.
  [[nodiscard]] End follow(int component, std::vector<JointId>& breaking);
  /// A mechanism of hinges: they turn under what they hold, until one has turned too far or what moved them is used up.
  /// The joints that are to break; nothing when the mechanism is none of theirs.
  [[nodiscard]] std::optional<std::vector<JointId>> swing(int component, const FrameMechanism& mechanism);
  /// Senses of joints that came to their capacity for the first time, handed out once.
  [[nodiscard]] std::vector<JointBreak> extract_yielded() { return std::exchange(yielded_, {}); }

  template <class Archive>
  void serialize(Archive& archive) {
    auto& [building, from, ductile, yielded] = *this;
    archive(ductile, yielded);
  }

 private:
  /// Two states on the way closer than this (relative) are one: symmetric joints differ by rounding.
  static constexpr double same_place = 1e-9;
  /// A moment that changes by less than this share of the capacity over the whole way does not change.
  static constexpr double no_change = 1e-9;
  /// Events on one way, for each hinge; a way that has more is going round in circles, and what would yield next
  /// breaks.
  static constexpr int most_events = 8;

  struct NextEvent;
  [[nodiscard]] NextEvent find_next_event(int component);
  [[nodiscard]] double end_of_way(int component, double energy);
  [[nodiscard]] double plastic_rotation_in_answer(const PlasticHinge& hinge) const;
  [[nodiscard]] double demand_in_base(const PlasticHinge& hinge) const;
  bool turn_back(int component);
  [[nodiscard]] bool end_reached(int component, double end, double energy, bool measured);
  void start_yielding(int component, const NextEvent& next, std::vector<JointId>& breaking);
  void give_up_surplus(int component);
  /// Yielding hinges that turn in a mechanism, each with its turn per unit of it.
  using Turning = std::vector<std::pair<PlasticHinge*, double>>;
  [[nodiscard]] Turning turning_in(int component, const FrameMechanism& mechanism, double& resisted, double& largest);
  [[nodiscard]] double work_of_loads(int component, const FrameMechanism& mechanism, double sign) const;
  [[nodiscard]] SolvedMember carried_along(MemberId member, const FrameMechanism& mechanism) const;
  bool turn_on(int component, const Turning& turning, const FrameMechanism& mechanism, double sign, double gain);
  void move_base(int component, double part, double energy);
  void let_yield(PlasticHinge& hinge, double held);
  void unload(PlasticHinge& hinge);
  void hold_all_again(int component);
  [[nodiscard]] bool turns_out_alone(PlasticHinge& hinge, double held);
  void report_yield(PlasticHinge& hinge, double held);

  const Building& building_;
  Sources from_;
  DuctileJoints ductile_;
  std::vector<JointBreak> yielded_;
};

}  // namespace topple::structure
