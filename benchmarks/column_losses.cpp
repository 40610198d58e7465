// Columns lost one at a time by corrections of one factor, every joint's use after each, against as many
// factorisations and solves by CHOLMOD on the same matrix in the same run. Errors beside times.
//   bench_column_losses [posts_x posts_y storeys lost_storeys]      (default 10 10 40 4)
#include <cstdlib>
#include <memory>

#include "assembly/frame_system.h"
#include "factor/factor.h"
#include "support/changed_frame.h"
#include "support/measure.h"
#include "support/provenance.h"
#include "support/steel_utilisations.h"

using namespace topple;
using namespace topple::bench;

namespace {

/// Largest difference of displacements to a fresh analysis without the member, relative.
double error(const RegularFrame& frame, const solver::Reanalysis& standing, int lost) {
  solver::FrameModel model = frame.model;
  solver::LoadSet loads = frame.loads;
  model.beams[static_cast<std::size_t>(lost)].end_stiffness.fill(solver::Vec6::Zero());
  std::erase_if(loads.beams, [&](const solver::BeamLoad& load) { return load.beam == lost; });
  return difference_to_fresh(model, loads, standing);
}

}  // namespace

int main(int argc, char** argv) {
  solver::prepare_blas(argv);
  if (argc != 1 && argc != 5) {
    std::fprintf(stderr, "usage: bench_column_losses [posts_x posts_y storeys lost_storeys]\n");
    return 2;
  }
  const int nx = argc > 1 ? std::atoi(argv[1]) : 10, ny = argc > 1 ? std::atoi(argv[2]) : 10;
  const int storeys = argc > 1 ? std::atoi(argv[3]) : 40, lost_storeys = argc > 1 ? std::atoi(argv[4]) : 4;
  if (nx < 2 || ny < 2 || storeys < lost_storeys || lost_storeys < 1) {
    std::fprintf(stderr, "bench_column_losses: at least 2 x 2 posts, 1 storey, 1 of them lost\n");
    return 2;
  }
  const RegularFrame frame = regular_frame(nx, ny, storeys);
  print_provenance("Columns lost one at a time in the regular steel frame", 1);
  const auto owned = stand(frame);
  solver::Reanalysis& standing = *owned;

  solver::FrameSystem system(frame.model);
  system.assemble();
  solver::Factor factor(system.matrix(), system.elimination_order(), solver::Factorisation::supernodal);
  Eigen::MatrixXd x;
  const auto anew = [&] {
    (void)factor.factorise(system.matrix());
    x.setOnes(system.matrix().size, 1);
    factor.solve(x);
  };
  const double fresh = interleaved_medians(5, {anew})[0];

  // Posts come first in each storey.
  const int in_a_storey = nx * ny + (nx - 1) * ny + nx * (ny - 1);
  std::vector<int> posts;
  for (int k = 0; k < lost_storeys; ++k)
    for (int p = 0; p < nx * ny; ++p) posts.push_back(k * in_a_storey + p);
  SteelUtilisations uses(standing);
  double worst = 0, largest_error = 0, largest_backward = 0, time = 0;
  int last = -1, refined = 0;
  constexpr std::size_t together = 16;
  for (std::size_t k = 0; k < posts.size(); ++k) {
    time += seconds([&] {
      if (k % together == 0) {
        if (last >= 0) standing.restore_beam(last);
        last = -1;
        standing.expect_losses(std::span(posts).subspan(k, std::min(together, posts.size() - k)));
      }
      if (last >= 0) standing.restore_beam(last);
      standing.remove_beam(posts[k]);
      if (!standing.solve().stable) std::exit(1);
      worst = std::max(worst, uses.largest());
    });
    last = posts[k];
    largest_backward = std::max(largest_backward, standing.solve().quality.backward_error);
    refined += standing.solve().quality.refinements > 0 ? 1 : 0;
    if (k == 0 || k == posts.size() / 2 || k + 1 == posts.size())
      largest_error = std::max(largest_error, error(frame, standing, last));
  }
  const double all = fresh * static_cast<double>(posts.size());
  std::printf("%d x %d posts, %d storeys; the %zu posts of the lowest %d lost one at a time\n\n", nx, ny, storeys,
              posts.size(), lost_storeys);
  std::printf("  CHOLMOD, factorisation and solve  %9.3f ms each, %.2f s for as many\n", 1e3 * fresh, all);
  std::printf("  corrections, every joint's use    %9.3f ms each, %.2f s: 1/%.1f (asked: 1/20)\n",
              1e3 * time / static_cast<double>(posts.size()), time, all / time);
  std::printf("  difference to a fresh analysis %.1e (first, middle and last), backward error at most %.1e\n",
              largest_error, largest_backward);
  const auto& c = standing.counters();
  std::printf("  by correction %llu, by new factor %llu; %d refined once more; worst use %.2f\n",
              static_cast<unsigned long long>(c.low_rank), static_cast<unsigned long long>(c.refactorisations), refined,
              worst);
  return 0;
}
