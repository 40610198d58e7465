#pragma once
// Fixed-end forces of one beam under many sets of loads: they are linear in the loads, and combinations repeat the same
// loads with other factors, so those of each unit load are worked out once.
#include <span>
#include <vector>

#include "elements/beam.h"

namespace topple::solver {

class BeamUnitLoads {
 public:
  /// Whether a beam's fixed-end forces follow from those of unit loads: no end is released, so that nothing that a
  /// loose part cannot hand on is lost.
  [[nodiscard]] static bool apply_to(const Beam& beam);

  /// Borrows the beam. Of its loads all must lie on it.
  explicit BeamUnitLoads(const CondensedBeam& beam) : beam_(beam) {}
  [[nodiscard]] Vec12 fixed_end_forces(std::span<const BeamLoad> loads);

 private:
  /// One component of a load's intensity at its first end, at its last, or of the same at both; or a temperature's
  /// part.
  enum class Part { first, last, both, strain, curvature_y, curvature_z };
  struct Unit {
    BeamLoad::Kind kind;
    Part part;
    int component;
    double from, to;
    Vec12 force;
  };
  void add(double size, const BeamLoad& load, Part part, int component, Vec12& force);

  const CondensedBeam& beam_;
  std::vector<Unit> known_;
};

}  // namespace topple::solver
