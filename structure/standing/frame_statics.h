#pragma once
// The solver behind a standing frame, in the building's own ids. Each connected component that the undamaged building
// has (by members, panels and diaphragms) is one solver::Reanalysis, so that a street of houses costs what was
// touched.
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "standing/panel_superelements.h"
#include "topple/solver/frame_dynamics.h"
#include "topple/solver/reanalysis.h"
#include "topple/structure/frame.h"

namespace topple::structure {

/// A motion without strain that the solver found, for every node of the building.
struct FrameMechanism {
  std::vector<NodeId> nodes;  ///< most first
  std::vector<Vec6> motion;
};

/// What a selective answer must not leave out (solver::UseWatch), in the building's ids.
class MemberWatch {
 public:
  virtual ~MemberWatch() = default;
  /// The member's end forces (the membrane's corner forces) were brought up to date: reads them; the largest use. No
  /// other may be asked for meanwhile.
  [[nodiscard]] virtual double member_use(MemberId member, const solver::Vec12& end_forces) = 0;
  [[nodiscard]] virtual double membrane_use(PanelId membrane, const std::array<Vec6, 4>& corner_forces) = 0;
  /// As UseWatch's growths.
  [[nodiscard]] virtual double member_growth(MemberId member, const solver::Vec12& root) = 0;
  [[nodiscard]] virtual double membrane_growth(PanelId membrane, const std::array<Vec6, 4>& root) = 0;
};

class FrameStatics {
 public:
  FrameStatics(const Building& building, const PanelSuperelements& shells, int threads);

  // Changes; they take effect together in the next solve() of their component.
  void break_joint(MemberId member, int end);
  void remove(MemberId member);
  void remove_membrane(PanelId panel);
  /// Of a membrane as it is while whole.
  [[nodiscard]] Mat24 membrane_stiffness(PanelId panel) const;
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
  /// By how much the nodes have turned against the member's ends at hinges that hold; local axes.
  [[nodiscard]] solver::Vec12 plastic_rotations(MemberId member) const;

  /// A frame of the same arrays that moves takes every change of the component as well from now on; null: none does.
  void follow(int component, solver::FrameDynamics* moving) {
    components_[static_cast<std::size_t>(component)].moving = moving;
  }
  /// Called before a component that was solved changes.
  void before_changes(std::function<void(int component)> told) { before_change_ = std::move(told); }
  /// As solved last, with nodes, beams, shells and supports numbered within the component.
  [[nodiscard]] const solver::FrameModel& model(int component) const { return parts(component).analysis->model(); }
  /// Index in model(component()).
  [[nodiscard]] int number(NodeId node) const { return node_place_[index(node)].local; }
  [[nodiscard]] int number(MemberId member) const { return member_place_[index(member)].local; }
  [[nodiscard]] int number(PanelId panel) const { return membrane_place_[index(panel)].local; }
  /// On a member; what stands for its plastic hinges apart.
  [[nodiscard]] const std::vector<solver::BeamLoad>& loads(MemberId member) const {
    return member_loads_[index(member)];
  }
  [[nodiscard]] const Vec6& load(NodeId node) const { return node_loads_[index(node)]; }

  [[nodiscard]] int components() const { return static_cast<int>(components_.size()); }
  [[nodiscard]] int component(NodeId node) const { return node_place_[index(node)].component; }
  [[nodiscard]] int component(MemberId member) const { return member_place_[index(member)].component; }
  [[nodiscard]] bool changed(int component) const { return parts(component).changed; }
  [[nodiscard]] const std::vector<MemberId>& members(int component) const { return parts(component).members; }
  [[nodiscard]] const std::vector<NodeId>& nodes(int component) const { return parts(component).nodes; }
  [[nodiscard]] const std::vector<PanelId>& membranes(int component) const { return parts(component).membranes; }
  [[nodiscard]] const std::vector<PanelId>& shells(int component) const { return parts(component).shells; }
  /// Both, membranes first.
  [[nodiscard]] std::vector<PanelId> plates(int component) const {
    std::vector<PanelId> all = membranes(component);
    all.insert(all.end(), shells(component).begin(), shells(component).end());
    return all;
  }
  /// A membrane or shell panel that has its stiffness.
  [[nodiscard]] bool stiff(PanelId panel) const { return stiff_[index(panel)] != 0; }

