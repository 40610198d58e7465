// Ordering and factorisation on the regular steel frame, side by side with direct calls of METIS and CHOLMOD:
//  - METIS on the graph of nodes against METIS on the graph of freedoms, call against call, time and fill;
//  - our factorisation and solution against supernodal CHOLMOD with METIS on the same matrix, one BLAS thread;
//  - a fresh factorisation of ours against supernodal CHOLMOD with default settings, both on all processors, beside the
//    rate of the matrix product; small systems against CHOLMOD's simplicial factorisation.
// Contestants take turns; medians of the wall time and of the processor time of all threads.
//   bench_factorisation [posts posts storeys]        (default 10 10 40: 24,000 freedoms; 4 6 5: 720; 17 17 110:
//   190,740)
#include <cholmod.h>
#include <metis.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <thread>

#include "assembly/frame_loads.h"
#include "assembly/frame_system.h"
#include "assembly/refinement.h"
#include "factor/factor.h"
#include "factor/ordering.h"
#include "support/measure.h"
#include "support/provenance.h"
#include "support/regular_frame.h"

extern "C" {
void openblas_set_num_threads(int);
void dgemm_(const char*, const char*, const int*, const int*, const int*, const double*, const double*, const int*,
            const double*, const int*, const double*, double*, const int*);
}

using namespace topple;
using namespace topple::bench;

namespace {

struct MetisGraph {
  std::vector<idx_t> start{0}, neighbour;
  std::vector<idx_t> order;
  /// As METIS does it by default.
  void dissect() {
    auto count = static_cast<idx_t>(start.size()) - 1;
    idx_t options[METIS_NOPTIONS];
    METIS_SetDefaultOptions(options);
    options[METIS_OPTION_SEED] = 1;
    order.resize(static_cast<std::size_t>(count));
    std::vector<idx_t> inverse(order.size());
    if (METIS_NodeND(&count, start.data(), neighbour.data(), nullptr, options, order.data(), inverse.data()) !=
        METIS_OK) {
      std::fprintf(stderr, "METIS failed\n");
      std::exit(1);
    }
  }
};

MetisGraph graph_of_freedoms(const solver::SparseSymmetric& K) {
  std::vector<std::vector<idx_t>> lists(static_cast<std::size_t>(K.size));
  for (int c = 0; c < K.size; ++c)
    for (auto k = K.start[static_cast<std::size_t>(c)] + 1; k < K.start[static_cast<std::size_t>(c) + 1]; ++k) {
      const int r = K.row[static_cast<std::size_t>(k)];
      lists[static_cast<std::size_t>(c)].push_back(r);
      lists[static_cast<std::size_t>(r)].push_back(c);
    }
  MetisGraph graph;
  for (const auto& list : lists) {
    graph.neighbour.insert(graph.neighbour.end(), list.begin(), list.end());
    graph.start.push_back(static_cast<idx_t>(graph.neighbour.size()));
  }
  return graph;
}

/// CHOLMOD called directly, with its own defaults but for what is named.
class DirectCholmod {
 public:
  explicit DirectCholmod(const solver::SparseSymmetric& K, int supernodal = CHOLMOD_SUPERNODAL)
      : start_(K.start.begin(), K.start.end()), row_(K.row.begin(), K.row.end()), value_(K.value) {
    cholmod_l_start(&common_);
    common_.supernodal = supernodal;
    common_.nmethods = 1;
    matrix_.nrow = matrix_.ncol = static_cast<std::size_t>(K.size);
    matrix_.nzmax = row_.size();
    matrix_.p = start_.data();
    matrix_.i = row_.data();
    matrix_.x = value_.data();
    matrix_.stype = -1;
    matrix_.itype = CHOLMOD_LONG;
    matrix_.xtype = CHOLMOD_REAL;
    matrix_.sorted = matrix_.packed = 1;
  }
  ~DirectCholmod() {
    free_factor();
    cholmod_l_finish(&common_);
  }
  DirectCholmod(const DirectCholmod&) = delete;
  DirectCholmod& operator=(const DirectCholmod&) = delete;

