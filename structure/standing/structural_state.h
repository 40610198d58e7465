#pragma once
// The state that all parts of a standing frame share: what stands, what acts on it, its static answer, what its joints
// bear, its energies, and its motion. Each part that changes it has a file of its own.
#include <memory>
#include <vector>

#include "loads/frame_loads.h"
#include "standing/component_parts.h"
#include "standing/contact_loads.h"
#include "standing/energy/energy_account.h"
#include "standing/frame_response.h"
#include "standing/motion/rigid_displacement_fit.h"
#include "standing/motion/standing_motion.h"
#include "standing/panel_superelements.h"
#include "standing/solver_contents.h"
#include "standing/standing_parts.h"
#include "topple/structure/standing_frame.h"

namespace topple::structure {

struct StructuralState {
  /// The undamaged building, which must outlive it; nothing is solved yet. Throws InputError for a combination that
  /// settles a support.
  StructuralState(const Building& building, CombinationId combination, const FailureRules& rules, int threads);

  [[nodiscard]] bool stands(MemberId member) const { return parts.stands(member); }
  [[nodiscard]] bool stands(PanelId panel) const { return parts.stands(panel); }
  [[nodiscard]] bool stands(NodeId node) const { return parts.stands(node); }
  [[nodiscard]] bool stands(const ContactPlace& place) const;
  [[nodiscard]] bool moves(int component) const { return motion && motion->moves(component); }
  /// All that acts on a panel now.
  [[nodiscard]] PanelLoading loading(PanelId panel) const;
  /// The momentum of a part that leaves, with that of the panels that leave with it; those that stay, or fall alone,
  /// keep theirs.
  [[nodiscard]] Detached::Motion motion_of(const Detached& part) const;

  /// Its joints are to be looked at again.
  void check_again(int component) { to_check[static_cast<std::size_t>(component)] = 1; }
  /// Loads that have changed go to the solver.
  void write_loads();
  /// The solver holds the node no more, nor does anything lie on it; no effect on one that it does not hold.
  void drop(NodeId node);
  /// The panel's load goes another way.
  void hand_on_anew(PanelId panel);
  /// The panel is as stiff as its superelement is now; `before`: what its nodes felt of it until now.
  void update_stiffness(PanelId panel, const Eigen::MatrixXd& before);

  /// But for motion, which is made and loaded once all that it looks at is there.
  template <class Archive>
  void serialize(Archive& archive);

  // What motion_of() is made of.
  void add_displacement(MemberId member, RigidDisplacementFit& to) const;
  void add_displacement(PanelId panel, const Detached& part, RigidDisplacementFit& to) const;
  [[nodiscard]] solver::Vec12 ends_of(MemberId member) const;
  [[nodiscard]] const Vec6& displacement_of(NodeId node) const;

  const Building& building;
  CombinationId combination;  ///< of its loads
  FailureRules rules;
  int threads;
  StandingParts parts;
  PanelSuperelements shells;
  FrameLoads loads;
  FrameStatics statics;
  ComponentParts components;
  JointStates joints;
  SolverContents in_solver;
  EnergyAccount account;
  FrameResponse response;
  ContactLoads contacts;
  std::unique_ptr<StandingMotion> motion;  ///< where what stands moves; null: it goes from rest to rest
  std::vector<char> to_check;              ///< per component
};

}  // namespace topple::structure
