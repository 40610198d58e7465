// Where an update gives way to a new factor: more and more joints broken at once, by a correction and by a new factor,
// and which of the two Reanalysis takes. Asked: its choice takes at most 1.3 times as long as the better one.
//   bench_update_or_refactor [posts_x posts_y storeys [counts]]      (default 10 10 20)
// With `counts` also what the prediction is made of, a line for each measurement.
#include <cstdlib>
#include <span>

#include "assembly/frame_system.h"
#include "assembly/refinement.h"
#include "factor/factor.h"
#include "reanalysis/base_factor.h"
#include "reanalysis/update_costs.h"
#include "support/changed_frame.h"
#include "support/measure.h"
#include "support/provenance.h"

using namespace topple;
using namespace topple::bench;

namespace {

struct Times {
  double correction = 0, new_factor = 0;
  solver::CorrectionWork work;
  solver::FactorWork factor_work;
};

/// All of the members but the last break. Each way's own work for one answer: correction and solve, or factorisation,
/// estimate of the condition, what makes the new factor the one that stands, and solve.
Times break_at_once(const RegularFrame& frame, solver::Factor& whole, std::span<const int> members) {
  solver::FrameSystem system(frame.model);
  system.assemble();
  (void)whole.factorise(system.matrix());
  solver::Factor anew(system.matrix(), system.elimination_order(), solver::Factorisation::automatic);
  (void)anew.factorise(system.matrix());
  solver::BaseFactor standing(system);
  standing.install(whole);
  const auto change = [&](std::span<const int> changed, const solver::Vec6& stiffness) {
    std::vector<int> nodes;
    for (const int member : changed) {
      solver::Beam& beam = system.model.beams[static_cast<std::size_t>(member)];
      standing.changes().remember_beam(member);
      beam.end_stiffness[1] = stiffness;
      nodes.insert(nodes.end(), beam.node.begin(), beam.node.end());
    }
    system.reassemble(nodes);
    standing.changes().touch(nodes);
  };
  // One more joint, broken and restored beforehand: a structure that stands is warm.
  for (const double stiffness : {0.0, solver::rigid}) {
    change(members.last(1), solver::Vec6::Constant(stiffness));
    Eigen::VectorXd warm = Eigen::VectorXd::Ones(system.matrix().size);
    if (!standing.plan().possible) std::exit(1);
    standing.update();
    standing.solve(warm);
  }
  change(members.first(members.size() - 1), solver::Vec6::Zero());
  Times times;
  Eigen::VectorXd x = Eigen::VectorXd::Ones(system.matrix().size);
  times.correction = seconds([&] {
    const solver::BaseFactor::Plan plan = standing.plan();
    if (!plan.possible) std::exit(1);
    times.work = plan.work;
    standing.update();
    standing.solve(x);
  });
  times.new_factor = seconds([&] {
    Eigen::MatrixXd y = Eigen::MatrixXd::Ones(system.matrix().size, 1);
    (void)anew.factorise(system.matrix());
    const auto solve = [&](Eigen::Ref<Eigen::MatrixXd> b) { anew.solve(b); };
    if (!(solver::estimate_condition(system.matrix(), solve) > 0)) std::exit(1);
    solver::BaseFactor next(system);
    next.install(anew);
    anew.solve(y);
  });
  times.factor_work = {anew.operations(), static_cast<double>(system.matrix().size), times.work.solve};
  return times;
}

void print_counts(const Times& t) {
  const solver::CorrectionWork& w = t.work;
  const solver::FactorWork& f = t.factor_work;
  std::printf("counts %.0f = %.0f: %.0f places %.0f blocks %.0f products %.0f shared %.0f pairs %.0f pair-products ",
              1e9 * t.correction, predicted_cost(w), w.places, w.path_blocks, w.path_products, w.shared_entries,
              w.pairs, w.pair_products);
  std::printf(
      "%.0f rank %.0f column-entries %.0f solve-entries %.0f solve-blocks; new factor %.0f = %.0f: %.0f operations "
      "%.0f freedoms\n",
      w.rank, w.column_entries, w.solve.entries, w.solve.blocks, 1e9 * t.new_factor, predicted_cost(f), f.operations,
      f.freedoms);
}

/// What Reanalysis itself does.
bool takes_correction(const RegularFrame& frame, const std::vector<int>& members) {
  solver::Reanalysis standing(frame.model);
  if (!standing.solve().stable) std::exit(1);
  for (const int member : members) standing.set_end_stiffness(member, 1, solver::Vec6::Zero());
  if (!standing.solve().stable) std::exit(1);
  return standing.counters().low_rank > 0;
}

}  // namespace

int main(int argc, char** argv) {
  solver::prepare_blas(argv);
  if (argc != 1 && argc != 4 && argc != 5) {
    std::fprintf(stderr, "usage: bench_update_or_refactor [posts_x posts_y storeys [counts]]\n");
    return 2;
  }
  const bool counts = argc == 5;
  const int nx = argc > 1 ? std::atoi(argv[1]) : 10, ny = argc > 1 ? std::atoi(argv[2]) : 10;
  const int storeys = argc > 1 ? std::atoi(argv[3]) : 20;
  if (nx < 2 || ny < 2 || storeys < 1) {
    std::fprintf(stderr, "bench_update_or_refactor: at least 2 x 2 posts, 1 storey\n");
    return 2;
  }
  const RegularFrame frame = regular_frame(nx, ny, storeys);
  print_provenance("The choice of strategy over the number of joints broken at once", 1);
  std::printf("%d x %d posts, %d storeys, %zu freedoms\n\n", nx, ny, storeys,
              6 * static_cast<std::size_t>(nx * ny * storeys));
  std::printf("  joints   correction   new factor   what it takes      times the better\n");
  solver::FrameSystem system(frame.model);
  system.assemble();
  solver::Factor whole(system.matrix(), system.elimination_order(), solver::Factorisation::automatic);
  constexpr unsigned rounds = 5;
  double worst = 0;
  for (std::size_t joints = 1; joints <= 128; joints *= 2) {
    std::vector<double> correction, new_factor;
    for (unsigned round = 0; round < rounds; ++round) {
      const std::vector<int> members = random_members(frame, joints + 1, round + 1);
      if (members.size() <= joints) break;
      const Times times = break_at_once(frame, whole, members);
      correction.push_back(times.correction);
      new_factor.push_back(times.new_factor);
      if (counts) print_counts(times);
    }
    if (correction.size() < rounds) break;
    const double corrected = median(correction), anew = median(new_factor);
    const bool corrects = takes_correction(frame, random_members(frame, joints, 1));
    const double ratio = (corrects ? corrected : anew) / std::min(corrected, anew);
    worst = std::max(worst, ratio);
    std::printf("  %6zu %9.3f ms %9.3f ms   %-16s %8.2f\n", joints, 1e3 * corrected, 1e3 * anew,
                corrects ? "correction" : "new factor", ratio);
  }
  std::printf("\n  worst choice %.2f times the better (asked: 1.3)\n", worst);
  return 0;
}
