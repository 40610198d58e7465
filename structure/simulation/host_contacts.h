#pragma once
// Contacts of bodies that the host owns. For the length of its impact such a body is one like any other; then it leaves
// again and its change of momentum is handed back.
#include <span>
#include <vector>

#include "simulation/impact/body_impacts.h"
#include "simulation/impact/standing_impacts.h"

namespace topple::structure {

class HostContacts {
 public:
  /// What it looks at and changes; all of it must outlive it.
  struct Parts {
    Scene& scene;
    RunningSums& sums;
    Debris& debris;
    StandingImpacts& standing_impacts;
    BodyImpacts& body_impacts;
    StruckClocks& struck;
  };
  explicit HostContacts(const Parts& parts) : to_(parts) {}

  /// A contact of the next step.
  void add(const HostContact& contact) { waiting_.push_back(contact); }
  [[nodiscard]] bool waiting() const { return !waiting_.empty(); }
  /// A step begins: what the last one handed back is of the past.
  void start_step() { impulses_.clear(); }
  /// All that wait, in the order in which they came.
  void strike_all();
  /// Of the contacts of this step.
  [[nodiscard]] std::span<const HostImpulse> impulses() const { return impulses_; }

  template <class Archive>
  void serialize(Archive& archive) {
    auto& [to, waiting, impulses] = *this;
    archive(waiting, impulses);
  }

 private:
  void strike(const HostContact& contact, Part part, HostImpulse& felt);
  void push_debris(const HostContact& contact, HostImpulse& felt);

  Parts to_;
  std::vector<HostContact> waiting_;
  std::vector<HostImpulse> impulses_;
};

}  // namespace topple::structure
