#pragma once
// What the solver said of its answer beside how far it was off: an error above the stated bound without a warning is
// false confidence.
#include <string>

#include "cases.h"
#include "extended_frame.h"
#include "topple/solver/reanalysis.h"

namespace topple::bench {

using Exact = reference::Answer<reference::Quad>;

struct Verdict {
  std::string family, what, way;  ///< way: fresh analysis, or reanalysis
  double parameter = 0;
  bool refused = false;  ///< it said that the structure cannot stand
  bool warned = false;   ///< near a mechanism, or not converged
  bool mechanism = false;
  double error = 0;        ///< of the displacements, relative; rotations times the mean length of members
  double force_error = 0;  ///< of the end forces, relative to the largest of forces, or of moments
  double bound = 0, backward_error = 0, condition = 0;

  /// An error above the bound, or a mechanism that was taken for a structure, without a word.
  [[nodiscard]] bool false_confidence() const { return !refused && !warned && (mechanism || !(error <= bound)); }
  /// A structure that stands, refused.
  [[nodiscard]] bool false_alarm() const { return refused && !mechanism; }
};

/// By a fresh analysis and by a reanalysis that has just begun.
[[nodiscard]] std::vector<Verdict> judge(const Case& c);
/// Fills in the errors and what the answer said.
void judge_answer(const solver::FrameModel& model, const solver::StaticSolution& answer, const Exact& exact,
                  Verdict& verdict);
/// The present answer of a reanalysis.
void judge_standing(const solver::Reanalysis& standing, const solver::ReanalysisAnswer& told, const Exact& exact,
                    Verdict& verdict);

/// A frame in which joints break and are mended, again and again, by one reanalysis: judged after 1, 10, 100 ...
/// changes.
[[nodiscard]] std::vector<Verdict> judge_damage_sequence(int changes);

}  // namespace topple::bench
