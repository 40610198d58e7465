// What one hit costs, from the hit to the meshes of what remains and of every chunk: on walls of 20 x 20 and 200 x 200
// cells of half a metre, for each method; how it grows with the damage, and with the wall. Triangles changed are
// counted, so that the growth can be judged on any machine.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <random>

#include "support/measure.h"
#include "support/provenance.h"
#include "topple/fracture/panel.h"

namespace {

using namespace topple;
using namespace topple::fracture;

constexpr double kCell = 0.5;
constexpr const char* kNames[] = {"voronoi", "quadrilateral", "local"};

BreakablePanel wall(Method method, int cells) {
  const double size = cells * kCell;
  PanelSettings settings;
  settings.method = method;
  settings.cell = kCell;
  return {{{Vec2(0, 0), Vec2(size, 0), Vec2(size, size), Vec2(0, size)}, 0.2, {}, {}}, settings};
}

double processor_milliseconds() { return 1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

struct Cost {
  double median = 0, most = 0;                ///< ms
  double cells = 0, chunks = 0, changed = 0;  ///< mean of each hit
};

/// Hits at random places, each on a copy of the wall, or one after another on the same.
Cost measure(const BreakablePanel& intact, double size, double radius, int hits, bool in_a_row) {
  std::mt19937 random(1);
  const auto place = [&] { return radius + (size - 2 * radius) * (static_cast<double>(random() % 10007) / 10007); };
  std::vector<double> times;
  Cost cost;
  BreakablePanel panel(intact);
  std::size_t kept = 0;  // so that nothing is optimised away
  for (int k = 0; k < hits; ++k) {
    if (!in_a_row) panel = BreakablePanel(intact);
    const Vec2 at(place(), place());
    Fracture result;
    const double start = processor_milliseconds();
    result = panel.hit(at, radius);
    for (const Chunk& chunk : result.chunks) {
      kept += mesh_of(chunk, 0.2).triangles.size();
      kept += properties_of(chunk, 0.2, 2400).mass > 0 ? 1 : 0;
    }
    kept += panel.mesh().triangles.size();
    times.push_back(processor_milliseconds() - start);
    cost.cells += static_cast<double>(result.cells) / hits;
    cost.chunks += static_cast<double>(result.chunks.size()) / hits;
    cost.changed += static_cast<double>(result.triangles_changed) / hits;
  }
  cost.median = bench::median(times);
  cost.most = *std::max_element(times.begin(), times.end());
  if (kept == 0) std::printf("nothing was broken\n");
  return cost;
}

void print(const char* what, const Cost& c) {
  std::printf("  %-34s %9.3f %9.3f %8.1f %8.1f %10.1f\n", what, c.median, c.most, c.cells, c.chunks, c.changed);
}

/// Slope of log y over log x by least squares.
double exponent(const std::vector<double>& x, const std::vector<double>& y) {
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  const auto n = static_cast<double>(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double a = std::log(x[i]), b = std::log(y[i]);
    sx += a;
    sy += b;
    sxx += a * a;
    sxy += a * b;
  }
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

void run(Method method) {
  std::printf("%s\n  %-34s %9s %9s %8s %8s %10s\n", kNames[static_cast<int>(method)], "", "median ms", "most ms",
              "cells", "chunks", "triangles");
  const BreakablePanel small = wall(method, 20), large = wall(method, 200);
  print("20 x 20, radius 1 m", measure(small, 10, 1, 200, false));
  print("20 x 20, radius 1 m, 40 in a row", measure(small, 10, 1, 40, true));
  print("200 x 200, radius 1 m", measure(large, 100, 1, 200, false));
  print("200 x 200, radius 1 m, 400 in a row", measure(large, 100, 1, 400, true));

  std::vector<double> damage, time, changed;
  for (const double radius : {1.0, 2.0, 4.0, 8.0, 16.0}) {
    const Cost cost = measure(large, 100, radius, 12, false);
    char what[64];
    std::snprintf(what, sizeof what, "200 x 200, radius %g m", radius);
    print(what, cost);
    damage.push_back(cost.chunks);
    time.push_back(cost.median);
    changed.push_back(cost.changed);
  }
  std::printf("  with the number of chunks grow: time by the power %.2f, changed triangles by %.2f\n",
              exponent(damage, time), exponent(damage, changed));
  std::vector<double> size, wall_time, wall_changed;
  for (const int cells : {20, 40, 80, 160, 320}) {
    const Cost cost = measure(wall(method, cells), cells * kCell, 1, 60, false);
    size.push_back(static_cast<double>(cells) * cells);
    wall_time.push_back(cost.median);
    wall_changed.push_back(cost.changed);
  }
  std::printf("  with the wall's cells (400 to 102400) grow: time by the power %.2f, changed triangles by %.2f\n\n",
              exponent(size, wall_time), exponent(size, wall_changed));
}

}  // namespace

int main() {
  bench::print_provenance("From one hit to the meshes of all pieces", 1);
  for (const Method method : {Method::voronoi, Method::quadrilateral, Method::local}) run(method);
  return 0;
}
