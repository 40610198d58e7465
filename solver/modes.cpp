#include "topple/solver/modes.h"

#include <cmath>

#include "block_krylov.h"
#include "factor.h"
#include "frame_system.h"
#include "ldl_factor.h"
#include "mass_matrix.h"
#include "mechanism.h"

namespace topple::solver {
namespace {

class Modes {
 public:
  Modes(const FrameModel& model, const MassModel& masses, const AnalysisOptions& options, const AxialState* tangent)
      : system_(model) {
    system_.second_order = tangent;
    system_.assemble();
    if (const auto defect = system_.defect()) throw Instability(defect->message, defect->motion);
    order_ = system_.elimination_order();
    mass_ = std::make_unique<MassMatrix>(system_, masses);
    if (order_.empty()) return;
    factor_ = std::make_unique<Factor>(system_.matrix(), order_, options.factorisation, options.threads);
    const Stability stability = factorise_and_judge(system_, *factor_, options);
    if (stability.defect) throw Instability(stability.defect->message, stability.defect->motion);
  }

  ModalAnswer find(int count) {
    ModalAnswer answer;
    if (order_.empty()) return answer;
    if (mass_->matrix().value.empty() ||
        *std::max_element(mass_->matrix().value.begin(), mass_->matrix().value.end()) <= 0)
      throw std::invalid_argument("natural modes need mass: no density, no masses");
    const KrylovOperators operators{static_cast<Eigen::Index>(order_.size()),
                                    [this](Eigen::Ref<Eigen::MatrixXd> x) { factor_->solve(x); },
                                    [this](const Eigen::Ref<const Eigen::MatrixXd>& x) { return mass_->times(x); }};
    // A wider block where the count says that some are missing.
    for (int extra = least_extra + count / 8; extra <= most_extra; extra *= 4) {
      const KrylovAnswer found = largest_eigenvalues(operators, count, extra);
      if (!none_missing(found, count)) continue;
      gather(found, std::min<Eigen::Index>(count, found.values.size()), answer);
      return answer;
    }
    throw std::runtime_error("the Sturm count finds more natural frequencies than the iteration does");
  }

 private:
  static constexpr int least_extra = 4, most_extra = 4096;

  /// Counts the eigenvalues of K x = s M x below a shift behind the last one asked for.
  [[nodiscard]] bool none_missing(const KrylovAnswer& found, int count) const {
    constexpr double apart = 1e-3, beyond = 1e-2;
    const Eigen::Index known = found.values.size();
    if (known == 0) return true;
    Eigen::Index last = std::min<Eigen::Index>(count, known) - 1;
    const auto eigenvalue = [&](Eigen::Index i) { return 1 / found.values(i); };
    const auto gap = [&](Eigen::Index i) { return i + 1 < known ? eigenvalue(i + 1) / eigenvalue(i) - 1 : 2 * beyond; };
    while (last + 1 < known && gap(last) < apart && last + 1 < found.converged) ++last;
    const double shift = eigenvalue(last) * (1 + std::min(beyond, gap(last) / 2));
    SparseSymmetric shifted = system_.matrix();
    const SparseSymmetric& M = mass_->matrix();
    for (std::size_t k = 0; k < shifted.value.size(); ++k) shifted.value[k] -= shift * M.value[k];
    return LdlFactor(shifted, order_).factorise(shifted, false) == static_cast<int>(last) + 1;
  }

  void gather(const KrylovAnswer& found, Eigen::Index count, ModalAnswer& answer) const {
    const Vec3 centre = mass_->centre();
    std::array<Eigen::VectorXd, 6> pushed;  // M times the rigid motions
    std::array<double, 6> total{};
    for (int c = 0; c < 6; ++c) {
      const auto i = static_cast<std::size_t>(c);
      const Eigen::VectorXd rigid = mass_->rigid_motion(c, centre);
      pushed[i] = mass_->times(rigid);
      total[i] = rigid.dot(pushed[i]);
      if (c < 3) answer.moving_mass(c) = total[i];
    }
    for (Eigen::Index m = 0; m < count; ++m) {
      VibrationMode mode;
      mode.angular_frequency = 1 / std::sqrt(found.values(m));
      const Eigen::VectorXd x =
          found.vectors.col(m) / std::sqrt(found.vectors.col(m).dot(mass_->times(found.vectors.col(m)).col(0)));
      for (std::size_t c = 0; c < 6; ++c)
        if (total[c] > 0) mode.mass_share[c] = std::pow(x.dot(pushed[c]), 2) / total[c];
      mode.shape = system_.shape(x);
      answer.modes.push_back(std::move(mode));
    }
  }

  FrameSystem system_;
  std::vector<int> order_;
  std::unique_ptr<MassMatrix> mass_;
  std::unique_ptr<Factor> factor_;
};

}  // namespace

ModalAnswer natural_modes(const FrameModel& model, const MassModel& masses, int count, const AnalysisOptions& options,
                          const AxialState* tangent) {
  return Modes(model, masses, options, tangent).find(count);
}

}  // namespace topple::solver
