// Small kernels, one at a time, as often as asked: for counting instructions, where times are noise.
//   bench_kernels NAME COUNT          (without arguments: the names)
#include <array>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>
#include <string>

#include "elements/beam.h"
#include "support/changed_frame.h"
#include "support/steel_utilisations.h"
#include "topple/solver/beam_diagram.h"

using namespace topple;
using namespace topple::bench;

namespace {

using Repeat = std::function<double(long)>;  ///< does the work so often; the sum keeps the compiler honest

const RegularFrame& seed_sized_frame() {
  static const RegularFrame frame = regular_frame(4, 5, 6);
  return frame;
}

const solver::Vec12 some_forces = solver::Vec12::LinSpaced(1e3, 12e3);

double beam_stiffness(long count) {
  solver::Beam beam = seed_sized_frame().model.beams.front();
  double sum = 0;
  for (long i = 0; i < count; ++i) {
    beam.end_stiffness[1][4] = 1e6 + static_cast<double>(i);
    sum += solver::CondensedBeam(beam).stiffness()(4, 4);
  }
  return sum;
}

double fixed_end_forces(long count) {
  const RegularFrame& frame = seed_sized_frame();
  solver::BeamLoad load = frame.loads.beams.back();
  const solver::CondensedBeam beam(frame.model.beams[static_cast<std::size_t>(load.beam)]);
  double sum = 0;
  for (long i = 0; i < count; ++i) {
    load.first[2] = -1e3 - static_cast<double>(i);
    sum += beam.fixed_end_forces(std::span(&load, 1)).force[2];
  }
  return sum;
}

double diagram_extremes(long count) {
  const RegularFrame& frame = seed_sized_frame();
  const solver::BeamLoad& load = frame.loads.beams.back();
  const solver::Beam& beam = frame.model.beams[static_cast<std::size_t>(load.beam)];
  double sum = 0;
  for (long i = 0; i < count; ++i) {
    const solver::BeamDiagram diagram(beam, some_forces * static_cast<double>(i + 1), std::span(&load, 1));
    sum += diagram.extremes(solver::BeamDiagram::moment_y).greatest.value;
  }
  return sum;
}

double utilisation(long count) {
  structure::JointCapacity limit;
  limit.breakable = true;
  limit.value = {3e6, 3e6, 6e5, 6e5, 5e4, 3e5, 1e5};
  double sum = 0;
  for (long i = 0; i < count; ++i)
    sum += structure::utilisation(limit, structure::member_joint_demand(some_forces * static_cast<double>(i), 1)).value;
  return sum;
}

double nothing_changes(long count) {
  const auto standing = stand(seed_sized_frame());
  double sum = 0;
  for (long i = 0; i < count; ++i) sum += standing->solve().quality.backward_error;
  return sum;
}

double load_changes(long count) {
  const auto standing = stand(seed_sized_frame());
  double sum = 0;
  for (long i = 0; i < count; ++i) {
    standing->set_node_load(100, solver::Vec6::Constant(1e3 + static_cast<double>(i % 7)));
    sum += standing->solve().quality.backward_error;
  }
  return sum;
}

double joint_breaks(long count) {
  const auto standing = stand(seed_sized_frame());
  const std::vector<int> members = random_members(seed_sized_frame(), 16, 1);
  double sum = 0;
  for (long i = 0; i < count; ++i) {
    const int member = members[static_cast<std::size_t>(i) % members.size()];
    standing->set_end_stiffness(member, 1, solver::Vec6::Zero());
    sum += standing->solve().quality.backward_error;
    standing->set_end_stiffness(member, 1, solver::Vec6::Constant(solver::rigid));
    sum += standing->solve().quality.backward_error;
  }
  return sum;
}

double fresh_analysis(long count) {
  double sum = 0;
  for (long i = 0; i < count; ++i) {
    solver::StaticAnalysis analysis(seed_sized_frame().model);
    sum += analysis.solve(std::span(&seed_sized_frame().loads, 1)).front().displacements.back().z();
  }
  return sum;
}

const std::map<std::string, Repeat> kernels{{"beam stiffness", beam_stiffness},
                                            {"fixed-end forces", fixed_end_forces},
                                            {"diagram and its extremes", diagram_extremes},
                                            {"use of a joint", utilisation},
                                            {"nothing changes", nothing_changes},
                                            {"a load changes", load_changes},
                                            {"a joint breaks and is mended", joint_breaks},
                                            {"fresh analysis", fresh_analysis}};

}  // namespace

int main(int argc, char** argv) {
  if (argc == 1) {
    for (const auto& [name, work] : kernels) std::printf("%s\n", name.c_str());
    return 0;
  }
  const auto found = kernels.find(argv[1]);
  if (argc != 3 || found == kernels.end()) {
    std::fprintf(stderr, "usage: bench_kernels NAME COUNT (without arguments: the names)\n");
    return 2;
  }
  std::printf("%.17g\n", found->second(std::atol(argv[2])));
  return 0;
}
