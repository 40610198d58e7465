#pragma once
// One member's displaced shape and internal forces in one solved state, and what its loads do through it.
#include <span>
#include <vector>

#include "topple/solver/beam_diagram.h"
#include "topple/structure/building.h"

namespace topple::structure {

/// Work of loads, apart by whether they act along gravity (as weight does) or not.
struct LoadWork {
  double gravity = 0, other = 0;
  [[nodiscard]] double sum() const { return gravity + other; }
  LoadWork& operator+=(const LoadWork& more) {
    gravity += more.gravity;
    other += more.other;
    return *this;
  }
};
template <class Archive>
void serialize(Archive& archive, LoadWork& work) {
  auto& [gravity, other] = work;
  archive(gravity, other);
}

class SolvedMember {
 public:
  /// `beam` as it is in this state; `rigid_ends`: displacements of the nodes' rigid ends at the beam's ends, local
  /// axes.
  SolvedMember(const solver::Beam& beam, const solver::Vec12& end_forces, const solver::Vec12& rigid_ends,
               std::vector<solver::BeamLoad> loads);

  [[nodiscard]] Vec6 rigid_end(int end) const { return rigid_ends_.segment<6>(6 * end); }
  /// Of the member's own end, behind its spring or broken joint; local axes.
  [[nodiscard]] Vec6 end(int end) const;
  /// Local axes.
  [[nodiscard]] Vec6 at(double distance) const { return diagram_.displacement(distance, rigid_ends_); }

  /// Loads times this shape, exactly for forces that vary linearly; `gravity` is its direction in local axes. Both the
  /// state's own loads and `loads` may break the polynomials.
  [[nodiscard]] LoadWork work(std::span<const solver::BeamLoad> loads, const Vec3& gravity) const;
  /// Of the member and its end springs.
  [[nodiscard]] double strain_energy() const;
  /// Internal forces of this state through the strains that those of another state make in this member, halved; without
  /// end springs.
  [[nodiscard]] double mutual_energy(const SolvedMember& other) const;

  /// What it was made of; make() makes it again.
  template <class Archive>
  void write(Archive& archive) const {
    const auto& [beam, end_forces, rigid_ends, loads, diagram] = *this;
    archive(beam, end_forces, rigid_ends, loads);  // of which the diagram follows
  }
  template <class Archive>
  [[nodiscard]] static SolvedMember make(Archive& archive) {
    solver::Beam beam;
    solver::Vec12 end_forces, rigid_ends;
    std::vector<solver::BeamLoad> loads;
    archive(beam, end_forces, rigid_ends, loads);
    return {beam, end_forces, rigid_ends, std::move(loads)};
  }

 private:
  [[nodiscard]] std::vector<double> cuts(std::span<const solver::BeamLoad> loads) const;
  [[nodiscard]] Vec6 stiffness() const;

  solver::Beam beam_;
  solver::Vec12 end_forces_, rigid_ends_;
  std::vector<solver::BeamLoad> loads_;
  solver::BeamDiagram diagram_;
};

/// Work of a nodal load, `gravity` its direction in global axes.
[[nodiscard]] LoadWork work(const Vec6& load, const Vec6& displacement, const Vec3& gravity);

}  // namespace topple::structure
