#include "topple/solver/buckling.h"

#include <cmath>
#include <map>
#include <memory>
#include <numeric>
#include <optional>

#include "assembly/frame_recovery.h"
#include "assembly/frame_system.h"
#include "assembly/mass_matrix.h"
#include "eigen/buckling_pairs.h"
#include "elements/second_order_beam.h"
#include "factor/factor.h"

namespace topple::solver {
namespace {

constexpr double enclosed = 1e-11;        // relative width at which a factor counts as found
constexpr double equal_to_newton = 2e-9;  // relative distance of factors whose shapes it mixes
constexpr double same_factor = 1e-6;      // modes this close are sought apart from each other
constexpr int inverse_iterations = 8;
constexpr int spare_starts = 3;  // beyond those sought: equal factors all come

class Buckling {
 public:
  Buckling(const FrameModel& model, const LoadSet& loads, const AnalysisOptions& options,
           const std::vector<JointedShell>& jointed, const StaticSolution& first_order)
      : system_(model), threads_(options.threads) {
    for (const Vec12& forces : first_order.beam_end_forces) first_axial_.push_back(-forces(0));
    loads_.resize(model.beams.size());
    for (const BeamLoad& load : loads.beams) loads_[static_cast<std::size_t>(load.beam)].push_back(load);
    axial_.mode = SecondOrder::exact;
    axial_.jointed = jointed;
    if (!model.shells.empty()) {
      axial_.shell_displacements = first_order.displacements;
      axial_.shell_strain = shell_strains(model, loads);
    }
    system_.assemble(threads_);
    const std::vector<int> order = system_.elimination_order();
    unloaded_scale_.assign(system_.scale().begin(), system_.scale().end());
    if (!order.empty())
      factor_ = std::make_unique<Factor>(system_.matrix(), order, Factorisation::automatic, options.threads);
    system_.second_order = &axial_;
  }

  /// How many critical factors lie below this one. Leaves the factorised tangent behind when it is to be kept.
  int below(double factor, bool keep = false) {
    if (const auto known = counted_.find(factor); known != counted_.end() && !keep) return known->second;
    const int inside = buckled_inside(factor);  // leaves the state at this factor
    int count = inside;
    if (factor_) {
      system_.assemble(threads_);
      count += factor_->factorise_indefinite(system_.matrix());
    }
    return counted_[factor] = count;
  }

  /// The lowest pairs at once, proved by one count; none where that does not work.
  [[nodiscard]] std::vector<BucklingPair> pairs(const std::vector<BucklingStart>& starts, int count) {
    TangentOperators operators;
    operators.tangent = [this](double factor) { return tangent(factor); };
    operators.count = [this](double factor) { return below(factor); };
    operators.factorise = [this](double factor) {
      if (buckled_inside(factor) > 0) return -1;
      return counted_[factor] = factor_->factorise_indefinite(tangent(factor));
    };
    operators.solve = [this](Eigen::Ref<Eigen::MatrixXd> x) { factor_->solve(x); };
    return buckling_pairs(operators, starts, count);
  }

  [[nodiscard]] std::vector<Vec6> shape_of(const BucklingPair& pair) const {
    Eigen::VectorXd x = pair.vector;
    for (Eigen::Index i = 0; i < x.size(); ++i)
      x(i) *= unloaded_scale_[static_cast<std::size_t>(i)] / system_.scale()[static_cast<std::size_t>(i)];
    return normalised_shape(system_, x);
  }

  /// What the counts made so far leave for the k-th factor: `high` stays when none has been beyond it.
  void bracket(int k, double& low, double& high) const {
    for (const auto& [factor, count] : counted_) {
      if (count < k) {
        low = std::max(low, factor);
      } else {
        high = factor;
        break;
      }
    }
  }

