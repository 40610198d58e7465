#include "dynamics/plastic_kinks.h"

#include <algorithm>
#include <cmath>

#include "assembly/frame_loads.h"
#include "assembly/scaled_equations.h"

namespace topple::solver {

std::size_t PlasticKinks::number(const FrameModel& model, int beam, std::size_t end, int component) {
  if (of_beam_.empty()) of_beam_.resize(model.beams.size());
  std::vector<std::size_t>& own = of_beam_[static_cast<std::size_t>(beam)];
  for (const std::size_t k : own)
    if (kinks_[k].end == end && kinks_[k].component == component) return k;
  Kink kink;
  kink.beam = beam;
  kink.end = end;
  kink.component = component;
  kinks_.push_back(std::move(kink));
  own.push_back(kinks_.size() - 1);
  return own.back();
}

Vec12 PlasticKinks::rotations(std::size_t beam) const {
  Vec12 rotations = Vec12::Zero();
  if (of_beam_.empty()) return rotations;
  for (const std::size_t k : of_beam_[beam]) rotations(kinks_[k].component_index()) = kinks_[k].current;
  return rotations;
}

void PlasticKinks::set(const FrameSystem& system, std::size_t k, double rotation) {
  find(system, k);
  kinks_[k].before = kinks_[k].now = kinks_[k].current = rotation;
}

void PlasticKinks::start_here() {
  for (Kink& kink : kinks_) kink.started_at = kink.current;
}

/// Loads of 1 rad.
void PlasticKinks::find(const FrameSystem& system, std::size_t k) {
  Kink& kink = kinks_[k];
  if (kink.known) return;
  BeamLoad angle;
  angle.beam = kink.beam;
  angle.kind = BeamLoad::Kind::temperature;
  (kink.end == 0 ? angle.first : angle.last)(kink.component) = 1;
  LoadSet loads;
  loads.beams = {angle};
  LoadVector load = load_vector(system, loads);
  system.drop_idle_loads(load);
  kink.force = scaled_force(system, load.force).sparseView();
  kink.fixed_end = load.beam_fixed_end[static_cast<std::size_t>(kink.beam)];
  kink.response.resize(0);
  kink.known = true;
}

void PlasticKinks::find_anew(const FrameSystem& system) {
  for (Kink& kink : kinks_) kink.known = false;
  for (std::size_t k = 0; k < kinks_.size(); ++k)
    if (kinks_[k].current != 0) find(system, k);
}

/// What turned before is likely to turn again; of the others the responses, as long as the frame, are let go.
void PlasticKinks::begin_substep() {
  for (Kink& kink : kinks_) {
    if (kink.held == 0) kink.response.resize(0);
    kink.before = kink.now = kink.current;
    kink.held = 0;
  }
}

void PlasticKinks::restore() {
  for (Kink& kink : kinks_) kink.now = kink.before;
}

void PlasticKinks::hold_nothing() {
  for (Kink& kink : kinks_) kink.held = 0;
}

void PlasticKinks::turn(std::size_t k, double turn, double capacity) {
  kinks_[k].now = kinks_[k].before + turn;
  kinks_[k].held = turn == 0 ? 0 : std::copysign(capacity, turn);
}

bool PlasticKinks::accept() {
  for (Kink& kink : kinks_) kink.current = kink.now;
  return std::any_of(kinks_.begin(), kinks_.end(), [](const Kink& kink) { return kink.held != 0; });
}

double PlasticKinks::resistance(std::size_t of, std::size_t by, const GeneralizedAlpha& method) const {
  const Kink &falls = kinks_[of], &turns = kinks_[by];
  double value = -method.h * method.h * method.beta / method.c * falls.force.dot(turns.response);
  if (falls.beam == turns.beam) value -= turns.fixed_end(falls.component_index());
  return value;
}

void PlasticKinks::add_fixed_end(std::size_t beam, bool at_end, Vec12& fixed_end) const {
  if (of_beam_.empty()) return;
  for (const std::size_t k : of_beam_[beam])
    fixed_end += (at_end ? kinks_[k].now : kinks_[k].before) * kinks_[k].fixed_end;
}

void PlasticKinks::add_start(const FrameSystem& system, Eigen::VectorXd& load) {
  for (std::size_t k = 0; k < kinks_.size(); ++k) {
    if (kinks_[k].before == 0) continue;
    find(system, k);
    load += kinks_[k].before * kinks_[k].force;
  }
}

void PlasticKinks::add_turned(double share, Eigen::VectorXd& load) const {
  for (const Kink& kink : kinks_)
    if (kink.now != kink.before) load += (kink.now - kink.before) * share * kink.force;
}

void PlasticKinks::subtract(Eigen::VectorXd& load) const {
  for (const Kink& kink : kinks_)
    if (kink.current != 0) load -= kink.current * kink.force;
}

/// E = 1/2 u'Ku - theta'G'u + 1/2 theta'D theta, G the kinks' forces, D what they hold against themselves: the last
/// two.
double PlasticKinks::elastic(const Eigen::VectorXd& u) const {
  double sum = 0;
  for (const Kink& kink : kinks_) {
    if (kink.current == 0) continue;
    sum -= kink.current * kink.force.dot(u);
    for (const std::size_t other : of_beam_[static_cast<std::size_t>(kink.beam)])
      sum -= 0.5 * kink.current * kinks_[other].current * kinks_[other].fixed_end(kink.component_index());
  }
  return sum;
}

void PlasticKinks::add_work(const LoadsOfBeam& loads, double& work) const {
  for (const Kink& kink : kinks_)
    work += loads(static_cast<std::size_t>(kink.beam))(kink.component_index()) * (kink.current - kink.started_at);
}

/// With g = G'u the equation's kinks do theta_c'dg along it, theta_c = af theta0 + (1 - af) theta1, and d(theta'g) =
/// theta_c'dg + dtheta'((1 - af) g0 + af g1): what is left beside the change of elastic energy is what the hinges took,
/// but for the error of the method. Of the work of loads on a beam its kinks have a part.
void PlasticKinks::account(const Eigen::VectorXd& u_start, const Eigen::VectorXd& u_end, const GeneralizedAlpha& method,
                           double stiffness_damping, const LoadsOfBeam& loads, DynamicEnergy& energy) const {
  double discrete = 0, damped = 0;
  for (const Kink& kink : kinks_) {
    const double turn = kink.now - kink.before;
    if (kink.now == 0 && kink.before == 0) continue;
    const double at_start = kink.force.dot(u_start), at_end = kink.force.dot(u_end);
    const double in_equation = method.af * kink.before + (1 - method.af) * kink.now;
    energy.external_work -= in_equation * (at_end - at_start);  // has it among the loads
    for (const std::size_t other : of_beam_[static_cast<std::size_t>(kink.beam)]) {
      const double against = -kinks_[other].fixed_end(kink.component_index());
      discrete -= 0.5 * against * (kink.now * kinks_[other].now - kink.before * kinks_[other].before);
    }
    if (turn == 0) continue;
    discrete += turn * ((1 - method.af) * at_start + method.af * at_end);
    damped += stiffness_damping / method.h * turn * (at_end - at_start);
    const double of_loads = loads(static_cast<std::size_t>(kink.beam))(kink.component_index()) * turn;
    energy.dissipated += kink.held * turn;
    energy.external_work += of_loads;
    energy.numerical -= kink.held * turn - of_loads;
  }
  energy.numerical += discrete;
  energy.external_work -= damped;  // has it among the loads
  energy.damped -= damped;
}

}  // namespace topple::solver
