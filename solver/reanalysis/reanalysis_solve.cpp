// The order of things: changes, then the answer by the way that was chosen for them.
#include <utility>

#include "reanalysis/reanalysis_state.h"
#include "reanalysis/update_costs.h"
#include "reanalysis/work_count.h"

namespace topple::solver {

bool Reanalysis::State::solve_loads() {
  count_work(nodes_cost(static_cast<double>(system->model.nodes.size())));
  complete(nullptr);
  if (selective) selective->forget_utilisations();
  return solution.solve(*serving, load.vector().force, answer.quality, work);
}

void Reanalysis::State::give_up(const Defect& defect) {
  answer.stable = false;
  answer.mechanism = defect.motion;
}

const ReanalysisAnswer& Reanalysis::solve() { return state_->solve(nullptr); }

/// From what is to become of the structure to its factor.
void Reanalysis::State::apply_changes(UtilisationWatch* watch) {
  effort = {};
  whole_known = false;
  // The uses of the present answer are what a selective one starts from.
  if (watch != nullptr && selective && !selective->uses_known() && answered && stands()) read_all_utilisations(*watch);
  watched = watch != nullptr;
  solution.forget_elimination();
  apply_changes();
  answered = true;
  const bool nearly_unstable = answer.nearly_unstable;  // a property of the factor, which may stay
  answer = ReanalysisAnswer();
  answer.nearly_unstable = nearly_unstable;
  reactions.clear();
  mechanism.reset();
  const bool same_structure = touched_nodes.empty() && assembled && structure_stands;
  if (same_structure)
    ++work.counters.load_solves;
  else
    mechanism = update_structure(touched_nodes);
}

const ReanalysisAnswer& Reanalysis::State::solve(UtilisationWatch* watch) {
  work.operations = 0;
  if (!pending()) {
    ++work.counters.unchanged;
    if (watch != nullptr && answer.stable) read_all_utilisations(*watch);
    return answer;
  }
  const CountedWork work_of_answer;
  apply_changes(watch);
  find_answer(watch);
  refresh.pay(work_of_answer.so_far());
  return answer;
}

void Reanalysis::State::find_answer(UtilisationWatch* watch) {
  ++work.counters.solves;
  if (mechanism) {
    give_up(*std::exchange(mechanism, std::nullopt));
    return;
  }
  if (const auto defect = system->unbalanced_load(load.vector(), negligible_lever)) {
    give_up(*defect);
    return;
  }
  if (watch != nullptr && answer_in_part(*watch)) return;
  if (!solve_loads()) {
    if (const auto defect = refactorise()) {
      structure_stands = false;
      give_up(*defect);
      return;
    }
    (void)solve_loads();
  }
  if (watch != nullptr) read_all_utilisations(*watch);
}

}  // namespace topple::solver
