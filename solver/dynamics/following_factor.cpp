#include "dynamics/following_factor.h"

#include <stdexcept>

#include "assembly/scaled_equations.h"

namespace topple::solver {

FrameDynamics::State::FollowingFactor::FollowingFactor(const FrameSystem& frame, const AnalysisOptions& options,
                                                       double softened)
    : softened_(softened), inertia_(*frame.inertia), frame_(frame.model, options) {
  inertia_.factor = 1 / softened;
  own().system->inertia = &inertia_;
}

/// As the frame's matrices have them, not as they are to be.
void FrameDynamics::State::FollowingFactor::follow_beams(const FrameSystem& now) {
  for (std::size_t i = 0; i < now.model.beams.size(); ++i) {
    const Beam& beam = now.model.beams[i];
    own().changes.set_beam_removed(i, now.beam_stands[i] == 0);
    for (std::size_t end = 0; end < 2; ++end) own().changes.set_end_stiffness(i, end, beam.end_stiffness[end]);
    own().changes.set_beam_density(i, beam.density);
    own().changes.set_beam_factor(i, now.beam_factor[i]);
  }
}

void FrameDynamics::State::FollowingFactor::follow_plates(const FrameSystem& now) {
  const FrameModel& before = own().system->model;
  for (std::size_t i = 0; i < now.model.shells.size(); ++i)
    if (now.shell_stands[i] == 0) own().changes.set_shell_removed(i, true);
  for (const auto& [shell, stiffness] : now.model.shell_stiffness)
    if (const auto had = before.shell_stiffness.find(shell);
        had == before.shell_stiffness.end() || had->second != stiffness)
      own().changes.set_shell_stiffness(shell, stiffness);
  for (std::size_t i = 0; i < now.model.patches.size(); ++i) {
    const Patch &patch = now.model.patches[i], &had = before.patches[i];
    if (patch.stiffness != had.stiffness) own().changes.set_patch_stiffness(static_cast<int>(i), patch.stiffness);
    if (patch.mass.rows() != had.mass.rows() || patch.mass != had.mass)
      own().changes.set_patch_mass(static_cast<int>(i), patch.mass);
  }
}

void FrameDynamics::State::FollowingFactor::follow_nodes(const FrameSystem& now) {
  for (std::size_t i = 0; i < now.node_stands.size(); ++i)
    if (now.node_stands[i] == 0 && own().system->node_stands[i] != 0) own().changes.drop_node(static_cast<int>(i));
  for (std::size_t i = 0; i < now.model.supports.size(); ++i)
    if (now.model.supports[i].stiffness != own().system->model.supports[i].stiffness)
      own().changes.set_support(static_cast<int>(i), now.model.supports[i].stiffness);
}

bool FrameDynamics::State::FollowingFactor::follow(const FrameSystem& now) {
  if (followed_) return false;
  follow_beams(now);
  follow_plates(now);
  follow_nodes(now);
  if (own().pending()) {
    own().apply_changes(nullptr);
    require_none(own().mechanism);
  }
  if (own().system->dofs().equations != now.dofs().equations)
    throw std::logic_error("a factor that follows the frame has other equations than it");
  ratio_ = scale_of(*own().system).cwiseQuotient(scale_of(now));
  followed_ = true;
  return true;
}

void FrameDynamics::State::FollowingFactor::renew() { require_none(own().renew_factor()); }

void FrameDynamics::State::FollowingFactor::solve(Eigen::VectorXd& x) {
  x = x.cwiseProduct(ratio_);
  own().solve_as_it_stands(x);
  x = x.cwiseProduct(ratio_) / softened_;
}

Eigen::MatrixXd FrameDynamics::State::FollowingFactor::between(const Eigen::MatrixXd& F, const Eigen::MatrixXd& G) {
  const Eigen::MatrixXd forces = ratio_.asDiagonal() * F;
  const Eigen::MatrixXd X = ratio_.asDiagonal() * G;
  return own().answers_between(forces, X) / softened_;
}

}  // namespace topple::solver
