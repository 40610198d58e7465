#include "simulation/call_checks.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <stdexcept>
#include <string>

#include "topple/structure/error.h"
#include "topple/structure/number_range.h"

namespace topple::structure {

namespace {

constexpr NumberRange inertia{1e-12, 1e15};  // kg m2

void require_index(std::int32_t index, std::size_t count, const char* kind, const char* call) {
  if (index >= 0 && static_cast<std::size_t>(index) < count) return;
  throw std::out_of_range(std::string(call) + ": there is no " + kind + " with index " + std::to_string(index) +
                          " (there are " + std::to_string(count) + ")");
}

template <class Id>
void require_ids(const Building& building, const std::vector<Id>& ids, const char* call) {
  for (const Id id : ids) require_id(building, id, call);
}

void require_place(const Vec3& place, const std::string& what) {
  for (const double coordinate : place) require_in(ranges::place, coordinate, what);
}

void require_length(const NumberRange& range, const Vec3& vector, const std::string& what) {
  // The largest of several numbers may pass over one that is none.
  require_in(range, vector.allFinite() ? vector.stableNorm() : unlimited, what);
}

void require_ball(const Vec3& from, double mass, double radius, const std::string& kind) {
  require_place(from, kind + ": from");
  require_in(ranges::mass, mass, kind + ": mass");
  require_in(ranges::radius, radius, kind + ": radius");
}

/// One function for each kind of tool.
struct ToolCheck {
  const Building& building;

  void operator()(const Projectile& ball) const {
    require_ball(ball.from, ball.mass, ball.radius, "projectile");
    require_length(ranges::speed, ball.velocity, "projectile: velocity");
  }
  void operator()(const WreckingBall& ball) const {
    require_ball(ball.from, ball.mass, ball.radius, "wrecking ball");
    require_place(ball.anchor, "wrecking ball: anchor");
    require_in(ranges::length, ball.cable, "wrecking ball: cable");
    if (!((ball.from - ball.anchor).norm() <= ball.cable))
      throw InputError("wrecking ball: cable: found one that does not reach from the anchor to the ball; accepted: " +
                       std::string("at least their distance"));
  }
  void operator()(const CutTool& cut) const { require_ids(building, cut.joints, "cut"); }
  void operator()(const RemoveTool& remove) const {
    require_ids(building, remove.members, "remove");
    require_ids(building, remove.panels, "remove");
    require_ids(building, remove.supports, "remove");
  }
  void operator()(const ChargeTool& charge) const {
    require_place(charge.centre, "charge: centre");
    require_in(ranges::length, charge.radius, "charge: radius");
    require_in(ranges::strength_factor, charge.strength_at_centre, "charge: strength at its centre");
    require_in(ranges::strength_factor, charge.strength_at_radius, "charge: strength at its radius");
  }
  void operator()(const WeakenTool& weaken) const {
    require_ids(building, weaken.joints, "weaken");
    require_ids(building, weaken.members, "weaken");
    require_in(ranges::strength_factor, weaken.strength, "weaken: strength");
    require_in(ranges::stiffness_factor, weaken.stiffness, "weaken: stiffness");
    require_in(ranges::instant, weaken.over, "weaken: over");
    require_in({1, 1e6}, weaken.stages, "weaken: stages");
  }
  void operator()(const GravityTool& tool) const { require_length(ranges::gravity, tool.gravity, "gravity"); }
  void operator()(const LoadTool& load) const {
    for (const NodeLoad& one : load.nodes) {
      require_id(building, one.node, "load");
      for (const double component : one.load) require_in(ranges::force, component, "load");
    }
  }
};

bool positive_definite(const Mat3& matrix) {
  constexpr double rounding = 1e-9;
  if (!matrix.allFinite()) return false;
  const double skew = (matrix - matrix.transpose()).cwiseAbs().maxCoeff();
  if (!(skew <= rounding * matrix.cwiseAbs().maxCoeff())) return false;
  const Vec3 principal = matrix.selfadjointView<Eigen::Lower>().eigenvalues();
  return inertia.contains(principal.minCoeff()) && inertia.contains(principal.maxCoeff());
}

}  // namespace

void require_id(const Building& building, NodeId id, const char* call) {
  require_index(id.index, building.nodes.size(), "node", call);
}
void require_id(const Building& building, MemberId id, const char* call) {
  require_index(id.index, building.members.size(), "member", call);
}
void require_id(const Building& building, PanelId id, const char* call) {
  require_index(id.index, building.panels.size(), "panel", call);
}
void require_id(const Building& building, JointId id, const char* call) {
  require_index(id.index, building.joints.size(), "joint", call);
}

void require_tool(const Building& building, const Tool& tool) { std::visit(ToolCheck{building}, tool); }

void require_capacities(const Building& building, std::span<const std::pair<JointId, JointCapacity>> capacities) {
  for (const auto& [joint, capacity] : capacities) {
    require_id(building, joint, "set_capacities");
    const std::string name = "set_capacities: joint " + building[joint].name;
    for (const double value : capacity.value)
      if (!(value >= 0)) throw InputError(name + ": found a capacity that is no number of 0 or above; accepted: one");
    for (const double value : capacity.ductility)
      if (value != 0) require_in(ranges::plastic_rotation, value, name + ": ductility, where it is not 0");
  }
}

void require_contact(const Building& building, const HostContact& contact) {
  const std::string name = "host contact " + std::to_string(contact.key);
  if (contact.member != MemberId()) require_id(building, contact.member, name.c_str());
  if (contact.panel != PanelId()) require_id(building, contact.panel, name.c_str());
  if (contact.member.valid() + contact.panel.valid() + (contact.body.value >= 0) != 1)
    throw InputError(name + ": it must touch one member, panel or body");
  require_in(ranges::mass, contact.mass, name + ": its mass");
  if (!positive_definite(contact.inertia))
    throw InputError(name + ": its inertia must be symmetric and positive definite, from 1e-12 to 1e15 kg m2");
  if (!(std::abs(contact.normal.norm() - 1) < 1e-9)) throw InputError(name + ": its normal must have length 1");
  require_place(contact.point, name + ": its point");
  require_place(contact.centre, name + ": its centre");
  require_length(ranges::speed, contact.velocity, name + ": its velocity");
  require_length(ranges::turning_speed, contact.angular_velocity, name + ": its angular velocity");
}

void require_scene(const Building& building, const Scenario& scenario) {
  const std::string file = (scenario.file.empty() ? "scenario" : scenario.file) + ": ";
  require_in(ranges::step, scenario.step, file + "step");
  require_in(ranges::session, scenario.duration, file + "duration");
  if (scenario.ground) require_in(ranges::place, *scenario.ground, file + "ground");
  require_in(ranges::sudden, scenario.failure.sudden, file + "failure.sudden");
  require_in(ranges::unit, scenario.impact.restitution, file + "impact.restitution");
  require_in(ranges::friction, scenario.debris.friction, file + "debris.friction");
  require_in(ranges::unit, scenario.debris.restitution, file + "debris.restitution");
  require_in(ranges::volume, scenario.debris.smallest_volume, file + "debris.smallest_volume");
  require_in(ranges::gravity, building.gravity, building.file + ": gravity");
  if (scenario.combination)
    require_index(scenario.combination->index, building.combinations.size(), "combination", "scenario");
  for (const Event& event : scenario.events) {
    require_in(ranges::instant, event.at, file + "an event's time");
    require_tool(building, event.tool);
  }
}

}  // namespace topple::structure
