#include "reanalysis/selective_solution.h"

#include <algorithm>
#include <cmath>

#include "reanalysis/work_count.h"

namespace topple::solver {
namespace {

/// The energies are differences of sums in double precision over an answer that is itself a rounded one.
constexpr double energy_rounding = 1e-8;
/// A block by itself takes so much longer than in a pass over all.
constexpr double block_by_block = 1.5;

}  // namespace

SelectiveSolution::SelectiveSolution(const FrameSystem& system, const TriangularSolver& solver, BeamStiffness stiffness)
    : system_(system), solver_(&solver), contents_(system, solver), beam_stiffness_(std::move(stiffness)) {
  const auto blocks = static_cast<std::size_t>(solver.blocks());
  below_start_.push_back(0);
  std::size_t most_below = 0;
  for (std::size_t b = 0; b < blocks; ++b) {
    const std::size_t below = solver.block(static_cast<int>(b)).below.size();
    below_start_.push_back(below_start_.back() + static_cast<std::int64_t>(below));
    most_below = std::max(most_below, below);
  }
  older_.assign(blocks, 0);
  unread_.assign(blocks, 0);
  behind_.assign(static_cast<std::size_t>(below_start_.back()), 0.0);
  own_use_.assign(blocks, 0.0);
  bound_ = growth_ = slack_ = own_use_;
  now_.visited.assign(blocks, 0);
  now_.below.resize(most_below);
  waiting_ = now_.du = now_.past = Eigen::VectorXd::Zero(solver.size());
}

bool SelectiveSolution::set_factor(const TriangularSolver& solver) {
  if (solver.size() != solver_->size() || solver.blocks() != solver_->blocks()) return false;
  for (int k = 0; k < solver.size(); ++k)
    if (solver.row_at(k) != solver_->row_at(k)) return false;
  for (int block = 0; block < solver.blocks(); ++block) {
    const auto now = solver.block(block), before = solver_->block(block);
    if (now.first != before.first || now.columns != before.columns ||
        !std::equal(now.below.begin(), now.below.end(), before.below.begin(), before.below.end()))
      return false;
  }
  solver_ = &solver;
  return true;
}

bool SelectiveSolution::is_current(int block) const {
  if (!partial_) return true;
  for (; block >= 0; block = solver_->parent(block))
    if (older_[static_cast<std::size_t>(block)] != 0) return false;
  return true;
}

/// Adds now_.past or now_.du of the block's rows to the answer: nodes that left stay at rest.
void SelectiveSolution::add_to_solution(int block, Answer answer) {
  const auto own = solver_->block(block);
  const auto& vertex = system_.dofs().vertex_of_equation;
  for (int k = own.first; k < own.first + own.columns; ++k) {
    const int row = solver_->row_at(k);
    const auto v = static_cast<std::size_t>(vertex[static_cast<std::size_t>(row)]);
    const bool left = v < system_.node_stands.size() && system_.node_stands[v] == 0;
    answer.solution(row) = left ? 0.0 : answer.solution(row) + now_.past(k);
  }
}

void SelectiveSolution::read_nodes(int block, Answer answer) const {
  for (const int node : contents_.nodes(block))
    answer.displacements[static_cast<std::size_t>(node)] = system_.node_displacement_of_scaled(node, answer.solution);
}

/// Carries the changes that the block missed through it, and hands them on to its children.
void SelectiveSolution::bring_older(int block, Answer answer) {
  const auto b = static_cast<std::size_t>(block);
  const auto own = solver_->block(block);
  count_work(block_by_block * solver_->pass_cost(block));
  double* behind = behind_.data() + below_start_[b];
  now_.past.segment(own.first, own.columns) = waiting_.segment(own.first, own.columns);
  solver_->backward(block, now_.past.data() + own.first, behind);
  for (std::size_t i = 0; i < own.below.size(); ++i) now_.past(own.below[i]) = behind[i];
  add_to_solution(block, answer);
  for (const int child : contents_.children(block)) {
    const auto c = static_cast<std::size_t>(child);
    const auto below = solver_->block(child).below;
    double* of_child = behind_.data() + below_start_[c];
    for (std::size_t i = 0; i < below.size(); ++i) of_child[i] += now_.past(below[i]);
    older_[c] = 1;
    bound_[c] += growth_[c] * slack_[b];
    slack_[c] += slack_[b];
  }
  waiting_.segment(own.first, own.columns).setZero();
  std::fill(behind, behind + own.below.size(), 0.0);
  own_use_[b] += growth_[b] * slack_[b];
  slack_[b] = 0;
  older_[b] = 0;
}

void SelectiveSolution::complete(Answer answer, UtilisationWatch* watch) {
  if (partial_) {
    for (int block = solver_->blocks() - 1; block >= 0; --block) {
      const auto b = static_cast<std::size_t>(block);
      if (older_[b] == 0) continue;
      bring_older(block, answer);
      read_nodes(block, answer);
      unread_[b] = 1;
    }
    partial_ = false;
    any_unread_ = true;
    bound_left_out_ = 0;
  }
  if (watch != nullptr && uses_known_ && any_unread_) read_unread(*watch);
}

void SelectiveSolution::read_unread(UtilisationWatch& watch) {
  for (int block = 0; block < solver_->blocks(); ++block) {
    if (unread_[static_cast<std::size_t>(block)] != 0) read_utilisations(block, watch);
    update_bound(block);
  }
  any_unread_ = false;
}

void SelectiveSolution::note(double use) { now_.worst = std::max(now_.worst, use); }

void SelectiveSolution::read_utilisations(int block, UtilisationWatch& watch) {
  constexpr double element = 750;  // ns, of its energy and its uses
  double use = 0;
  count_work(element * static_cast<double>(contents_.beams(block).size() + contents_.shells(block).size()));
  for (const int beam : contents_.beams(block)) use = std::max(use, watch.beam_utilisation(beam));
  for (const int shell : contents_.shells(block)) use = std::max(use, watch.shell_utilisation(shell));
  own_use_[static_cast<std::size_t>(block)] = use;
  unread_[static_cast<std::size_t>(block)] = 0;
  note(use);
  effort_.beams += static_cast<int>(contents_.beams(block).size());
  effort_.shells += static_cast<int>(contents_.shells(block).size());
}

void SelectiveSolution::update_bound(int block) {
  const auto b = static_cast<std::size_t>(block);
  bound_[b] = own_use_[b];
  for (const int child : contents_.children(block))
    bound_[b] = std::max(bound_[b], bound_[static_cast<std::size_t>(child)]);
}

void SelectiveSolution::read_all(UtilisationWatch& watch) {
  now_.worst = 0;
  read_growths(watch);
  for (int block = 0; block < solver_->blocks(); ++block) {
    read_utilisations(block, watch);
    update_bound(block);
    slack_[static_cast<std::size_t>(block)] = 0;
  }
  for (const int beam : contents_.held_beams()) note(watch.beam_utilisation(beam));
  for (const int shell : contents_.held_shells()) note(watch.shell_utilisation(shell));
  uses_known_ = true;
  any_unread_ = false;
}

void SelectiveSolution::read_growths(UtilisationWatch& watch) {
  if (growths_known_) return;
  growths_known_ = true;
  for (int block = 0; block < solver_->blocks(); ++block) {
    constexpr double element = 1000;  // ns
    count_work(element * static_cast<double>(contents_.beams(block).size() + contents_.shells(block).size()));
    double& growth = growth_[static_cast<std::size_t>(block)];
    growth = 0;
    for (const int beam : contents_.beams(block)) {
      const auto i = static_cast<std::size_t>(beam);
      if (system_.beam_stands[i] == 0) continue;
      const Mat12 K = CondensedBeam(system_.model.beams[i], system_.beam_factor[i]).stiffness();
      double root[12];
      for (int k = 0; k < 12; ++k) root[k] = std::sqrt(std::max(0.0, K(k, k)));
      growth = std::max(growth, watch.beam_growth(beam, root));
    }
    for (const int shell : contents_.shells(block)) {
      if (system_.shell_stands[static_cast<std::size_t>(shell)] == 0) continue;
      const Mat24& K = system_.shell_node_stiffness(shell);
      double root[24];
      for (int k = 0; k < 24; ++k) root[k] = std::sqrt(std::max(0.0, K(k, k)));
      growth = std::max(growth, watch.shell_growth(shell, root));
    }
    for (const int child : contents_.children(block))
      growth = std::max(growth, growth_[static_cast<std::size_t>(child)]);
  }
}

/// Rows that share an element with any of these, these included.
void SelectiveSolution::reach_neighbours(std::span<const int> rows) {
  now_.near_rows.assign(rows.begin(), rows.end());
  int last = -1;
  for (const int row : rows) {
    const int vertex = system_.dofs().vertex_of_equation[static_cast<std::size_t>(row)];
    if (vertex == last) continue;
    last = vertex;
    now_.elements.clear();
    system_.elements_of_vertex(vertex, now_.elements);
    for (const int element : now_.elements) {
      for (const int e : system_.assembly_map().freedoms(static_cast<std::size_t>(element)))
        if (e >= 0 && e < system_.dofs().equations) now_.near_rows.push_back(e);
    }
  }
}

const std::vector<char>& SelectiveSolution::begin(std::span<const int> rows, Answer answer) {
  reach_neighbours(rows);
  solver_->mark_paths(now_.near_rows, now_.path);
  if (!partial_) return now_.path;
  for (int block = solver_->blocks() - 1; block >= 0; --block) {
    const auto b = static_cast<std::size_t>(block);
    if (now_.path[b] == 0 || older_[b] == 0) continue;
    bring_older(block, answer);
    read_nodes(block, answer);
  }
  return now_.path;
}

/// This change alone, in a block whose ancestors have it.
void SelectiveSolution::step_now(int block, const Eigen::VectorXd& y, Answer answer) {
  const auto own = solver_->block(block);
  count_work(block_by_block * solver_->pass_cost(block));
  for (std::size_t i = 0; i < own.below.size(); ++i) now_.below[i] = now_.du(own.below[i]);
  now_.du.segment(own.first, own.columns) = y.segment(own.first, own.columns);
  solver_->backward(block, now_.du.data() + own.first, now_.below.data());
  now_.past.segment(own.first, own.columns) = now_.du.segment(own.first, own.columns);
  add_to_solution(block, answer);
  read_nodes(block, answer);
  now_.visited[static_cast<std::size_t>(block)] = 1;
  now_.visits.push_back(block);
  effort_.entries += static_cast<double>(own.columns) * static_cast<double>(own.columns + own.below.size());
}

Vec6 SelectiveSolution::node_change(int node) const {
  const auto n = static_cast<std::size_t>(node);
  Vec6 u = Vec6::Zero();
  if (system_.node_stands[n] == 0) return u;
  for (std::size_t c = 0; c < 6; ++c) {
    const int e = system_.dofs().number[n][c];
    if (e < system_.dofs().equations)
      u(static_cast<Eigen::Index>(c)) = now_.du(solver_->position(e)) * system_.scale()[static_cast<std::size_t>(e)];
  }
  u(0) -= system_.dofs().arm[n][1] * u(5);
  u(1) += system_.dofs().arm[n][0] * u(5);
  return u;
}

double SelectiveSolution::twice_energy_of_beam(int index) const {
  const auto i = static_cast<std::size_t>(index);
  if (system_.beam_stands[i] == 0) return 0;
  const Beam& beam = system_.model.beams[i];
  const Vec6 strain =
      relative_motion(beam.length, rigid_end_displacements(beam, node_change(beam.node[0]), node_change(beam.node[1])));
  return beam_stiffness_(index).twice_energy(strain);
}

double SelectiveSolution::twice_energy_of_shell(int index) const {
  const auto i = static_cast<std::size_t>(index);
  if (system_.shell_stands[i] == 0) return 0;
  Vec24 u;
  for (int corner = 0; corner < 4; ++corner)
    u.segment<6>(6 * corner) = node_change(system_.model.shells[i].node[static_cast<std::size_t>(corner)]);
  return u.dot(system_.shell_node_stiffness(index) * u);
}

double SelectiveSolution::twice_energy_of_elements(int block) const {
  double sum = 0;
  for (const int beam : contents_.beams(block)) sum += twice_energy_of_beam(beam);
  for (const int shell : contents_.shells(block)) sum += twice_energy_of_shell(shell);
  return sum;
}

/// What the block missed of this change waits for it.
void SelectiveSolution::leave_out(int block) {
  const auto b = static_cast<std::size_t>(block);
  const auto below = solver_->block(block).below;
  double* behind = behind_.data() + below_start_[b];
  for (std::size_t i = 0; i < below.size(); ++i) behind[i] += now_.du(below[i]);
  older_[b] = 1;
  partial_ = true;
}

/// From the children of what was visited downwards, those deepest in the tree (nearest to the change) first.
void SelectiveSolution::descend(const Eigen::VectorXd& y, UtilisationWatch& watch, Answer answer) {
  now_.open.clear();
  for (const int block : now_.visits)
    for (const int child : contents_.children(block))
      if (now_.path[static_cast<std::size_t>(child)] == 0) now_.open.push_back(child);
  const auto shallower = [&](int a, int b) {
    const int first = contents_.depth(a), second = contents_.depth(b);
    return first != second ? first < second : a < b;
  };
  std::sort(now_.open.begin(), now_.open.end(), shallower);
  now_.left_out.clear();
  while (!now_.open.empty()) {
    const int block = now_.open.back();
    const auto b = static_cast<std::size_t>(block);
    now_.open.pop_back();
    const double limit = (1 - watch.margin) * (watch.largest_decides ? std::max(1.0, now_.worst) : 1.0);
    if (!(bound_[b] + growth_[b] * std::sqrt(energy_left_out()) > limit)) {
      now_.left_out.push_back(block);
      continue;
    }
    if (older_[b] != 0) bring_older(block, answer);
    step_now(block, y, answer);
    now_.remaining -= twice_energy_of_elements(block);
    read_utilisations(block, watch);
    for (const int child : contents_.children(block)) now_.open.push_back(child);
  }
}

/// Twice the energy of this change in what was not visited, at most.
double SelectiveSolution::energy_left_out() const {
  return std::max(0.0, now_.remaining) + energy_rounding * 2 * effort_.energy;
}

/// What was left out waits, with a bound of what it missed.
void SelectiveSolution::finish(const Eigen::VectorXd& y) {
  const double root = std::sqrt(energy_left_out());
  for (const int block : now_.left_out) {
    const auto b = static_cast<std::size_t>(block);
    leave_out(block);
    slack_[b] += root;
    bound_[b] += growth_[b] * root;
    bound_left_out_ = std::max(bound_left_out_, bound_[b]);
  }
  for (int block = 0; block < solver_->blocks(); ++block) {
    if (now_.visited[static_cast<std::size_t>(block)] != 0) {
      update_bound(block);
    } else {
      const auto own = solver_->block(block);
      waiting_.segment(own.first, own.columns) += y.segment(own.first, own.columns);
    }
  }
  effort_.left_out = energy_left_out() / 2;
}

void SelectiveSolution::advance(std::span<const int> rows, const Eigen::VectorXd& residual, const Eigen::VectorXd& y,
                                UtilisationWatch& watch, Answer answer) {
  effort_ = {};
  now_.visits.clear();
  now_.worst = bound_left_out_ = 0;
  std::fill(now_.visited.begin(), now_.visited.end(), 0);
  for (int block = solver_->blocks() - 1; block >= 0; --block)
    if (now_.path[static_cast<std::size_t>(block)] != 0) step_now(block, y, answer);
  now_.remaining = 0;
  for (const int row : rows) now_.remaining += residual(row) * now_.du(solver_->position(row));
  effort_.energy = now_.remaining / 2;
  for (const int block : now_.visits) {
    now_.remaining -= twice_energy_of_elements(block);
    read_utilisations(block, watch);
  }
  for (const int beam : contents_.held_beams()) note(watch.beam_utilisation(beam));
  for (const int shell : contents_.held_shells()) note(watch.shell_utilisation(shell));
  descend(y, watch, answer);
  finish(y);
}

}  // namespace topple::solver
