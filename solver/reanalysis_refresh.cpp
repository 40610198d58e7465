// New factors made on another thread, and how they take over.
#include "reanalysis_state.h"

namespace topple::solver {

void Reanalysis::set_refresh(RefreshRules rules) { state_->refresh_rules = std::move(rules); }

void Reanalysis::State::begin_refresh_if_due() {
  if (refresh || refresh_failed || !standing || standing->rank() <= refresh_rules.columns) return;
  const double anew = factor_operations();
  if (anew < refresh_rules.least_operations) return;
  next = std::make_unique<StandingFactor>(*system);
  refresh = std::make_unique<FactorRefresh>(system->matrix(), order, options, refresh_rules.on_worker);
  refresh_paid = 0;
  refresh_due = refresh_rules.share * anew;
}

bool Reanalysis::State::take_refreshed() {
  bool late = false;
  FactorRefresh::Result made = refresh->take(late);
  refresh.reset();
  if (late) ++counters.late_factors;
  std::unique_ptr<StandingFactor> taking_over = std::move(next);
  if (!made.factor) {
    refresh_failed = true;
    return false;
  }
  complete(nullptr);
  restricted.reset();
  standing = std::move(taking_over);
  factor = std::move(made.factor);
  standing->serve(*factor);
  correction_paid = looked_at_softening = 0;
  condition = made.condition;
  first_solution.resize(0);
  ++counters.background_factors;
  return true;
}

void Reanalysis::State::drop_refresh() {
  refresh.reset();
  next.reset();
}

}  // namespace topple::solver
