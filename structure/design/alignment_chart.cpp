#include "design/alignment_chart.h"

#include <cmath>
#include <numbers>

namespace topple::structure {

namespace {

constexpr int halvings = 60;

/// The place between `low` and `high` where `f`, negative below it, changes its sign.
template <class Function>
double where_it_vanishes(double low, double high, Function f) {
  for (int k = 0; k < halvings; ++k) {
    const double middle = (low + high) / 2;
    (f(middle) < 0 ? low : high) = middle;
  }
  return (low + high) / 2;
}

}  // namespace

double chart_braced(double ga, double gb) {
  // In u = pi/K, from pi (pinned ends) to 2 pi (rigid ones): the characteristic equation without its tangents' poles.
  const auto equation = [&](double u) {
    const double half = u / 2;
    return (ga * gb / 4 * u * u - 1) * std::sin(u) * u * std::cos(half) +
           (ga + gb) / 2 * (std::sin(u) - u * std::cos(u)) * u * std::cos(half) + 2 * std::sin(half) * std::sin(u);
  };
  constexpr double pi = std::numbers::pi, apart = 1e-9;
  const double sign = equation(pi * (1 + 1e-6)) < 0 ? 1 : -1;
  const double u =
      where_it_vanishes(pi * (1 + apart), 2 * pi * (1 - apart), [&](double at) { return sign * equation(at); });
  return pi / u;
}

double chart_sway(double ga, double gb) {
  // u tan-free: (ga gb u^2 - 36) sin u - 6 (ga + gb) u cos u = 0, u in (0, pi).
  const auto equation = [&](double u) {
    return (ga * gb * u * u - 36) * std::sin(u) - 6 * (ga + gb) * u * std::cos(u);
  };
  constexpr double pi = std::numbers::pi, apart = 1e-9;
  const double u = where_it_vanishes(apart, pi * (1 - apart), equation);
  return pi / u;
}

}  // namespace topple::structure
