// Simulates a scene with Bullet until the given time and says how far its roof sagged, what its joints carried and what
// a step cost. Reads the scene from a file, writes one JSON object.
//   bench_baseline_double SCENE [--solver si|nncg|pgs|dantzig|lemke|featherstone] [--iterations N] [--substeps N]
//                         [--step S] [--seconds S] [--average S] [--compliance C] [--limit S] [--trace]
// --limit: processor seconds after which it stops and says so; --average: the last seconds over which forces are
// averaged.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <iostream>
#include <map>
#include <stdexcept>

#include "bullet_building.h"
#include "bullet_tree.h"

namespace {

using namespace baseline;

struct Run {
  std::vector<double> step_seconds;
  std::vector<JointForce> mean_forces;
  std::vector<double> sag;  // after every step
  bool out_of_time = false, diverged = false;
  int silent_fallbacks = 0, joints_left_out = 0;
};

double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

Run simulate(const Scene& scene, const Method& method, double seconds, double average, double limit) {
  std::unique_ptr<Engine> engine;
  if (method.solver == "featherstone") {
    engine = std::make_unique<BulletTree>(scene, method);
  } else {
    engine = std::make_unique<BulletBuilding>(scene, method);
  }
  Engine& building = *engine;
  Run run;
  run.mean_forces.assign(scene.joints.size(), JointForce{});
  const int steps = static_cast<int>(std::lround(seconds / method.step));
  const int averaged = std::max(1, static_cast<int>(std::lround(average / method.step)));
  const double start = processor_seconds();
  std::vector<std::vector<JointForce>> history;
  for (int i = 0; i < steps && !run.out_of_time && !run.diverged; ++i) {
    const double before = processor_seconds();
    building.step();
    run.step_seconds.push_back(processor_seconds() - before);
    run.sag.push_back(building.mean_roof_sag());
    history.push_back(building.joint_forces());
    if (static_cast<int>(history.size()) > averaged) history.erase(history.begin());
    run.out_of_time = processor_seconds() - start > limit;
    run.diverged = !building.finite() || std::abs(run.sag.back()) > 1e3;
  }
  for (const auto& forces : history) {
    for (std::size_t j = 0; j < forces.size(); ++j) {
      for (std::size_t c = 0; c < 6; ++c) run.mean_forces[j][c] += forces[j][c] / static_cast<double>(history.size());
    }
  }
  run.silent_fallbacks = building.silent_fallbacks();
  run.joints_left_out = building.joints_left_out();
  return run;
}

/// Quantile of the sorted values; 0 when there are none.
double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

/// Steps after which the sag stays within 5 % of where it ends; not finite when it was still moving as the averaging
/// began.
double steps_to_settle(const Run& run, double end, std::size_t averaged) {
  const double band = 0.05 * std::abs(end);
  std::size_t settled = run.sag.size();
  while (settled > 0 && std::abs(run.sag[settled - 1] - end) <= band) --settled;
  const bool moving = settled + averaged > run.sag.size() || run.out_of_time || run.diverged;
  return moving ? NAN : static_cast<double>(settled + 1);
}

/// Root mean square of the differences over that of the reference, over joints and components that `use` picks.
template <typename Use>
double relative_error(const Scene& scene, const Run& run, Use use) {
  double difference = 0, reference = 0;
  for (std::size_t j = 0; j < scene.joints.size(); ++j) {
    if (!scene.joints[j].has_force) continue;
    for (std::size_t c = 0; c < 6; ++c) {
      if (!use(scene.joints[j], c)) continue;
      const double d = run.mean_forces[j][c] - scene.joints[j].force[c];
      difference += d * d;
      reference += scene.joints[j].force[c] * scene.joints[j].force[c];
    }
  }
  return reference > 0 ? std::sqrt(difference / reference) : 0;
}

void number(std::ostream& out, const char* key, double value) {
  out << ", \"" << key << "\": ";
  if (std::isfinite(value)) {
    out << value;
  } else {
    out << "null";
  }
}

double mean_of_last(const std::vector<double>& values, std::size_t count) {
  const std::size_t used = std::min(count, values.size());
  double sum = 0;
  for (std::size_t i = values.size() - used; i < values.size(); ++i) sum += values[i];
  return used > 0 ? sum / static_cast<double>(used) : NAN;
}

void write(std::ostream& out, const Scene& scene, const Method& method, const Run& run, std::size_t averaged,
           bool trace) {
  double sum = 0, expected = 0;
  double least = 1e300, most = -1e300;
  for (std::size_t j = 0; j < scene.joints.size(); ++j) {
    const SceneJoint& joint = scene.joints[j];
    if (joint.other >= 0 || !joint.has_force) continue;
    sum += run.mean_forces[j][2];
    expected += joint.force[2];
    least = std::min(least, run.mean_forces[j][2] / joint.force[2]);
    most = std::max(most, run.mean_forces[j][2] / joint.force[2]);
  }
  const auto reactions = [](const SceneJoint& joint, std::size_t c) { return joint.other < 0 && c == 2; };
  const auto posts = [](const SceneJoint& joint, std::size_t c) { return joint.name[0] == 'P' && c == 2; };
  const auto shears = [](const SceneJoint& joint, std::size_t c) { return joint.name[0] == 'B' && c == 2; };
  const auto moments = [](const SceneJoint& joint, std::size_t c) { return joint.name[0] == 'B' && c > 2; };
  out.precision(9);
  out << "{\"solver\": \"" << method.solver << "\", \"precision\": \"" << (sizeof(btScalar) == 8 ? "double" : "single")
      << "\"";
  number(out, "iterations", method.iterations);
  number(out, "substeps", method.substeps);
  number(out, "compliance", method.compliance);
  number(out, "bodies", static_cast<double>(scene.bodies.size()));
  number(out, "joints", static_cast<double>(scene.joints.size()));
  number(out, "steps", static_cast<double>(run.step_seconds.size()));
  number(out, "sag", mean_of_last(run.sag, averaged));
  number(out, "last_sag", run.sag.empty() ? NAN : run.sag.back());
  number(out, "largest_sag", run.sag.empty() ? NAN : *std::max_element(run.sag.begin(), run.sag.end()));
  number(out, "static_sag", scene.static_sag);
  number(out, "reaction_sum", sum / expected);
  number(out, "least_share", least);
  number(out, "largest_share", most);
  number(out, "reaction_error", relative_error(scene, run, reactions));
  number(out, "post_force_error", relative_error(scene, run, posts));
  number(out, "beam_shear_error", relative_error(scene, run, shears));
  number(out, "beam_moment_error", relative_error(scene, run, moments));
  number(out, "milliseconds_per_step", 1e3 * quantile(run.step_seconds, 0.5));
  number(out, "milliseconds_low", 1e3 * quantile(run.step_seconds, 0.25));
  number(out, "milliseconds_high", 1e3 * quantile(run.step_seconds, 0.75));
  number(out, "steps_to_settle", steps_to_settle(run, mean_of_last(run.sag, averaged), averaged));
  number(out, "silent_fallbacks", run.silent_fallbacks);
  number(out, "joints_left_out", run.joints_left_out);
  out << ", \"timed_out\": " << (run.out_of_time ? "true" : "false")
      << ", \"diverged\": " << (run.diverged ? "true" : "false");
  if (trace) {
    out << ", \"trace\": [";
    for (std::size_t i = 0; i < run.sag.size(); i += 30) out << (i ? ", " : "") << run.sag[i];
    out << "]";
  }
  out << "}\n";
}

}  // namespace

