#pragma once
// Reads a standing frame's joints while its statics are brought up to date where it may matter.
#include "standing/joint_answers.h"

namespace topple::structure {

class JointAnswers::Watch : public MemberWatch {
 public:
  /// `slow`: only what comes on slowly changed since the answer was whole.
  explicit Watch(JointAnswers& answers, bool slow = false)
      : state_(answers.state_), edge_loads_(answers.edge_loads_), slow_(slow) {}
  double member_utilisation(MemberId member, const solver::Vec12& end_forces) override;
  double membrane_utilisation(PanelId membrane, const std::array<Vec6, 4>& corner_forces) override;
  double member_growth(MemberId member, const solver::Vec12& root) override;
  double membrane_growth(PanelId membrane, const std::array<Vec6, 4>& root) override;

 private:
  [[nodiscard]] double read(JointId joint, const Vec6& demand);
  [[nodiscard]] double growth(JointId joint, const Vec6& most) const;

  StructuralState& state_;
  EdgeDemands& edge_loads_;
  bool slow_;
};

}  // namespace topple::structure