  /// Brings one component up to date. A mechanism leaves the displacements as they were.
  /// With second order the answer is that of the displaced structure, iterated on the elastic factor with the geometric
  /// forces as loads, K u' = F - Kg(N) u; where that does not settle (the loads are near or beyond what it bears before
  /// it buckles) the first-order answer stands, and diverged() says so.
  [[nodiscard]] std::optional<FrameMechanism> solve(int component);
  void use_second_order() { second_order_ = true; }
  [[nodiscard]] bool diverged(int component) const { return parts(component).diverged; }
  /// The same where the watch's uses may matter. What is asked for later makes the answer whole.
  [[nodiscard]] std::optional<FrameMechanism> solve(int component, MemberWatch& watch);
  /// Makes the answer whole; the watch reads what was left out.
  void complete(int component, MemberWatch& watch);
  /// Something was left out of what the last watch read of the component's answer.
  [[nodiscard]] bool partial(int component) const { return parts(component).unwatched; }
  /// Capacities changed.
  void forget_uses(int component) { components_[static_cast<std::size_t>(component)].analysis->forget_uses(); }
  /// What uses are counted from changed.
  void forget_references(int component) {
    components_[static_cast<std::size_t>(component)].analysis->forget_references();
  }
  /// Nothing of the component stands: there is nothing to solve.
  void forget(int component);

  // The answer as solved last.
  [[nodiscard]] const Vec6& displacement(NodeId node) const;
  /// What flowing hinges hold included. They outlive a mechanism that solve() finds later.
  [[nodiscard]] const solver::Vec12& end_forces(MemberId member) const;
  /// The same without the geometric forces of second order: those of what strains the member.
  [[nodiscard]] solver::Vec12 elastic_end_forces(MemberId member) const;
  /// As it is now, weakened E and G included.
  [[nodiscard]] solver::Beam beam(MemberId member) const;
  [[nodiscard]] double stiffness(MemberId member) const { return member_stiffness_[index(member)]; }
  [[nodiscard]] const solver::Shell& shell(PanelId membrane) const;
  /// What set_stiffness() gave the membrane before the last solve(); null: its one element's own.
  [[nodiscard]] const Mat24* given_stiffness(PanelId membrane) const;
  [[nodiscard]] const Eigen::MatrixXd& shell_stiffness(PanelId shell) const;
  /// As they are now, with the nodes numbered as in nodes().
  [[nodiscard]] const std::vector<solver::Support>& supports(int component) const {
    return parts(component).analysis->model().supports;
  }
  [[nodiscard]] double strain_energy(int component) const;
  [[nodiscard]] std::array<Vec6, 4> corner_forces(PanelId membrane) const;
  /// What the panel's nodes (Panel::all_nodes()) do to a membrane or shell panel, global.
  [[nodiscard]] std::vector<Vec6> node_forces(PanelId panel) const;
  /// The same at other displacements of its nodes, by the stiffness that it has in the answer.
  [[nodiscard]] std::vector<Vec6> node_forces(PanelId panel, const std::vector<Vec6>& displacements) const;
  /// Of the support at its index in Building::supports.
  [[nodiscard]] Vec6 reaction(std::size_t support) const;
  /// Of all supports at a node, those of panel edges included.
  [[nodiscard]] Vec6 reaction(NodeId node) const;
  [[nodiscard]] Vec6 reaction(NodeId node, std::size_t edge_support) const;
  /// Displacement of a point of a member's axis at this distance from its first end, `loads` being those on it.
  [[nodiscard]] Vec3 point_displacement(MemberId member, double distance,
                                        const std::vector<solver::BeamLoad>& loads) const;

  /// Response to loads on one component alone, in building ids.
  class Response {
   public:
    [[nodiscard]] const Vec6& displacement(NodeId node) const;
    [[nodiscard]] solver::Vec12 end_forces(MemberId member) const;
    [[nodiscard]] Vec3 point_displacement(MemberId member, double distance,
                                          const std::vector<solver::BeamLoad>& loads) const;
    [[nodiscard]] int component() const { return component_; }
    /// False only of a response on elimination paths: the displacement is not known there.
    [[nodiscard]] bool known(NodeId node) const;

