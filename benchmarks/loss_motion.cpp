// The error of joints' peak uses after the loss of a post, over the substep: against the superposition of all modes
// (Eigen's dense eigenvectors, exact in time) for a building's posts one by one. Without damping, the hardest case.
//   bench_loss_motion [MODEL COMBINATION PATTERN SECONDS]      (default: seed_building collapse P-*-*-1 1.5)
// Asked: within 0.01 max(1, peak) at 8 substeps of 1/60 s, 99.9 % of joints within 1 % of their peak at 16.
#include <Eigen/Eigenvalues>
#include <cstdlib>
#include <map>

#include "analysis/motion/frame_motion.h"
#include "assembly/frame_recovery.h"
#include "assembly/frame_system.h"
#include "model/index_of.h"
#include "support/provenance.h"
#include "topple/structure/formats/files.h"

using namespace topple;
using namespace topple::structure;

namespace {

Eigen::MatrixXd dense(const solver::SparseSymmetric& A, std::span<const double> scale) {
  Eigen::MatrixXd full = Eigen::MatrixXd::Zero(A.size, A.size);
  for (int c = 0; c < A.size; ++c)
    for (auto k = A.start[static_cast<std::size_t>(c)]; k < A.start[static_cast<std::size_t>(c) + 1]; ++k) {
      const int r = A.row[static_cast<std::size_t>(k)];
      full(r, c) = full(c, r) = A.value[static_cast<std::size_t>(k)] / scale[static_cast<std::size_t>(r)] /
                                scale[static_cast<std::size_t>(c)];
    }
  return full;
}

/// A state of the frame that the modes have made.
class ByModes : public DamagedFrame::Motion {
 public:
  ByModes(const solver::FrameSystem& system, const MovingFrame& moving) : system_(system) {
    for (std::size_t b = 0; b < moving.beam_loads.size(); ++b)
      fixed_.push_back(system.fixed_end_forces(static_cast<int>(b), moving.beam_loads[b]).force);
  }
  void take(const Eigen::VectorXd& u) {
    nodes_ = node_displacements(system_, u, Eigen::VectorXd::Zero(system_.dofs().held));
  }
  [[nodiscard]] solver::Vec12 beam_end_forces(int beam) const override {
    return system_.end_forces(beam, nodes_, fixed_[static_cast<std::size_t>(beam)]);
  }
  [[nodiscard]] std::array<Vec6, 4> shell_corner_forces(int shell) const override {
    return system_.corner_forces(shell, nodes_, solver::Vec24::Zero());
  }
  [[nodiscard]] const std::vector<Vec6>& displacements() const override { return nodes_; }

