// What a base factor would have to correct: the changes compared with what it remembers, and what that costs.
#include <algorithm>
#include <numeric>

#include "reanalysis/base_factor.h"

namespace topple::solver {
namespace {

/// Operations that one entry of the factor costs in a triangular solve of one column, where memory sets the pace, and
/// for each further column; and those of a small dense solver, which runs at a fraction of the factorisation's rate.
constexpr double entry_cost = 10, column_cost = 3, dense_cost = 2;
/// For each entry of the small dense solver, whose condition is estimated by a few solves.
constexpr double condition_cost = 20;
/// For each row that two columns share on their paths, when their product is made.
constexpr double product_cost = 3;

double operations_of(const CorrectionWork& work) {
  return column_cost * work.path_products + product_cost * work.pair_products + entry_cost * work.shared_entries +
         dense_cost * (work.rank * work.rank * work.rank - work.kept * work.kept * work.kept) +
         condition_cost * work.rank * work.rank;
}

void sort_unique(std::vector<int>& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

}  // namespace

void BaseFactor::want(Key key, const Eigen::Ref<const Eigen::MatrixXd>& D) {
  const auto known = wanted_.find(key);
  if (known != wanted_.end()) {
    if (known->second.D.size() == D.size() && known->second.D == D) return;
    known->second.D = D;
    known->second.set = false;
  } else if ((D.array() != 0).any()) {
    wanted_.emplace(key, Wanted{D, false});
  }
}

void BaseFactor::plan_beam(int beam, const BeamModeMatrix& before) {
  const auto& nodes = system_.model.beams[static_cast<std::size_t>(beam)].node;
  BeamModeMatrix D = BeamModeMatrix::Zero(before.rows(), before.cols());
  if (!inside_dropped(nodes)) D = beam_mode_stiffness(system_, beam) - before;
  want({Kind::beam, beam}, D);
}

void BaseFactor::plan_beams() {
  if (dropped_more_) {
    for (const auto& [beam, before] : beam_before_) plan_beam(beam, before);
  } else {
    for (const int beam : stale_beams_) plan_beam(beam, beam_before_.at(beam));
  }
  stale_beams_.clear();
}

void BaseFactor::plan_shells() {
  for (const auto& [shell, before] : shell_before_) {
    const auto s = static_cast<std::size_t>(shell);
    const bool inside = inside_dropped(system_.model.shells[s].node);
    know_modes(shell);
    const double change = inside ? 0.0 : (system_.shell_stands[s] != 0 ? 1.0 : 0.0) - (before != 0 ? 1.0 : 0.0);
    const auto known = wanted_.find({Kind::shell, shell});
    if (change == 0 && known == wanted_.end()) continue;
    const Eigen::Index count = shell_modes_.at(shell).B.cols();
    want({Kind::shell, shell}, change * Eigen::MatrixXd::Identity(count, count));
  }
}

/// Places among an element's freedoms of those that are equations.
std::vector<int> BaseFactor::equations_of(std::size_t element) const {
  const auto freedoms = system_.assembly_map().freedoms(element);
  std::vector<int> kept;
  for (std::size_t k = 0; k < freedoms.size(); ++k)
    if (freedoms[k] < system_.dofs().equations) kept.push_back(static_cast<int>(k));
  return kept;
}

/// A change of any shape is one of all the element's freedoms, each a column of its own.
void BaseFactor::plan_plates() {
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
    want({Kind::plate, static_cast<int>(element)}, D);
  }
}

/// What nodes have besides their elements: springs of supports, held rotations. False where a diaphragm shares it.
bool BaseFactor::plan_nodes() {
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
    want({Kind::node, node}, D);
  }
  touched_.clear();
  return true;
}

/// One node of each dropped part that held together is held, so that the part is not loose.
void BaseFactor::plan_grounds() {
  for (auto& [key, wanted] : wanted_) {
    if (key.kind != Kind::ground) continue;
    wanted.D.setZero();
    wanted.set = false;
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
    want({Kind::ground, dropped_[i]}, Eigen::MatrixXd::Identity(count, count));
  }
}

BaseFactor::Plan BaseFactor::plan() {
  Plan plan;
  sort_unique(dropped_);
  plan_beams();
  plan_shells();
  plan_plates();
  if (!plan_nodes()) return plan;
  if (dropped_more_) plan_grounds();
  dropped_more_ = false;
  plan.possible = true;
  CorrectionWork& work = plan.work;
  std::vector<int> new_rows;
  double before = 0;  // active places so far
  for (const auto& [key, wanted] : wanted_) {
    if (!wanted.active()) continue;
    const auto columns = static_cast<double>(wanted.D.cols());
    plan.rank += static_cast<int>(columns);
    ++before;
    if (place_.contains(key)) continue;
    const ElementModes& m = planned_.try_emplace(key, modes(key)).first->second;
    const EliminationPath path = solver_->path(m.rows);
    ++work.places;
    work.path_blocks += static_cast<double>(path.block.size());
    work.path_products += columns * solver_->entries(path);
    work.pairs += before;
    work.pair_products += columns * path.rows() * plan.rank;
    work.column_entries += columns * path.rows();
    new_rows.insert(new_rows.end(), m.rows.begin(), m.rows.end());
  }
  // Blocks that several paths share are read once.
  if (work.places > 0) work.shared_entries = solver_->entries_on_paths(new_rows, marked_);
  work.column_entries += correction_->entries();
  work.rank = plan.rank;
  work.kept = correction_->active_rank();
  for (const auto& [key, place] : place_)
    if (!wanted_.at(key).set) work.kept = std::min<double>(work.kept, correction_->rank_before(place));
  work.kept = std::min(work.kept, work.rank);
  work.solve = {solver_->entries(), static_cast<double>(solver_->blocks())};
  plan.operations = operations_of(work) + solve_operations();
  return plan;
}

}  // namespace topple::solver
