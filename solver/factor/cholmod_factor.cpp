#include "factor/cholmod_factor.h"

#include <cholmod.h>

#include <new>
#include <stdexcept>
#include <string>

#include "parallel/one_blas_thread.h"
#include "parallel/serial_regions.h"

namespace topple::solver {

namespace {

using Long = SuiteSparse_long;

/// CHOLMOD's workspace and settings, ended with their owner.
class Common {
 public:
  Common() {
    use_one_blas_thread();
    cholmod_l_start(&common_);
    common_.itype = CHOLMOD_LONG;
    common_.print = 0;
    common_.error_handler = nullptr;
    common_.try_catch = 1;  // failures come back as a status, and nothing is written to the terminal
    common_.quick_return_if_not_posdef = 1;
  }
  ~Common() { cholmod_l_finish(&common_); }
  Common(const Common&) = delete;
  Common& operator=(const Common&) = delete;
  cholmod_common* get() { return &common_; }
  cholmod_common* operator->() { return &common_; }

  void check(const char* what) const {
    if (common_.status == CHOLMOD_OUT_OF_MEMORY) throw std::bad_alloc();
    if (common_.status == CHOLMOD_TOO_LARGE)
      throw std::runtime_error(std::string(what) + ": the system is too large for CHOLMOD's integers");
    if (common_.status < CHOLMOD_OK)
      throw std::runtime_error(std::string(what) + ": CHOLMOD failed with status " + std::to_string(common_.status));
  }

 private:
  cholmod_common common_{};
};

}  // namespace

struct CholmodFactor::State {
  Common common;
  cholmod_factor* factor = nullptr;
  std::vector<Long> start, row;  // the pattern, in CHOLMOD's integers
  int size = 0;
  double operations = 0;
  cholmod_dense *solution = nullptr, *work_y = nullptr, *work_e = nullptr;

  ~State() {
    for (cholmod_dense** dense : {&solution, &work_y, &work_e})
      if (*dense) cholmod_l_free_dense(dense, common.get());
    if (factor) cholmod_l_free_factor(&factor, common.get());
  }

  /// The matrix as CHOLMOD sees it: lower triangle, borrowed arrays.
  cholmod_sparse view(const double* values) {
    cholmod_sparse a{};
    a.nrow = a.ncol = static_cast<std::size_t>(size);
    a.nzmax = row.size();
    a.p = start.data();
    a.i = row.data();
    a.x = const_cast<double*>(values);  // CHOLMOD reads it only
    a.stype = -1;
    a.itype = CHOLMOD_LONG;
    a.xtype = values ? CHOLMOD_REAL : CHOLMOD_PATTERN;
    a.dtype = CHOLMOD_DOUBLE;
    a.sorted = 1;
    a.packed = 1;
    return a;
  }

  void choose(Factorisation kind) {
#ifdef TOPPLE_GPL
    if (kind == Factorisation::simplicial) common->supernodal = CHOLMOD_SIMPLICIAL;
    if (kind == Factorisation::supernodal) common->supernodal = CHOLMOD_SUPERNODAL;
#else
    (void)kind;
    common->supernodal = CHOLMOD_SIMPLICIAL;
#endif
    common->final_ll = 0;  // simplicial: L D L', whose pivots' signs are seen
    common->nmethods = 1;
    common->method[0].ordering = CHOLMOD_GIVEN;
    common->postorder = 1;
  }
};

CholmodFactor::CholmodFactor(const SparseSymmetric& pattern, const std::vector<int>& permutation, Factorisation kind)
    : state_(std::make_unique<State>()) {
  State& s = *state_;
  s.size = pattern.size;
  s.start.assign(pattern.start.begin(), pattern.start.end());
  s.row.assign(pattern.row.begin(), pattern.row.end());
  s.choose(kind);
  std::vector<Long> order(permutation.begin(), permutation.end());
  // Values of one: CHOLMOD's analysis takes the pattern of a real matrix, and looks at no value.
  cholmod_sparse a = s.view(nullptr);
  const SerialRegions serial;
  s.factor = cholmod_l_analyze_p(&a, order.data(), nullptr, 0, s.common.get());
  s.common.check("symbolic factorisation");
  s.operations = s.common->fl;
}

CholmodFactor::~CholmodFactor() = default;

std::int64_t CholmodFactor::factorise(const SparseSymmetric& matrix) {
  State& s = *state_;
  cholmod_sparse a = s.view(matrix.value.data());
  const SerialRegions serial;
  cholmod_l_factorize(&a, s.factor, s.common.get());
  if (s.common->status != CHOLMOD_NOT_POSDEF && s.common->status != CHOLMOD_DSMALL) s.common.check("factorisation");
  return static_cast<std::int64_t>(s.factor->minor);
}

void CholmodFactor::solve(Eigen::Ref<Eigen::MatrixXd> right_hand_sides) const {
  State& s = *state_;
  if (right_hand_sides.cols() == 0 || s.size == 0) return;
  cholmod_dense b{};
  b.nrow = static_cast<std::size_t>(right_hand_sides.rows());
  b.ncol = static_cast<std::size_t>(right_hand_sides.cols());
  b.d = static_cast<std::size_t>(right_hand_sides.outerStride());
  b.nzmax = b.d * b.ncol;
  b.x = right_hand_sides.data();
  b.xtype = CHOLMOD_REAL;
  b.dtype = CHOLMOD_DOUBLE;
  const SerialRegions serial;
  // solve2 keeps its workspaces from call to call: nothing is allocated once they are large enough.
  cholmod_l_solve2(CHOLMOD_A, s.factor, &b, nullptr, &s.solution, nullptr, &s.work_y, &s.work_e, s.common.get());
  s.common.check("solution");
  right_hand_sides = Eigen::Map<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>(
      static_cast<const double*>(s.solution->x), right_hand_sides.rows(), right_hand_sides.cols(),
      Eigen::OuterStride<>(static_cast<Eigen::Index>(s.solution->d)));
}

std::size_t CholmodFactor::entries() const {
  const cholmod_factor& f = *state_->factor;
  return f.is_super ? f.xsize : f.nzmax;
}

FactorView CholmodFactor::view() const {
  const cholmod_factor& f = *state_->factor;
  static_assert(sizeof(Long) == sizeof(std::int64_t));
  const auto integers = [](const void* data, std::size_t count) {
    return std::span(reinterpret_cast<const std::int64_t*>(data), data == nullptr ? 0 : count);
  };
  FactorView view;
  view.supernodal = f.is_super != 0;
  view.is_ll = f.is_ll != 0;
  view.order = integers(f.Perm, f.n);
  if (view.supernodal) {
    view.first = integers(f.super, f.nsuper + 1);
    view.row_start = integers(f.pi, f.nsuper + 1);
    view.start = integers(f.px, f.nsuper + 1);
    view.row = integers(f.s, f.ssize);
    view.value = std::span(static_cast<const double*>(f.x), f.xsize);
  } else {
    view.start = integers(f.p, f.n + 1);
    view.count = integers(f.nz, f.n);
    view.row = integers(f.i, f.nzmax);
    view.value = std::span(static_cast<const double*>(f.x), f.nzmax);
  }
  return view;
}

double CholmodFactor::operations() const { return state_->operations; }

Factorisation CholmodFactor::kind() const {
  return state_->factor->is_super ? Factorisation::supernodal : Factorisation::simplicial;
}

}  // namespace topple::solver