 private:
  const solver::FrameSystem& system_;
  std::vector<solver::Vec12> fixed_;
  std::vector<Vec6> nodes_;
};

struct LostPost {
  MovingFrame moving;
  std::vector<Vec6> before, rest;
};

std::vector<double> exact_peaks(const DividedBuilding& divided, const DamagedFrame& frame, const LostPost& lost,
                                double duration) {
  const solver::SystemInertia inertia{lost.moving.masses,
                                      solver::masses_at_nodes(lost.moving.model, lost.moving.masses), 1};
  solver::FrameSystem system(lost.moving.model);
  system.inertia = &inertia;
  system.assemble();
  const Eigen::MatrixXd M = dense(system.mass(), system.scale()), K = dense(system.matrix(), system.scale()) - M;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> modes(K, M);
  const Eigen::VectorXd w = modes.eigenvalues().cwiseMax(0).cwiseSqrt();
  const auto equations = [&](const std::vector<Vec6>& nodes) {
    Eigen::VectorXd x = Eigen::VectorXd::Zero(M.rows());
    for (std::size_t n = 0; n < nodes.size(); ++n)
      for (std::size_t c = 0; c < 6; ++c)
        if (const int e = system.dofs().number[n][c]; e < M.rows()) x(e) = nodes[n](static_cast<Eigen::Index>(c));
    return x;
  };
  const Eigen::VectorXd still = equations(lost.rest);
  const Eigen::VectorXd start = modes.eigenvectors().transpose() * (M * (equations(lost.before) - still));
  ByModes state(system, lost.moving);
  std::vector<Vec6> demand;
  std::vector<JointId> holding;
  std::vector<double> peaks;
  constexpr double dt = 1.0 / 3840;
  constexpr int together = 128;
  for (double t = 0; t <= duration; t += together * dt) {
    Eigen::MatrixXd q(M.rows(), together);
    for (int k = 0; k < together; ++k) q.col(k) = start.array() * (w.array() * (t + k * dt)).cos();
    const Eigen::MatrixXd u = (modes.eigenvectors() * q).colwise() + still;
    for (int k = 0; k < together && t + k * dt <= duration; ++k) {
      state.take(u.col(k));
      frame.read_demands(state, demand, holding);
      peaks.resize(holding.size(), 0.0);
      for (std::size_t j = 0; j < holding.size(); ++j) {
        const JointCapacity& capacity = divided.building()[holding[j]].capacity;
        peaks[j] = std::max(peaks[j], utilisation(capacity, demand[index_of(holding[j])]).value);
      }
    }
  }
  return peaks;
}

std::vector<double> computed_peaks(const DividedBuilding& divided, const DamagedFrame& frame, const LostPost& lost,
                                   double duration, double h) {
  solver::DynamicOptions options;
  options.substep = h;
  options.spectral_radius = 1;
  options.keep_energy = false;
  solver::FrameDynamics motion(lost.moving.model, lost.moving.masses, options);
  for (std::size_t b = 0; b < lost.moving.beam_loads.size(); ++b)
    if (frame.stands(MemberId(b))) motion.set_beam_loads(static_cast<int>(b), lost.moving.beam_loads[b]);
  for (std::size_t n = 0; n < lost.moving.node_loads.size(); ++n)
    motion.set_node_load(static_cast<int>(n), lost.moving.node_loads[n]);
  motion.set_state(lost.before, std::vector<Vec6>(lost.before.size(), Vec6::Zero()));
  const MotionRequest nothing_named;
  MotionPeaks peaks(divided, frame, nothing_named, {}, motion);
  while (motion.time() < duration - h / 2) {
    (void)motion.advance();
    peaks.sample(motion);
  }
  return peaks.uses();
}

/// Over all losses so far.
struct Errors {
  double worst = 0;          ///< of |difference| / max(1, peak)
  long joints = 0, off = 0;  ///< those farther off than 1 % of their peak
};

int run(const std::string& model, const std::string& combination, const std::string& pattern, double duration) {
  const Building building = read_model(find_model(model));
  const std::vector<MemberId> posts = NameIndex(building).members_matching(pattern);
  const DividedBuilding divided(building);
  DamagedFrame frame(divided, posts, {});
  CombinationId id;
  for (std::size_t c = 0; c < building.combinations.size(); ++c)
    if (building.combinations[c].name == combination) id = CombinationId(c);
  if (!id.valid() || posts.empty()) return 2;
  frame.load(part_loads(divided.building(), id));
  std::map<int, Errors> errors;
  for (const MemberId post : posts) {
    LostPost lost;
    if (!frame.solve().stable) return 1;
    lost.before = frame.analysis().displacements();
    frame.lose(post);
    if (frame.solve().stable) {
      lost.rest = frame.analysis().displacements();
      lost.moving = frame.moving_frame(given_masses(building, id));
      const std::vector<double> exact = exact_peaks(divided, frame, lost, duration);
      for (const int substeps : {2, 4, 8, 16, 32}) {
        const std::vector<double> found = computed_peaks(divided, frame, lost, duration, 1.0 / (60 * substeps));
        Errors& sum = errors[substeps];
        double worst = 0;
        for (std::size_t j = 0; j < exact.size(); ++j) {
          const double off = std::abs(found[j] - exact[j]);
          worst = std::max(worst, off / std::max(1.0, exact[j]));
          ++sum.joints;
          sum.off += off > 0.01 * exact[j] ? 1 : 0;
        }
        sum.worst = std::max(sum.worst, worst);
        std::printf("%s%s %.4f", substeps == 2 ? building[post].name.c_str() : "", ":", worst);
      }
      std::printf("\n");
      std::fflush(stdout);
    }
    frame.restore();
  }
  std::printf("\nsubsteps of 1/60 s   worst error / max(1, peak)   joints within 1 %% of their peak\n");
  for (const auto& [substeps, sum] : errors)
    std::printf("%8d %24.4f %28.3f %%\n", substeps, sum.worst,
                100.0 * static_cast<double>(sum.joints - sum.off) / static_cast<double>(sum.joints));
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  bench::print_provenance("Peaks after the loss of a post, over the substep", 1);
  if (argc > 4) return run(argv[1], argv[2], argv[3], std::atof(argv[4]));
  return run("seed_building", "collapse", "P-*-*-1", 1.5);
}
