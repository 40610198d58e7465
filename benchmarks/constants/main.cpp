// A collapse with one constant of docs/constants.md changed, and what came of it as one line of JSON.
//   bench_constants --list                      names and values, a line each
//   bench_constants SCENARIO [NAME FACTOR]      the constant times FACTOR; whole numbers are rounded, and at least 1
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <variant>
#include <vector>

#include "simulation/debris/debris_settings.h"
#include "simulation/impact/impact_settings.h"
#include "solver/solver_settings.h"
#include "standing/motion/motion_settings.h"
#include "topple/structure/formats/files.h"
#include "topple/structure/simulation.h"

namespace {

using namespace topple;

struct Constant {
  const char* name;
  std::variant<double*, int*> value;
};
const std::vector<Constant> constants = {
#include "constants_table.inc"
};

double value_of(const Constant& one) {
  return std::visit([](const auto* value) { return static_cast<double>(*value); }, one.value);
}

bool change(const char* name, double factor) {
  for (const Constant& one : constants) {
    if (std::strcmp(one.name, name) != 0) continue;
    if (auto* const* whole = std::get_if<int*>(&one.value))
      **whole = std::max(1, static_cast<int>(std::lround(**whole * factor)));
    else
      **std::get_if<double*>(&one.value) *= factor;
    return true;
  }
  return false;
}

int run(const char* path) {
  auto [building, scenario] = structure::read_scenario(std::string(path));
  structure::Simulation simulation(std::move(building), std::move(scenario));
  const std::size_t members = simulation.building().members.size();
  std::vector<std::pair<double, std::size_t>> course;  // time, members down
  const auto down = [&] {
    std::size_t count = 0;
    for (std::size_t i = 0; i < members; ++i)
      if (simulation.body_of(structure::MemberId(i)).value != -1) ++count;
    return count;
  };
  while (!simulation.finished()) {
    if (simulation.skip_idle() == 0) simulation.step();
    if (const std::size_t now = down(); course.empty() || now > course.back().second)
      course.emplace_back(simulation.time(), now);
  }
  const std::size_t all = course.empty() ? 0 : course.back().second;
  double half = -1;
  for (const auto& [time, count] : course)
    if (half < 0 && count > 0 && 2 * count >= all) half = time;
  std::printf("{\"down\": %zu, \"share\": %.6f, ", all, static_cast<double>(all) / static_cast<double>(members));
  std::printf(half < 0 ? "\"half\": null, " : "\"half\": %.6f, ", half);
  std::printf("\"rest\": %.6f, \"residual\": %.3e}\n", simulation.time(), simulation.ledger().residual());
  return 0;
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc == 2 && std::strcmp(argv[1], "--list") == 0) {
    for (const Constant& one : constants) std::printf("%s %.17g\n", one.name, value_of(one));
    return 0;
  }
  if (argc != 2 && argc != 4) {
    std::fprintf(stderr, "usage: bench_constants --list | SCENARIO [NAME FACTOR]\n");
    return 2;
  }
  if (argc == 4) {
    char* end = nullptr;
    const double factor = std::strtod(argv[3], &end);
    if (*end != 0 || !(factor > 0) || !std::isfinite(factor)) {
      std::fprintf(stderr, "bench_constants: the factor \"%s\" must be a number above 0\n", argv[3]);
      return 2;
    }
    if (!change(argv[2], factor)) {
      std::fprintf(stderr, "bench_constants: no constant \"%s\"; --list names them\n", argv[2]);
      return 2;
    }
  }
  return run(argv[1]);
} catch (const std::exception& error) {
  std::fprintf(stderr, "bench_constants: %s\n", error.what());
  return 1;
}
