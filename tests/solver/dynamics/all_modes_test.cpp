// A frame of several storeys that loses a ground post, against the superposition of all its modes, which is exact in
// time: eigenvectors of the dense matrices by Eigen; what is in common is the assembly of K and M alone.
#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>

#include "assembly/frame_recovery.h"
#include "assembly/frame_system.h"
#include "frames.h"
#include "topple/solver/frame_dynamics.h"

using namespace topple::test;

namespace {

constexpr int posts = 3, storeys = 3;
constexpr double duration = 1.5;
/// rad/s, where the damping holds: about the lowest frequency of the frame, and that of its floors.
constexpr double lowest = 6, shape = 25;

/// With floors hung on the beams as mass and load, whichever way they go.
FrameModel frame_with_floors() {
  FrameModel model = tower(posts, storeys);
  for (Beam& beam : model.beams) {
    const bool post = std::abs(beam.axes(0, 2)) > 0.5;
    beam.density = post ? 7850 : 7850 + 1500 / beam.area;
  }
  return model;
}

std::vector<BeamLoad> weight_of(const FrameModel& model, int index) {
  const Beam& beam = model.beams[static_cast<std::size_t>(index)];
  const Vec3 down = beam.axes * Vec3(0, 0, -9.81 * beam.density * beam.area);
  return {uniform_load(index, beam.length, components(down.x(), down.y(), down.z(), 0, 0, 0))};
}

Eigen::MatrixXd dense(const SparseSymmetric& A, std::span<const double> scale) {
  Eigen::MatrixXd full(A.size, A.size);
  full.setZero();
  for (int c = 0; c < A.size; ++c)
    for (auto k = A.start[static_cast<std::size_t>(c)]; k < A.start[static_cast<std::size_t>(c) + 1]; ++k) {
      const int r = A.row[static_cast<std::size_t>(k)];
      full(r, c) = full(c, r) = A.value[static_cast<std::size_t>(k)] / scale[static_cast<std::size_t>(r)] /
                                scale[static_cast<std::size_t>(c)];
    }
  return full;
}

/// Uses of both ends of every beam: the largest component over capacities like those of a moment frame's joints.
Eigen::VectorXd uses(const Vec12& forces) {
  const Vec6 capacity = components(3e6, 6e5, 6e5, 5e4, 4e5, 1e5);
  Eigen::VectorXd both(2);
  both << (forces.head<6>().array() / capacity.array()).abs().maxCoeff(),
      (forces.tail<6>().array() / capacity.array()).abs().maxCoeff();
  return both;
}

/// The frame without the post, and where it stood with it.
struct Loss {
  FrameModel model;
  int post = 0;
  std::vector<Vec6> before;
  LoadSet loads;
  RayleighDamping damping;
};

Loss lose(int post) {
  Loss loss{frame_with_floors(), post, {}, {}, {}};
  for (int b = 0; b < static_cast<int>(loss.model.beams.size()); ++b)
    for (const BeamLoad& load : weight_of(loss.model, b)) loss.loads.beams.push_back(load);
  loss.before = solve_one(loss.model, loss.loads).displacements;
  loss.model.beams[static_cast<std::size_t>(post)].end_stiffness = {Vec6::Zero(), Vec6::Zero()};
  std::erase_if(loss.loads.beams, [&](const BeamLoad& load) { return load.beam == post; });
  return loss;
}

/// Peaks of the uses by all modes.
Eigen::VectorXd exact_peaks(const Loss& loss) {
  const StaticSolution rest = solve_one(loss.model, loss.loads);
  SystemInertia inertia{{}, masses_at_nodes(loss.model, {}), 1};
  FrameSystem system(loss.model);
  system.inertia = &inertia;
  system.assemble();
  const Eigen::MatrixXd M = dense(system.mass(), system.scale()), K = dense(system.matrix(), system.scale()) - M;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> modes(K, M);
  const Eigen::VectorXd w = modes.eigenvalues().cwiseMax(0).cwiseSqrt();
  const auto equations = [&](const std::vector<Vec6>& nodes) {
    Eigen::VectorXd x(M.rows());
    for (std::size_t n = 0; n < nodes.size(); ++n)
      for (std::size_t c = 0; c < 6; ++c)
        if (system.dofs().number[n][c] < M.rows())
          x(system.dofs().number[n][c]) = nodes[n](static_cast<Eigen::Index>(c));
    return x;
  };
  const Eigen::VectorXd still = equations(rest.displacements);
  const Eigen::VectorXd start = modes.eigenvectors().transpose() * (M * (equations(loss.before) - still));
  // Each mode by itself: q'' + 2 decay q' + w2 q = 0. Those beyond their critical damping (250 Hz and more) are gone
  // within milliseconds, whatever their formula.
  const Eigen::ArrayXd decay = (loss.damping.mass + loss.damping.stiffness * w.array().square()) / 2;
  const Eigen::ArrayXd damped = (w.array().square() - decay.square()).max(1e-12).sqrt();
  const int beams = static_cast<int>(loss.model.beams.size());
  std::vector<Vec12> fixed;
  for (int b = 0; b < beams; ++b)
    fixed.push_back(b == loss.post ? Vec12(Vec12::Zero()) : system.fixed_end_forces(b, weight_of(loss.model, b)).force);
  Eigen::VectorXd peaks = Eigen::VectorXd::Zero(2 * beams);
  constexpr double dt = 2.5e-4;
  constexpr int together = 200;
  for (double t = 0; t <= duration; t += together * dt) {
    Eigen::MatrixXd q(M.rows(), together);
    for (int k = 0; k < together; ++k) {
      const Eigen::ArrayXd at = damped * (t + k * dt);
      q.col(k) = start.array() * (-decay * (t + k * dt)).exp() * (at.cos() + decay / damped * at.sin());
    }
    const Eigen::MatrixXd u = (modes.eigenvectors() * q).colwise() + still;
    for (int k = 0; k < together; ++k) {
      const std::vector<Vec6> nodes = node_displacements(system, u.col(k), Eigen::VectorXd::Zero(system.dofs().held));
      for (int b = 0; b < beams; ++b)
        if (b != loss.post)
          peaks.segment<2>(2 * b) =
              peaks.segment<2>(2 * b).cwiseMax(uses(system.end_forces(b, nodes, fixed[static_cast<std::size_t>(b)])));
    }
  }
  return peaks;
}

Eigen::VectorXd computed_peaks(const Loss& loss, double h) {
  DynamicOptions options;
  options.substep = h;
  options.spectral_radius = 1;
  options.keep_energy = false;
  options.damping = loss.damping;
  FrameDynamics frame(loss.model, {}, options);
  for (const BeamLoad& load : loss.loads.beams) frame.set_beam_loads(load.beam, {load});
  frame.set_state(loss.before, std::vector<Vec6>(loss.before.size(), Vec6::Zero()));
  const int beams = static_cast<int>(loss.model.beams.size());
  Eigen::VectorXd peaks = Eigen::VectorXd::Zero(2 * beams);
  while (frame.time() < duration - h / 2) {
    frame.advance();
    for (int b = 0; b < beams; ++b) {
      const SubstepCourse<Vec12> course = frame.beam_course(b);
      for (int part = 0; part <= 8; ++part)
        peaks.segment<2>(2 * b) = peaks.segment<2>(2 * b).cwiseMax(uses(course.at(part / 8.0)));
    }
  }
  return peaks;
}

}  // namespace

