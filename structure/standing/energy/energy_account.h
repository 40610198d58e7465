#pragma once
// Energies of a standing frame from one state of rest (in which nothing breaks) to the next, component by component.
// The static states in between are never reached: their joints break on the way. Elastic energy and works (loads times
// displacements) are summed over what stood in the last state of rest (StateOfRest) when somebody asks, and not before;
// what changes from one rest to the next is written down as it happens (ChangeFromRest).
#include <optional>
#include <vector>

#include "standing/energy/change_from_rest.h"

namespace topple::structure {

class EnergyAccount {
 public:
  /// What `frame` looks at must outlive the account.
  explicit EnergyAccount(const SolvedFrame& frame);
  EnergyAccount(const EnergyAccount&) = delete;
  EnergyAccount& operator=(const EnergyAccount&) = delete;

  /// The building stands and is solved: works count from here.
  void start();

  [[nodiscard]] const SolvedFrame& now() const { return now_; }
  /// Displacement in the last state of rest.
  [[nodiscard]] const Vec6& displacement(NodeId node) const { return rest_.displacement(node); }

  /// What happens on the way to the next state of rest; the component is on that way from now on.
  ChangeFromRest& change(int component);
  ChangeFromRest& change(MemberId member) { return change(now_.statics.component(member)); }
  ChangeFromRest& change(NodeId node) { return change(now_.statics.component(node)); }
  ChangeFromRest& change(PanelId panel) { return change(now_.component(panel)); }
  /// Loads are about to be written to the solver; nothing before start().
  void write(MemberId member);
  void write(NodeId node, const Vec6& before);
  /// Around a change of gravity: before and after the loads know of it.
  void turn_gravity();
  void gravity_turned(const Vec3& gravity);

  /// The component rests again; see ChangeFromRest::finish().
  void finish(int component, bool slow, std::vector<JointBreak>& breaks);
  /// The lines of breaks were handed out: what is freed later is told by none of them.
  void lines_are_out();

  [[nodiscard]] FrameEnergy energy() const;
  [[nodiscard]] double freed() const { return past_.freed; }  ///< as in energy()
  /// The last state of rest.
  [[nodiscard]] const StateOfRest& at_rest() const { return rest_; }
  /// J, of the component in its last state of rest.
  [[nodiscard]] double elastic_at_rest(int component) const { return rest(component).elastic; }

  template <class Archive>
  void save(Archive& archive) const {
    const auto& [now, rest, started, elastic_at_start, start, past, rests, changes] = *this;
    archive(now, rest, started, elastic_at_start, start, past, rests);
    for (const std::optional<ChangeFromRest>& change : changes) {
      archive(change.has_value());
      if (change) archive(*change);
    }
  }
  template <class Archive>
  void load(Archive& archive) {
    archive(now_, rest_, started_, elastic_at_start_, start_, past_, rests_);
    for (std::optional<ChangeFromRest>& change : changes_) {
      bool under_way = false;
      archive(under_way);
      change.reset();
      if (under_way) archive(change.emplace(now_, rest_));
    }
  }

 private:
  /// Sums over what stood in the state of rest, J.
  struct Rest {
    LoadWork work;
    double contact = 0, elastic = 0;
  };
  template <class Archive>
  friend void serialize(Archive& archive, Rest& sums) {
    auto& [work, contact, elastic] = sums;
    archive(work, contact, elastic);
  }
  const Rest& rest(int component) const;

  SolvedFrame now_;
  StateOfRest rest_;
  bool started_ = false;
  double elastic_at_start_ = 0;
  LoadWork start_;
  ChangeFromRest::Sums past_;                           ///< of all changes that are finished
  mutable std::vector<std::optional<Rest>> rests_;      ///< per component: made when needed
  std::vector<std::optional<ChangeFromRest>> changes_;  ///< per component: while it is on its way
};

}  // namespace topple::structure
