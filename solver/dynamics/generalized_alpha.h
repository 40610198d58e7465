#pragma once
// The generalized-alpha method of J. Chung and G. M. Hulbert (1993) with their optimal parameters:
//   M a(n+1-am) + C v(n+1-af) + K u(n+1-af) = f(n+1-af),   x(n+1-a) = (1 - a) x(n+1) + a x(n),
//   u(n+1) = u + h v + h2 ((1/2 - b) a + b a(n+1)),   v(n+1) = v + h ((1 - g) a + g a(n+1)).
// With C = a1 K (mass damping is foreseen, and a force), q = u + (1-af) (h v + h2 (1/2 - b) a) + a1 (v + (1-af) h (1-g)
// a) and w = q + c a(n+1) the equation becomes (K + s M) w = f + M (s q - am a): one solve and one product with M.
#include <stdexcept>

namespace topple::solver {

struct GeneralizedAlpha {
  double am = 0.5, af = 0.5, beta = 0.25, gamma = 0.5;
  double h = 0;
  double c = 0;  ///< s2
  double s = 0;  ///< 1/s2

  /// `stiffness_damping`: a1, s.
  GeneralizedAlpha(double substep, double spectral_radius, double stiffness_damping) : h(substep) {
    if (!(substep > 0)) throw std::invalid_argument("a substep must be above 0 s");
    if (!(spectral_radius >= 0 && spectral_radius <= 1))
      throw std::invalid_argument("a spectral radius must lie between 0 and 1");
    if (!(stiffness_damping >= 0)) throw std::invalid_argument("damping must not be negative");
    const double rho = spectral_radius;
    am = (2 * rho - 1) / (rho + 1);
    af = rho / (rho + 1);
    gamma = 0.5 - am + af;
    beta = (1 - am + af) * (1 - am + af) / 4;
    c = (1 - af) * (beta * h * h + gamma * h * stiffness_damping);
    s = (1 - am) / c;
  }
  template <class Archive>
  void serialize(Archive& archive) {
    auto& [mass_share, force_share, of_displacement, of_velocity, substep, of_acceleration, shift] = *this;
    archive(mass_share, force_share, of_displacement, of_velocity, substep, of_acceleration, shift);
  }
};

}  // namespace topple::solver
