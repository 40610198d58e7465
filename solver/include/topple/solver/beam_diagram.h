#pragma once
// Internal forces and deflections along one beam, exactly, from its end forces and the loads on it.
#include <array>
#include <memory>
#include <span>
#include <vector>

#include "topple/solver/frame_model.h"

namespace topple::solver {

/// Internal forces are what the part beyond does to the part before, on the face that looks along +x: axial tension is
/// positive, and the value at the first end is minus the end force there. Deflections are from the straight line
/// between the beam's ends (behind any spring or release), along local y and z.
class BeamDiagram {
 public:
  /// What is told along the beam: forces in N, moments in N m, deflections in m, local axes.
  enum Quantity { axial, shear_y, shear_z, torsion, moment_y, moment_z, deflection_y, deflection_z };
  static constexpr int quantities = 8;  ///< How many quantities there are.

  /// `end_forces` as in StaticSolution; `loads` those on this beam; `stiffness_factor` multiplies E and G. Copies what
  /// it needs. Throws std::invalid_argument for a load outside of the beam.
  BeamDiagram(const Beam& beam, const Vec12& end_forces, std::span<const BeamLoad> loads, double stiffness_factor = 1);
  ~BeamDiagram();
  /// Moves: what is moved from may only be destroyed or assigned to.
  BeamDiagram(BeamDiagram&&) noexcept;
  /// Moves, as the constructor does.
  BeamDiagram& operator=(BeamDiagram&&) noexcept;

  /// At a distance from the first end (held to 0 ... length). Where the quantity jumps, the value just before, or just
  /// `beyond`.
  [[nodiscard]] double value(Quantity quantity, double distance, bool beyond = false) const;
  /// All quantities at once, in the order of Quantity. The same rules as value().
  [[nodiscard]] std::array<double, 8> values(double distance, bool beyond = false) const;
  /// Places between the ends where a load begins, ends or acts: there quantities may jump or kink. Ascending.
  [[nodiscard]] std::vector<double> breaks() const;

  /// The value of a quantity and its distance from the first end, m.
  struct Extreme {
    double value = 0;  ///< of the quantity
    double at = 0;     ///< m from the first end
  };
  /// The least and the greatest value of a quantity over the beam.
  struct Range {
    Extreme least;     ///< most negative
    Extreme greatest;  ///< most positive
  };
  /// Over the whole beam, both sides of every jump; the first place where several are equal.
  [[nodiscard]] Range extremes(Quantity quantity) const;

  /// Displacement and rotation of the section at a distance, local axes, given those of the rigid ends at the beam's
  /// ends (local, after the arms). A beam loose between its ends is taken as if it moved with its first rigid end.
  [[nodiscard]] Vec6 displacement(double distance, const Vec12& rigid_end_displacements) const;

 private:
  struct State;
  struct Free {
    void operator()(State* state) const;
  };
  static std::unique_ptr<State>& spare();
  std::unique_ptr<State, Free> state_;
};

}  // namespace topple::solver
