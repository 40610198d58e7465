// New factors made on another thread, and how they take over.
#include <utility>

#include "reanalysis/reanalysis_state.h"
#include "reanalysis/update_costs.h"

namespace topple::solver {

void Reanalysis::set_refresh(RefreshRules rules) { state_->refresh_rules = std::move(rules); }

namespace {
/// Places that changed while the new factor was made, and that it takes over beside each answer of the old one.
constexpr int places_at_once = 6;
}  // namespace

void Reanalysis::State::begin_refresh_if_due() {
  if (next || refresh_failed || !standing || standing->rank() <= refresh_rules.columns) return;
  if (factor_operations() >= refresh_rules.least_operations) begin_refresh();
}

void Reanalysis::State::begin_refresh() {
  unwanted.reset();
  next = std::make_unique<BaseFactor>(*system);
  refresh = std::make_unique<BackgroundFactor>(system->matrix(), order, options, refresh_rules.on_worker);
  refresh_paid = 0;
  refresh_due = refresh_rules.share * predicted_cost(factor_work());
}

/// Waits for the new factor. False: it is of no use.
bool Reanalysis::State::take_refreshed() {
  bool late = false;
  BackgroundFactor::Result made = refresh->take(late);
  refresh.reset();
  if (late) ++counters.late_factors;
  if (!made.factor) {
    next.reset();
    refresh_failed = true;
    return false;
  }
  next->serve(std::move(*made.triangles));
  next_factor = std::move(made.factor);
  next_condition = made.condition;
  return true;
}

/// When the new factor is due it catches up with what changed meanwhile, some of it beside each answer, and takes over.
void Reanalysis::State::go_on_with_refresh() {
  if (refresh && refresh_paid >= refresh_due) (void)take_refreshed();
  if (!next_factor) return;
  const BaseFactor::CaughtUp done = next->catch_up(places_at_once);
  operations += done.operations;
  if (done.all) switch_factors();
}

void Reanalysis::State::count_answer(int solves) {
  if (!standing) return;
  const double solve = standing->solve_cost(), corrected = standing->correction_cost();
  const double more = solve + residual_cost(static_cast<double>(system->matrix().value.size()));
  correction_paid += solves * corrected + (solves - 1) * more;
  refresh_paid += solves * (solve + corrected);
}

std::optional<Defect> Reanalysis::State::renew_factor() {
  if (!standing || !standing->changed()) return std::nullopt;
  go_on_with_refresh();
  if (!standing->changed() || correction_paid <= predicted_cost(factor_work())) return std::nullopt;
  if (factor_operations() < refresh_rules.least_operations) return refactorise();
  if (!next && !refresh_failed) begin_refresh();
  return std::nullopt;
}

/// At once, whatever it has to catch up with. False: there is none under way, or it is of no use.
bool Reanalysis::State::switch_now() {
  if (!next_factor && (!refresh || !take_refreshed())) return false;
  switch_factors();
  return true;
}

void Reanalysis::State::switch_factors() {
  complete(nullptr);
  const std::unique_ptr<BaseFactor> before = std::exchange(standing, std::move(next));
  const std::unique_ptr<Factor> factor_before = std::exchange(factor, std::move(next_factor));
  if (selective && !selective->serve(standing->triangles())) selective.reset();
  correction_paid = looked_at_softening = 0;
  condition = next_condition;
  first_solution.resize(0);
  ++counters.background_factors;
}

/// The thread of one that is under way is waited for when the next one begins.
void Reanalysis::State::drop_refresh() {
  if (refresh) unwanted = std::move(refresh);
  next.reset();
  next_factor.reset();
}

}  // namespace topple::solver
