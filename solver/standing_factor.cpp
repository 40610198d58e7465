#include "standing_factor.h"

#include <algorithm>
#include <numeric>

namespace topple::solver {
namespace {

/// Operations that one entry of the factor costs in a triangular solve of one column, where memory sets the pace, and
/// for each further column; and those of a small dense solver, which runs at a fraction of the factorisation's rate.
constexpr double entry_cost = 10, column_cost = 3, dense_cost = 2;
/// For each entry of the small dense solver, whose condition is estimated by a few solves.
constexpr double condition_cost = 20;
/// For each entry of the changes' columns in one solve.
constexpr double correction_cost = 4;
/// For each row that two columns share on their paths, when their product is made.
constexpr double product_cost = 3;

void sort_unique(std::vector<int>& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

}  // namespace

StandingFactor::StandingFactor(const FrameSystem& system) : system_(system) {
  for (int node = 0; node < static_cast<int>(system.model.nodes.size()); ++node) {
    if (system.dofs().diaphragm_of_node[static_cast<std::size_t>(node)] >= 0) {
      diaphragm_node_before_.emplace(node, system.supports_and_inert_rotations(node));
      continue;
    }
    const auto own = system.own_stiffness(node);
    if ((own.array() != 0).any()) node_before_.emplace(node, own);
  }
}

void StandingFactor::serve(const Factor& factor) {
  solver_.emplace(factor);
  correction_.emplace(*solver_);
}

void StandingFactor::remember_beam(int beam) {
  if (!beam_before_.contains(beam)) beam_before_.emplace(beam, beam_mode_stiffness(system_, beam));
  stale_beams_.push_back(beam);
}

void StandingFactor::remember_shell(int shell) {
  shell_before_.emplace(shell, system_.shell_stands[static_cast<std::size_t>(shell)]);
  know_modes(shell);
}

/// What it strains by does not change: found once, while it stands.
void StandingFactor::know_modes(int shell) {
  if (system_.shell_stands[static_cast<std::size_t>(shell)] != 0 && !shell_modes_.contains(shell))
    shell_modes_.emplace(shell, shell_modes(system_, system_.shell_stiffness(shell), shell));
}

bool StandingFactor::remember_plate(std::size_t element) {
  if (element < system_.element_of_patch(0) &&
      shell_before_.contains(static_cast<int>(element - system_.element_of_shell(0))))
    return false;
  if (!plate_before_.contains(element)) plate_before_.emplace(element, system_.plate_stiffness(element));
  return true;
}

bool StandingFactor::inside_dropped(std::span<const int> nodes) const {
  return std::all_of(nodes.begin(), nodes.end(),
                     [&](int n) { return std::binary_search(dropped_.begin(), dropped_.end(), n); });
}

void StandingFactor::want(Key key, const Eigen::Ref<const Eigen::MatrixXd>& D) {
  const auto known = wanted_.find(key);
  if (known != wanted_.end()) {
    if (known->second.D.size() == D.size() && known->second.D == D) return;
    known->second.D = D;
    known->second.set = false;
  } else if ((D.array() != 0).any()) {
    wanted_.emplace(key, Wanted{D, false});
  }
}

void StandingFactor::plan_beam(int beam, const Mat6& before) {
  const auto& nodes = system_.model.beams[static_cast<std::size_t>(beam)].node;
  Mat6 D = Mat6::Zero();
  if (!inside_dropped(nodes)) D = beam_mode_stiffness(system_, beam) - before;
  want({Kind::beam, beam}, D);
}

void StandingFactor::plan_beams() {
  if (dropped_more_) {
    for (const auto& [beam, before] : beam_before_) plan_beam(beam, before);
  } else {
    for (const int beam : stale_beams_) plan_beam(beam, beam_before_.at(beam));
  }
  stale_beams_.clear();
}

void StandingFactor::plan_shells() {
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
std::vector<int> StandingFactor::equations_of(std::size_t element) const {
  const auto freedoms = system_.scatter().freedoms(element);
  std::vector<int> kept;
  for (std::size_t k = 0; k < freedoms.size(); ++k)
    if (freedoms[k] < system_.dofs().equations) kept.push_back(static_cast<int>(k));
  return kept;
}

/// A change of any shape is one of all the element's freedoms, each a column of its own.
void StandingFactor::plan_plates() {
  for (const auto& [element, before] : plate_before_) {
    const std::vector<int> kept = equations_of(element);
    const auto freedoms = system_.scatter().freedoms(element);
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
bool StandingFactor::plan_nodes() {
  sort_unique(touched_);
  for (const int node : touched_) {
    const auto n = static_cast<std::size_t>(node);
    const bool dropped = inside_dropped(std::span(&node, 1));
    if (system_.dofs().diaphragm_of_node[n] >= 0) {
      // Its own equations alone: what it shares with the diaphragm is not corrected for.
      if (dropped || diaphragm_node_before_.at(node) != system_.supports_and_inert_rotations(node)) return false;
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
void StandingFactor::plan_grounds() {
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

ElementModes StandingFactor::modes(Key key) const {
  if (key.kind == Kind::beam) return beam_modes(system_, key.index);
  if (key.kind == Kind::shell) return shell_modes_.at(key.index);
  if (key.kind == Kind::plate) {
    const auto element = static_cast<std::size_t>(key.index);
    ElementModes own;
    for (const int place : equations_of(element))
      own.rows.push_back(system_.scatter().freedoms(element)[static_cast<std::size_t>(place)]);
    const auto count = static_cast<Eigen::Index>(own.rows.size());
    own.B = Eigen::MatrixXd::Identity(count, count);
    return own;
  }
  return node_modes(system_, key.index);
}

StandingFactor::Plan StandingFactor::plan() {
  Plan plan;
  sort_unique(dropped_);
  plan_beams();
  plan_shells();
  plan_plates();
  if (!plan_nodes()) return plan;
  if (dropped_more_) plan_grounds();
  dropped_more_ = false;
  plan.possible = true;
  double new_columns = 0, path_cost = 0;
  std::vector<int> new_rows;
  for (const auto& [key, wanted] : wanted_) {
    if (!wanted.active()) continue;
    plan.rank += static_cast<int>(wanted.D.cols());
    if (place_.contains(key)) continue;
    const ElementModes m = modes(key);
    const EliminationPath path = solver_->path(m.rows);
    const auto columns = static_cast<double>(wanted.D.cols());
    path_cost += column_cost * columns * solver_->entries(path);
    path_cost += product_cost * columns * path.rows() * (plan.rank + columns);
    new_rows.insert(new_rows.end(), m.rows.begin(), m.rows.end());
    new_columns += columns;
  }
  // Blocks that several paths share are read once.
  if (new_columns > 0) path_cost += entry_cost * solver_->entries_on_paths(new_rows, marked_);
  double kept = correction_->active_rank();
  for (const auto& [key, place] : place_)
    if (!wanted_.at(key).set) kept = std::min<double>(kept, correction_->rank_before(place));
  const double rank = plan.rank;
  kept = std::min(kept, rank);
  const auto dense = [](double columns) {
    return dense_cost * columns * columns * columns + condition_cost * columns * columns;
  };
  plan.operations = path_cost + dense(rank) - dense_cost * kept * kept * kept + solve_operations();
  if (kept > 0)
    plan.carried = dense(rank) - dense_cost * kept * kept * kept - dense(rank - kept) +
                   correction_cost * correction_->entries() * kept / rank;
  return plan;
}

/// What was restored is as the factor has it: no need to look at it again until it changes again.
void StandingFactor::forget_unchanged(std::optional<Eigen::Index> kept) {
  const std::vector<int> number = kept ? correction_->forget_unchanged(*kept) : correction_->forget_unchanged();
  if (number.empty()) return;
  for (auto place = place_.begin(); place != place_.end();) {
    place->second = number[static_cast<std::size_t>(place->second)];
    if (place->second >= 0) {
      ++place;
      continue;
    }
    wanted_.erase(place->first);
    // A beam inside a part that left stays known: it holds the part together.
    if (place->first.kind == Kind::beam &&
        !inside_dropped(system_.model.beams[static_cast<std::size_t>(place->first.index)].node))
      beam_before_.erase(place->first.index);
    place = place_.erase(place);
  }
}

void StandingFactor::update() {
  for (const auto& [key, place] : place_) {
    Wanted& wanted = wanted_.at(key);
    if (!wanted.set) correction_->set(place, wanted.D);
    wanted.set = true;
  }
  forget_unchanged();
  for (const auto& [key, wanted] : wanted_) {
    if (wanted.set || !wanted.active()) continue;
    const ElementModes m = modes(key);
    place_.emplace(key, correction_->add(m.rows, m.B));
  }
  correction_->finish_adding();
  for (const auto& [key, place] : place_) {
    Wanted& wanted = wanted_.at(key);
    if (!wanted.set) correction_->set(place, wanted.D);
    wanted.set = true;
  }
  correction_->update();
}

void StandingFactor::solve(Eigen::VectorXd& x, const std::vector<int>* rows) const {
  solver_->permute(x, eliminated_);
  if (rows != nullptr) {
    solver_->mark_paths(*rows, marked_);
    solver_->forward(eliminated_, &marked_);
  } else {
    solver_->forward(eliminated_);
  }
  correction_->correct(eliminated_);
  solver_->backward(eliminated_);
  solver_->restore(eliminated_, x);
  forget_dropped(x);
}

void StandingFactor::forget_dropped(Eigen::VectorXd& x) const {
  for (const int node : dropped_) {
    const auto n = static_cast<std::size_t>(node);
    for (int e = system_.dofs().first_equation[n]; e < system_.dofs().first_equation[n + 1]; ++e) x(e) = 0;
  }
}

void StandingFactor::solve_on_paths(Eigen::VectorXd& x, const std::vector<int>& rows, std::vector<char>& known) const {
  solver_->permute(x, eliminated_);
  solver_->mark_paths(rows, marked_);
  solver_->forward(eliminated_, &marked_);
  correction_->correct(eliminated_);
  solver_->backward(eliminated_, &marked_);
  solver_->restore(eliminated_, x);
  known.resize(static_cast<std::size_t>(x.size()));
  for (Eigen::Index row = 0; row < x.size(); ++row) {
    known[static_cast<std::size_t>(row)] = marked_[static_cast<std::size_t>(solver_->block_of(static_cast<int>(row)))];
    if (known[static_cast<std::size_t>(row)] == 0) x(row) = 0;
  }
  forget_dropped(x);
}

void StandingFactor::forward(const Eigen::VectorXd& x, const std::vector<char>& marked, Eigen::VectorXd& y) const {
  solver_->permute(x, y);
  solver_->forward(y, &marked);
  correction_->correct(y);
}

Eigen::MatrixXd StandingFactor::solve_without(std::span<const Loss> losses) {
  forget_unchanged(0);
  std::vector<int> places;
  std::vector<Eigen::MatrixXd> y;
  for (const Loss& loss : losses) {
    ElementModes m = beam_modes(system_, loss.beam);
    // Every row of the residual on one path with those of the modes.
    const auto own = m.B.rows();
    m.B.conservativeResize(own + static_cast<Eigen::Index>(loss.rows.size()), Eigen::NoChange);
    m.B.bottomRows(static_cast<Eigen::Index>(loss.rows.size())).setZero();
    m.rows.insert(m.rows.end(), loss.rows.begin(), loss.rows.end());
    places.push_back(correction_->add(m.rows, m.B));
    const Key key{Kind::beam, loss.beam};
    place_.emplace(key, places.back());
    wanted_.insert_or_assign(key, Wanted{Mat6::Zero(), true});
    const EliminationPath& path = correction_->path(places.back());
    Eigen::MatrixXd column = Eigen::MatrixXd::Zero(path.rows(), 1);
    for (std::size_t i = 0; i < loss.rows.size(); ++i)
      column(solver_->row_on_path(path, loss.rows[i])) = loss.residual(static_cast<Eigen::Index>(i));
    y.push_back(std::move(column));
  }
  std::vector<PathColumns> also;
  for (std::size_t j = 0; j < losses.size(); ++j) also.push_back({&correction_->path(places[j]), &y[j]});
  correction_->finish_adding(also);
  Eigen::MatrixXd Y = Eigen::MatrixXd::Zero(solver_->size(), std::ssize(losses));
  Eigen::VectorXd on_path, whole;
  for (std::size_t j = 0; j < losses.size(); ++j) {
    on_path = y[j].col(0);
    if (!correction_->correct_alone(places[j], -beam_mode_stiffness(system_, losses[j].beam), on_path)) continue;
    whole.setZero(solver_->size());
    const double minus = -1;
    solver_->subtract(correction_->path(places[j]), on_path, &minus, whole);
    Y.col(static_cast<Eigen::Index>(j)) = whole;
  }
  solver_->backward(Y);
  for (Eigen::Index j = 0; j < Y.cols(); ++j) {
    on_path = Y.col(j);
    solver_->restore(on_path, whole);
    Y.col(j) = whole;
  }
  return Y;
}

Eigen::VectorXd StandingFactor::softest_motion() const {
  Eigen::VectorXd y = correction_->softest_motion(), x;
  solver_->backward(y);
  solver_->restore(y, x);
  const double norm = x.norm();
  if (norm > 0) x /= norm;
  return x;
}

double StandingFactor::solve_operations() const {
  return 2 * entry_cost * solver_->entries() + correction_cost * correction_->entries();
}

}  // namespace topple::solver
