#pragma once
// Energies of a standing frame from one state of rest (in which nothing breaks) to the next, component by component.
// The static states in between are never reached: their joints break on the way. With U the elastic energy, F loads and
// u displacements, a sudden change at which loads F0 become F1 and the cut forces s0 vanish frees
//   1/2 (F1 - F0).(u0 + u1) - 1/2 s0.d1 + U of what left,   d1 the gap that opened (Clapeyron's theorem, twice),
// corrected for loads that come or go at their present displacement without doing work. Everything in it is local to
// the change. Elastic energy and works (loads times displacements) are summed over what stood in the last state of rest
// when somebody asks, and not before: the state is kept, what changes in it from one rest to the next is written anew.
#include <map>
#include <vector>

#include "failure/segmentation.h"
#include "loads/frame_loads.h"
#include "model/member_shape.h"
#include "standing/frame_statics.h"
#include "topple/structure/standing_frame.h"

namespace topple::structure {

class EnergyAccount {
 public:
  /// What it looks at; all of it must outlive the account.
  struct Sources {
    const Building& building;
    const Segmentation& segments;
    const PanelBearings& bearings;
    const FrameLoads& loads;
    const FrameStatics& statics;
    const std::vector<char>& node_solved;                       ///< per node: the solver holds it
    const std::vector<std::vector<solver::BeamLoad>>& applied;  ///< per member: what the solver has
  };
  explicit EnergyAccount(const Sources& sources);

  /// The building stands and is solved: works count from here.
  void start();

  /// Displacement in the last state of rest.
  [[nodiscard]] const Vec6& displacement(NodeId node) const { return rest_displacement_[index(node)]; }
  /// True while the component is on its way from one state of rest to the next.
  [[nodiscard]] bool open(int component) const { return changes_[static_cast<std::size_t>(component)].open; }

  // What happens on the way to the next state of rest, each told before the solver and the loads know of it.
  /// `told`: index of the joint's line among the breaks, -1 when it has none.
  void lose_joint(JointId joint, int told);
  void lose_membrane(PanelId panel);
  /// It becomes softer: by how much, as its nodes feel it.
  void soften(PanelId panel, const Eigen::MatrixXd& lost);
  /// It is about to become softer.
  void soften(MemberId member);
  void lose_support(NodeId node) { lose_support(node, from_.statics.reaction(node)); }
  /// One of its supports, that bears this.
  void lose_support(NodeId node, const Vec6& reaction);
  void drop(NodeId node);
  void leave(MemberId member);
  void leave(NodeId node);
  /// The panel's load goes another way, or leaves with it; after bearings and segmentation know, before the loads do.
  void hand_on(PanelId panel);
  /// Around the loss of a part of a standing panel: before the loads know of it, and after; what it hands on by the
  /// bearings that it has, with that part and without.
  void lighten(PanelId panel) { begin(from_.building[panel].nodes[0]); }
  void lightened(PanelId panel, const TributaryLoads& before, const TributaryLoads& after);
  void add_load(NodeId node, const Vec6& load);
  /// Around a change of gravity: before and after the loads know of it.
  void turn_gravity();
  void gravity_turned(const Vec3& gravity);
  /// Loads are about to be written to the solver.
  void write(MemberId member);
  void write(NodeId node, const Vec6& before);

  /// A plastic hinge turned: told as it turns, on the way from one state of rest to the next.
  void dissipate(MemberId member, double work);
  [[nodiscard]] MemberShape shape_now(MemberId member) const;
  /// Displacements of the rigid ends at a member's ends, local axes, from those of its nodes.
  [[nodiscard]] solver::Vec12 rigid_ends(MemberId member, const Vec6& first, const Vec6& second) const;

  /// The component rests again. `slow`: only contact loads changed, and they were laid on slowly. Adds each told
  /// joint's energy to its line, what is not a joint's own shared equally between those told.
  void finish(int component, bool slow, std::vector<JointBreak>& breaks);
  /// The lines of breaks were handed out: what is freed later is told by none of them.
  void lines_are_out();

  [[nodiscard]] FrameEnergy energy() const;
  [[nodiscard]] double freed() const { return freed_; }  ///< as in energy()