   private:
    friend class FrameStatics;
    const FrameStatics* statics_ = nullptr;
    int component_ = 0;
    solver::Reanalysis::Response answer_;
    std::vector<char> known_;  ///< per node of the component; empty: everywhere
  };
  struct ResponseLoads {
    std::vector<std::pair<MemberId, solver::BeamLoad>> members;
    std::vector<std::pair<NodeId, Vec6>> nodes;
  };
  [[nodiscard]] Response respond(int component, const ResponseLoads& loads) const;
  /// At a part of the cost, and known on the elimination paths of the loads alone, where they act among them.
  [[nodiscard]] Response respond_near(int component, const ResponseLoads& loads) const;
  /// Both for several loads at once, at less than as many times the cost; known on the paths of all of them.
  [[nodiscard]] std::vector<Response> respond(int component, std::span<const ResponseLoads> loads) const;
  [[nodiscard]] std::vector<Response> respond_near(int component, std::span<const ResponseLoads> loads) const;
  /// Diagonal of the stiffness that the member had in the undamaged building, local axes.
  [[nodiscard]] const solver::Vec12& stiffness_diagonal(MemberId member) const {
    return stiffness_diagonal_[index(member)];
  }

  [[nodiscard]] solver::ReanalysisCounters counters() const;
  /// Answers of one component so far.

 private:
  struct Place {
    int component = -1, local = -1;
  };
  struct Component {
    std::vector<NodeId> nodes;
    std::vector<MemberId> members;
    std::vector<PanelId> membranes, shells;  ///< shells and patches of the model, in order
    std::unique_ptr<solver::Reanalysis> analysis;
    bool changed = true, gone = false, diverged = false;
    bool unwatched = false;        ///< the watch has not read all of the answer
    mutable bool partial = false;  ///< end_forces_ of some members are behind
    solver::FrameDynamics* moving = nullptr;
  };
  template <class Tag>
  static std::size_t index(Id<Tag> id) {
    return static_cast<std::size_t>(id.index);
  }
  [[nodiscard]] const Component& parts(int component) const { return components_[static_cast<std::size_t>(component)]; }
  /// Of a member with hinges: what those that yield hold, how far those that unload have slipped, and the stiffness
  /// of both ends with the flowing ones released.
  struct Hinges {
    std::array<Vec6, 2> stiffness;
    solver::Vec12 held = solver::Vec12::Zero(), plastic_rotation = solver::Vec12::Zero();
  };
  [[nodiscard]] solver::LoadSet local(const ResponseLoads& loads) const;
  [[nodiscard]] std::vector<Response> told(int component, std::vector<solver::Reanalysis::Response> answers,
                                           const std::vector<char>& known) const;
  /// Does it to the analysis of the component, and to what follows it.
  template <class Change>
  void change(const Place& place, const Change& change);
  void read_end_forces(int component);
  bool displace(int component);
  void lose_support(std::size_t support);
  void write_loads(MemberId member);
  void write_load(NodeId node);
  [[nodiscard]] std::vector<solver::BeamLoad> with_hinges(MemberId member, std::vector<solver::BeamLoad> loads) const;
  void set_hinge(MemberId member, int end, int axis, double stiffness, double held, double plastic_rotation);
  [[nodiscard]] const solver::Reanalysis& at(const Place& place) const;
  class Adapter;
  std::optional<FrameMechanism> told(int component, const solver::ReanalysisAnswer& answer);
  void read_end_forces(const Component& component, MemberId member) const;
  [[nodiscard]] solver::Vec12 answered_end_forces(const Component& component, MemberId member) const;
  void read_end_forces(const Component& component) const;
  std::vector<solver::FrameModel> split(const Building& building, const Frame& frame);
  void place_panels(const Building& building, const Frame& frame, std::vector<solver::FrameModel>& models);
  void place_supports(const Building& building, const Frame& frame, std::vector<solver::FrameModel>& models);

  std::vector<Place> node_place_, member_place_, membrane_place_, support_place_;
  std::vector<NodeId> support_node_;
  std::vector<int> support_edge_;                  ///< per support: index in Building::edge_supports, -1: of a node
  std::vector<char> stiff_, patch_;                ///< per panel: it has stiffness; it is a patch of the model
  mutable std::vector<solver::Vec12> end_forces_;  ///< of a partial answer, as far as they were asked for
  std::vector<solver::Vec12> stiffness_diagonal_;
  std::vector<double> member_stiffness_;  ///< factors
  std::vector<Component> components_;
  std::map<MemberId, Hinges> hinges_;
  std::vector<std::vector<solver::BeamLoad>> member_loads_;  ///< as given
  std::vector<Vec6> node_loads_;                             ///< as given
  std::vector<Vec6> geometric_;                              ///< second order: added to them, per node
  bool second_order_ = false;
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
