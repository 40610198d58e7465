// Time and memory of everything that grows with the building: reading, analysis, reanalysis, segmentation, steps. One
// model in a process of its own, one thread; writes one JSON object.
//   bench_scaling MODEL.json
#include <fstream>
#include <iostream>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include "failure/segmentation.h"
#include "support/measure.h"
#include "topple/solver/blas_kernel.h"
#include "topple/solver/reanalysis.h"
#include "topple/structure/formats/files.h"
#include "topple/structure/frame.h"
#include "topple/structure/simulation.h"

namespace {

using namespace topple;
using namespace topple::bench;
using structure::Building;
using structure::JointId;

/// Of this process, in MiB: the field of /proc/self/status. 0 where there is none.
double memory(const std::string& field) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.rfind(field + ":", 0) == 0) return std::stod(line.substr(field.size() + 1)) / 1024;
  }
  return 0;
}

/// The peak is counted from now on.
void forget_peak() { std::ofstream("/proc/self/clear_refs") << 5; }

class Report {
 public:
  void add(const std::string& name, double value) { std::cout << ", \"" << name << "\": " << value; }
  void add(const std::string& stage, const Spread& spread) {
    add(stage + "_seconds", spread.median);
    add(stage + "_low", spread.low);
    add(stage + "_high", spread.high);
  }
  /// Runs a stage once, with its time and the peak of memory while it ran.
  template <typename Work>
  void stage(const std::string& name, Work work) {
    forget_peak();
    add(name + "_seconds", seconds(work));
    add(name + "_peak_mib", memory("VmHWM"));
  }
};

/// Members spread over the whole building, each with whatever number its place in the file gave it.
std::vector<int> spread_members(const Building& building, std::size_t count) {
  std::vector<int> members;
  const std::size_t all = building.members.size();
  for (std::size_t i = 0; i < count; ++i) {
    std::size_t member = (2 * i + 1) * all / (2 * count);
    while (member + 1 < all && building.members[member].kind != structure::MemberKind::beam) ++member;
    members.push_back(static_cast<int>(member));
  }
  return members;
}

void analyse(const Building& building, const structure::Frame& frame, const solver::LoadSet& loads, Report& report) {
  std::optional<solver::StaticAnalysis> analysis;
  std::vector<solver::StaticSolution> solutions;
  report.stage("analysis", [&] {
    analysis.emplace(frame.model);
    solutions = analysis->solve(std::span(&loads, 1));
  });
  const solver::AnalysisStatistics& s = analysis->statistics();
  report.add("freedoms", static_cast<double>(s.freedoms));
  report.add("members", static_cast<double>(building.members.size()));
  report.add("factor_entries", static_cast<double>(s.factor_entries));
  report.add("factor_operations", s.factor_operations);
  report.add("order_seconds", s.order_seconds);
  report.add("assemble_seconds", s.assemble_seconds);
  report.add("factor_seconds", s.factor_seconds);
  report.add("solve_seconds", s.solve_seconds);
  report.add("backward_error", solutions.front().quality.backward_error);
  report.add("error_bound", solutions.front().quality.error_bound);
}

void reanalyse(const Building& building, const structure::Frame& frame, const solver::LoadSet& loads, Report& report) {
  std::unique_ptr<solver::Reanalysis> standing;
  report.stage("standing", [&] {
    standing = std::make_unique<solver::Reanalysis>(frame.model);
    std::vector<std::vector<solver::BeamLoad>> by_beam(frame.model.beams.size());
    for (const solver::BeamLoad& load : loads.beams) by_beam[static_cast<std::size_t>(load.beam)].push_back(load);
    for (std::size_t b = 0; b < by_beam.size(); ++b)
      standing->set_beam_loads(static_cast<int>(b), std::move(by_beam[b]));
    if (!standing->solve().stable) throw std::runtime_error("the building does not stand");
  });
  std::vector<double> joint, load;
  for (const int beam : spread_members(building, 9)) {
    standing->set_end_stiffness(beam, 1, solver::Vec6::Zero());
    joint.push_back(seconds([&] { (void)standing->solve(); }));
    standing->set_end_stiffness(beam, 1, solver::Vec6::Constant(solver::rigid));
    (void)standing->solve();
    standing->set_node_load(frame.model.beams[static_cast<std::size_t>(beam)].node[0], solver::Vec6::Constant(1e3));
    load.push_back(seconds([&] { (void)standing->solve(); }));
  }
  report.add("joint_breaks", spread_of(joint));
  report.add("load_changes", spread_of(load));
}

void segment(const Building& building, Report& report) {
  std::optional<structure::Segmentation> segmentation;
  report.stage("segments", [&] { segmentation.emplace(building); });
  std::vector<double> cut;
  for (const int member : spread_members(building, 49)) {
    const JointId joint = building.joint(structure::MemberId(member), 0);
    cut.push_back(seconds([&] {
      segmentation->break_joint(joint);
      if (!segmentation->extract_unanchored().empty()) throw std::runtime_error("a beam fell by one joint");
    }));
  }
  report.add("segmentation", spread_of(cut));
}

void simulate(Building building, Report& report) {
  std::vector<JointId> joints;
  for (const int member : spread_members(building, 5)) joints.push_back(building.joint(structure::MemberId(member), 0));
  structure::Scenario scenario;
  scenario.combination = structure::CombinationId(0);
  scenario.until_rest = false;
  scenario.duration = 1e9;
  std::optional<structure::Simulation> simulation;
  report.stage("simulation", [&] { simulation.emplace(std::move(building), scenario); });
  std::vector<double> idle, cut, flight;
  for (int i = 0; i < 101; ++i) idle.push_back(seconds([&] { simulation->step(); }));
  for (const JointId joint : joints) {
    simulation->apply(structure::CutTool{{joint}});
    cut.push_back(seconds([&] { simulation->step(); }));
  }
  simulation->apply(structure::Projectile{{-50, -50, 500}, {-10, 0, 0}});
  simulation->step();
  for (int i = 0; i < 51; ++i) flight.push_back(seconds([&] { simulation->step(); }));
  report.add("idle_step", spread_of(idle));
  report.add("cut_step", spread_of(cut));
  report.add("flight_step", spread_of(flight));
}

void run(const std::string& file) {
  Report report;
  std::cout.precision(9);
  std::cout << "{\"blas_kernel\": \"" << solver::blas_kernel() << "\"";
  std::optional<Building> building;
  report.stage("reading", [&] { building = structure::read_model(file); });
  {
    const structure::Frame frame = make_frame(*building);
    const solver::LoadSet loads = load_set(*building, part_loads(*building, structure::CombinationId(0)));
    analyse(*building, frame, loads, report);
    reanalyse(*building, frame, loads, report);
  }
  segment(*building, report);
  simulate(std::move(*building), report);
  std::cout << "}\n";
}

}  // namespace

int main(int argc, char** argv) {
  solver::prepare_blas(argv);
  try {
    if (argc != 2) throw std::runtime_error("usage: bench_scaling MODEL.json");
    run(argv[1]);
    return 0;
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
