#pragma once
// What happens in one component on its way from one state of rest to the next, and what it frees. With U the elastic
// energy, F loads and u displacements, a sudden change at which loads F0 become F1 and the cut forces s0 vanish frees
//   1/2 (F1 - F0).(u0 + u1) - 1/2 s0.d1 + U of what left,   d1 the gap that opened (Clapeyron's theorem, twice),
// corrected for loads that come or go at their present displacement without doing work. Everything in it is local to
// the change.
#include <map>
#include <vector>

#include "standing/energy/state_of_rest.h"
#include "topple/structure/standing_frame.h"

namespace topple::structure {

class ChangeFromRest {
 public:
  /// Both must outlive it.
  ChangeFromRest(const SolvedFrame& now, const StateOfRest& rest) : now_(now), rest_(rest) {}

  // What happens, each told before the solver and the loads know of it.
  /// `line`: index of the joint's line among the breaks, -1 when it has none.
  void lose_joint(JointId joint, int line);
  void lose_membrane(PanelId panel);
  /// It becomes softer: by how much, as its nodes feel it.
  void soften(PanelId panel, const Eigen::MatrixXd& lost);
  void soften(MemberId member);
  void lose_support(NodeId node) { lose_support(node, now_.statics.reaction(node)); }
  /// One of its supports, that bears this.
  void lose_support(NodeId node, const Vec6& reaction) { supports_.push_back({node, reaction}); }
  /// A node without members: it springs back on its supports.
  void drop(NodeId node);
  void leave(MemberId member);
  void leave(NodeId node);
  /// The panel's load goes another way, or leaves with it; after bearings and segmentation know, before the loads do.
  void hand_on(PanelId panel) { handed_.emplace(panel, now_.loads.handed(panel)); }
  /// A part of a standing panel is gone, and the loads know of it: what the panel hands on by the bearings that it has,
  /// with that part and without.
  void lighten(PanelId panel, const TributaryLoads& before, const TributaryLoads& after);
  void add_load(NodeId node, const Vec6& load);
  /// Gravity turned and nothing else: works at rest, by its direction before.
  void turn_gravity(const LoadWork& before, const LoadWork& now);
  /// Loads are about to be written to the solver.
  void write(MemberId member);
  void write(NodeId node, const Vec6& before) { node_loads_.emplace(node, before); }
  /// A plastic hinge turned: J.
  void dissipate(double work) { sums_.dissipated += work; }
  /// The lines of breaks were handed out: what is freed later is told by none of them.
  void forget_lines();

  /// Members deformed or joints opened.
  [[nodiscard]] bool moves() const { return !shapes_.empty() || !openings_.empty(); }
  /// Panels that were weakened or lost.
  [[nodiscard]] const std::map<PanelId, PanelAtRest>& panels() const { return panels_; }

  /// Works of what left, with corrections for loads that came or went without work; energies, J.
  struct Sums {
    LoadWork left;
    double contact_left = 0, freed = 0, dissipated = 0;
  };
  /// The component, of this number, rests again: what the change did. `slow`: only contact loads changed, and they were
  /// laid on slowly. Adds each told joint's energy to its line; what is not a joint's own is shared equally among them.
  [[nodiscard]] Sums finish(int component, bool slow, std::vector<JointBreak>& breaks);
  /// What it told of becomes part of the state of rest: joints that broke, loads that were written.
  void commit_to(StateOfRest& rest) const;

  template <class Archive>
  void save(Archive& archive) const {
    const auto& [now, rest, shapes, openings, supports, membranes, softened, member_loads, node_loads, came, handed,
                 panels, sums] = *this;
    archive(shapes.size());
    for (const auto& [member, shape] : shapes) {
      archive(member);
      shape.write(archive);
    }
    archive(openings, supports, membranes, softened, member_loads, node_loads, came, handed, panels, sums);
  }
  template <class Archive>
  void load(Archive& archive) {
    std::size_t count = 0;
    archive(count);
    shapes_.clear();
    for (std::size_t i = 0; i < count; ++i) {
      MemberId member;
      archive(member);
      shapes_.emplace(member, SolvedMember::make(archive));
    }
    archive(openings_, supports_, membranes_, softened_, member_loads_, node_loads_, came_, handed_, panels_, sums_);
  }
  template <class Archive>
  friend void serialize(Archive& archive, Sums& sums) {
    auto& [left, contact_left, freed, dissipated] = sums;
    archive(left, contact_left, freed, dissipated);
  }

 private:
  struct Opening {
    JointId joint;
    int line = -1;
    Vec6 force = Vec6::Zero(),
         rigid_end = Vec6::Zero();  ///< what the rigid end did to the member, and where it was; local axes
  };
  struct SupportLoss {
    NodeId node;
    Vec6 reaction = Vec6::Zero();
  };
  struct MembraneLoss {
    PanelId panel;
    std::vector<Vec6> forces;  ///< at its nodes
  };
  template <class Archive>
  friend void serialize(Archive& archive, Opening& opening) {
    auto& [joint, line, force, rigid_end] = opening;
    archive(joint, line, force, rigid_end);
  }
  template <class Archive>
  friend void serialize(Archive& archive, SupportLoss& loss) {
    auto& [node, reaction] = loss;
    archive(node, reaction);
  }
  template <class Archive>
  friend void serialize(Archive& archive, MembraneLoss& loss) {
    auto& [panel, forces] = loss;
    archive(panel, forces);
  }
  /// Work of a load that several parts bear, by whether they stand.
  struct Shares {
    LoadWork standing, left;
  };

  const SolvedMember& shape_at_rest(MemberId member);
  PanelAtRest& at_rest(PanelId panel);
  [[nodiscard]] Vec6 after(NodeId node) const;
  [[nodiscard]] double opened(const Opening& opening) const;
  [[nodiscard]] double load_changes() const;
  [[nodiscard]] double softening() const;
  [[nodiscard]] double yielding(int component) const;
  void settle_panels();
  void settle_contacts(int component);
  void settle_losses();
  void settle_openings(std::vector<JointBreak>& breaks);
  [[nodiscard]] Shares shares(const PlacedLoad& placed);
  [[nodiscard]] Shares shares(const TributaryLoads& handed);
  void add_share(MemberId member, const solver::BeamLoad& load, Shares& shares);
  void add_share(NodeId node, const Vec6& load, Shares& shares) const;

  const SolvedFrame& now_;
  const StateOfRest& rest_;
  std::map<MemberId, SolvedMember> shapes_;  ///< at rest, of members that changed
  std::vector<Opening> openings_;
  std::vector<SupportLoss> supports_;
  std::vector<MembraneLoss> membranes_;
  std::vector<MemberId> softened_;
  std::map<MemberId, std::vector<solver::BeamLoad>> member_loads_;  ///< at rest, of members written anew
  std::map<NodeId, Vec6> node_loads_;
  std::map<NodeId, double> came_;  ///< J: of loads that came in this change, as if they had been there at rest
  std::map<PanelId, TributaryLoads> handed_;  ///< by panels that hand on otherwise now
  std::map<PanelId, PanelAtRest> panels_;
  Sums sums_;
};

}  // namespace topple::structure
