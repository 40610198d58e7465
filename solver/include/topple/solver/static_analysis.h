#pragma once
// Linear static analysis of a frame model: one factorisation, any number of right-hand sides.
#include <cstddef>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "topple/solver/frame_model.h"

namespace topple::solver {

/// A structure that can move without strain (or nearly so): which nodes, how.
struct Mechanism {
  std::vector<int> nodes;  ///< nodes that move, most first
  std::vector<Vec6>
      motion;  ///< for every node of the model, scaled to a largest translation of 1 (or rotation, if none)
  /// Beams that can move by themselves, released at both ends so far that no node has to move with them.
  std::vector<int> beams;
};

/// Thrown when the model is not stable. what() names node indices and freedoms; callers with names use `mechanism`.
class Instability : public std::runtime_error {
 public:
  /// `message` becomes what().
  Instability(const std::string& message, Mechanism motion)
      : std::runtime_error(message), mechanism(std::move(motion)) {}
  Mechanism mechanism;  ///< the motion, by indices of the model
};

/// Which factorisation is used; automatic: the cheaper one by predicted operations.
enum class Factorisation { automatic, simplicial, supernodal };

/// How equations are factorised, and when they count as singular.
struct AnalysisOptions {
  Factorisation factorisation = Factorisation::automatic;  ///< which one
  int threads = 1;  ///< threads for the numeric factorisation; the bits do not depend on it
  /// Relative size of a scaled pivot, or reciprocal condition, below which a model is unstable.
  double singular_limit = 1e-13;
  double warning_limit = 1e-10;  ///< the same, below which it is stable with a warning
};

/// How far to trust an answer.
struct SolveQuality {
  double backward_error = 0;  ///< componentwise (Oettli-Prager), after refinement
  double condition = 0;       ///< estimate for the scaled matrix
  double error_bound = 0;     ///< on the relative forward error of the displacements
  int refinements = 0;        ///< steps of iterative refinement
  bool converged = true;      ///< false: the backward error stayed above 1e-14 whatever the refinement
};

/// Answer to one right-hand side.
struct StaticSolution {
  std::vector<Vec6> displacements;  ///< per node, global
  std::vector<Vec6> reactions;      ///< per entry of FrameModel::supports: what the support does to the structure
  std::vector<Vec12>
      beam_end_forces;  ///< per beam: what the nodes do to the beam at its ends, local, first then second
  std::vector<std::array<Vec6, 4>> shell_corner_forces;  ///< per shell: what the nodes do to it, global
  SolveQuality quality;                                  ///< of the displacements
};

/// Sizes, times and trust of one analysis.
struct AnalysisStatistics {
  std::size_t freedoms = 0;        ///< equations
  std::size_t matrix_entries = 0;  ///< stored entries of the lower triangle
  std::size_t factor_entries = 0;  ///< of the factor
  double factor_operations = 0;    ///< floating-point operations of the numeric factorisation
  std::string factorisation;       ///< which was used
  std::string ordering;            ///< which was used
  double assemble_seconds = 0;     ///< wall time, s
  double order_seconds = 0;        ///< wall time, s
  double factor_seconds = 0;       ///< wall time, s
  double solve_seconds = 0;        ///< wall time, s
  double condition_seconds = 0;    ///< for the estimate of the condition, apart from solve_seconds
  bool nearly_unstable = false;    ///< inside the warning band
  double digits_left = 16;         ///< decimal digits left by the condition, 0 to 16
};

/// Orders, assembles and factorises on construction (throws Instability); solve() costs triangular solves only.
class StaticAnalysis {
 public:
  /// Throws std::invalid_argument for a model that cannot be used.
  explicit StaticAnalysis(FrameModel model, const AnalysisOptions& options = {});
  ~StaticAnalysis();
  /// Moves: what is moved from may only be destroyed or assigned to.
  StaticAnalysis(StaticAnalysis&&) noexcept;
  /// Moves, as the constructor does.
  StaticAnalysis& operator=(StaticAnalysis&&) noexcept;

  /// Solves all right-hand sides together. Throws std::invalid_argument for loads on what does not exist or that are
  /// not finite, Instability for a load on a part that nothing holds.
  [[nodiscard]] std::vector<StaticSolution> solve(std::span<const LoadSet> loads);
  /// As it was given.
  [[nodiscard]] const FrameModel& model() const;
  /// solve()'s times are added to those of the construction.
  [[nodiscard]] const AnalysisStatistics& statistics() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace topple::solver
