// A joint breaks: what the new answer costs, against a new factorisation by CHOLMOD and against a forward and backward
// solve with its factor ("pair"), all on the same matrix in one run. Errors beside times.
//   bench_reanalysis [posts_x posts_y storeys breaks]      (default 10 10 40 50)
#include <algorithm>
#include <cstdlib>
#include <limits>
#include <memory>
#include <numeric>
#include <random>

#include "assembly/frame_system.h"
#include "factor/factor.h"
#include "support/changed_frame.h"
#include "support/measure.h"
#include "support/provenance.h"
#include "support/steel_utilisations.h"

using namespace topple;
using namespace topple::bench;

namespace {

constexpr unsigned seed = 1;

struct Reference {
  double factor = 0, pair = 0;
};

/// CHOLMOD's own numeric factorisation and solve, with the better of its two kinds.
Reference measure_reference(const RegularFrame& frame, solver::Factorisation kind, int rounds) {
  solver::FrameSystem system(frame.model);
  system.assemble();
  solver::Factor factor(system.matrix(), system.elimination_order(), kind);
  Eigen::MatrixXd x = Eigen::MatrixXd::Ones(system.matrix().size, 1);
  const auto time = interleaved_medians(rounds, {[&] { (void)factor.factorise(system.matrix()); },
                                                 [&] {
                                                   x.setOnes();
                                                   factor.solve(x);
                                                 }});
  return {time[0], time[1]};
}

/// Every joint's forces, as a simulation asks for them.
double all_forces(const solver::Reanalysis& standing) {
  double sum = 0;
  for (int b = 0; b < static_cast<int>(standing.model().beams.size()); ++b) sum += standing.beam_end_forces(b)(0);
  return sum;
}

/// Largest difference of displacements to a fresh analysis, relative.
double error(const RegularFrame& frame, const solver::Reanalysis& standing) {
  solver::FrameModel model = standing.model();
  solver::LoadSet loads = frame.loads;
  std::erase_if(loads.beams, [&](const solver::BeamLoad& load) {
    const auto& ends = model.beams[static_cast<std::size_t>(load.beam)].end_stiffness;
    return ends[0].isZero(0) && ends[1].isZero(0);
  });
  return difference_to_fresh(model, loads, standing);
}

struct Steps {
  std::vector<double> time, forces;
};

Steps break_one_by_one(solver::Reanalysis& standing, const std::vector<int>& members) {
  Steps steps;
  for (const int member : members) {
    standing.set_end_stiffness(member, 1, solver::Vec6::Zero());
    steps.time.push_back(seconds([&] {
      if (!standing.solve().stable) {
        std::fprintf(stderr, "member %d: the frame became a mechanism\n", member);
        std::exit(1);
      }
    }));
    double sum = 0;
    steps.forces.push_back(seconds([&] { sum = all_forces(standing); }));
    if (sum == 0) std::exit(1);
  }
  return steps;
}

double median_of(const std::vector<double>& values, std::size_t from, std::size_t count) {
  return median({values.begin() + static_cast<std::ptrdiff_t>(from),
                 values.begin() + static_cast<std::ptrdiff_t>(std::min(from + count, values.size()))});
}

/// One joint broken in a fresh state, over and over: breaks are undone in between, which is not counted.
double first_break(solver::Reanalysis& standing, const std::vector<int>& members, bool forces) {
  std::vector<double> times;
  for (const int member : members) {
    standing.set_end_stiffness(member, 1, solver::Vec6::Zero());
    times.push_back(seconds([&] {
      (void)standing.solve();
      if (forces && all_forces(standing) == 0) std::exit(1);
    }));
    standing.set_end_stiffness(member, 1, solver::Vec6::Constant(solver::rigid));
    (void)standing.solve();
  }
  return median(times);
}

/// The same with selective answers: the time with reading the uses, and what was gone through.
struct Restricted {
  double time = 0, longest = 0, visited = 0, beams = 0, left = 0, answers = 0;
};

Restricted first_break_in_part(solver::Reanalysis& standing, const std::vector<int>& members) {
  SteelUtilisations uses(standing);
  (void)standing.solve(uses);
  std::vector<double> times, visited, beams, left;
  Restricted result;
  for (const int member : members) {
    standing.set_end_stiffness(member, 1, solver::Vec6::Zero());
    times.push_back(seconds([&] { (void)standing.solve(uses); }));
    const solver::SelectiveEffort& effort = standing.selective_effort();
    result.answers += effort.selective ? 1 : 0;
    visited.push_back(effort.visited_entries / std::max(1.0, effort.factor_entries));
    beams.push_back(effort.beams);
    left.push_back(effort.largest_left_out);
    standing.set_end_stiffness(member, 1, solver::Vec6::Constant(solver::rigid));
    (void)standing.solve();
    (void)standing.solve(uses);
  }
  result.time = median(times);
  result.longest = *std::max_element(times.begin(), times.end());
  result.visited = median(visited);
  result.beams = median(beams);
  result.left = median(left);
  return result;
}

/// Sixteen joints broken in a fresh state, another sixteen each time; times in order of size, the largest error.
struct Together {
  std::vector<double> time;
  double error = 0;
};

Together break_together(solver::Reanalysis& standing, const RegularFrame& frame, const std::vector<int>& members) {
  constexpr std::size_t joints = 16, rounds = 7;
  Together result;
  for (std::size_t round = 0; round < rounds; ++round) {
    const std::size_t first = round * 5 % (members.size() - joints + 1);
    const std::vector<int> own(members.begin() + static_cast<std::ptrdiff_t>(first),
                               members.begin() + static_cast<std::ptrdiff_t>(first + joints));
    for (const int member : own) standing.set_end_stiffness(member, 1, solver::Vec6::Zero());
    result.time.push_back(seconds([&] { (void)standing.solve(); }));
    result.error = std::max(result.error, error(frame, standing));
    for (const int member : own) standing.set_end_stiffness(member, 1, solver::Vec6::Constant(solver::rigid));
    (void)standing.solve();
  }
  std::sort(result.time.begin(), result.time.end());
  return result;
}

}  // namespace

