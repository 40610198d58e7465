#pragma once
// Uses of a plain frame's beam ends for selective answers: the largest of |force| / capacity over the six components.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "topple/solver/reanalysis.h"

namespace topple::test {

class JointUtilisations : public solver::UtilisationWatch {
 public:
  /// Capacities per beam: of axial force, shears, torsion, moments.
  JointUtilisations(const solver::Reanalysis& standing, std::vector<solver::Vec6> capacity)
      : use(capacity.size(), {0, 0}), reads(capacity.size(), 0), standing_(standing), capacity_(std::move(capacity)) {}

  static double of(const solver::Vec6& force, const solver::Vec6& capacity) {
    return (force.cwiseAbs().array() / capacity.array()).maxCoeff();
  }
  /// Of both ends, zero at a broken one.
  [[nodiscard]] std::array<double, 2> ends(const solver::Reanalysis& standing, int beam) const {
    const solver::Vec12 forces = standing.beam_end_forces(beam);
    const auto i = static_cast<std::size_t>(beam);
    const auto& stiffness = standing.model().beams[i].end_stiffness;
    std::array<double, 2> result{0, 0};
    for (std::size_t e = 0; e < 2; ++e)
      if (!stiffness[e].isZero(0)) result[e] = of(forces.segment<6>(6 * static_cast<Eigen::Index>(e)), capacity_[i]);
    return result;
  }

  double beam_utilisation(int beam) override {
    const auto i = static_cast<std::size_t>(beam);
    ++reads[i];
    use[i] = ends(standing_, beam);
    return std::max(use[i][0], use[i][1]);
  }
  double shell_utilisation(int) override { return 0; }
  double beam_growth(int beam, const double (&root)[12]) override {
    double growth = 0;
    for (Eigen::Index k = 0; k < 12; ++k)
      growth = std::max(growth, root[k] / capacity_[static_cast<std::size_t>(beam)](k % 6));
    return growth;
  }
  double shell_growth(int, const double (&)[24]) override { return 0; }

  std::vector<std::array<double, 2>> use;  ///< per beam and end, as read last
  std::vector<int> reads;                  ///< per beam

 private:
  const solver::Reanalysis& standing_;
  std::vector<solver::Vec6> capacity_;
};

}  // namespace topple::test
