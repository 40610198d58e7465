#pragma once
// Members that carry only tension or only compression. A member that would carry the other is slack: axially released
// at the end that does not bear its own weight (the lower end of a tie, the upper end of a strut). Which are slack is
// found by iteration and holds when it is verified: no taut member carries the wrong sign, and no slack one would be
// stretched the way it can resist.
#include <functional>
#include <string>
#include <vector>

#include "topple/solver/second_order.h"
#include "topple/solver/static_analysis.h"

namespace topple::structure {

struct OneWayAnswer {
  solver::StaticSolution solution;
  std::vector<solver::Beam> beams;  ///< with the releases of what is slack
  std::vector<char> active;         ///< per beam
  int iterations = 0;
  solver::AxialState axial;  ///< of a second-order solution
};

/// The model with every beam taking tension and compression: what the solver takes.
[[nodiscard]] solver::FrameModel carrying_both(solver::FrameModel model);

class OneWayMembers {
 public:
  explicit OneWayMembers(const solver::FrameModel& model);
  [[nodiscard]] bool any() const { return !members_.empty(); }

  /// Solves a model with releases where members are slack: into the solution and what goes with it.
  using Solve = std::function<void(const solver::FrameModel& model, OneWayAnswer& answer)>;

  /// All members active, with the solution for that.
  [[nodiscard]] OneWayAnswer all_taut(const solver::StaticSolution& solution) const;
  /// What to do where a state on the way is a mechanism: pass the Instability on, or go through it by a trace of the
  /// slack members' stiffness (for first order), which shows whom the mechanism pulls taut.
  enum class Mechanisms { end_it, go_through };
  /// Turns members over until every one is as the solution wants it, from a state with its solution, by first order or
  /// by second: `solve` decides. The state that is found holds without any trace: passes on the Instability that
  /// `solve` throws where it is a mechanism; throws std::runtime_error naming beams (by `names`) when the states repeat
  /// without an end.
  [[nodiscard]] OneWayAnswer settle(const solver::LoadSet& loads, OneWayAnswer start, const Solve& solve,
                                    const std::vector<std::string>& names,
                                    Mechanisms mechanisms = Mechanisms::end_it) const;

 private:
  /// `trace`: what slack members keep of their axial stiffness.
  [[nodiscard]] solver::FrameModel with_releases(const std::vector<char>& active, double trace) const;
  [[nodiscard]] double violation(std::size_t member, const std::vector<char>& active,
                                 const std::vector<std::vector<solver::BeamLoad>>& loads,
                                 const std::vector<solver::Beam>& beams, const solver::StaticSolution& solution) const;

  const solver::FrameModel& model_;
  std::vector<std::size_t> members_;  ///< beams that are one-way
};

}  // namespace topple::structure