int main(int argc, char** argv) {
  try {
    if (argc < 2) throw std::runtime_error("usage: bench_baseline_double SCENE [--option value]...");
    std::map<std::string, std::string> options;
    for (int i = 2; i < argc; ++i) {
      const std::string key = argv[i];
      if (key == "--trace") {
        options[key] = "1";
      } else if (key.rfind("--", 0) == 0 && i + 1 < argc) {
        options[key] = argv[++i];
      } else {
        throw std::runtime_error("option " + key + " has no value");
      }
    }
    const auto value = [&](const char* key, double fallback) {
      const auto found = options.find(key);
      return found == options.end() ? fallback : std::stod(found->second);
    };
    std::ifstream file(argv[1]);
    if (!file) throw std::runtime_error(std::string(argv[1]) + ": cannot be read");
    const Scene scene = read_scene(file);
    Method method;
    if (options.count("--solver")) method.solver = options["--solver"];
    method.iterations = static_cast<int>(value("--iterations", method.iterations));
    method.substeps = static_cast<int>(value("--substeps", method.substeps));
    method.step = value("--step", method.step);
    method.compliance = value("--compliance", 0);
    const double seconds = value("--seconds", 10);
    const double average = value("--average", 2);
    const Run run = simulate(scene, method, seconds, average, value("--limit", 60));
    const auto averaged = static_cast<std::size_t>(std::lround(average / method.step));
    write(std::cout, scene, method, run, std::max<std::size_t>(1, averaged), options.count("--trace") > 0);
    return 0;
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
}