int main(int argc, char** argv) {
  solver::prepare_blas(argv);
  if (argc != 1 && argc != 5) {
    std::fprintf(stderr, "usage: bench_reanalysis [posts_x posts_y storeys breaks]\n");
    return 2;
  }
  const int nx = argc > 1 ? std::atoi(argv[1]) : 10, ny = argc > 1 ? std::atoi(argv[2]) : 10;
  const int storeys = argc > 1 ? std::atoi(argv[3]) : 40, breaks = argc > 1 ? std::atoi(argv[4]) : 50;
  if (nx < 2 || ny < 2 || storeys < 1 || breaks < 1) {
    std::fprintf(stderr, "bench_reanalysis: at least 2 x 2 posts, 1 storey, 1 break\n");
    return 2;
  }
  const RegularFrame frame = regular_frame(nx, ny, storeys);
  const auto members = random_members(frame, static_cast<std::size_t>(std::max(breaks, 18)), seed);
  if (members.size() < 18) {
    std::fprintf(stderr, "bench_reanalysis: the frame is too small for 18 joints apart\n");
    return 2;
  }
  print_provenance("Reanalysis of the regular steel frame", 1);
  auto structure = stand(frame);
  const Reference supernodal = measure_reference(frame, solver::Factorisation::supernodal, 5);
  const Reference simplicial =
      nx * ny * storeys < 500 ? measure_reference(frame, solver::Factorisation::simplicial, 15) : Reference{1e9, 1e9};
  const double refactor = std::min(supernodal.factor, simplicial.factor), pair = supernodal.pair;
  std::printf("%d x %d posts, %d storeys, %zu members; seed of the breaks %u\n\n", nx, ny, storeys,
              frame.model.beams.size(), seed);
  std::printf("  CHOLMOD's numeric factorisation  %9.3f ms\n  CHOLMOD's pair                   %9.3f ms\n\n",
              1e3 * refactor, 1e3 * pair);

  // Members that never broke before: nothing is kept from an earlier break. Small frames are quick, and need more of
  // them before the program itself is warm.
  std::vector<int> once(frame.model.beams.size());
  std::iota(once.begin(), once.end(), 0);
  std::shuffle(once.begin(), once.end(), std::mt19937(seed));
  const std::ptrdiff_t joints = std::ssize(once) < 2000 ? std::ssize(once) / 3 : 9;
  const std::vector<int> some(once.begin(), once.begin() + joints),
      others(once.begin() + joints, once.begin() + 2 * joints);
  const double one = first_break(*structure, some, false), one_forces = first_break(*structure, others, true);
  std::printf("one joint: displacements           %9.3f ms = 1/%.1f factorisation = %.2f pairs\n", 1e3 * one,
              refactor / one, one / pair);
  std::printf("one joint: and all joints' forces  %9.3f ms\n", 1e3 * one_forces);

  structure = stand(frame);
  const Restricted part = first_break_in_part(*structure, some);
  std::printf(
      "one joint: selective answer        %9.3f ms = 1/%.1f factorisation = %.2f pairs, uses read (asked: 1/40, 0.6 "
      "at 24,000 freedoms, 0.35 at 190,000)\n",
      1e3 * part.time, refactor / part.time, part.time / pair);
  std::printf(
      "  %.0f of %zu restricted, the longest %.2f pairs; backward through %.0f %% of the factor, %.1f %% of the beams "
      "read, uses left out below %.2f\n",
      part.answers, some.size(), part.longest / pair, 100 * part.visited,
      100 * part.beams / static_cast<double>(frame.model.beams.size()), part.left);

  structure = stand(frame);
  solver::RefreshRules never;
  never.columns = std::numeric_limits<int>::max();
  structure->set_refresh(never);
  const Steps steps = break_one_by_one(*structure, members);
  const auto& c = structure->counters();
  const std::size_t window = std::min<std::size_t>(5, steps.time.size());
  const double early = median_of(steps.time, 0, window),
               late = median_of(steps.time, steps.time.size() - window, window);
  std::printf(
      "%zu joints one after the other: first %.3f ms, last %.3f ms (medians of %zu), ratio %.2f (asked: at most "
      "2); by correction %llu, by new factor %llu\n",
      steps.time.size(), 1e3 * early, 1e3 * late, window, late / early, static_cast<unsigned long long>(c.low_rank),
      static_cast<unsigned long long>(c.refactorisations));
  std::printf("  difference to a fresh analysis after all of them %.1e, backward error %.1e\n",
              error(frame, *structure), structure->solve().quality.backward_error);

  structure = stand(frame);
  const Together sixteen = break_together(*structure, frame, members);
  std::printf(
      "16 joints at once                  %9.3f ms = 1/%.1f factorisation (asked: 1/8; median of %zu, %.3f to %.3f), "
      "difference %.1e\n",
      1e3 * median(sixteen.time), refactor / median(sixteen.time), sixteen.time.size(), 1e3 * sixteen.time.front(),
      1e3 * sixteen.time.back(), sixteen.error);
  return 0;
}
