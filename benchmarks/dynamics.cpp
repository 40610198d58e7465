// What a substep of a frame that moves costs, beside the triangular solves of a static answer over the same factor:
// with all joints looked at, with and without the ledger of energy, and with its own error told, as collapses take it;
// and what a joint that breaks in it adds, beside one static answer.
//   bench_dynamics [posts_x posts_y storeys]      (default: 4 5 6 and 10 10 40)
// Asked on a quiet machine: at 24,000 freedoms 1.3 solve pairs, at 720 0.06 ms.
#include <cstdlib>
#include <span>

#include "assembly/frame_system.h"
#include "factor/factor.h"
#include "reanalysis/base_factor.h"
#include "support/changed_frame.h"
#include "support/measure.h"
#include "support/provenance.h"
#include "topple/solver/frame_dynamics.h"
#include "topple/structure/joint_check.h"

using namespace topple;
using namespace topple::bench;

namespace {

/// Capacities that nothing reaches.
class Strong : public solver::JointLaw {
 public:
  Strong() {
    limit_.breakable = true;
    limit_.value = {3e8, 3e8, 6e7, 6e7, 5e6, 3e7, 1e7};
  }
  [[nodiscard]] double beam_utilisation(int beam, const solver::Vec12& forces) const override {
    return std::max(end_utilisation(beam, 0, forces), end_utilisation(beam, 1, forces));
  }
  [[nodiscard]] double end_utilisation(int, int end, const solver::Vec12& forces) const override {
    return structure::utilisation(limit_, structure::member_joint_demand(forces, end)).value;
  }

 private:
  structure::JointCapacity limit_;
};

/// The regular frame with its loads as mass, swaying after a push. `told`: of each substep it is asked how far it is
/// off.
solver::FrameDynamics swaying(const RegularFrame& regular, bool keep_energy, bool told = false) {
  solver::FrameModel model = regular.model;
  for (const solver::BeamLoad& load : regular.loads.beams) {
    solver::Beam& beam = model.beams[static_cast<std::size_t>(load.beam)];
    beam.density = load.first.head<3>().norm() / (9.81 * beam.area);
  }
  solver::DynamicOptions options;
  options.keep_energy = keep_energy;
  if (told) options.most_parts = 8;
  options.damping = solver::rayleigh_damping(0.02, 6, 30);
  solver::FrameDynamics frame(std::move(model), {}, options);
  for (const solver::BeamLoad& load : regular.loads.beams) frame.set_beam_loads(load.beam, {load});
  std::vector<solver::Vec6> still(regular.model.nodes.size(), solver::Vec6::Zero()), moving = still;
  for (std::size_t n = 0; n < moving.size(); ++n) moving[n](0) = 0.01 * regular.model.nodes[n].z();
  frame.set_state(still, moving);
  return frame;
}

void measure(int nx, int ny, int storeys) {
  const RegularFrame regular = regular_frame(nx, ny, storeys);
  const auto standing = stand(regular);
  solver::FrameSystem system(regular.model);
  system.assemble();
  solver::Factor factor(system.matrix(), system.elimination_order(), solver::Factorisation::automatic);
  (void)factor.factorise(system.matrix());
  solver::BaseFactor pair(system);
  pair.install(factor);
  Eigen::VectorXd x = Eigen::VectorXd::Ones(system.matrix().size);
  solver::FrameDynamics with_energy = swaying(regular, true), without = swaying(regular, false),
                        told = swaying(regular, false, true);
  const Strong law;
  const int repeated = nx * ny * storeys > 1000 ? 1 : 20;
  const auto many = [&](const auto& work) {
    return [&, work] {
      for (int k = 0; k < repeated; ++k) work();
    };
  };
  const std::vector<double> times = interleaved_medians(
      25,
      {many([&] { pair.solve(x); }), many([&] { (void)without.advance(); }), many([&] { (void)without.advance(&law); }),
       many([&] { (void)with_energy.advance(&law); }), many([&] { (void)told.advance(&law); })});
  const double one = times[0] / repeated;
  std::printf("  %6d %9.4f ms %9.4f ms %5.2f %9.4f ms %5.2f %9.4f ms %5.2f %9.4f ms %5.2f\n", system.matrix().size,
              1e3 * one, 1e3 * times[1] / repeated, times[1] / times[0], 1e3 * times[2] / repeated, times[2] / times[0],
              1e3 * times[3] / repeated, times[3] / times[0], 1e3 * times[4] / repeated, times[4] / times[0]);

  // Joints that break one after the other, a substep each, against answers of the static reanalysis.
  std::vector<double> moved, answered;
  const std::vector<int> members = random_members(regular, 9, 1);
  for (const int member : members) {
    with_energy.set_end_stiffness(member, 1, solver::Vec6::Zero());
    moved.push_back(seconds([&] { (void)with_energy.advance(&law); }));
    standing->set_end_stiffness(member, 1, solver::Vec6::Zero());
    answered.push_back(seconds([&] { (void)standing->solve(); }));
  }
  std::printf("         a substep with a break %.3f ms; a static answer %.3f ms\n", 1e3 * median(moved),
              1e3 * median(answered));
}

}  // namespace

int main(int argc, char** argv) {
  print_provenance("A substep of a frame that moves", 1);
  std::printf(
      "freedoms    solve pair        no joints          all joints          and energy          and its error\n");
  if (argc > 3) {
    measure(std::atoi(argv[1]), std::atoi(argv[2]), std::atoi(argv[3]));
    return 0;
  }
  measure(4, 5, 6);
  measure(10, 10, 40);
  return 0;
}
