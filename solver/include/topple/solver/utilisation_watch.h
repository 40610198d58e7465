#pragma once
// What a selective answer (Reanalysis::solve(UtilisationWatch&)) must not leave out. The utilisation of an element is
// its demand over its capacity, by whatever rule: the solver only needs to read it, and to know how fast it can grow.

namespace topple::solver {

/// Reads utilisations for Reanalysis::solve(). The caller derives from it.
class UtilisationWatch {
 public:
  virtual ~UtilisationWatch() = default;

  /// Largest utilisation in this beam in the present answer. Called when its displacements were brought up to date;
  /// Reanalysis::beam_end_forces() of this beam may be asked for.
  [[nodiscard]] virtual double beam_utilisation(int beam) = 0;
  /// As beam_utilisation(), of a shell: shell_corner_forces() may be asked for.
  [[nodiscard]] virtual double shell_utilisation(int shell) = 0;
  /// How much the utilisation grows at most when each end force i of the beam changes by at most root(i): the square
  /// roots of the diagonal of its stiffness, local axes. The growth is then what sqrt(2 x 1 J) of strain energy can do.
  [[nodiscard]] virtual double beam_growth(int beam, const double (&root)[12]) = 0;
  /// As beam_growth(), of a shell: 24 corner forces, global axes.
  [[nodiscard]] virtual double shell_growth(int shell, const double (&root)[24]) = 0;

  /// Utilisations below (1 - margin) max(1, the largest one) do not matter; with `largest_decides` false, those below
  /// 1 - margin.
  double margin = 1e-6;
  bool largest_decides = true;  ///< true: the largest utilisation raises the limit below which others do not matter
};

}  // namespace topple::solver
