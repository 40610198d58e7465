#include "reanalysis/factor_refresh.h"

#include <utility>

namespace topple::solver {
namespace {

/// Places that changed while the new factor was made, and that it takes over beside each answer of the old one.
constexpr int places_at_once = 6;

}  // namespace

void FactorRefresh::begin(const FrameSystem& system, const std::vector<int>& order, const AnalysisOptions& options,
                          double cost) {
  unwanted_.reset();
  base_ = std::make_unique<BaseFactor>(system);
  making_ = std::make_unique<BackgroundFactor>(system.matrix(), order, options, rules_.on_worker);
  paid_ = 0;
  due_ = rules_.share * cost;
}

/// Waits for the new factor. False: it is of no use.
bool FactorRefresh::receive(ReanalysisWork& work) {
  bool late = false;
  BackgroundFactor::Result made = making_->extract(late);
  making_.reset();
  if (late) ++work.counters.late_factors;
  if (!made.factor) {
    base_.reset();
    allowed_ = false;
    return false;
  }
  base_->install(std::move(*made.triangles));
  factor_ = std::move(made.factor);
  values_ = std::move(made.values);
  condition_ = made.condition;
  return true;
}

bool FactorRefresh::go_on(ReanalysisWork& work) {
  if (making_ && paid_ >= due_) (void)receive(work);
  if (!factor_) return false;
  const BaseFactor::CaughtUp done = base_->catch_up(places_at_once);
  work.operations += done.operations;
  return done.all;
}

bool FactorRefresh::finish(ReanalysisWork& work) { return factor_ || (making_ && receive(work)); }

FactorRefresh::Made FactorRefresh::release() {
  return {std::move(factor_), std::move(base_), condition_, std::move(values_)};
}

void FactorRefresh::drop() {
  if (making_) unwanted_ = std::move(making_);
  base_.reset();
  factor_.reset();
}

}  // namespace topple::solver
