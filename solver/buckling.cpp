#include "topple/solver/buckling.h"

#include <Eigen/SparseCholesky>
#include <cmath>

#include "frame_system.h"
#include "second_order_beam.h"

namespace topple::solver {
namespace {

constexpr double enclosed = 1e-11;    // relative width at which a factor counts as found
constexpr double same_factor = 1e-6;  // modes this close are sought apart from each other
constexpr int inverse_iterations = 8;

using Sparse = Eigen::SparseMatrix<double>;

class Buckling {
 public:
  Buckling(const FrameModel& model, const LoadSet& loads, const AnalysisOptions& options) : system_(model) {
    StaticAnalysis linear(model, options);
    const std::vector<StaticSolution> solution = linear.solve({&loads, 1});
    for (const Vec12& forces : solution.front().beam_end_forces) first_axial_.push_back(-forces(0));
    loads_.resize(model.beams.size());
    for (const BeamLoad& load : loads.beams) loads_[static_cast<std::size_t>(load.beam)].push_back(load);
    axial_.mode = SecondOrder::exact;
    system_.assemble();
    const std::vector<int> order = system_.elimination_order();
    place_.resize(static_cast<Eigen::Index>(order.size()));
    for (std::size_t k = 0; k < order.size(); ++k) place_.indices()(order[k]) = static_cast<int>(k);
    system_.second_order = &axial_;
  }

  /// How many critical factors lie below this one. Leaves the factorised tangent behind.
  int below(double factor) {
    set_factor(factor);
    int count = 0;
    for (std::size_t i = 0; i < first_axial_.size(); ++i)
      count += SecondOrderBeam(system_.model.beams[i], 1, SecondOrder::exact, axial_.first_axial[i], axial_.loads[i])
                   .buckled_modes();
    if (place_.size() == 0) return count;
    system_.assemble();
    ldlt_.compute(permuted());
    for (Eigen::Index i = 0; i < ldlt_.vectorD().size(); ++i) count += ldlt_.vectorD()(i) < 0 ? 1 : 0;
    return count;
  }

  /// The shape at a factor hardly below a critical one, apart from the vectors in `known`.
  std::vector<Vec6> shape(double factor, std::vector<Eigen::VectorXd>& known) {
    std::vector<Vec6> shape(system_.model.nodes.size(), Vec6::Zero());
    if (place_.size() == 0) return shape;
    below(factor);
    const Eigen::Index n = place_.size();
    Eigen::VectorXd x(n);
    for (Eigen::Index i = 0; i < n; ++i) x(i) = std::sin(1.0 + 0.7 * static_cast<double>(i));  // no symmetry of its own
    double growth = 0;
    for (int k = 0; k < inverse_iterations; ++k) {
      for (const Eigen::VectorXd& other : known) x -= other.dot(x) * other;
      x.normalize();
      x = ldlt_.solve(x);
      growth = x.norm();
    }
    for (const Eigen::VectorXd& other : known) x -= other.dot(x) * other;
    x.normalize();
    constexpr double singular = 1e5;  // what a vector grows by where the tangent is all but singular
    if (growth < singular) return shape;
    known.push_back(x);
    Eigen::VectorXd u = place_.transpose() * x;
    for (Eigen::Index i = 0; i < n; ++i) u(i) *= system_.scale()[static_cast<std::size_t>(i)];
    shape = system_.node_displacements(u, Eigen::VectorXd::Zero(system_.dofs().held));
    double largest = 0;
    for (const Vec6& s : shape) largest = std::max(largest, s.head<3>().norm());
    if (largest > 0)
      for (Vec6& s : shape) s /= largest;
    return shape;
  }

  [[nodiscard]] bool has_compression() const {
    for (std::size_t i = 0; i < first_axial_.size(); ++i)
      if (first_axial_[i] < 0 || !loads_[i].empty()) return true;
    return false;
  }

 private:
  void set_factor(double factor) {
    axial_.first_axial = first_axial_;
    axial_.loads = loads_;
    for (double& n : axial_.first_axial) n *= factor;
    for (auto& list : axial_.loads)
      for (BeamLoad& load : list) {
        load.first *= factor;
        load.last *= factor;
      }
  }

  [[nodiscard]] Sparse permuted() const {
    const SparseSymmetric& K = system_.matrix();
    std::vector<Eigen::Triplet<double>> entries;
    entries.reserve(K.row.size());
    for (int column = 0; column < K.size; ++column)
      for (auto k = K.start[static_cast<std::size_t>(column)]; k < K.start[static_cast<std::size_t>(column) + 1]; ++k) {
        const int i = place_.indices()(K.row[static_cast<std::size_t>(k)]), j = place_.indices()(column);
        entries.emplace_back(std::max(i, j), std::min(i, j), K.value[static_cast<std::size_t>(k)]);
      }
    Sparse matrix(K.size, K.size);
    matrix.setFromTriplets(entries.begin(), entries.end());
    return matrix;
  }

  FrameSystem system_;
  AxialState axial_;
  std::vector<double> first_axial_;
  std::vector<std::vector<BeamLoad>> loads_;
  Eigen::PermutationMatrix<Eigen::Dynamic> place_;
  Eigen::SimplicialLDLT<Sparse, Eigen::Lower, Eigen::NaturalOrdering<int>> ldlt_;
};

}  // namespace

std::vector<BucklingMode> buckling_modes(const FrameModel& model, const LoadSet& loads, int count,
                                         const AnalysisOptions& options, double largest_factor) {
  Buckling buckling(model, loads, options);
  std::vector<BucklingMode> modes;
  if (!buckling.has_compression()) return modes;
  double low = 0;
  std::vector<Eigen::VectorXd> known;
  for (int k = 1; k <= count; ++k) {
    double high = std::max(2 * low, 1.0);
    while (buckling.below(high) < k) {
      low = high;
      high *= 2;
      if (high > largest_factor) return modes;
    }
    while (high - low > enclosed * high) {
      const double middle = low + (high - low) / 2;
      (buckling.below(middle) >= k ? high : low) = middle;
    }
    const bool repeated = !modes.empty() && high - modes.back().factor < same_factor * high;
    if (!repeated) known.clear();
    modes.push_back({high, buckling.shape(low * (1 - 100 * enclosed), known)});
  }
  return modes;
}

}  // namespace topple::solver
