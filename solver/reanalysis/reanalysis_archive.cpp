// The state of a Reanalysis as bytes, and back.
#include <istream>
#include <ostream>
#include <utility>

#include "description_archive.h"
#include "reanalysis/factor_archive.h"
#include "reanalysis/reanalysis_state.h"
#include "state_archive.h"

namespace topple::solver {

void Reanalysis::State::save_to(std::ostream& to) const {
  StateWriter archive(to);
  // Options, and when the factor follows, are the constructor's; strain forces are found again with the same bits;
  // touched nodes are scratch.
  const auto& [own_system, given_options, own_changes, own_load, own_strain_forces, own_serving, own_refresh,
               own_solution, own_selective, is_assembled, stands_now, has_answer, defect, last_answer, last_effort,
               is_watched, whole, is_whole, at_supports, counted, touched, when_asked, lags] = *this;
  archive_changes(archive, own_system->model);
  archive(*own_system, own_changes, own_load);
  own_serving->save(archive);
  own_refresh.save(archive, *own_system);
  archive(own_solution, own_selective != nullptr);
  if (own_selective) archive(*own_selective);
  archive(is_assembled, stands_now, has_answer, defect, last_answer, last_effort, is_watched, is_whole, lags);
  if (is_whole) archive(whole);
  archive(at_supports, counted);
}

void Reanalysis::State::load_from(std::istream& from) {
  StateReader archive(from);
  FrameModel model = system->model;
  archive_changes(archive, model);
  selective.reset();
  refresh.drop();
  renumber(std::move(model));
  archive(*system, changes, load);
  strain_forces = KeptStrainForces(system->model.beams.size());
  serving->load(archive);
  refresh.load(archive, *system, serving->order(), options);
  bool in_part = false;
  archive(solution, in_part);
  if (in_part) {
    begin_selective();
    archive(*selective);
  }
  archive(assembled, structure_stands, answered, mechanism, answer, effort, watched, whole_known, factor_lags);
  if (whole_known) archive(whole_displacements);
  archive(reactions, work);
}

void Reanalysis::save_state(std::ostream& to) const { state_->save_to(to); }
void Reanalysis::load_state(std::istream& from) { state_->load_from(from); }

}  // namespace topple::solver
