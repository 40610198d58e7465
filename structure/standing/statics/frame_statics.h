#pragma once
// The solver behind a standing frame, in the building's own ids: what changes it, and what brings it up to date. What
// can be asked is FrameAnswers, which part lies where FrameNumbers.
#include <functional>
#include <optional>
#include <vector>

#include "standing/statics/frame_answers.h"

namespace topple::structure {

/// A motion without strain that the solver found, for every node of the building.
struct FrameMechanism {
  std::vector<NodeId> nodes;  ///< most first
  std::vector<Vec6> motion;
};

/// What a selective answer must not leave out (solver::UtilisationWatch), in the building's ids.
class MemberWatch {
 public:
  virtual ~MemberWatch() = default;
  /// The member's end forces (the membrane's corner forces) were brought up to date: reads them; the largest
  /// utilisation. No other may be asked for meanwhile.
  [[nodiscard]] virtual double member_utilisation(MemberId member, const solver::Vec12& end_forces) = 0;
  [[nodiscard]] virtual double membrane_utilisation(PanelId membrane, const std::array<Vec6, 4>& corner_forces) = 0;
  /// As UtilisationWatch's growths.
  [[nodiscard]] virtual double member_growth(MemberId member, const solver::Vec12& root) = 0;
  [[nodiscard]] virtual double membrane_growth(PanelId membrane, const std::array<Vec6, 4>& root) = 0;
};

/// All that FrameAnswers tells, and what changes it.
class FrameStatics : public FrameAnswers {
 public:
  FrameStatics(const Building& building, const PanelSuperelements& shells, int threads);

  // Changes; they take effect together in the next solve() of their component.
  void break_joint(MemberId member, int end);
  void remove(MemberId member);
  void remove_membrane(PanelId panel);
  /// Of a membrane (24 freedoms) or shell panel: what its nodes (Panel::all_nodes()) feel of it from now on.
  void set_stiffness(PanelId panel, const Eigen::MatrixXd& stiffness);
  void remove_support(NodeId node);
  /// That of a panel's edge alone, by its index in Building::edge_supports.
  void remove_support(NodeId node, std::size_t edge_support);
  /// Factor on E and G, above 0.
  void set_stiffness(MemberId member, double factor);
  void drop(const std::vector<NodeId>& nodes);
  /// Loads in the member's local axes; BeamLoad::beam is set here.
  void set_loads(MemberId member, std::vector<solver::BeamLoad> loads);
  void set_load(NodeId node, const Vec6& load);

  // Plastic hinges at the ends of members, component 3 to 5 of the member's axes.
  /// From now on the end turns freely in this component under the moment `held` that the node gives to the member.
  void let_yield(MemberId member, int end, int axis, double held);
  /// It unloads (with `stiffness`), turned by `plastic_rotation` (node less end).
  void unload(MemberId member, int end, int axis, double stiffness, double plastic_rotation);

  /// A frame of the same arrays that moves takes every change of the component as well from now on; null: none does.
  void follow(int component, solver::FrameDynamics* moving) {
    components_[static_cast<std::size_t>(component)].moving = moving;
  }
  /// Called before a component that was solved changes.
  void before_changes(std::function<void(int component)> told) { before_change_ = std::move(told); }

  /// Brings one component up to date. A mechanism leaves the displacements as they were.
  /// With second order the answer is that of the displaced structure, iterated on the elastic factor with the geometric
  /// forces as loads, K u' = F - Kg(N) u; where that does not settle (the loads are near or beyond what it bears before
  /// it buckles) the first-order answer stands, and diverged() says so.
  [[nodiscard]] std::optional<FrameMechanism> solve(int component);
  void use_second_order() { second_order_ = true; }
  /// The same where the watch's uses may matter. What is asked for later makes the answer whole.
  [[nodiscard]] std::optional<FrameMechanism> solve(int component, MemberWatch& watch);
  /// Makes the answer whole; the watch reads what was left out.
  void complete(int component, MemberWatch& watch);
  /// Capacities changed.
  void forget_utilisations(int component) { state(component).analysis->forget_utilisations(); }
  /// What uses are counted from changed.
  void forget_references(int component) { state(component).analysis->forget_references(); }
  /// Nothing of the component stands: there is nothing to solve.
  void forget(int component);

  /// Whoever asks to be told before_changes() does so anew.
  template <class Archive>
  void serialize(Archive& archive) {
    FrameAnswers::serialize(archive);
    archive(geometric_);
  }

 private:
  class Adapter;
  FrameStatics(const Building& building, const Frame& frame, const PanelSuperelements& shells, int threads);
  /// Does it to the analysis of the component, and to what follows it.
  template <class Change>
  void change(const Place& place, const Change& change);
  bool displace(int component);
  void lose_support(std::size_t support);
  void write_loads(MemberId member);
  void write_load(NodeId node);
  void set_hinge(MemberId member, int end, int axis, double stiffness, double held, double plastic_rotation);
  std::optional<FrameMechanism> told(int component, const solver::ReanalysisAnswer& answer);

  std::vector<Vec6> geometric_;  ///< second order: added to the loads, per node
  std::function<void(int)> before_change_;
};

template <class Change>
void FrameStatics::change(const Place& place, const Change& change) {
  Component& component = components_[static_cast<std::size_t>(place.component)];
  if (!component.changed && before_change_) before_change_(place.component);
  component.changed = true;
  change(*component.analysis);
  if (component.moving != nullptr) change(*component.moving);
}

}  // namespace topple::structure
