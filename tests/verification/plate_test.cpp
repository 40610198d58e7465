// Thin plates against series solutions (Timoshenko and Woinowsky-Krieger, Theory of Plates and Shells).
#include <catch2/catch.hpp>

#include "verification/shell_grid.h"
#include "verification/table.h"

using namespace topple::test;

namespace {

/// Centre deflection of a plate of sides 1 and b over q/D, or over P/D.
double centre(int n, double b, bool clamped, bool point, double thickness = 1e-3) {
  const double E = 1e9, nu = 0.3, D = E * std::pow(thickness, 3) / (12 * (1 - nu * nu));
  ShellGrid grid = shell_grid(n, n, E, nu, thickness, true, [&](double s, double t) { return Vec3(s, b * t, 0); });
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      const bool at_x = i == 0 || i == n, at_y = j == 0 || j == n;
      // Hard simple support: no deflection, no twist along the edge.
      const Vec6 edge = clamped ? fixed() : components(rigid, rigid, rigid, at_x ? rigid : 0, at_y ? rigid : 0, rigid);
      grid.hold(i, j, at_x || at_y ? edge : components(rigid, rigid, 0, 0, 0, rigid));
    }
  LoadSet loads = grid.traction(Vec3(0, 0, 1));
  if (point) {
    loads = {};
    loads.nodes = {{grid.node(n / 2, n / 2), unit(2, 1)}};
  }
  return grid.moved(loads, n / 2, n / 2)(2) * D;
}

}  // namespace

TEST_CASE("thin square plates bend as series say: 2 % on 16 x 16, 1 % on 32 x 32") {
  struct Case {
    const char* name;
    bool clamped, point;
    double published;
  };
  for (const Case& c : {Case{"simply supported plate, uniform load", false, false, 0.00406235},
                        Case{"simply supported plate, point load", false, true, 0.0116008},
                        Case{"clamped plate, uniform load", true, false, 0.00126532},
                        Case{"clamped plate, point load", true, true, 0.00561202}})
    for (const auto& [n, asked] : {std::pair(8, 0.0), std::pair(16, 0.02), std::pair(32, 0.01)}) {
      const Answer answer{std::string(c.name) + ", t/a = 1/1000, " + std::to_string(n) + " x " + std::to_string(n),
                          "Timoshenko", c.published, centre(n, 1, c.clamped, c.point)};
      if (asked > 0)
        judge(answer, asked);
      else
        show(answer, "coarse");
    }
  // Second order: halving the mesh quarters the error.
  const double coarse = std::abs(centre(8, 1, false, false) - 0.00406235);
  const double fine = std::abs(centre(16, 1, false, false) - 0.00406235);
  CHECK(coarse / fine > 3);
}

TEST_CASE("one panel in 4 x 4 elements is no stiffer at t/a = 1/10000 than at 1/100") {
  for (const bool clamped : {false, true})
    judge({std::string(clamped ? "clamped" : "simply supported") + " plate, 4 x 4, t/a = 1/10000 over 1/100",
           "same mesh, moderately thin", centre(4, 1, clamped, false, 1e-2), centre(4, 1, clamped, false, 1e-4)},
          0.01);
}

TEST_CASE("plates five times as long as wide, of MacNeal and Harder's set, on elements five times as long") {
  // Their unit: E = 1.7472e7, t = 1e-4, a = 2, q = 1e-4, P = 4e-4; so q a4/D and P a2/D are both 1000.
  struct Case {
    const char* name;
    bool clamped, point;
    double published;
  };
  for (const Case& c : {Case{"plate b/a = 5, simply supported, uniform load", false, false, 12.97e-3},
                        Case{"plate b/a = 5, simply supported, point load", false, true, 16.96e-3},
                        Case{"plate b/a = 5, clamped, uniform load", true, false, 2.56e-3},
                        Case{"plate b/a = 5, clamped, point load", true, true, 7.23e-3}})
    show({std::string(c.name) + ", 32 x 32", "MacNeal and Harder 1985", c.published, centre(32, 5, c.clamped, c.point)},
         "printed");
}
