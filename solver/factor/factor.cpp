#include "factor/factor.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <stdexcept>

#include "factor/cholmod_factor.h"
#include "factor/multifrontal.h"
#include "parallel/one_blas_thread.h"

namespace topple::solver {
namespace {

/// Calls visit(k, pivot): the square of the k-th diagonal entry of L, or D's.
template <class Visit>
void each_pivot(const FactorView& view, Visit visit) {
  const auto square = [](double diagonal) { return diagonal * diagonal; };
  if (!view.supernodal) {
    for (std::size_t k = 0; k < view.order.size(); ++k) {
      const double value = view.value[static_cast<std::size_t>(view.start[k])];
      visit(k, view.is_ll ? square(value) : value);
    }
    return;
  }
  for (std::size_t b = 0; b + 1 < view.first.size(); ++b) {
    const std::int64_t rows = view.row_start[b + 1] - view.row_start[b];
    for (std::int64_t k = view.first[b]; k < view.first[b + 1]; ++k)
      visit(static_cast<std::size_t>(k),
            square(view.value[static_cast<std::size_t>(view.start[b] + (k - view.first[b]) * (rows + 1))]));
  }
}

}  // namespace

struct Factor::State {
  std::optional<CholmodFactor> cholmod;
  std::optional<MultifrontalFactor> own;
};

Factor::Factor(const SparseSymmetric& pattern, const std::vector<int>& permutation, Factorisation kind, int threads)
    : state_(std::make_unique<State>()) {
  use_one_blas_thread();
  if (kind == Factorisation::automatic) {
    state_->own.emplace(pattern, permutation, threads);
  } else {
    state_->cholmod.emplace(pattern, permutation, kind);
  }
}

Factor::~Factor() = default;
Factor::Factor(Factor&&) noexcept = default;
Factor& Factor::operator=(Factor&&) noexcept = default;

Factor::Outcome Factor::factorise(const SparseSymmetric& matrix) {
  const std::int64_t done = state_->own ? state_->own->factorise(matrix) : state_->cholmod->factorise(matrix);
  const FactorView numbers = view();
  Outcome outcome;
  if (done < static_cast<std::int64_t>(numbers.order.size())) {
    outcome.worst_row = static_cast<int>(numbers.order[static_cast<std::size_t>(done)]);
    return outcome;
  }
  outcome.positive_definite = true;
  outcome.worst_pivot = std::numeric_limits<double>::infinity();
  each_pivot(numbers, [&](std::size_t k, double pivot) {
    const auto row = static_cast<std::size_t>(numbers.order[k]);
    const double relative = pivot / matrix.value[static_cast<std::size_t>(matrix.start[row])];
    if (relative < outcome.worst_pivot || !std::isfinite(relative)) {
      outcome.worst_pivot = relative;
      outcome.worst_row = static_cast<int>(row);
    }
    if (!(pivot > 0)) outcome.positive_definite = false;
  });
  return outcome;
}

int Factor::factorise_indefinite(const SparseSymmetric& matrix) {
  if (!state_->own) throw std::invalid_argument("only the factorisation `automatic` counts negative pivots");
  const std::int64_t done = state_->own->factorise_indefinite(matrix);
  if (done < static_cast<std::int64_t>(view().order.size()))
    throw std::runtime_error("a count of eigenvalues meets numbers that are not finite");
  return static_cast<int>(state_->own->negative().size());
}

void Factor::solve(Eigen::Ref<Eigen::MatrixXd> right_hand_sides) const {
  if (right_hand_sides.size() == 0) return;
  if (state_->own) {
    state_->own->solve(right_hand_sides);
  } else {
    state_->cholmod->solve(right_hand_sides);
  }
}

std::size_t Factor::entries() const {
  return state_->own ? static_cast<std::size_t>(state_->own->fronts().value_start.back()) : state_->cholmod->entries();
}

double Factor::operations() const {
  return state_->own ? state_->own->fronts().operations : state_->cholmod->operations();
}

FactorView Factor::view() const {
  if (!state_->own) return state_->cholmod->view();
  const Supernodes& fronts = state_->own->fronts();
  FactorView view;
  view.supernodal = view.is_ll = true;
  view.order = fronts.order;
  view.first = fronts.first;
  view.row_start = fronts.row_start;
  view.row = fronts.row;
  view.start = fronts.value_start;
  view.value = state_->own->values();
  return view;
}

Factorisation Factor::kind() const { return state_->own ? Factorisation::automatic : state_->cholmod->kind(); }

const char* Factor::name() const {
  switch (kind()) {
    case Factorisation::simplicial:
      return "CHOLMOD simplicial";
    case Factorisation::supernodal:
      return "CHOLMOD supernodal";
    default:
      return "multifrontal";
  }
}

}  // namespace topple::solver
