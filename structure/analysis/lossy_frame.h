#pragma once
// A building's frame under one combination that loses a member and gets it back. What a loss means for its panels
// (edges that no longer hold, membranes that are load alone, load that goes another way) is as in a running collapse.
#include <optional>
#include <span>
#include <vector>

#include "frame_loads.h"
#include "topple/solver/reanalysis.h"

namespace topple::structure {

class LossyFrame {
 public:
  /// `candidates`: members that may be lost.
  LossyFrame(const Building& building, const std::vector<MemberId>& candidates, const solver::AnalysisOptions& options);
  LossyFrame(const LossyFrame&) = delete;
  LossyFrame& operator=(const LossyFrame&) = delete;

  void load(const PartLoads& loads);
  void lose(MemberId member);
  /// Gives back what was lost last; takes effect with the next solve().
  void restore();
  /// These are going to be lost next, one after the other: their answers are found together.
  void expect(std::span<const MemberId> members);
  [[nodiscard]] const solver::ReanalysisAnswer& solve() { return analysis_->solve(); }

  [[nodiscard]] const solver::Reanalysis& analysis() const { return *analysis_; }
  [[nodiscard]] bool stands(MemberId member) const { return member != lost_; }
  /// Demand of each breakable joint that holds, in order; of all others nothing is written.
  void read_demands(std::vector<Vec6>& demand, std::vector<JointId>& holding) const;

 private:
  void write_loads();
  void set_ground(NodeId node, bool held);
  [[nodiscard]] std::vector<NodeId> nodes_left_bare(MemberId member) const;

  const Building& building_;
  Frame frame_;
  EdgeMembers edges_;
  PanelBearings whole_, bearings_;
  PanelSuperelements shells_;  ///< none: the building has no shells
  std::optional<FrameLoads> loads_;
  std::unique_ptr<solver::Reanalysis> analysis_;
  std::vector<int> members_at_node_;
  std::vector<int> ground_;  ///< per node: a support without stiffness that holds it once nothing else does; -1
  // What was lost last.
  MemberId lost_;
  PanelBearings::Changes changes_;
  std::vector<NodeId> bare_;
};

}  // namespace topple::structure