  /// Entries of the factor under an order of the rows.
  double fill(const std::vector<idx_t>& order) {
    std::vector<SuiteSparse_long> given(order.begin(), order.end());
    common_.method[0].ordering = CHOLMOD_GIVEN;
    cholmod_factor* factor = cholmod_l_analyze_p(&matrix_, given.data(), nullptr, 0, &common_);
    cholmod_l_free_factor(&factor, &common_);
    return common_.lnz;
  }
  void analyse_with_metis() {
    free_factor();
    common_.method[0].ordering = CHOLMOD_METIS;
    factor_ = cholmod_l_analyze(&matrix_, &common_);
  }
  void analyse_by_default() {
    free_factor();
    common_.nmethods = 0;
    factor_ = cholmod_l_analyze(&matrix_, &common_);
  }
  void factorise() { cholmod_l_factorize(&matrix_, factor_, &common_); }
  [[nodiscard]] double operations() const { return common_.fl; }
  Eigen::VectorXd solve(const Eigen::VectorXd& b) {
    cholmod_dense right{};
    right.nrow = right.d = right.nzmax = static_cast<std::size_t>(b.size());
    right.ncol = 1;
    right.x = const_cast<double*>(b.data());
    right.xtype = CHOLMOD_REAL;
    cholmod_dense* x = cholmod_l_solve(CHOLMOD_A, factor_, &right, &common_);
    Eigen::VectorXd result = Eigen::Map<Eigen::VectorXd>(static_cast<double*>(x->x), b.size());
    cholmod_l_free_dense(&x, &common_);
    return result;
  }

 private:
  void free_factor() {
    if (factor_ != nullptr) cholmod_l_free_factor(&factor_, &common_);
  }
  cholmod_common common_{};
  cholmod_sparse matrix_{};
  cholmod_factor* factor_ = nullptr;
  std::vector<SuiteSparse_long> start_, row_;
  std::vector<double> value_;
};

void compare_orderings(const solver::FrameSystem& system, DirectCholmod& direct) {
  MetisGraph freedoms = graph_of_freedoms(system.matrix());
  std::vector<int> order;
  const auto time = interleaved_medians(7, {[&] { order = system.elimination_order(); }, [&] { freedoms.dissect(); }});
  const double node_fill = direct.fill({order.begin(), order.end()}), freedom_fill = direct.fill(freedoms.order);
  std::printf("order by METIS on      time        entries of the factor\n");
  std::printf("  graph of nodes       %7.1f ms  %.0f  (building the graph included)\n", 1e3 * time[0], node_fill);
  std::printf("  graph of freedoms    %7.1f ms  %.0f  (the call alone)\n", 1e3 * time[1], freedom_fill);
  std::printf("  nodes are %.2f times as fast (asked: 1.8), fill ratio %.3f (asked: at most 1.05)\n\n",
              time[1] / time[0], node_fill / freedom_fill);
}

void compare_factors(const solver::FrameSystem& system, DirectCholmod& direct, const Eigen::VectorXd& load) {
  const solver::SparseSymmetric& K = system.matrix();
  std::unique_ptr<solver::Factor> ours;
  const auto analysis = interleaved_medians(3, {[&] {
                                                  ours = std::make_unique<solver::Factor>(
                                                      K, system.elimination_order(), solver::Factorisation::automatic);
                                                },
                                                [&] { direct.analyse_with_metis(); }});
  Eigen::MatrixXd x;
  Eigen::VectorXd y;
  const auto time = interleaved_medians(K.size > 100000 ? 3 : 9, {[&] {
                                                                    if (!ours->factorise(K).positive_definite)
                                                                      std::exit(1);
                                                                  },
                                                                  [&] { direct.factorise(); },
                                                                  [&] {
                                                                    x = load;
                                                                    ours->solve(x);
                                                                  },
                                                                  [&] { y = direct.solve(load); }});
  const solver::ExtendedResidual residual(K);
  Eigen::MatrixXd r;
  const double our_error = residual(load, x, r).front(), their_error = residual(load, y, r).front();
  std::printf("                       order+analyse  factor      solve     GF/s   backward error\n");
  std::printf("  ours (%-12s)  %8.1f ms  %8.1f ms  %7.2f ms  %5.1f   %.1e\n", ours->name(), 1e3 * analysis[0],
              1e3 * time[0], 1e3 * time[2], ours->operations() / time[0] / 1e9, our_error);
  std::printf("  CHOLMOD, supernodal  %9.1f ms  %8.1f ms  %7.2f ms  %5.1f   %.1e\n", 1e3 * analysis[1], 1e3 * time[1],
              1e3 * time[3], direct.operations() / time[1] / 1e9, their_error);
  std::printf("  ours takes %.2f of its time for factor and solve (asked: at most 1), %.2f with the analysis\n",
              (time[0] + time[2]) / (time[1] + time[3]),
              (analysis[0] + time[0] + time[2]) / (analysis[1] + time[1] + time[3]));
}

/// Multiply-adds in a second, times two as usual, of the matrix product on all processors.
double product_rate(int processors) {
  constexpr int n = 1536;
  const std::vector<double> a(static_cast<std::size_t>(n) * n, 0.5), b(a);
  std::vector<double> c(a.size());
  const double one = 1, zero = 0;
  openblas_set_num_threads(processors);
  const double t = interleaved_medians(
      5, {[&] { dgemm_("N", "N", &n, &n, &n, &one, a.data(), &n, b.data(), &n, &zero, c.data(), &n); }})[0];
  openblas_set_num_threads(1);
  return 2.0 * n * n * n / t;
}

void compare_fresh(const solver::FrameSystem& system) {
  const int processors = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  const solver::SparseSymmetric& K = system.matrix();
  const bool small = K.size < 2000;
  solver::Factor ours(K, system.elimination_order(), solver::Factorisation::automatic, processors);
  DirectCholmod theirs(K, small ? CHOLMOD_SIMPLICIAL : CHOLMOD_SUPERNODAL);
  theirs.analyse_by_default();
  const double before = product_rate(processors);
  const auto spent = interleaved_spending(small             ? 99
                                          : K.size > 100000 ? 3
                                                            : 9,
                                          {[&] {
                                             if (!ours.factorise(K).positive_definite) std::exit(1);
                                           },
                                           [&] {
                                             openblas_set_num_threads(processors);
                                             theirs.factorise();
                                             openblas_set_num_threads(1);
                                           }});
  const double rate = std::max(before, product_rate(processors));
  std::printf("\nfresh factorisation on %d processors    wall         processor     GF/s\n", processors);
  std::printf("  ours (multifrontal)             %9.2f ms  %9.2f ms  %7.1f\n", 1e3 * spent[0].wall,
              1e3 * spent[0].processor, ours.operations() / spent[0].wall / 1e9);
  std::printf("  CHOLMOD, %-12s           %9.2f ms  %9.2f ms  %7.1f\n", small ? "simplicial" : "default",
              1e3 * spent[1].wall, 1e3 * spent[1].processor, theirs.operations() / spent[1].wall / 1e9);
  std::printf("  matrix product                                           %7.1f\n", rate / 1e9);
  std::printf("  ours is %.2f times as fast (by processor time %.2f; asked: %s), at %.2f of the product's rate\n",
              spent[1].wall / spent[0].wall, spent[1].processor / spent[0].processor,
              K.size > 100000 ? "1.6, or 0.75 of the rate" : "2", ours.operations() / spent[0].wall / rate);
}

}  // namespace