 private:
  struct Opening {
    JointId joint;
    int told = -1;
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
  /// A panel that has stiffness, as it was at rest.
  struct Plate {
    std::vector<Vec6> forces;  ///< at its nodes, those of what is left of it
    double energy = 0;         ///< of all that it was
  };
  /// A support that gives.
  struct Spring {
    NodeId node;
    Vec6 stiffness = Vec6::Zero();  ///< infinite where it does not give
  };
  /// What happened in one component since it rested last.
  struct Change {
    bool open = false;
    std::map<MemberId, MemberShape> before;
    std::vector<Opening> openings;
    std::vector<SupportLoss> supports;
    std::vector<MembraneLoss> membranes;
    std::vector<MemberId> softened;
    std::map<MemberId, std::vector<solver::BeamLoad>> member_loads;
    std::map<NodeId, Vec6> node_loads;
    std::map<PanelId, TributaryLoads> handed;  ///< by panels that hand on otherwise now
    std::map<PanelId, Plate> plates;           ///< those that were weakened or lost
    LoadWork left;  ///< works of what left, and corrections for loads that came or went without work
    double contact_left = 0, freed = 0, dissipated = 0;
  };
  /// Sums over what stood in the state of rest, made when needed.
  struct Rest {
    bool known = false;
    LoadWork work;
    double contact = 0, elastic = 0;
  };
  struct Shares {
    LoadWork standing, left;
  };

  template <class Tag>
  static std::size_t index(Id<Tag> id) {
    return static_cast<std::size_t>(id.index);
  }
  Change& begin(int component);
  Change& begin(MemberId member) { return begin(from_.statics.component(member)); }
  Change& begin(NodeId node) { return begin(from_.statics.component(node)); }
  const MemberShape& shape_at_rest(MemberId member);
  [[nodiscard]] MemberShape rest_shape(MemberId member) const;
  [[nodiscard]] std::span<const solver::BeamLoad> rest_own_loads(MemberId member) const;
  Plate& plate_at_rest(PanelId panel);
  [[nodiscard]] Plate rest_plate(PanelId panel) const;
  [[nodiscard]] solver::Vec12 rest_plastic_rotations(MemberId member) const;
  [[nodiscard]] double turned(int component) const;
  [[nodiscard]] Vec6 rigid_end_now(MemberId member, int end) const;
  [[nodiscard]] Vec3 local_gravity(MemberId member) const;
  [[nodiscard]] double opened(const Opening& opening) const;
  [[nodiscard]] double load_changes(const Change& change) const;
  [[nodiscard]] double softening(const Change& change) const;
  [[nodiscard]] Vec6 after(NodeId node) const;
  [[nodiscard]] LoadWork load_work(int component) const;
  [[nodiscard]] double rest_contact_work(int component) const;
  [[nodiscard]] double rest_elastic(int component) const;
  [[nodiscard]] LoadWork rest_load_work(int component) const;
  const Rest& rest(int component) const;
  void remember(int component);
  void remember_loads(MemberId member);
  void remember_loads(NodeId node);
  void remember_contacts(int component);
  void settle_panels(Change& change);
  void settle_contacts(int component, Change& change);
  [[nodiscard]] int component(const PlacedLoad& placed) const;
  [[nodiscard]] bool stays(const PlacedLoad& placed) const;
  Shares shares(const PlacedLoad& placed);
  [[nodiscard]] Shares shares(const TributaryLoads& handed);
  void add_share(MemberId member, const solver::BeamLoad& load, Shares& shares);
  void add_share(NodeId node, const Vec6& load, Shares& shares);

  Sources from_;
  Vec3 gravity_ = -Vec3::UnitZ();
  bool started_ = false;
  double elastic_at_start_ = 0;
  LoadWork start_, left_;
  double contact_left_ = 0, freed_ = 0, dissipated_ = 0;

  // The last state of rest.
  std::vector<Vec6> rest_displacement_;
  std::vector<solver::Vec12> rest_end_forces_;
  std::vector<std::vector<solver::BeamLoad>> rest_loads_;
  std::vector<std::size_t> rest_own_;                     ///< per member: of its loads those that are no contacts
  std::vector<Vec6> rest_node_loads_, rest_event_loads_;  ///< per node, contacts apart; those of events
  std::vector<char> rest_member_stands_, rest_node_stands_;
  std::vector<std::vector<Spring>> rest_springs_;  ///< per component
  std::map<std::int64_t, PlacedLoad> rest_contacts_;
  std::vector<char> rest_holds_;                              ///< per joint of a member
  std::map<MemberId, solver::Vec12> rest_plastic_rotations_;  ///< of members with plastic hinges
  std::vector<double> rest_stiffness_;                        ///< per member: factor
  mutable std::vector<Rest> rests_;
  std::vector<Change> changes_;
};

}  // namespace topple::structure
