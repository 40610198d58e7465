#pragma once
// The statics of what stands as they were solved last, in the building's ids, and answers to loads besides its own:
// all that can be asked without changing anything. Each component is one solver::Reanalysis, so that a street of houses
// costs what was touched.
#include <map>
#include <memory>
#include <span>
#include <vector>

#include "archive/nested_state.h"
#include "standing/panel_superelements.h"
#include "standing/statics/frame_numbers.h"
#include "topple/solver/frame_dynamics.h"
#include "topple/solver/reanalysis.h"

namespace topple::structure {

class FrameAnswers : public FrameNumbers {
 public:
  [[nodiscard]] bool changed(int component) const { return state(component).changed; }
  /// With second order: the answer did not settle, and is that of the first order.
  [[nodiscard]] bool diverged(int component) const { return state(component).diverged; }
  /// Something was left out of what the last watch read of the component's answer.
  [[nodiscard]] bool partial(int component) const { return state(component).unwatched; }
  /// As solved last, with nodes, beams, shells and supports numbered within the component.
  [[nodiscard]] const solver::FrameModel& model(int component) const { return state(component).analysis->model(); }
  /// On a member; what stands for its plastic hinges apart.
  [[nodiscard]] const std::vector<solver::BeamLoad>& loads(MemberId member) const {
    return member_loads_[index(member)];
  }
  [[nodiscard]] const Vec6& load(NodeId node) const { return node_loads_[index(node)]; }

  // Stiffness as it is.
  /// A membrane or shell panel that has its stiffness.
  [[nodiscard]] bool stiff(PanelId panel) const { return stiff_[index(panel)] != 0; }
  /// Of a membrane as it is while whole.
  [[nodiscard]] Mat24 membrane_stiffness(PanelId panel) const;
  /// As it is now, weakened E and G included.
  [[nodiscard]] solver::Beam beam(MemberId member) const;
  [[nodiscard]] double stiffness(MemberId member) const { return member_stiffness_[index(member)]; }
  [[nodiscard]] const solver::Shell& shell(PanelId membrane) const;
  /// What set_stiffness() gave the membrane before the last solve(); null: its one element's own.
  [[nodiscard]] const Mat24* given_stiffness(PanelId membrane) const;
  [[nodiscard]] const Eigen::MatrixXd& shell_stiffness(PanelId shell) const;
  /// As they are now, with the nodes numbered as in nodes().
  [[nodiscard]] const std::vector<solver::Support>& supports(int component) const { return model(component).supports; }
  /// Diagonal of the stiffness that the member had in the undamaged building, local axes.
  [[nodiscard]] const solver::Vec12& stiffness_diagonal(MemberId member) const {
    return stiffness_diagonal_[index(member)];
  }
  /// By how much the nodes have turned against the member's ends at hinges that hold; local axes.
  [[nodiscard]] solver::Vec12 plastic_rotations(MemberId member) const;

  // The answer as solved last.
  [[nodiscard]] const Vec6& displacement(NodeId node) const;
  /// What yielding hinges hold included. They outlive a mechanism that solve() finds later.
  [[nodiscard]] const solver::Vec12& end_forces(MemberId member) const;
  /// The same without the geometric forces of second order: those of what strains the member.
  [[nodiscard]] solver::Vec12 elastic_end_forces(MemberId member) const;
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
    friend class FrameAnswers;
    const FrameAnswers* statics_ = nullptr;
    int component_ = 0;
    solver::Reanalysis::Response answer_;
    std::vector<char> known_;  ///< per node of the component; empty: everywhere
  };
  [[nodiscard]] Response respond(int component, const ResponseLoads& loads) const;
  /// At a part of the cost, and known on the elimination paths of the loads alone, where they act among them.
  [[nodiscard]] Response respond_near(int component, const ResponseLoads& loads) const;
  /// Both for several loads at once, at less than as many times the cost; known on the paths of all of them.
  [[nodiscard]] std::vector<Response> respond(int component, std::span<const ResponseLoads> loads) const;
  [[nodiscard]] std::vector<Response> respond_near(int component, std::span<const ResponseLoads> loads) const;

  /// Of all components.
  [[nodiscard]] solver::ReanalysisCounters counters() const;

  /// `stiffness_diagonal_` is of the undamaged building, the rules say whether `second_order_`.
  template <class Archive>
  void serialize(Archive& archive) {
    archive(stiff_, end_forces_, member_stiffness_, components_, hinges_, member_loads_, node_loads_);
  }

 protected:
  struct Component {
    std::unique_ptr<solver::Reanalysis> analysis;
    bool changed = true, gone = false, diverged = false;
    bool unwatched = false;        ///< the watch has not read all of the answer
    mutable bool partial = false;  ///< end_forces_ of some members are behind
    solver::FrameDynamics* moving = nullptr;
    template <class Archive>
    void serialize(Archive& archive) {
      auto& [solved_by, has_changed, has_gone, has_diverged, is_unwatched, is_partial, followed_by] = *this;
      NestedState nested{*solved_by};
      archive(nested, has_changed, has_gone, has_diverged, is_unwatched, is_partial);  // motion begins to follow anew
    }
  };
  /// Of a member with hinges: what those that yield hold, how far those that unload have slipped, and the stiffness
  /// of both ends with the yielding ones released.
  struct Hinges {
    std::array<Vec6, 2> stiffness;
    solver::Vec12 held = solver::Vec12::Zero(), plastic_rotation = solver::Vec12::Zero();
  };
  template <class Archive>
  friend void serialize(Archive& archive, Hinges& hinges) {
    auto& [stiffness, held, plastic_rotation] = hinges;
    archive(stiffness, held, plastic_rotation);
  }

  FrameAnswers(const Building& building, const Frame& frame, std::vector<solver::FrameModel> models, int threads);
  [[nodiscard]] const Component& state(int component) const { return components_[static_cast<std::size_t>(component)]; }
  [[nodiscard]] const solver::Reanalysis& at(const Place& place) const { return *state(place.component).analysis; }
  [[nodiscard]] std::vector<solver::BeamLoad> with_hinges(MemberId member, std::vector<solver::BeamLoad> loads) const;
  void read_end_forces(MemberId member) const;
  void read_end_forces(int component) const;
  [[nodiscard]] solver::Vec12 answered_end_forces(MemberId member) const;

  std::vector<char> stiff_;                        ///< per panel: it has stiffness
  mutable std::vector<solver::Vec12> end_forces_;  ///< of a partial answer, as far as they were asked for
  std::vector<solver::Vec12> stiffness_diagonal_;
  std::vector<double> member_stiffness_;  ///< factors
  std::vector<Component> components_;
  std::map<MemberId, Hinges> hinges_;
  std::vector<std::vector<solver::BeamLoad>> member_loads_;  ///< as given
  std::vector<Vec6> node_loads_;                             ///< as given
  bool second_order_ = false;

 private:
  [[nodiscard]] std::vector<Response> told(int component, std::vector<solver::Reanalysis::Response> answers,
                                           const std::vector<char>& known) const;
};

}  // namespace topple::structure
