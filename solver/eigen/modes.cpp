#include "topple/solver/modes.h"

#include <cmath>
#include <limits>

#include "assembly/frame_recovery.h"
#include "assembly/frame_system.h"
#include "assembly/mass_matrix.h"
#include "assembly/mechanism.h"
#include "eigen/block_krylov.h"
#include "factor/factor.h"
#include "topple/solver/shifted_modes.h"
#include "topple/solver/unresolved_modes.h"

namespace topple::solver {
namespace {

class Modes {
 public:
  Modes(const FrameModel& model, const MassModel& masses, double shift, const AnalysisOptions& options,
        const AxialState* tangent)
      : system_(model), shift_(shift), threads_(options.threads) {
    system_.second_order = tangent;
    system_.assemble(threads_);
    if (shift_ == 0) require_none(system_.defect());
    order_ = system_.elimination_order();
    mass_ = std::make_unique<MassMatrix>(system_, masses, threads_);
    stiffness_ = system_.matrix();
    for (std::size_t k = 0; shift_ != 0 && k < stiffness_.value.size(); ++k)
      stiffness_.value[k] += shift_ * mass_->matrix().value[k];
    if (order_.empty()) return;
    factor_ = std::make_unique<Factor>(stiffness_, order_, options.factorisation, options.threads);
    if (shift_ == 0) {
      require_none(factorise_and_judge(system_, *factor_, options).defect);
    } else {
      factorise_shifted(options);
    }
  }

  ModalAnswer find(int count) {
    try {
      return found(count);
    } catch (const std::runtime_error& error) {
      require_resolved(error.what());
      throw;
    }
  }

 private:
  ModalAnswer found(int count) {
    ModalAnswer answer;
    if (order_.empty()) return answer;
    if (mass_->matrix().value.empty() ||
        *std::max_element(mass_->matrix().value.begin(), mass_->matrix().value.end()) <= 0)
      throw std::invalid_argument("natural modes need mass: no density, no masses");
    const KrylovOperators operators{
        static_cast<Eigen::Index>(order_.size()), [this](Eigen::Ref<Eigen::MatrixXd> x) { solve(x); },
        [this](const Eigen::Ref<const Eigen::MatrixXd>& x) { return mass_->times(x); }, threads_};
    // More than there are freedoms are never found: asking for them is asking for all.
    count = static_cast<int>(std::min<std::size_t>(static_cast<std::size_t>(count), order_.size()));
    // A wider block where the count says that some are missing.
    const int first = least_extra + count / 8, last = std::max(first, most_extra);
    // So too where it does not settle: the beams of a floor all swing at the same frequency.
    for (int extra = first; extra <= last; extra *= 4) {
      const bool widest = 4 * extra > last || count + extra >= static_cast<int>(order_.size());
      const KrylovAnswer found = largest_eigenvalues(operators, count, extra, widest ? most_restarts : few_restarts);
      if (!found.settled && !widest) continue;
      if (!found.settled)
        throw std::runtime_error("the eigenvalue iteration does not converge: relative residual " +
                                 std::to_string(found.residual));
      if (!none_missing(found, count)) continue;
      gather(found, std::min<Eigen::Index>(count, found.values.size()), answer);
      return answer;
    }
    throw std::runtime_error("the Sturm count finds more natural frequencies than the iteration does");
  }

  /// Whether what has failed is due to the model: its softest freedom is lost in the rounding of the stiffest one's, or
  /// of the shift's. Freedoms by themselves, as each bounds the frequencies from one side.
  void require_resolved(const std::string& failed) const {
    if (!mass_) return;
    constexpr double resolved = 1e15;  // what 53 bits hold, and a bit for the sums
    UnresolvedModes::Place least{std::numeric_limits<double>::infinity(), -1}, largest{shift_, -1};
    const SparseSymmetric &K = system_.matrix(), &M = mass_->matrix();
    for (std::size_t row = 0; row + 1 < M.start.size(); ++row) {
      const double mass = M.value[static_cast<std::size_t>(M.start[row])];
      if (!(mass > 0)) continue;
      const double ratio = K.value[static_cast<std::size_t>(K.start[row])] / mass;
      const int vertex = system_.dofs().vertex_of_equation[row];
      const int node = vertex < static_cast<int>(system_.dofs().number.size()) ? vertex : -1;
      if (ratio < least.first) least = {ratio, node};
      if (ratio > largest.first) largest = {ratio, node};
    }
    if (!(largest.first < resolved * least.first)) throw UnresolvedModes(failed, least, largest);
  }