int main(int argc, char** argv) {
  solver::prepare_blas(argv);
  openblas_set_num_threads(1);
  int size[3] = {10, 10, 40};
  for (int i = 1; i < std::min(argc, 4); ++i) size[i - 1] = std::atoi(argv[i]);
  if ((argc != 1 && argc != 4) || *std::min_element(size, size + 3) < 1) {
    std::fprintf(stderr, "usage: bench_factorisation [posts posts storeys]\n");
    return 2;
  }
  const RegularFrame frame = regular_frame(size[0], size[1], size[2]);
  solver::FrameSystem system(frame.model);
  system.assemble();
  const Eigen::Index n = system.dofs().equations;
  const Eigen::VectorXd load = load_vector(system, frame.loads)
                                   .force.head(n)
                                   .cwiseProduct(Eigen::Map<const Eigen::VectorXd>(system.scale().data(), n));
  print_provenance("Ordering and factorisation of the regular steel frame", 1);
  std::printf("%d x %d posts, %d storeys: %ld freedoms, %zu entries in the lower triangle\n\n", size[0], size[1],
              size[2], static_cast<long>(n), system.matrix().row.size());
  {
    DirectCholmod direct(system.matrix());
    compare_orderings(system, direct);
    compare_factors(system, direct, load);
  }
  compare_fresh(system);
  return 0;
}
