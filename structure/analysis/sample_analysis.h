#pragma once
// Analyses one after the other of buildings that differ in numbers alone, and losses one after the other of one
// building, as samples of a study ask for them.
#include <memory>
#include <vector>

#include "topple/solver/kept_equations.h"
#include "topple/structure/analysis.h"
#include "topple/structure/losses.h"

namespace topple::structure {

/// As analyse(), with the same numbers. What one leaves in `kept` (ordering, symbolic factor, stiffnesses of what is
/// the same) serves the next.
[[nodiscard]] AnalysisResult analyse_with(solver::KeptEquations& kept, const Building& building,
                                          const AnalysisRequest& request);

/// The same where only the uses of joints, the ends of members and the storeys are wanted: without extremes and
/// stations along members, the largest displacement, and the meshes' errors (and what would be warned of for these),
/// which take half of the time that a whole one takes beside its equations.
[[nodiscard]] AnalysisResult analyse_briefly(solver::KeptEquations& kept, const Building& building,
                                             const AnalysisRequest& request);

/// Losses of members one at a time, each answered on its own, from a factor that stays.
class LossSweep {
 public:
  /// `request.each`: the members that may be lost. The building stays where it is, as it is. Throws as find_losses()
  /// does.
  LossSweep(const Building& building, std::vector<CombinationId> combinations, LossRequest request,
            const solver::AnalysisOptions& options);
  ~LossSweep();
  LossSweep(const LossSweep&) = delete;
  LossSweep& operator=(const LossSweep&) = delete;

  /// The same bits whatever was lost before: each loss begins in the state that the factor was made in, and a factor
  /// that did not stay is made anew.
  [[nodiscard]] MemberLoss lose(MemberId member);
  /// Factors made, the first among them.
  [[nodiscard]] std::size_t factors() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace topple::structure