  /// Estimates to begin with; none where members are not what is compressed.
  [[nodiscard]] std::vector<BucklingStart> starts(int count) {
    const double reference = reference_factor();
    if (!factor_ || !(reference > 0)) return {};
    const SparseSymmetric K = tangent(0);
    constexpr double small = 1e-4;  // of the reference: what is lost is then linear to some digits
    SparseSymmetric G = tangent(small * reference);
    for (std::size_t k = 0; k < G.value.size(); ++k) G.value[k] = (K.value[k] - G.value[k]) / (small * reference);
    if (!factor_->factorise(K).positive_definite) return {};
    const auto times = [&](const Eigen::Ref<const Eigen::MatrixXd>& x) {
      Eigen::MatrixXd y = Eigen::MatrixXd::Zero(x.rows(), x.cols());
      multiply_symmetric(G, x, y, threads_);
      return y;
    };
    return estimate_buckling({K.size, [&](Eigen::Ref<Eigen::MatrixXd> x) { factor_->solve(x); }, times, threads_},
                             count);
  }

  /// From an estimate to the factor nearby: inverse iteration and Newton's method in turn, until it moves no more than
  /// its square shows. Returns what is left of the doubt; the factor is proved by counts alone.
  double sharpen(const BucklingStart& start, double& factor) {
    constexpr int most = 6;
    constexpr double close = 1e-7, lost = 0.5;
    factor = start.factor;
    displacement_ = start.vector.normalized();
    double moved = factor;
    for (int turn = 0; turn < most && std::abs(moved) > close * factor; ++turn) {
      below(factor, true);
      const double guess = newton(factor);
      moved = guess - factor;
      if (!(guess > 0) || !(std::abs(moved) < lost * factor)) return factor;
      factor = guess;
    }
    return std::max(10 * moved * moved / factor, enclosed / 4 * factor);
  }

  /// Members that have buckled between their ends held; leaves the state at this factor.
  int buckled_inside(double factor) {
    set_factor(factor);
    int count = 0;
    for (std::size_t i = 0; i < first_axial_.size(); ++i) {
      const Beam& beam = system_.model.beams[i];
      if (far_from_buckling_inside(beam, axial_.first_axial[i], axial_.loads[i])) continue;
      count += SecondOrderBeam(beam, 1, SecondOrder::exact, axial_.first_axial[i], axial_.loads[i]).buckled_modes();
    }
    return count;
  }

  /// After below(factor, true): where the tangent's eigenvalue nearest to zero vanishes, by Newton's method on its
  /// Rayleigh quotient.
  double newton(double factor) {
    if (!factor_) return factor;
    constexpr int turns = 3;
    constexpr double step = 1e-5;
    if (displacement_.size() == 0) displacement_ = start();
    Eigen::VectorXd x = displacement_;
    for (int k = 0; k < turns; ++k) {
      factor_->solve(x);
      x.normalize();
    }
    displacement_ = x;
    const Eigen::VectorXd u = unscaled(x);
    const double here = energy(u);
    set_factor(factor * (1 + step));
    system_.assemble(threads_);
    return factor - here * step * factor / (energy(u) - here);
  }

  /// The shape at a factor hardly below a critical one, apart from the vectors in `known`.
  std::vector<Vec6> shape(double factor, std::vector<Eigen::VectorXd>& known) {
    std::vector<Vec6> shape(system_.model.nodes.size(), Vec6::Zero());
    if (!factor_) return shape;
    assemble_in_unloaded_scale(factor);
    (void)factor_->factorise_indefinite(system_.matrix());
    Eigen::VectorXd x = start();
    double growth = 0;
    for (int k = 0; k < inverse_iterations; ++k) {
      for (const Eigen::VectorXd& other : known) x -= other.dot(x) * other;
      x.normalize();
      factor_->solve(x);
      growth = x.norm();
    }
    for (const Eigen::VectorXd& other : known) x -= other.dot(x) * other;
    x.normalize();
    constexpr double singular = 1e5;  // what a vector grows by where the tangent is all but singular
    if (growth < singular) return shape;
    known.push_back(x);
    return normalised_shape(system_, x);
  }

