#include "sections/torsion.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace topple::structure {

namespace {
using std::numbers::pi;
/// The remaining sums fall off as exp(-n pi long/short): six odd terms are below rounding.
constexpr int last_odd_term = 11;
}  // namespace

double rectangle_torsion_constant(double depth, double width) {
  const double a = std::max(depth, width), b = std::min(depth, width);
  // Sum of tanh(n pi a / 2 b) / n^5 over odd n, as sum 1/n^5 = 31 zeta(5)/32 less a rest that converges at once.
  double sum = 31.0 / 32.0 * 1.0369277551433699263;
  for (int n = 1; n <= last_odd_term; n += 2) sum -= 2.0 / (std::pow(n, 5) * (std::exp(n * pi * a / b) + 1.0));
  return a * b * b * b * (1.0 / 3.0 - 64.0 / std::pow(pi, 5) * (b / a) * sum);
}

double rectangle_torsion_modulus(double depth, double width) {
  const double a = std::max(depth, width), b = std::min(depth, width);
  double sum = 0;
  for (int n = 1; n <= last_odd_term; n += 2) sum += 1.0 / (n * n * std::cosh(std::min(n * pi * a / (2 * b), 700.0)));
  const double peak = b * (1.0 - 8.0 / (pi * pi) * sum);  // of stress, per G and twist
  return rectangle_torsion_constant(depth, width) / peak;
}

double I_torsion_constant(double depth, double width, double web, double flange, double fillet) {
  const double plates = 2.0 / 3.0 * width * std::pow(flange, 3) + (depth - 2 * flange) * std::pow(web, 3) / 3.0;
  const double ratio = web / flange, round = fillet / flange;
  const double alpha = -0.042 + 0.2204 * ratio + 0.1355 * round - 0.0865 * round * ratio - 0.0725 * ratio * ratio;
  const double circle =  // diameter of the largest circle in the junction
      (std::pow(flange + fillet, 2) + (fillet + web / 4) * web) / (2 * fillet + flange);
  return plates + 2 * alpha * std::pow(circle, 4) - 0.420 * std::pow(flange, 4);
}

}  // namespace topple::structure
