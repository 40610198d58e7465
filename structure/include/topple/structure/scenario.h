#pragma once
// What happens to a building: combination, rules of failure, tools at their times. SI, as the scenario format has it
// (docs/scenario-format.md).
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "topple/structure/building.h"

namespace topple::structure {

enum class BracingRule { buckling, classic, none };
enum class MechanismRule { hinge, detach };
/// Whether what stands follows losses and impacts in time, or by static states and the factor of a sudden loss.
enum class StandingRule { statics, dynamics };

/// When what stands fails. Keys of the scenario's `failure`.
struct FailureRules {
  BracingRule bracing = BracingRule::buckling;     ///< how posts that lose their bracing are judged
  MechanismRule mechanism = MechanismRule::hinge;  ///< what becomes of a part that can move without strain
  bool second_order = false;                       ///< axial forces act on the displaced structure
  double sudden = 2.0;                             ///< dynamic factor of a sudden loss (static standing); 1 is off
};
/// How what stands moves. Keys of the scenario's `dynamics`.
struct MotionRules {
  std::optional<int> substeps;    ///< of a step, at least 1; none: as few as are no longer than 1/480 s
  std::optional<double> damping;  ///< share of critical damping, from 0; none: 0.02 of metals, 0.05 of all else
  double spectral_radius = 0.8;   ///< of generalized-alpha at infinite frequency, 0 to 1
};
/// How impacts are computed. Keys of the scenario's `impact`.
struct ImpactRules {
  double restitution = 0.1;    ///< coefficient, where nothing breaks
  bool structure_mass = true;  ///< false: what is struck has no mass of its own (static standing alone)
};
/// Which debris there is and how it touches. Keys of the scenario's `debris`.
struct DebrisRules {
  double friction = 0.6;           ///< coefficient
  double restitution = 0.1;        ///< coefficient
  std::optional<int> limit;        ///< bodies kept; without one all are, for a limit is a quota
  double smallest_volume = 0.002;  ///< m3
};

/// A ball that flies in.
struct Projectile {
  Vec3 from = Vec3::Zero();      ///< m, where it begins
  Vec3 velocity = Vec3::Zero();  ///< m/s, at first
  double mass = 500;             ///< kg
  double radius = 0.4;           ///< m
};
/// A ball on a cable that starts at rest.
struct WreckingBall {
  Vec3 anchor = Vec3::Zero();  ///< m, where the cable hangs
  Vec3 from = Vec3::Zero();    ///< m, where the ball starts
  double cable = 0;            ///< length, at least the distance between them
  double mass = 3000;          ///< kg
  double radius = 0.8;         ///< m
};
/// Breaks joints.
struct CutTool {
  std::vector<JointId> joints;  ///< that break
};
/// Takes parts and supports away at once.
struct RemoveTool {
  std::vector<MemberId> members;  ///< that go
  std::vector<PanelId> panels;    ///< that go
  std::vector<NodeId> supports;   ///< nodes whose support goes
};
/// An explosive charge, as joints that it weakens: a factor on their capacity by distance, linear.
struct ChargeTool {
  Vec3 centre = Vec3::Zero();     ///< m
  double radius = 0;              ///< m: nothing happens beyond
  double strength_at_centre = 0;  ///< factor in the centre
  double strength_at_radius = 1;  ///< factor at `radius`
};
/// A fire, or rot: joints lose strength and members stiffness in equal stages, stage i of n at `over` i / n after the
/// event. Several act together by their product.
struct WeakenTool {
  std::vector<JointId> joints;    ///< that are weakened
  std::vector<MemberId> members;  ///< that are softened
  double strength = 1;            ///< factor at the last stage; 0: the joints break
  double stiffness = 1;           ///< factor on E and G at the last stage, above 0
  double over = 0;                ///< s
  int stages = 1;                 ///< in how many stages
};
/// Another gravity from now on.
struct GravityTool {
  Vec3 gravity = Vec3::Zero();  ///< m/s2, global axes
};
/// Further loads from now on.
struct LoadTool {
  std::vector<NodeLoad> nodes;  ///< in N and N m, global axes
};
/// Each event's tool; alternatives are added as tools are built.
using Tool = std::variant<Projectile, WreckingBall, CutTool, RemoveTool, ChargeTool, WeakenTool, GravityTool, LoadTool>;

/// A tool at its time.
struct Event {
  double at = 0;  ///< s from the start
  Tool tool;      ///< what happens
};

/// A whole scenario: what is demolished, how, for how long.
struct Scenario {
  std::string title;                                ///< for a person
  std::string file;                                 ///< path that it was read from
  std::string model;                                ///< path of its model
  std::optional<CombinationId> combination;         ///< set by the reader
  double step = 1.0 / 60.0;                         ///< s
  double duration = 60;                             ///< s, at most
  bool until_rest = true;                           ///< ends as soon as all is at rest and no event is to come
  std::uint64_t seed = 1;                           ///< of what is drawn by chance in fracture
  std::optional<double> ground;                     ///< height; none: the lowest support
  StandingRule standing = StandingRule::dynamics;   ///< whether what stands moves
  MotionRules motion;                               ///< how it moves
  FailureRules failure;                             ///< what breaks
  ImpactRules impact;                               ///< how things strike each other
  DebrisRules debris;                               ///< what lies about
  std::optional<fracture::PanelSettings> fracture;  ///< of panels that have none of their own nor by material
  std::vector<Event> events;                        ///< in order of time
};

}  // namespace topple::structure