TEST_CASE("After the loss of a ground post the joints' uses peak as the superposition of all modes has it") {
  // Corner, edge and inner post.
  const int in_storey = posts * posts + 2 * posts * (posts - 1);
  REQUIRE(frame_with_floors().beams.size() == static_cast<std::size_t>(storeys * in_storey));
  for (const auto& [i, j] : {std::pair{0, 0}, {1, 0}, {1, 1}}) {
    // tower() adds to each line of posts its beams; the post of line (i, j) is the one between these nodes.
    int post = -1;
    const FrameModel model = frame_with_floors();
    for (int b = 0; b < static_cast<int>(model.beams.size()); ++b)
      if (model.beams[static_cast<std::size_t>(b)].node == std::array{j * posts + i, (posts + j) * posts + i}) post = b;
    REQUIRE(post >= 0);
    Loss loss = lose(post);
    loss.damping = rayleigh_damping(0.02, lowest, shape);
    const Eigen::VectorXd exact = exact_peaks(loss);
    const auto errors = [&](double h) {
      return ((computed_peaks(loss, h) - exact).array().abs() / exact.array().max(1)).eval();
    };
    const Eigen::ArrayXd at_8 = errors(1.0 / 480), at_16 = errors(1.0 / 960);
    INFO("post " << i << ", " << j << ": largest use " << exact.maxCoeff() << ", errors at 8 substeps of 1/60 s "
                 << at_8.maxCoeff() << ", at 16 " << at_16.maxCoeff());
    CHECK(at_8.maxCoeff() < 0.01);
    CHECK(((computed_peaks(loss, 1.0 / 960) - exact).array().abs() <= 0.01 * exact.array()).all());
    // Second order would leave a quarter; the samples of both sides tell to some 3e-4.
    CHECK(at_16.maxCoeff() < 0.4 * at_8.maxCoeff() + 3e-4);
  }
}
