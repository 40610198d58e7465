#pragma once
// Changes by tools, which wait until what stands is settled or moves.
#include <utility>
#include <variant>
#include <vector>

#include "standing/damage/standing_damage.h"

namespace topple::structure {

class QueuedChanges {
 public:
  struct BreakJoint {
    JointId joint;
    BreakCause cause;
  };
  struct RemoveSupport {
    NodeId node;
  };
  struct EventLoad {
    NodeId node;
    Vec6 force;
  };
  struct Gravity {
    Vec3 gravity;
  };
  /// A member or panel alone is taken away.
  using Change = std::variant<BreakJoint, MemberId, PanelId, RemoveSupport, EventLoad, Gravity>;

  /// Both must outlive it.
  QueuedChanges(StructuralState& state, StandingDamage& damage) : state_(state), damage_(damage) {}

  void add(Change change) { waiting_.push_back(std::move(change)); }
  [[nodiscard]] bool empty() const { return waiting_.empty(); }
  /// All of them act, in the order in which they were added.
  void act();

  template <class Archive>
  void serialize(Archive& archive) {
    auto& [state, damage, waiting] = *this;
    archive(waiting);
  }
  template <class Archive>
  friend void serialize(Archive& archive, BreakJoint& one) {
    auto& [joint, cause] = one;
    archive(joint, cause);
  }
  template <class Archive>
  friend void serialize(Archive& archive, RemoveSupport& one) {
    auto& [node] = one;
    archive(node);
  }
  template <class Archive>
  friend void serialize(Archive& archive, EventLoad& one) {
    auto& [node, force] = one;
    archive(node, force);
  }
  template <class Archive>
  friend void serialize(Archive& archive, Gravity& one) {
    auto& [gravity] = one;
    archive(gravity);
  }

 private:
  void act(const BreakJoint& one) { damage_.break_joint(one.joint, one.cause); }
  void act(MemberId member) { damage_.remove(member); }
  void act(PanelId panel) { damage_.remove(panel); }
  void act(const RemoveSupport& one);
  void act(const EventLoad& one);
  void act(const Gravity& one);

  StructuralState& state_;
  StandingDamage& damage_;
  std::vector<Change> waiting_;
};

}  // namespace topple::structure
