#pragma once
// What a restricted answer (Reanalysis::solve(UseWatch&)) must not leave out: the use of an element is its demand over
// its capacity, by whatever rule; the solver only needs to read it, and to know how fast it can grow.

namespace topple::solver {

/// Reads utilisations for Reanalysis::solve(). The caller derives from it.
class UseWatch {
 public:
  virtual ~UseWatch() = default;

  /// Largest use in this beam (shell) in the present answer. Called when its displacements were brought up to date;
  /// Reanalysis::beam_end_forces() (shell_corner_forces()) of this element may be asked for.
  [[nodiscard]] virtual double beam_use(int beam) = 0;
  /// As beam_use(), of a shell.
  [[nodiscard]] virtual double shell_use(int shell) = 0;
  /// How much the use grows at most when each end force i of the beam (corner force of the shell) changes by at most
  /// root(i): the square roots of the diagonal of its stiffness, local axes for beams, global for shells. The growth
  /// is then what sqrt(2 x 1 J) of strain energy can do.
  [[nodiscard]] virtual double beam_growth(int beam, const double (&root)[12]) = 0;
  /// As beam_growth(), of a shell: 24 freedoms, global axes.
  [[nodiscard]] virtual double shell_growth(int shell, const double (&root)[24]) = 0;

  /// Uses below (1 - margin) max(1, the largest use) do not matter; with `largest_decides` false, uses below
  /// 1 - margin.
  double margin = 1e-6;
  bool largest_decides = true;  ///< true: the largest use raises the limit below which uses do not matter
};

}  // namespace topple::solver
