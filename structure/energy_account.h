#pragma once
// Energies of a standing frame from one solved state to the next. With U the elastic energy, F loads and u
// displacements, a sudden change at which loads F0 become F1 and the cut forces s0 vanish frees
//   1/2 (F1 - F0).(u0 + u1) - 1/2 s0.d1 + U of what left,   d1 the gap that opened (Clapeyron's theorem, twice),
// corrected for loads that come or go at their present displacement without doing work. Everything in it is local to
// the change. Works are loads times displacements, summed over what stands when somebody asks.
#include <map>
#include <vector>

#include "frame_loads.h"
#include "frame_statics.h"
#include "member_shape.h"
#include "segmentation.h"
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

  // What happens on the way to the next state, each told before the solver and the loads know of it.
  /// `told`: index of the joint's line among the breaks, -1 when it has none.
  void lose_joint(JointId joint, int told);
  void lose_membrane(PanelId panel);
  void lose_support(NodeId node);
  void drop(NodeId node);
  void leave(MemberId member);
  void leave(NodeId node);
  /// The panel's load goes another way, or leaves with it; after bearings and segmentation know, before the loads do.
  void hand_on(PanelId panel);
  void drop_contact(const PlacedLoad& placed);
  void add_load(NodeId node, const Vec6& load);
  /// Works of all loads at present; to be handed to gravity_turned() after the loads know of the new gravity.
  [[nodiscard]] LoadWork load_work() const;
  void gravity_turned(const LoadWork& before, const Vec3& gravity);
  /// Loads are about to be written to the solver.
  void write(MemberId member);
  void write(NodeId node, const Vec6& before);

  /// The next state is solved. `slow`: only contact loads changed, and they were laid on slowly. Adds each told joint's
  /// energy to its line, what is not a joint's own shared equally between those of this change.
  void finish(bool slow, std::vector<JointBreak>& breaks);

  [[nodiscard]] FrameEnergy energy() const;

 private:
  struct Opening {
    JointId joint;
    int told = -1;
    Vec6 force = Vec6::Zero(), hub = Vec6::Zero();  ///< what the hub did to the member, and where it was; local axes
  };
  struct SupportLoss {
    NodeId node;
    Vec6 reaction = Vec6::Zero(), displacement = Vec6::Zero();
  };
  struct MembraneLoss {
    PanelId panel;
    std::array<Vec6, 4> forces, displacements;
  };
  const MemberShape& shape_before(MemberId member);
  [[nodiscard]] MemberShape shape_now(MemberId member) const;
  [[nodiscard]] Vec3 local_gravity(MemberId member) const;
  [[nodiscard]] double opened(const Opening& opening) const;
  [[nodiscard]] double load_changes() const;
  [[nodiscard]] double contact_work() const;
  /// Work of what one force on a panel or the panel itself hands on, through the state before: on what stands, and on
  /// what has left.
  struct Shares {
    LoadWork standing, left;
  };
  void add_share(MemberId member, const solver::BeamLoad& load, Shares& shares);
  void add_share(NodeId node, const Vec6& load, Shares& shares);
  [[nodiscard]] Vec6 after(NodeId node, const Vec6& before) const;
  [[nodiscard]] Vec6 hub_now(MemberId member, int end) const;

  Sources from_;
  Vec3 gravity_ = -Vec3::UnitZ();

  bool started_ = false;
  double elastic_at_start_ = 0;
  LoadWork start_, left_;  ///< left: works of what left, and corrections for loads that came or went without work
  double contact_left_ = 0, freed_ = 0;

  std::vector<char> held_;  ///< per joint of a member: it held in the state before

  // The change that is going on.
  std::map<MemberId, MemberShape> before_;
  std::vector<Opening> openings_;
  std::vector<SupportLoss> supports_;
  std::vector<MembraneLoss> membranes_;
  std::map<MemberId, std::vector<solver::BeamLoad>> member_loads_before_;
  std::map<NodeId, std::pair<Vec6, Vec6>> node_loads_before_;  ///< load, displacement
  double freed_now_ = 0;
};

}  // namespace topple::structure
