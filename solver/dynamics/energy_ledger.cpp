#include "dynamics/energy_ledger.h"

namespace topple::solver {

void EnergyLedger::find_products(const FrameSystem& system, const MotionState& motion) {
  if (known_) return;
  known_ = true;
  s_ = system.inertia->factor;
  const Eigen::Index n = system.dofs().equations;
  motion_.setZero(8, n);
  motion_.row(0) = motion_.row(4) = motion.u;
  motion_.row(1) = motion_.row(5) = motion.v;
  motion_.row(2) = motion.a;
  multiply_by_two(system.mass(), system.matrix(), motion_, products_);
}

const SideBySide<8>& EnergyLedger::products(const FrameSystem& system, const MotionState& motion) {
  find_products(system, motion);
  return products_;
}

double EnergyLedger::store(const FrameSystem& system, const MotionState& motion, double of_kinks) {
  find_products(system, motion);
  energy_.kinetic = 0.5 * products_.row(1).dot(motion.v.transpose());
  energy_.elastic = 0.5 * (products_.row(4) - s_ * products_.row(0)).dot(motion.u.transpose());
  energy_.elastic += of_kinks;
  return energy_.kinetic + energy_.elastic;
}

void EnergyLedger::book_loads(const MotionState& start, const MotionState& end, const Eigen::VectorXd& load,
                              const Eigen::VectorXd& of_breaks) {
  moved_ = end.u - start.u;
  const double freed = of_breaks.dot(moved_);
  energy_.external_work += load.dot(moved_) - freed;
  energy_.freed -= freed;
}

void EnergyLedger::book_start(const GeneralizedAlpha& method, const RayleighDamping& damping) {
  const double a0 = damping.mass, a1 = damping.stiffness, foreseen = (1 - method.af) * method.h;
  if (a0 > 0) energy_.damped += a0 * (products_.row(1) + foreseen * products_.row(2)).dot(moved_.transpose());
  if (a1 > 0) energy_.damped += a1 * method.af * (products_.row(5) - s_ * products_.row(1)).dot(moved_.transpose());
  old_products_.resize(2, moved_.size());
  old_products_.row(0) = products_.row(2);
  old_products_.row(1) = products_.row(4) - s_ * products_.row(0);
}

/// What the substep's equation, times its displacement du, has beyond the change of energy, all at its end: of K
/// (1/2 - af) du'K du, and of M what is left of du'M a(n+1-am) once the change of 1/2 v'Mv is taken out, with
/// du = h (v + v(n+1))/2 + h2 (b - g/2) da and a(n+1-am) = dv/h + (1/2 - af) da.
void EnergyLedger::book_numerical(const MotionState& start, const MotionState& end, const GeneralizedAlpha& method) {
  const double h = method.h, part = 0.5 - method.af, by_a = method.beta - method.gamma / 2;
  if (part == 0 && by_a == 0) return;
  const auto stiff = products_.row(4) - s_ * products_.row(0) - old_products_.row(1);
  const auto inert = (products_.row(2) - old_products_.row(0)).eval();
  energy_.numerical += part * stiff.dot(moved_.transpose());
  energy_.numerical += part * h / 2 * inert.dot((start.v + end.v).transpose());
  energy_.numerical += h * by_a * inert.dot((end.v - start.v).transpose());
  energy_.numerical += h * h * by_a * part * inert.dot((end.a - start.a).transpose());
}

void EnergyLedger::book_end(const MotionState& start, const MotionState& end, const GeneralizedAlpha& method,
                            const RayleighDamping& damping) {
  book_numerical(start, end, method);
  if (damping.stiffness > 0)
    energy_.damped +=
        damping.stiffness * (1 - method.af) * (products_.row(5) - s_ * products_.row(1)).dot(moved_.transpose());
}

}  // namespace topple::solver
