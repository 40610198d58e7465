#include "dynamics/impulse_factor.h"

#include <stdexcept>

namespace topple::solver {

FrameDynamics::State::ImpulseFactor::ImpulseFactor(const State& of, double softened)
    : softened_(softened), inertia_(of.inertia), frame_(of.frame.model(), of.options.analysis) {
  inertia_.factor = 1 / softened;
  own().system->inertia = &inertia_;
}

/// As the frame's matrices have them, not as they are to be.
void FrameDynamics::State::ImpulseFactor::follow_beams(const FrameSystem& now) {
  for (std::size_t i = 0; i < own().targets.size(); ++i) {
    BeamTarget& target = own().targets[i];
    const Beam& beam = now.model.beams[i];
    const bool removed = now.beam_stands[i] == 0;
    if (target.removed == removed && target.end_stiffness == beam.end_stiffness && target.density == beam.density &&
        target.factor == now.beam_factor[i])
      continue;
    target.removed = removed;
    target.end_stiffness = beam.end_stiffness;
    target.density = beam.density;
    target.factor = now.beam_factor[i];
    own().mark(static_cast<int>(i));
  }
}

void FrameDynamics::State::ImpulseFactor::follow_plates(const FrameSystem& now) {
  const FrameModel& before = own().system->model;
  for (std::size_t i = 0; i < now.model.shells.size(); ++i)
    if (now.shell_stands[i] == 0) own().set_shell_removed(static_cast<int>(i), true);
  for (const auto& [shell, stiffness] : now.model.shell_stiffness)
    if (const auto had = before.shell_stiffness.find(shell);
        had == before.shell_stiffness.end() || had->second != stiffness)
      own().given_stiffness[shell] = stiffness;
  for (std::size_t i = 0; i < now.model.patches.size(); ++i) {
    const Patch &patch = now.model.patches[i], &had = before.patches[i];
    if (patch.stiffness != had.stiffness) own().given_to_patch[static_cast<int>(i)] = patch.stiffness;
    if (patch.mass.rows() != had.mass.rows() || patch.mass != had.mass)
      own().given_mass[static_cast<int>(i)] = patch.mass;
  }
}

void FrameDynamics::State::ImpulseFactor::follow_nodes(const FrameSystem& now) {
  for (std::size_t i = 0; i < now.node_stands.size(); ++i)
    if (now.node_stands[i] == 0 && own().system->node_stands[i] != 0)
      own().dropped_nodes.push_back(static_cast<int>(i));
  for (std::size_t i = 0; i < now.model.supports.size(); ++i)
    if (now.model.supports[i].stiffness != own().system->model.supports[i].stiffness)
      own().changed_supports.emplace_back(static_cast<int>(i), now.model.supports[i].stiffness);
}

void FrameDynamics::State::ImpulseFactor::follow(const State& of) {
  const FrameSystem& now = of.system();
  follow_beams(now);
  follow_plates(now);
  follow_nodes(now);
  if (own().pending()) {
    own().take_changes(nullptr);
    if (own().mechanism) throw Instability(own().mechanism->message, own().mechanism->motion);
  }
  if (const auto defect = own().renew_factor()) throw Instability(defect->message, defect->motion);
  const auto n = static_cast<Eigen::Index>(of.equations());
  if (own().system->dofs().equations != n)
    throw std::logic_error("the factor for impulses has other equations than the frame");
  const Eigen::Map<const Eigen::VectorXd> scale(own().system->scale().data(), n), of_frame(now.scale().data(), n);
  ratio_ = scale.cwiseQuotient(of_frame);
}

void FrameDynamics::State::ImpulseFactor::solve(Eigen::VectorXd& x) {
  x = x.cwiseProduct(ratio_);
  own().solve_as_it_stands(x);
  x = x.cwiseProduct(ratio_) / softened_;
}

Eigen::MatrixXd FrameDynamics::State::ImpulseFactor::between(const Eigen::MatrixXd& F, const Eigen::MatrixXd& G) {
  const Eigen::MatrixXd forces = ratio_.asDiagonal() * F;
  Eigen::MatrixXd X = ratio_.asDiagonal() * G;
  if (!own().standing || own().is_soft()) {
    for (Eigen::Index j = 0; j < X.cols(); ++j) {
      Eigen::VectorXd x = X.col(j);
      own().solve_as_it_stands(x);
      X.col(j) = x;
    }
    return forces.transpose() * X / softened_;
  }
  std::vector<int> loaded;
  for (Eigen::Index row = 0; row < F.rows(); ++row)
    if ((F.row(row).array() != 0).any()) loaded.push_back(static_cast<int>(row));
  std::vector<char> known;
  own().standing->solve_on_paths(X, loaded, known);
  own().count_answer(1);
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(F.cols(), G.cols());
  for (const int row : loaded) result += forces.row(row).transpose() * X.row(row);
  return result / softened_;
}

FrameDynamics::State::ImpulseFactor& FrameDynamics::State::impulse_factor() {
  const double softened = method.h * options.damping.stiffness;
  if (!impulses_by) impulses_by = std::make_unique<ImpulseFactor>(*this, softened);
  impulses_by->follow(*this);
  return *impulses_by;
}

}  // namespace topple::solver
