// NLopt stays behind this file.
#include <nlopt.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>

#include "study/design_search.h"

namespace topple::structure::study {

namespace {

/// NLopt asks for the objective and the constraints of one point one after the other: the point is computed once.
class Point {
 public:
  Point(const SearchSpace& space, const TryDesigns& attempt) : space_(space), attempt_(attempt) {}

  /// Null once it was stopped or the runs are used up.
  const StudyDesign* at(const double* x) {
    const std::vector<double> place(x, x + space_.variables.size());
    if (ended_ || place == place_) return ended_ ? nullptr : &design_;
    if (runs_++ >= space_.runs) return end();
    std::vector<StudyValue> values;
    constexpr double rim = 1e-9;
    for (std::size_t v = 0; v < place.size(); ++v)
      values.push_back(space_.variables[v].distribution.quantile(std::clamp(place[v], rim, 1 - rim)));
    std::vector<StudyDesign> done = attempt_({std::move(values)});
    if (done.empty()) return end();
    place_ = place;
    design_ = std::move(done.front());
    return &design_;
  }
  [[nodiscard]] nlopt_opt& optimiser() { return optimiser_; }

 private:
  const StudyDesign* end() {
    ended_ = true;
    nlopt_force_stop(optimiser_);
    return nullptr;
  }
  const SearchSpace& space_;
  const TryDesigns& attempt_;
  nlopt_opt optimiser_ = nullptr;
  std::vector<double> place_;
  StudyDesign design_;
  int runs_ = 0;
  bool ended_ = false;
};

struct Problem {
  Point point;
  const std::function<double(const StudyDesign&)>& value;
  const std::function<std::vector<double>(const StudyDesign&)>& excess;
  std::exception_ptr failure;

  /// What a design without numbers counts for: worse than any that has them.
  static constexpr double no_number = 1e30;

  template <class Use>
  void with(const double* x, Use use) {
    try {
      if (const StudyDesign* design = point.at(x)) use(*design);
    } catch (...) {  // not through NLopt, which is C
      failure = std::current_exception();
      nlopt_force_stop(point.optimiser());
    }
  }
};

double finite(double value) { return std::isfinite(value) ? value : Problem::no_number; }

double objective(unsigned, const double* x, double*, void* data) {
  auto& problem = *static_cast<Problem*>(data);
  double result = Problem::no_number;
  problem.with(x, [&](const StudyDesign& design) { result = finite(problem.value(design)); });
  return result;
}

void constraints_of(unsigned count, double* result, unsigned, const double* x, double*, void* data) {
  auto& problem = *static_cast<Problem*>(data);
  std::fill(result, result + count, Problem::no_number);
  problem.with(x, [&](const StudyDesign& design) {
    const std::vector<double> excess = problem.excess(design);
    for (unsigned i = 0; i < count; ++i) result[i] = finite(excess[i]);
  });
}

}  // namespace

void nlopt_search(const SearchSpace& space, const std::string& method, const TryDesigns& attempt,
                  const std::function<double(const StudyDesign&)>& value,
                  const std::function<std::vector<double>(const StudyDesign&)>& excess, std::size_t constraints) {
  const auto n = static_cast<unsigned>(space.variables.size());
  const std::unique_ptr<nlopt_opt_s, decltype(&nlopt_destroy)> optimiser(
      nlopt_create(method == "isres" ? NLOPT_GN_ISRES : NLOPT_LN_COBYLA, n), &nlopt_destroy);
  if (!optimiser) throw std::bad_alloc();
  Problem problem{Point(space, attempt), value, excess, nullptr};
  problem.point.optimiser() = optimiser.get();
  nlopt_srand(static_cast<unsigned long>(space.seed));
  nlopt_set_lower_bounds1(optimiser.get(), 0);
  nlopt_set_upper_bounds1(optimiser.get(), 1);
  nlopt_set_min_objective(optimiser.get(), objective, &problem);
  if (constraints > 0)
    nlopt_add_inequality_mconstraint(optimiser.get(), static_cast<unsigned>(constraints), constraints_of, &problem,
                                     nullptr);
  nlopt_set_initial_step1(optimiser.get(), 0.25);
  nlopt_set_xtol_rel(optimiser.get(), 1e-8);
  std::vector<double> x(n, 0.5);
  double least = 0;
  const nlopt_result result = nlopt_optimize(optimiser.get(), x.data(), &least);
  if (problem.failure) std::rethrow_exception(problem.failure);
  const bool ended = result > 0 || result == NLOPT_FORCED_STOP || result == NLOPT_ROUNDOFF_LIMITED;
  if (!ended) throw std::runtime_error("NLopt ends with its code " + std::to_string(static_cast<int>(result)));
}

}  // namespace topple::structure::study
