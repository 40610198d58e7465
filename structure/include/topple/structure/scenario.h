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
/// Whether what stands follows losses and blows in time, or by static states and the factor of a sudden loss.
enum class StandingRule { statics, dynamics };

struct FailureRules {
  BracingRule bracing = BracingRule::buckling;
  MechanismRule mechanism = MechanismRule::hinge;
  bool second_order = false;
  double sudden = 2.0;  ///< dynamic factor of a sudden loss; 1 is off
};
struct ImpactRules {
  double restitution = 0.1;
  bool structure_mass = true;
};
struct DebrisRules {
  double friction = 0.6, restitution = 0.1;
  std::optional<int> limit;        ///< bodies kept; without one all are, for a limit is a quota
  double smallest_volume = 0.002;  ///< m3
};

struct Projectile {
  Vec3 from = Vec3::Zero(), velocity = Vec3::Zero();
  double mass = 500, radius = 0.4;
};
/// A ball on a cable that starts at rest.
struct WreckingBall {
  Vec3 anchor = Vec3::Zero(), from = Vec3::Zero();
  double cable = 0;  ///< length, at least the distance between them
  double mass = 3000, radius = 0.8;
};
struct CutTool {
  std::vector<JointId> joints;
};
struct RemoveTool {
  std::vector<MemberId> members;
  std::vector<PanelId> panels;
  std::vector<NodeId> supports;
};
struct ChargeTool {
  Vec3 centre = Vec3::Zero();
  double radius = 0;
  double strength_at_centre = 0, strength_at_radius = 1;
};
/// A fire, or rot: joints lose strength and members stiffness in equal stages, stage i of n at `over` i / n after the
/// event. Several act together by their product.
struct WeakenTool {
  std::vector<JointId> joints;
  std::vector<MemberId> members;
  double strength = 1;   ///< factor at the last stage; 0: the joints break
  double stiffness = 1;  ///< factor on E and G at the last stage, above 0
  double over = 0;       ///< s
  int stages = 1;
};
struct GravityTool {
  Vec3 gravity = Vec3::Zero();
};
struct LoadTool {
  std::vector<NodeLoad> nodes;
};
/// Each event's tool; alternatives are added as tools are built.
using Tool = std::variant<Projectile, WreckingBall, CutTool, RemoveTool, ChargeTool, WeakenTool, GravityTool, LoadTool>;

struct Event {
  double at = 0;
  Tool tool;
};

struct Scenario {
  std::string title, file, model;
  std::optional<CombinationId> combination;  ///< set by the reader
  double step = 1.0 / 60.0, duration = 60;
  bool until_rest = true;
  std::uint64_t seed = 1;
  std::optional<double> ground;  ///< height; none: the lowest support
  StandingRule standing = StandingRule::statics;
  FailureRules failure;
  ImpactRules impact;
  DebrisRules debris;
  std::optional<fracture::PanelSettings> fracture;  ///< of panels that have none of their own nor by material
  std::vector<Event> events;                        ///< in order of time
};

}  // namespace topple::structure
