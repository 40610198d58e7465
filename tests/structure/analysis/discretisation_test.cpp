// The estimate of what a mesh costs against the true error: stresses of the same model on a mesh twice as fine as the
// finest that is judged, in the energy norm. (Its own error makes that of the finest mesh look some 10 % smaller.)
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>

#include "analysis/resultants/discretisation.h"
#include "analysis/resultants/shell_results.h"
#include "topple/solver/static_analysis.h"
#include "topple/structure/formats/files.h"

using namespace topple::structure;
namespace solver = topple::solver;

namespace {

using Resultants = Eigen::Matrix<double, 8, 1>;

/// A grid of panels, each meshed n x n.
struct Benchmark {
  std::string name;
  int nx = 1, ny = 1;
  double thickness = 0;
  double youngs_modulus = 0, poisson_ratio = 0;
  std::function<Vec3(double, double)> place;
  std::function<std::string(int, int)> rest;  ///< supports and loads
  int finest = 16;                            ///< elements along a panel's side, of the four meshes that are judged
};

std::string part(const char* kind, int i, int j) {
  return '"' + (kind + std::to_string(i)) + "_" + std::to_string(j) + '"';
}

std::string number(double x) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", x);
  return text;
}

Building built(const Benchmark& b, int n) {
  std::string nodes, panels;
  for (int j = 0; j <= b.ny; ++j)
    for (int i = 0; i <= b.nx; ++i) {
      const Vec3 p = b.place(double(i) / b.nx, double(j) / b.ny);
      nodes += (nodes.empty() ? "" : ",") + part("N", i, j) + ": [" + number(p.x()) + "," + number(p.y()) + "," +
               number(p.z()) + "]";
      if (i == b.nx || j == b.ny) continue;
      panels += (panels.empty() ? "" : ",") + part("P", i, j) + R"(: {"kind": "slab", "model": "shell", "material": "c",
        "mesh": )" +
                std::to_string(n) + R"(, "thickness": )" + number(b.thickness) + R"(, "nodes": [)" + part("N", i, j) +
                "," + part("N", i + 1, j) + "," + part("N", i + 1, j + 1) + "," + part("N", i, j + 1) + "]}";
    }
  return parse_model(R"({"topple": 1, "gravity": 1, "materials": {"c": {"youngs_modulus": )" +
                         number(b.youngs_modulus) + R"(, "poisson_ratio": )" + number(b.poisson_ratio) +
                         R"(, "density": 1}}, "nodes": {)" + nodes + R"(}, "panels": {)" + panels + "}, " +
                         b.rest(b.nx, b.ny) + "}",
                     b.name + ".json");
}

/// Edges along a side of the grid (0: t = 0, 1: s = 1, 2: t = 1, 3: s = 0).
std::string side(int nx, int ny, int of, const std::string& support) {
  std::string all;
  for (int k = 0; k < (of % 2 == 0 ? nx : ny); ++k) {
    const int i = of == 1 ? nx - 1 : (of == 3 ? 0 : k), j = of == 2 ? ny - 1 : (of == 0 ? 0 : k);
    std::string name = part("P", i, j);
    name.insert(name.size() - 1, ":" + std::to_string(of + 1));
    all += (all.empty() ? "" : ", ") + name + ": " + support;
  }
  return all;
}

Resultants as_vector(const solver::ShellResultants& r) {
  Resultants v;
  v << r.membrane, r.moments, r.shears;
  return v;
}

struct Solved {
  std::vector<PanelResultants> panels;
  double estimate = 0;
};

Solved solved(const Benchmark& b, int n) {
  const Building building = built(b, n);
  const Frame frame = make_frame(building);
  const PartLoads parts = part_loads(building, CombinationId(0));
  const std::vector<solver::LoadSet> sets{on_frame(building, frame, parts, load_set(building, parts))};
  solver::StaticAnalysis analysis(frame.model, {});
  const solver::StaticSolution solution = analysis.solve(sets).front();
  Solved all;
  std::vector<PanelResult> results(building.panels.size());
  all.estimate = recover_resultants(building, frame, parts, solution, results);
  for (std::size_t p = 0; p < building.panels.size(); ++p)
    all.panels.push_back(panel_resultants(building, frame, PanelId(p), parts, solution));
  return all;
}

/// Twice the strain energy per area.
double energy(const Benchmark& b, const Resultants& r) {
  const double E = b.youngs_modulus, nu = b.poisson_ratio, t = b.thickness;
  const auto plane = [&](int at) {
    return r(at) * r(at) + r(at + 1) * r(at + 1) - 2 * nu * r(at) * r(at + 1) + 2 * (1 + nu) * r(at + 2) * r(at + 2);
  };
  return plane(0) / (E * t) + 12 * plane(3) / (E * t * t * t) +
         2 * (1 + nu) / (E * t * 5 / 6) * (r(6) * r(6) + r(7) * r(7));
}