  static constexpr int least_extra = 4, most_extra = 4096, few_restarts = 15, most_restarts = 200;

  void factorise_shifted(const AnalysisOptions& options) {
    const Factor::Outcome outcome = factor_->factorise(stiffness_);
    if (outcome.positive_definite && outcome.worst_pivot >= options.singular_limit) return;
    Defect defect = find_mechanism(system_, *factor_, outcome.worst_row);
    require_none(Defect{defect.message + ", and the shift of the eigenvalue finds no mass in this motion to hold it by",
                        defect.motion});
  }

  /// Counts the eigenvalues of (K + shift M) x = s M x below a place s behind the last one asked for.
  [[nodiscard]] bool none_missing(const KrylovAnswer& found, int count) {
    constexpr double apart = 1e-3, beyond = 1e-2;
    const Eigen::Index known = found.values.size();
    if (known == 0) return true;
    Eigen::Index last = std::min<Eigen::Index>(count, known) - 1;
    const auto eigenvalue = [&](Eigen::Index i) { return 1 / found.values(i); };
    const auto gap = [&](Eigen::Index i) { return i + 1 < known ? eigenvalue(i + 1) / eigenvalue(i) - 1 : 2 * beyond; };
    while (last + 1 < known && gap(last) < apart && last + 1 < found.converged) ++last;
    const double place = eigenvalue(last) * (1 + std::min(beyond, gap(last) / 2));
    SparseSymmetric shifted = stiffness_;
    const SparseSymmetric& M = mass_->matrix();
    for (std::size_t k = 0; k < shifted.value.size(); ++k) shifted.value[k] -= place * M.value[k];
    return negative_pivots(shifted) == static_cast<int>(last) + 1;
  }

  /// In the place of the stiffness' own factor, which comes back where it is asked for again.
  [[nodiscard]] int negative_pivots(const SparseSymmetric& matrix) {
    if (factor_->kind() != Factorisation::automatic)
      return Factor(matrix, order_, Factorisation::automatic, threads_).factorise_indefinite(matrix);
    of_stiffness_ = false;
    return factor_->factorise_indefinite(matrix);
  }

  void solve(Eigen::Ref<Eigen::MatrixXd> x) {
    if (!of_stiffness_) (void)factor_->factorise(stiffness_);
    of_stiffness_ = true;
    factor_->solve(x);
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
      constexpr double rounding = 1e-8;  // of the shift: what is left where it is taken off again
      const double square = 1 / found.values(m) - shift_;
      mode.angular_frequency = square <= rounding * shift_ ? 0 : std::sqrt(square);
      const Eigen::VectorXd x =
          found.vectors.col(m) / std::sqrt(found.vectors.col(m).dot(mass_->times(found.vectors.col(m)).col(0)));
      for (std::size_t c = 0; c < 6; ++c)
        if (total[c] > 0) mode.mass_share[c] = std::pow(x.dot(pushed[c]), 2) / total[c];
      mode.shape = normalised_shape(system_, x);
      answer.modes.push_back(std::move(mode));
    }
  }

  FrameSystem system_;
  double shift_;
  int threads_;
  SparseSymmetric stiffness_;  ///< with the shift's share of the mass
  std::vector<int> order_;
  std::unique_ptr<MassMatrix> mass_;
  std::unique_ptr<Factor> factor_;
  bool of_stiffness_ = true;  ///< what `factor_` is the factor of
};

}  // namespace

ModalAnswer natural_modes(const FrameModel& model, const MassModel& masses, int count, const AnalysisOptions& options,
                          const AxialState* tangent) {
  return Modes(model, masses, 0, options, tangent).find(count);
}

ModalAnswer shifted_modes(const FrameModel& model, const MassModel& masses, int count, double shift,
                          const AnalysisOptions& options, const AxialState* tangent) {
  if (!(shift > 0) || !std::isfinite(shift))
    throw std::invalid_argument("the shift of natural modes is " + std::to_string(shift) + "; accepted: above 0");
  return Modes(model, masses, shift, options, tangent).find(count);
}

}  // namespace topple::solver
