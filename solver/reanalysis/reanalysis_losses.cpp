// Beams that will be lost one at a time: the answers of many, found together.
#include "assembly/checked_index.h"
#include "reanalysis/reanalysis_state.h"

namespace topple::solver {

void Reanalysis::expect_losses(std::span<const int> beams) {
  for (const int beam : beams) (void)checked_beam(model(), beam);
  state_->expect_losses(beams);
}

/// What the present answer leaves over when the beam is gone.
BaseFactor::Loss Reanalysis::State::residual_without(int beam) {
  const auto change = [&](bool removed) {
    changes.set_beam_removed(static_cast<std::size_t>(beam), removed);
    apply_changes();
    system->reassemble(touched_nodes);
  };
  change(true);
  BaseFactor::Loss loss = solution.loss_of(beam, *serving, load.vector().force, touched_nodes);
  change(false);
  return loss;
}

void Reanalysis::State::expect_losses(std::span<const int> beams) {
  (void)solve(nullptr);
  solution.expect_nothing();
  BaseFactor* const base = serving->base();
  if (!stands() || base == nullptr || base->changed() || !solution.is_of(*system)) return;
  std::vector<BaseFactor::Loss> losses;
  for (const int beam : beams)
    if (system->beam_stands[static_cast<std::size_t>(beam)] != 0) losses.push_back(residual_without(beam));
  (void)base->plan();  // takes note that all stand again
  base->update();
  if (!base->changed()) solution.expect(*serving, losses, work);
}

}  // namespace topple::solver