/// Relative error of the coarse mesh's own field (bilinear through its Gauss points) at the centres of the fine mesh.
/// Elements of a panel go along x first; panels' elements are of equal size but for slants, which the sum leaves out.
double true_error(const Benchmark& b, const Solved& coarse, int n, const Solved& fine, int N) {
  double error = 0, whole = 0;
  constexpr double gauss = 0.57735026918962576;
  for (std::size_t p = 0; p < fine.panels.size(); ++p)
    for (int J = 0; J < N; ++J)
      for (int I = 0; I < N; ++I) {
        const double s = (I + 0.5) / N * n, t = (J + 0.5) / N * n;
        const int i = int(s), j = int(t);
        const double x = (2 * (s - i) - 1) / gauss, y = (2 * (t - j) - 1) / gauss;
        const auto& points = coarse.panels[p].gauss[std::size_t(j * n + i)];
        const Resultants own = ((1 - x) * (1 - y) * as_vector(points[0]) + (1 + x) * (1 - y) * as_vector(points[1]) +
                                (1 + x) * (1 + y) * as_vector(points[2]) + (1 - x) * (1 + y) * as_vector(points[3])) /
                               4;
        const Resultants exact = as_vector(fine.panels[p].centre[std::size_t(J * N + I)]);
        error += energy(b, own - exact);
        whole += energy(b, exact);
      }
  return std::sqrt(error / whole);
}

std::string everywhere(int nx, int ny, const std::string& what) {
  std::string all;
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) all += (all.empty() ? "" : ", ") + part("P", i, j) + ": " + what;
  return all;
}

std::vector<Benchmark> benchmarks() {
  const auto plate = [](const std::string& edges) {
    return [edges](int nx, int ny) {
      std::string supports;
      for (int k = 0; k < 4; ++k) supports += (k > 0 ? ", " : "") + side(nx, ny, k, edges);
      return "\"supports\": {" + supports + R"(}, "loads": {"u": {"panels": {)" +
             everywhere(nx, ny, R"({"pressure": 1})") + "}}}";
    };
  };
  const auto flat = [](double s, double t) { return Vec3(s, t, 0); };
  std::vector<Benchmark> all;
  all.push_back({"simply supported plate", 1, 1, 0.01, 1e9, 0.3, flat, plate("\"pinned\""), 32});
  all.push_back({"clamped plate", 1, 1, 0.01, 1e9, 0.3, flat, plate("\"fixed\""), 32});
  all.push_back({"Cook's membrane", 1, 1, 1, 1, 1.0 / 3,
                 [](double s, double t) { return Vec3(48 * s, 44 * s + t * (44 - 28 * s), 0); },
                 [](int nx, int ny) {
                   return "\"supports\": {" + side(nx, ny, 3, "\"fixed\"") + R"(}, "loads": {"u": {"nodes": {)" +
                          part("N", nx, 0) + R"(: {"y": 0.5}, )" + part("N", nx, ny) + R"(: {"y": 0.5}}}})";
                 },
                 32});
  const double degree = 0.017453292519943295;
  all.push_back(
      {"Scordelis-Lo roof", 2, 4, 0.25, 4.32e8, 0,
       [=](double s, double t) { return Vec3(25 * s, 25 * std::sin(40 * degree * t), 25 * std::cos(40 * degree * t)); },
       [](int nx, int ny) {
         return "\"supports\": {" + side(nx, ny, 3, R"({"y": true, "z": true})") + ", " +
                side(nx, ny, 1, R"({"x": true, "ry": true, "rz": true})") + ", " +
                side(nx, ny, 0, R"({"y": true, "rx": true, "rz": true})") + R"(}, "loads": {"u": {"self_weight": 1}})";
       },
       16});
  all.push_back({"pinched hemisphere", 4, 4, 0.04, 6.825e7, 0.3,
                 [=](double s, double t) {
                   const double at = 72 * degree * t, round = 90 * degree * s;
                   return Vec3(10 * std::cos(at) * std::cos(round), 10 * std::cos(at) * std::sin(round),
                               10 * std::sin(at));
                 },
                 [](int nx, int ny) {
                   return "\"supports\": {" + side(nx, ny, 3, R"({"y": true, "rx": true, "rz": true})") + ", " +
                          side(nx, ny, 1, R"({"x": true, "ry": true, "rz": true})") + ", " + part("N", nx / 2, 0) +
                          R"(: {"z": true}}, "loads": {"u": {"nodes": {)" + part("N", 0, 0) + R"(: {"x": 1}, )" +
                          part("N", nx, 0) + R"(: {"y": -1}}}})";
                 },
                 16});
  all.push_back({"twisted beam", 12, 1, 0.32, 29e6, 0.22,
                 [=](double s, double t) {
                   const double y = 1.1 * (t - 0.5);
                   return Vec3(12 * s, y * std::cos(90 * degree * s), y * std::sin(90 * degree * s));
                 },
                 [](int nx, int ny) {
                   return "\"supports\": {" + side(nx, ny, 3, "\"fixed\"") + R"(}, "loads": {"u": {"nodes": {)" +
                          part("N", nx, 0) + R"(: {"z": 0.5}, )" + part("N", nx, ny) + R"(: {"z": 0.5}}}})";
                 },
                 16});
  return all;
}

}  // namespace

TEST_CASE("the estimate of a mesh's error is within a factor of two of the true one") {
  for (const Benchmark& b : benchmarks()) {
    const int N = 2 * b.finest;
    const Solved fine = solved(b, N);
    for (int n = b.finest / 8; n <= b.finest; n *= 2) {
      const Solved coarse = solved(b, n);
      const double error = true_error(b, coarse, n, fine, N), ratio = coarse.estimate / error;
      INFO(b.name << ", " << n << ": estimate " << coarse.estimate << ", true " << error);
      CHECK(ratio > 0.5);
      CHECK(ratio < 2);
      if (std::getenv("TOPPLE_PRINT") != nullptr)
        std::printf("| %s | %d | %.1f %% | %.1f %% | %.2f |\n", b.name.c_str(), n, 100 * coarse.estimate, 100 * error,
                    ratio);
    }
  }
}