  [[nodiscard]] bool has_compression() const {
    if (!system_.model.shells.empty()) return true;
    for (std::size_t i = 0; i < first_axial_.size(); ++i)
      if (first_axial_[i] < 0 || !loads_[i].empty()) return true;
    return false;
  }

 private:
  /// The tangent, each freedom scaled by what its stiffness is without load: by its own in the tangent, a freedom that
  /// buckles alone (the middle of a post between held ends) would look as stiff as any other.
  void assemble_in_unloaded_scale(double factor) {
    set_factor(0);
    system_.assemble(threads_);
    set_factor(factor);
    std::vector<int> nodes(system_.model.nodes.size());
    std::iota(nodes.begin(), nodes.end(), 0);
    system_.reassemble(nodes);
  }

  /// The tangent in the scale of the unloaded stiffness.
  [[nodiscard]] SparseSymmetric tangent(double factor) {
    set_factor(factor);
    system_.assemble(threads_);
    SparseSymmetric T = system_.matrix();
    std::vector<double> ratio(unloaded_scale_);
    for (std::size_t i = 0; i < ratio.size(); ++i) ratio[i] /= system_.scale()[i];  // powers of two: exact
    for (std::size_t column = 0; column < ratio.size(); ++column)
      for (auto k = static_cast<std::size_t>(T.start[column]); k < static_cast<std::size_t>(T.start[column + 1]); ++k)
        T.value[k] *= ratio[static_cast<std::size_t>(T.row[k])] * ratio[column];
    return T;
  }

  /// A vector without any symmetry of its own.
  [[nodiscard]] Eigen::VectorXd start() const {
    Eigen::VectorXd x(system_.dofs().equations);
    for (Eigen::Index i = 0; i < x.size(); ++i) x(i) = std::sin(1.0 + 0.7 * static_cast<double>(i));
    return x;
  }

  [[nodiscard]] Eigen::VectorXd unscaled(const Eigen::VectorXd& x) const {
    Eigen::VectorXd u(x.size());
    for (Eigen::Index i = 0; i < x.size(); ++i) u(i) = x(i) * system_.scale()[static_cast<std::size_t>(i)];
    return u;
  }

  /// u K u of the tangent as it is assembled; its scale may be another one than the vector's.
  [[nodiscard]] double energy(const Eigen::VectorXd& u) const {
    Eigen::VectorXd x(u.size());
    for (Eigen::Index i = 0; i < u.size(); ++i) x(i) = u(i) / system_.scale()[static_cast<std::size_t>(i)];
    Eigen::MatrixXd force = Eigen::MatrixXd::Zero(u.size(), 1);
    multiply_symmetric(system_.matrix(), x, force);
    return x.dot(force.col(0));
  }

  void set_factor(double factor) {
    axial_.first_axial = first_axial_;
    axial_.loads = loads_;
    axial_.shell_factor = factor;
    for (double& n : axial_.first_axial) n *= factor;
    for (auto& list : axial_.loads)
      for (BeamLoad& load : list) {
        load.first *= factor;
        load.last *= factor;
      }
  }

  /// The least of the factors at which a member would buckle by itself between pinned ends.
  [[nodiscard]] double reference_factor() const {
    constexpr double pi = 3.14159265358979323846;
    double most = 0;
    for (std::size_t i = 0; i < first_axial_.size(); ++i) {
      const Beam& beam = system_.model.beams[i];
      const double least = std::min(beam.Iy, beam.Iz) * beam.youngs_modulus * pi * pi / (beam.length * beam.length);
      most = std::max(most, -first_axial_[i] / least);
    }
    return most > 0 ? 1 / most : 0;
  }

