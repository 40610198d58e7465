// Loads that go with time.
#include <stdexcept>

#include "assembly/mass_matrix.h"
#include "assembly/scaled_equations.h"
#include "dynamics/dynamic_state.h"

namespace topple::solver {

Eigen::VectorXd FrameDynamics::State::scaled(const Eigen::VectorXd& force) const {
  return scaled_force(system(), force);
}

/// The equations' displacements (not forces) from those of nodes; of a diaphragm from its first node that stands.
Eigen::VectorXd FrameDynamics::State::scaled_equations(const std::vector<Vec6>& per_node) const {
  const DofMap& dofs = system().dofs();
  if (per_node.size() != system().model.nodes.size())
    throw std::invalid_argument("displacements: six for each node of the frame");
  Eigen::VectorXd x = Eigen::VectorXd::Zero(dofs.equations);
  for (std::size_t k = per_node.size(); k-- > 0;) {
    if (system().node_stands[k] == 0) continue;
    Vec6 own = per_node[k];
    own.head<3>() -= dofs.diaphragm_arm(static_cast<int>(k)) * own.tail<3>();
    for (std::size_t c = 0; c < 6; ++c) {
      const int e = dofs.number[k][c];
      if (e < dofs.equations) x(e) = own(static_cast<Eigen::Index>(c)) / system().scale()[static_cast<std::size_t>(e)];
    }
  }
  return x;
}

void FrameDynamics::State::find_pattern(LoadPattern& pattern) {
  if (pattern.kind == LoadPattern::Kind::loads) {
    LoadVector load = system().load_vector(pattern.loads);
    system().drop_idle_loads(load);
    pattern.force = scaled(load.force);
    pattern.fixed_end.clear();
    for (const BeamLoad& one : pattern.loads.beams)
      pattern.fixed_end.insert_or_assign(one.beam, load.beam_fixed_end[static_cast<std::size_t>(one.beam)]);
    return;
  }
  if (pattern.kind == LoadPattern::Kind::holding) return;
  const MassMatrix directions(system(), MassModel());
  SideBySide<1> along = SideBySide<1>::Zero(1, equations()), product;
  for (int c = 0; c < 3; ++c)
    if (pattern.direction(c) != 0) along += pattern.direction(c) * directions.rigid_motion(c, Vec3::Zero()).transpose();
  multiply<1>(system().mass(), along, product);
  pattern.force = -product.row(0).transpose();
}

void FrameDynamics::State::find_patterns() {
  for (LoadPattern& pattern : patterns)
    if (pattern.force.size() != equations()) find_pattern(pattern);
}

int FrameDynamics::add_pattern(const LoadSet& loads) {
  if (!loads.shells.empty() || !loads.settlements.empty())
    throw std::invalid_argument("loads that go with time act on nodes and beams");
  LoadPattern pattern;
  pattern.loads = loads;
  state_->patterns.push_back(std::move(pattern));
  return static_cast<int>(state_->patterns.size()) - 1;
}

int FrameDynamics::add_ground_acceleration(const Vec3& direction) {
  LoadPattern pattern;
  pattern.kind = LoadPattern::Kind::ground;
  pattern.direction = direction;
  state_->patterns.push_back(std::move(pattern));
  return static_cast<int>(state_->patterns.size()) - 1;
}

int FrameDynamics::add_holding_force() {
  State& state = *state_;
  state.begin_substep();
  state.apply_changes();
  SideBySide<1> u = state.current().u.transpose(), Au, Mu;
  multiply<1>(state.system().matrix(), u, Au);
  multiply<1>(state.system().mass(), u, Mu);
  LoadPattern pattern;
  pattern.kind = LoadPattern::Kind::holding;
  pattern.force = (Au.row(0) - state.method.s * Mu.row(0)).transpose() - state.constant_load;
  for (const Kink& kink : state.kinks)
    if (kink.current != 0) pattern.force -= kink.current * kink.force;
  state.patterns.push_back(std::move(pattern));
  return static_cast<int>(state.patterns.size()) - 1;
}

void FrameDynamics::set_pattern(int pattern, double value_at_end) {
  state_->patterns.at(static_cast<std::size_t>(pattern)).next = value_at_end;
}

void FrameDynamics::jump_pattern(int pattern, double value) {
  LoadPattern& one = state_->patterns.at(static_cast<std::size_t>(pattern));
  one.current = one.next = value;
}

}  // namespace topple::solver
