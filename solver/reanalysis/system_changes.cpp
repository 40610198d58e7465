#include "reanalysis/system_changes.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace topple::solver {
namespace {

void sort_unique(std::vector<int>& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

}  // namespace

SystemChanges::SystemChanges(const FrameSystem& system) : system_(system) {
  for (int node = 0; node < static_cast<int>(system.model.nodes.size()); ++node) {
    if (system.dofs().diaphragm_of_node[static_cast<std::size_t>(node)] >= 0) {
      diaphragm_node_before_.emplace(node, system.supports_and_inert_motions(node));
      continue;
    }
    const auto own = system.own_stiffness(node);
    if ((own.array() != 0).any()) node_before_.emplace(node, own);
  }
}

void SystemChanges::remember_beam(int beam) {
  if (!beam_before_.contains(beam)) beam_before_.emplace(beam, beam_mode_stiffness(system_, beam));
  stale_beams_.push_back(beam);
}

void SystemChanges::remember_shell(int shell) {
  shell_before_.emplace(shell, system_.shell_stands[static_cast<std::size_t>(shell)]);
  find_shell_modes(shell);
}

/// What it strains by does not change: found once, while it stands.
void SystemChanges::find_shell_modes(int shell) {
  if (system_.shell_stands[static_cast<std::size_t>(shell)] != 0 && !shell_modes_.contains(shell))
    shell_modes_.emplace(shell, shell_modes(system_, system_.shell_stiffness(shell), shell));
}

void SystemChanges::drop_node(int node) {
  dropped_.push_back(node);
  dropped_more_ = true;
}

bool SystemChanges::remember_plate(std::size_t element) {
  if (element < system_.element_of_patch(0) &&
      shell_before_.contains(static_cast<int>(element - system_.element_of_shell(0))))
    return false;
  if (!plate_before_.contains(element)) plate_before_.emplace(element, system_.plate_stiffness(element));
  return true;
}

bool SystemChanges::inside_dropped(std::span<const int> nodes) const {
  return std::all_of(nodes.begin(), nodes.end(),
                     [&](int n) { return std::binary_search(dropped_.begin(), dropped_.end(), n); });
}

ElementModes SystemChanges::modes(Place place) const {
  if (place.kind == Kind::beam) return beam_modes(system_, place.index);
  if (place.kind == Kind::shell) return shell_modes_.at(place.index);
  if (place.kind == Kind::plate) {
    const auto element = static_cast<std::size_t>(place.index);
    ElementModes own;
    for (const int equation : equations_of(element))
      own.rows.push_back(system_.assembly_map().freedoms(element)[static_cast<std::size_t>(equation)]);
    const auto count = static_cast<Eigen::Index>(own.rows.size());
    own.B = Eigen::MatrixXd::Identity(count, count);
    return own;
  }
  return node_modes(system_, place.index);
}

void SystemChanges::set(Place place, const Eigen::Ref<const Eigen::MatrixXd>& D) {
  const auto known = changes_.find(place);
  if (known != changes_.end()) {
    if (known->second.D.size() == D.size() && known->second.D == D) return;
    known->second.D = D;
    known->second.extracted = false;
  } else if ((D.array() != 0).any()) {
    changes_.emplace(place, Change{D, false});
  }
}

void SystemChanges::compare_beam(int beam, const BeamModeMatrix& before) {
  const auto& nodes = system_.model.beams[static_cast<std::size_t>(beam)].node;
  BeamModeMatrix D = BeamModeMatrix::Zero(before.rows(), before.cols());
  if (!inside_dropped(nodes)) D = beam_mode_stiffness(system_, beam) - before;
  set({Kind::beam, beam}, D);
}

void SystemChanges::compare_beams() {
  if (dropped_more_) {
    for (const auto& [beam, before] : beam_before_) compare_beam(beam, before);
  } else {
    for (const int beam : stale_beams_) compare_beam(beam, beam_before_.at(beam));
  }
  stale_beams_.clear();
}

void SystemChanges::compare_shells() {
  for (const auto& [shell, before] : shell_before_) {
    const auto s = static_cast<std::size_t>(shell);
    const bool inside = inside_dropped(system_.model.shells[s].node);
    find_shell_modes(shell);
    const double change = inside ? 0.0 : (system_.shell_stands[s] != 0 ? 1.0 : 0.0) - (before != 0 ? 1.0 : 0.0);
    const auto known = changes_.find({Kind::shell, shell});
    if (change == 0 && known == changes_.end()) continue;
    const Eigen::Index count = shell_modes_.at(shell).B.cols();
    set({Kind::shell, shell}, change * Eigen::MatrixXd::Identity(count, count));
  }
}

/// Places among an element's freedoms of those that are equations.
std::vector<int> SystemChanges::equations_of(std::size_t element) const {
  const auto freedoms = system_.assembly_map().freedoms(element);
  std::vector<int> kept;
  for (std::size_t k = 0; k < freedoms.size(); ++k)
    if (freedoms[k] < system_.dofs().equations) kept.push_back(static_cast<int>(k));
  return kept;
}

/// A change of any shape is one of all the element's freedoms, each a column of its own.
void SystemChanges::compare_plates() {
  for (const auto& [element, before] : plate_before_) {
    const std::vector<int> kept = equations_of(element);
    const auto freedoms = system_.assembly_map().freedoms(element);
    const auto size = static_cast<Eigen::Index>(kept.size());
    Eigen::MatrixXd D = Eigen::MatrixXd::Zero(size, size);
    if (!inside_dropped(system_.plate_nodes(element))) {
      const Eigen::MatrixXd change = system_.plate_stiffness(element) - before;
      const auto scale = [&](Eigen::Index i) {
        const int place = kept[static_cast<std::size_t>(i)];
        return system_.scale()[static_cast<std::size_t>(freedoms[static_cast<std::size_t>(place)])];
      };
      for (Eigen::Index i = 0; i < size; ++i)
        for (Eigen::Index j = 0; j < size; ++j)
          D(i, j) = change(kept[static_cast<std::size_t>(i)], kept[static_cast<std::size_t>(j)]) * scale(i) * scale(j);
    }
    set({Kind::plate, static_cast<int>(element)}, D);
  }
}

/// What nodes have besides their elements: springs of supports, held rotations. False where a diaphragm shares it.
bool SystemChanges::compare_nodes() {
  sort_unique(touched_);
  for (const int node : touched_) {
    const auto n = static_cast<std::size_t>(node);
    const bool dropped = inside_dropped(std::span(&node, 1));
    if (system_.dofs().diaphragm_of_node[n] >= 0) {
      // Its own equations alone: what it shares with the diaphragm is not corrected for.
      if (dropped || diaphragm_node_before_.at(node) != system_.supports_and_inert_motions(node)) return false;
      continue;
    }
    FrameSystem::NodeMatrix D = system_.own_stiffness(node);
    if (dropped) D.setZero();
    const auto before = node_before_.find(node);
    if (before != node_before_.end() && !dropped) D -= before->second;
    set({Kind::node, node}, D);
  }
  touched_.clear();
  return true;
}

/// One node of each dropped part that held together is held, so that the part is not loose.
void SystemChanges::hold_dropped_parts() {
  for (auto& [place, change] : changes_) {
    if (place.kind != Kind::ground) continue;
    change.D.setZero();
    change.extracted = false;
  }
  std::vector<int> part(dropped_.size());
  std::iota(part.begin(), part.end(), 0);
  const auto index = [&](int node) {
    return static_cast<int>(std::lower_bound(dropped_.begin(), dropped_.end(), node) - dropped_.begin());
  };
  const auto find = [&](int i) {
    while (part[static_cast<std::size_t>(i)] != i) i = part[static_cast<std::size_t>(i)];
    return i;
  };
  const auto join = [&](std::span<const int> nodes) {
    for (const int node : nodes.subspan(1)) {
      const int a = find(index(nodes[0])), b = find(index(node));
      part[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
    }
  };
  for (const auto& [beam, before] : beam_before_) {
    const auto& nodes = system_.model.beams[static_cast<std::size_t>(beam)].node;
    if ((before.array() != 0).any() && inside_dropped(nodes)) join(nodes);
  }
  for (const auto& [shell, before] : shell_before_) {
    const auto& nodes = system_.model.shells[static_cast<std::size_t>(shell)].node;
    if (before != 0 && inside_dropped(nodes)) join(nodes);
  }
  for (const auto& [element, before] : plate_before_)
    if ((before.array() != 0).any() && inside_dropped(system_.plate_nodes(element))) join(system_.plate_nodes(element));
  for (std::size_t i = 0; i < dropped_.size(); ++i) {
    if (find(static_cast<int>(i)) != static_cast<int>(i)) continue;
    const auto n = static_cast<std::size_t>(dropped_[i]);
    const Eigen::Index count = system_.dofs().first_equation[n + 1] - system_.dofs().first_equation[n];
    set({Kind::ground, dropped_[i]}, Eigen::MatrixXd::Identity(count, count));
  }
}

const Eigen::MatrixXd* SystemChanges::extract_changed(Place place) {
  Change& change = changes_.at(place);
  return std::exchange(change.extracted, true) ? nullptr : &change.D;
}

SystemChanges::Place SystemChanges::add_unchanged(int beam, Eigen::Index columns) {
  const Place place{Kind::beam, beam};
  changes_.insert_or_assign(place, Change{Eigen::MatrixXd::Zero(columns, columns), true});
  return place;
}

void SystemChanges::forget(Place place) {
  changes_.erase(place);
  // A beam inside a part that left stays known: it holds the part together.
  if (place.kind == Kind::beam && !inside_dropped(system_.model.beams[static_cast<std::size_t>(place.index)].node))
    beam_before_.erase(place.index);
}

bool SystemChanges::compare() {
  sort_unique(dropped_);
  compare_beams();
  compare_shells();
  compare_plates();
  if (!compare_nodes()) return false;
  if (dropped_more_) hold_dropped_parts();
  dropped_more_ = false;
  return true;
}

void SystemChanges::clear_dropped(Eigen::VectorXd& x) const {
  for (const int node : dropped_) {
    const auto n = static_cast<std::size_t>(node);
    for (int e = system_.dofs().first_equation[n]; e < system_.dofs().first_equation[n + 1]; ++e) x(e) = 0;
  }
}

}  // namespace topple::solver