  FrameSystem system_;
  int threads_;
  AxialState axial_;
  std::map<double, int> counted_;
  std::vector<double> first_axial_;
  std::vector<std::vector<BeamLoad>> loads_;
  std::unique_ptr<Factor> factor_;
  std::vector<double> unloaded_scale_;
  Eigen::VectorXd displacement_;  ///< where the last search for an eigenvector ended
};

/// Encloses the k-th factor between `low`, with fewer below it, and `high`, with at least k.
void enclose(Buckling& buckling, int k, double& low, double& high) {
  const auto take = [&](double factor, int count) { (count >= k ? high : low) = factor; };
  constexpr double close = 0.5;  // relative width from which Newton's method is worth its price
  while (high - low > enclosed * high) {
    const double middle = low + (high - low) / 2;
    const bool sharpen = high - low < close * high;
    take(middle, buckling.below(middle, sharpen));
    if (!sharpen) continue;
    // A factor where a member buckles between resting nodes is a pole, not a zero: then halving goes on.
    const double guess = buckling.newton(middle), moved = guess - middle;
    if (!(guess > low && guess < high)) continue;
    const double margin = std::max(10 * moved * moved / guess, enclosed / 4 * guess);
    const bool another_nearby = moved != 0 && high - low < equal_to_newton * high;
    for (const double side : {guess - margin, guess + margin})
      if (side > low && side < high) take(side, buckling.below(side));
    // Newton's method ends between factors that lie so close that it cannot tell their shapes apart.
    if (another_nearby && high - low > enclosed * high && high - low < equal_to_newton * high) return;
  }
}

/// Counts on both sides of where an estimate leads to: most often that encloses the k-th factor at once.
void count_around(Buckling& buckling, int k, const BucklingStart& start) {
  double low = 0, high = 0;
  buckling.bracket(k, low, high);
  if (high > 0 && high - low <= enclosed * high) return;
  double factor = 0;
  const double doubt = buckling.sharpen(start, factor);
  // Factors close by, or an estimate of another one, leave it on one side: then from further and further away.
  constexpr double least = 5e-10, wider = 100, furthest = 0.1;
  for (const double way : {-1.0, 1.0})
    for (double step = doubt; step < furthest * factor; step = std::max(least * factor, wider * step)) {
      const bool beyond = buckling.below(factor + way * step) >= k;
      if (beyond == (way > 0)) break;
    }
}

}  // namespace

std::vector<BucklingMode> buckling_modes(const FrameModel& model, const LoadSet& loads, int count,
                                         const AnalysisOptions& options, double largest_factor,
                                         const std::vector<JointedShell>& jointed, const StaticSolution* first_order) {
  std::optional<StaticSolution> found;
  if (first_order == nullptr) found = std::move(StaticAnalysis(model, options).solve({&loads, 1}).front());
  Buckling buckling(model, loads, options, jointed, found ? *found : *first_order);
  std::vector<BucklingMode> modes;
  if (!buckling.has_compression()) return modes;
  const std::vector<BucklingStart> starts = buckling.starts(count + spare_starts);
  for (const BucklingPair& pair : buckling.pairs(starts, count))
    if (static_cast<int>(modes.size()) < count && pair.factor <= largest_factor)
      modes.push_back({pair.factor, buckling.shape_of(pair)});
    else
      return modes;
  if (!modes.empty()) return modes;
  double low = 0;
  std::vector<Eigen::VectorXd> known;
  for (int k = 1; k <= count; ++k) {
    if (static_cast<std::size_t>(k) <= starts.size())
      count_around(buckling, k, starts[static_cast<std::size_t>(k) - 1]);
    double high = 0;
    buckling.bracket(k, low, high);
    if (high == 0) {
      high = std::max(2 * low, 1.0);
      while (high < largest_factor && buckling.below(high) < k) {
        low = high;
        high *= 2;
      }
    }
    // What lies beyond may have been counted alone: an estimate leads to it where a member buckles between resting
    // nodes.
    if (high > largest_factor) {
      if (low >= largest_factor || buckling.below(largest_factor) < k) return modes;
      high = largest_factor;
    }
    enclose(buckling, k, low, high);
    const bool repeated = !modes.empty() && high - modes.back().factor < same_factor * high;
    if (!repeated) known.clear();
    modes.push_back({high, buckling.shape(low * (1 - 100 * enclosed), known)});
  }
  return modes;
}

}  // namespace topple::solver
