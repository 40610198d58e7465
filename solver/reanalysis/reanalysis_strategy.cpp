// How a change is answered: by a low-rank update or by a new factor.
#include <utility>

#include "reanalysis/reanalysis_state.h"
#include "reanalysis/update_costs.h"
#include "reanalysis/work_count.h"

namespace topple::solver {

std::optional<Defect> Reanalysis::State::update_structure(const std::vector<int>& touched) {
  const bool stood = structure_stands;
  structure_stands = false;
  count_work(changes_cost(static_cast<double>(touched.size())));
  if (!assembled) {
    system->assemble();
    assembled = true;
  } else if (!touched.empty()) {
    system->reassemble(touched);
  }
  std::optional<Defect> defect;
  if (stood && serving->base() != nullptr) {
    defect = system->defect(touched);
  } else {
    defect = system->defect();
  }
  report_factors([&](SystemChanges& one) { one.touch(touched); });
  solution.touch(touched);
  if (defect) return defect;
  if (system->dofs().equations == 0) {  // everything is held: nothing to factorise, every answer is exact
    structure_stands = true;
    return std::nullopt;
  }
  if (factor_when_asked) {
    structure_stands = factor_lags = true;
    return std::nullopt;
  }
  return update_factor(!touched.empty());
}

std::optional<Defect> Reanalysis::State::update_factor(bool changed) {
  std::optional<Defect> defect;
  go_on_with_refresh();
  Correction correction = correct_factor(changed, defect);
  // Beyond what a correction can do, a factor that is under way comes sooner than one begun now.
  if (correction == Correction::not_made && switch_now()) correction = correct_factor(changed, defect);
  if (correction == Correction::made) {
    structure_stands = !defect;
    if (structure_stands) begin_refresh_if_due();
    return defect;
  }
  defect = refactorise();
  structure_stands = !defect;
  return defect;
}

void Reanalysis::State::catch_up() {
  if (!std::exchange(factor_lags, false)) return;
  require_none(update_factor(true));
}

Reanalysis::State::Correction Reanalysis::State::correct_factor(bool changed, std::optional<Defect>& defect) {
  solution.forget_elimination();
  const ServingFactor::Choice choice = serving->choose(refresh.rules());
  const Correction otherwise = choice.last_alone_too_much ? Correction::beyond : Correction::not_made;
  if (!choice.correction) return otherwise;
  solution.update_correction(*serving, choice.plan.work.places > 0, load.vector().force, selective.get(), watched);
  work.operations += choice.plan.operations;
  Stability verdict;
  verdict.nearly_unstable = answer.nearly_unstable;
  const bool decided = serving->judge_correction(verdict);
  answer.nearly_unstable = verdict.nearly_unstable;
  if (!decided) return otherwise;
  defect = std::move(verdict.defect);
  if (changed) ++work.counters.low_rank;
  return Correction::made;
}

std::optional<Defect> Reanalysis::State::refactorise() {
  complete(nullptr);
  refresh.drop();
  solution.forget_elimination();
  solution.forget_first();
  selective.reset();
  const Stability verdict = serving->make(work);
  if (verdict.defect) return verdict.defect;
  answer.nearly_unstable = verdict.nearly_unstable;
  refresh.allow(!verdict.nearly_unstable);
  return std::nullopt;
}

}  // namespace topple::solver
