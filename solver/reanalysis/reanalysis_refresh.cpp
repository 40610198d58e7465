// When a new factor is begun on another thread, and how it takes over.
#include <utility>

#include "reanalysis/reanalysis_state.h"

namespace topple::solver {

void Reanalysis::set_refresh(RefreshRules rules) { state_->refresh.set_rules(std::move(rules)); }

void Reanalysis::State::begin_refresh_if_due() {
  const BaseFactor* base = serving->base();
  if (!refresh.may_begin() || base == nullptr || base->rank() <= refresh.rules().columns) return;
  if (serving->operations() >= refresh.rules().least_operations) begin_refresh();
}

void Reanalysis::State::begin_refresh() { refresh.begin(*system, serving->order(), options, serving->cost()); }

void Reanalysis::State::go_on_with_refresh() {
  if (refresh.go_on(work)) switch_factors();
}

bool Reanalysis::State::switch_now() {
  if (!refresh.finish(work)) return false;
  switch_factors();
  return true;
}

void Reanalysis::State::switch_factors() {
  complete(nullptr);
  const FactorRefresh::Made before = serving->replace(refresh.release());
  if (selective && !selective->set_factor(serving->base()->triangles())) selective.reset();
  solution.forget_first();
  ++work.counters.background_factors;
}

std::optional<Defect> Reanalysis::State::renew_factor() {
  catch_up();
  if (!serving->corrected()) return std::nullopt;
  go_on_with_refresh();
  if (!serving->corrected() || !serving->worn()) return std::nullopt;
  if (serving->operations() < refresh.rules().least_operations) return refactorise();
  if (refresh.may_begin()) begin_refresh();
  return std::nullopt;
}

}  // namespace topple::solver
