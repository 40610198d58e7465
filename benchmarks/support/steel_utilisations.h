#pragma once
// How much of its joints' capacities a regular steel frame uses.
#include <algorithm>

#include "topple/solver/reanalysis.h"
#include "topple/structure/joint_check.h"

namespace topple::bench {

/// Steel of 355 MPa, plastic moments of about 1.15 times the elastic ones, all scaled so that the joint that is used
/// most bears `share` of its capacity in the present answer.
class SteelUtilisations : public solver::UtilisationWatch {
 public:
  explicit SteelUtilisations(const solver::Reanalysis& standing, double share = 0.6) : standing_(standing) {
    limit_.breakable = true;
    limit_.value = {3e6, 3e6, 6e5, 6e5, 5e4, 3e5, 1e5};
    const double used = largest();
    for (double& value : limit_.value) value *= used / share;
  }

  double beam_utilisation(int beam) override {
    const solver::Vec12 forces = standing_.beam_end_forces(beam);
    double use = 0;
    for (int end = 0; end < 2; ++end)
      use = std::max(use, structure::utilisation(limit_, structure::member_joint_demand(forces, end)).value);
    return use;
  }
  double shell_utilisation(int) override { return 0; }
  double beam_growth(int, const double (&root)[12]) override {
    const solver::Vec12 most = Eigen::Map<const solver::Vec12>(root);
    double growth = 0;
    for (int end = 0; end < 2; ++end)
      growth = std::max(growth, structure::utilisation(limit_, structure::member_joint_demand(most, end)).value);
    return growth;
  }
  double shell_growth(int, const double (&)[24]) override { return 0; }

  /// Of all joints.
  [[nodiscard]] double largest() {
    double worst = 0;
    for (int beam = 0; beam < static_cast<int>(standing_.model().beams.size()); ++beam)
      worst = std::max(worst, beam_utilisation(beam));
    return worst;
  }

 private:
  const solver::Reanalysis& standing_;
  structure::JointCapacity limit_;
};

}  // namespace topple::bench
