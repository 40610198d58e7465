#include "reanalysis/requested_changes.h"

#include <algorithm>

namespace topple::solver {
namespace {

bool same(const BeamLoad& a, const BeamLoad& b) {
  return a.kind == b.kind && a.from == b.from && a.to == b.to && a.first == b.first && a.last == b.last &&
         a.strain == b.strain && a.curvature_y == b.curvature_y && a.curvature_z == b.curvature_z;
}

bool same(const std::vector<BeamLoad>& a, const std::vector<BeamLoad>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const BeamLoad& x, const BeamLoad& y) { return same(x, y); });
}

}  // namespace

RequestedChanges::RequestedChanges(const FrameModel& model) : shell_removed_(model.shells.size(), 0) {
  for (const Beam& beam : model.beams) targets_.push_back({beam.end_stiffness, false, 1, beam.density, {}});
}

template <class Value>
void RequestedChanges::set(std::size_t beam, Value& target, const Value& value) {
  if (target == value) return;
  target = value;
  mark_beam(static_cast<int>(beam));
}

void RequestedChanges::set_end_stiffness(std::size_t beam, std::size_t end, const Vec6& stiffness) {
  set(beam, targets_[beam].end_stiffness[end], stiffness);
}
void RequestedChanges::set_beam_removed(std::size_t beam, bool removed) { set(beam, targets_[beam].removed, removed); }
void RequestedChanges::set_beam_factor(std::size_t beam, double factor) { set(beam, targets_[beam].factor, factor); }
void RequestedChanges::set_beam_density(std::size_t beam, double density) {
  set(beam, targets_[beam].density, density);
}

void RequestedChanges::set_beam_loads(std::size_t beam, std::vector<BeamLoad> loads) {
  for (BeamLoad& load : loads) load.beam = static_cast<int>(beam);
  if (same(targets_[beam].loads, loads)) return;
  targets_[beam].loads = std::move(loads);
  mark_beam(static_cast<int>(beam));
}

void RequestedChanges::set_shell_removed(std::size_t shell, bool removed) {
  if (shell_removed(shell) == removed) return;
  shell_removed_[shell] = removed ? 1 : 0;
  mark_shell(static_cast<int>(shell));
}

bool RequestedChanges::none() const {
  return beams_.empty() && shells_.empty() && dropped_nodes_.empty() && supports_.empty() && shell_stiffness_.empty() &&
         patch_stiffness_.empty() && patch_mass_.empty();
}

void RequestedChanges::clear() {
  beams_.clear();
  shells_.clear();
  dropped_nodes_.clear();
  supports_.clear();
  shell_stiffness_.clear();
  patch_stiffness_.clear();
  patch_mass_.clear();
}

std::span<const int> RequestedChanges::sorted_beams() {
  std::sort(beams_.begin(), beams_.end());
  beams_.erase(std::unique(beams_.begin(), beams_.end()), beams_.end());
  return beams_;
}

const Mat24* RequestedChanges::stiffness_of_shell(const FrameModel& model, int shell) const {
  if (const auto next = shell_stiffness_.find(shell); next != shell_stiffness_.end()) return &next->second;
  const auto own = model.shell_stiffness.find(shell);
  return own == model.shell_stiffness.end() ? nullptr : &own->second;
}

const Eigen::MatrixXd& RequestedChanges::stiffness_of_patch(const FrameModel& model, int patch) const {
  const auto next = patch_stiffness_.find(patch);
  return next == patch_stiffness_.end() ? model.patches[static_cast<std::size_t>(patch)].stiffness : next->second;
}

const Eigen::MatrixXd& RequestedChanges::mass_of_patch(const FrameModel& model, int patch) const {
  const auto next = patch_mass_.find(patch);
  return next == patch_mass_.end() ? model.patches[static_cast<std::size_t>(patch)].mass : next->second;
}

}  // namespace topple::solver
