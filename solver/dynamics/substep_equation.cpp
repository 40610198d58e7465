#include "dynamics/substep_equation.h"

namespace topple::solver {

void SubstepEquation::set(const FrameSystem& system, const GeneralizedAlpha& method, const RayleighDamping& damping,
                          const MotionState& start, const Eigen::VectorXd& load, const SideBySide<8>* products) {
  const double h = method.h, am = method.am, af = method.af, a0 = damping.mass, a1 = damping.stiffness;
  const double by_v = (1 - af) * h + a1;
  const double by_a = (1 - af) * h * h * (0.5 - method.beta) + a1 * (1 - af) * h * (1 - method.gamma);
  q_ = start.u + by_v * start.v + by_a * start.a;
  w_ = load;
  const double foreseen = (1 - af) * h;
  if (products != nullptr) {
    w_ += (method.s * products->row(0) + (method.s * by_v - a0) * products->row(1) +
           (method.s * by_a - am - a0 * foreseen) * products->row(2))
              .transpose();
  } else {
    z_ = (method.s * q_ - am * start.a - a0 * (start.v + foreseen * start.a)).transpose();
    multiply<1>(system.mass(), z_, mass_z_);
    w_ += mass_z_.row(0).transpose();
  }
}

void SubstepEquation::find_end(const GeneralizedAlpha& method, const MotionState& start, MotionState& end) const {
  const double h = method.h;
  end.a = (w_ - q_) / method.c;
  end.u = start.u + h * start.v + h * h * ((0.5 - method.beta) * start.a + method.beta * end.a);
  end.v = start.v + h * ((1 - method.gamma) * start.a + method.gamma * end.a);
}

}  // namespace topple::solver
