#include "dynamics/load_patterns.h"

#include <utility>

#include "assembly/frame_loads.h"
#include "assembly/mass_matrix.h"
#include "assembly/scaled_equations.h"
#include "dynamics/products.h"

namespace topple::solver {

int LoadPatterns::add(Pattern pattern) {
  patterns_.push_back(std::move(pattern));
  return static_cast<int>(patterns_.size()) - 1;
}

int LoadPatterns::add(const LoadSet& loads) {
  Pattern pattern;
  pattern.loads = loads;
  return add(std::move(pattern));
}

int LoadPatterns::add_ground(const Vec3& direction) {
  Pattern pattern;
  pattern.kind = Pattern::Kind::ground;
  pattern.direction = direction;
  return add(std::move(pattern));
}

int LoadPatterns::add_holding(const FrameSystem& system, Eigen::VectorXd force) {
  Pattern pattern;
  pattern.kind = Pattern::Kind::holding;
  pattern.loads.nodes = node_loads_of_scaled(system, force);
  pattern.force = std::move(force);
  return add(std::move(pattern));
}

void LoadPatterns::jump(int pattern, double value) {
  Pattern& one = patterns_.at(static_cast<std::size_t>(pattern));
  one.current = one.next = value;
}

void LoadPatterns::begin_substep() {
  for (Pattern& pattern : patterns_) {
    pattern.before = pattern.current;
    pattern.now = pattern.next;
  }
}

void LoadPatterns::accept() {
  for (Pattern& pattern : patterns_) pattern.current = pattern.now;
}

void LoadPatterns::find(const FrameSystem& system, Pattern& pattern) {
  if (pattern.kind != Pattern::Kind::ground) {
    LoadVector load = load_vector(system, pattern.loads);
    system.drop_idle_loads(load);
    pattern.force = scaled_force(system, load.force);
    pattern.fixed_end.clear();
    for (const BeamLoad& one : pattern.loads.beams)
      pattern.fixed_end.insert_or_assign(one.beam, load.beam_fixed_end[static_cast<std::size_t>(one.beam)]);
    return;
  }
  const MassMatrix directions(system, MassModel());
  SideBySide<1> along = SideBySide<1>::Zero(1, system.dofs().equations), product;
  for (int c = 0; c < 3; ++c)
    if (pattern.direction(c) != 0) along += pattern.direction(c) * directions.rigid_motion(c, Vec3::Zero()).transpose();
  multiply<1>(system.mass(), along, product);
  pattern.force = -product.row(0).transpose();
}

void LoadPatterns::find(const FrameSystem& system) {
  for (Pattern& pattern : patterns_)
    if (pattern.force.size() != system.dofs().equations) find(system, pattern);
}

void LoadPatterns::forget() {
  for (Pattern& pattern : patterns_)
    if (pattern.kind != Pattern::Kind::holding) pattern.force.resize(0);
}

void LoadPatterns::forget_equations() {
  for (Pattern& pattern : patterns_) pattern.force.resize(0);
}

void LoadPatterns::add_to(double start, Eigen::VectorXd& load) const {
  for (const Pattern& pattern : patterns_) {
    const double value = start * pattern.before + (1 - start) * pattern.now;
    if (value != 0) load += value * pattern.force;
  }
}

void LoadPatterns::add_fixed_end(int beam, bool at_end, Vec12& fixed_end) const {
  for (const Pattern& pattern : patterns_) {
    const auto own = pattern.fixed_end.find(beam);
    if (own != pattern.fixed_end.end()) fixed_end += (at_end ? pattern.now : pattern.before) * own->second;
  }
}

}  // namespace topple::solver
