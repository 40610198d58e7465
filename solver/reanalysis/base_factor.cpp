#include "reanalysis/base_factor.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace topple::solver {
namespace {

/// Operations that one entry of the factor costs in a triangular solve, and one entry of the changes' columns.
constexpr double entry_operations = 10, correction_operations = 4;

}  // namespace

BaseFactor::BaseFactor(const FrameSystem& system) : system_(system), changes_(system) {}

void BaseFactor::install(const Factor& factor) { install(TriangularSolver(factor)); }

void BaseFactor::install(TriangularSolver triangles) {
  solver_.emplace(std::move(triangles));
  correction_.emplace(*solver_);
}

BaseFactor::CaughtUp BaseFactor::catch_up(int places) {
  const Plan whole = plan();
  if (!whole.possible) return {};
  const std::size_t all = planned_.size(), extracted = std::min(all, static_cast<std::size_t>(places));
  while (planned_.size() > extracted) planned_.erase(std::prev(planned_.end()));
  for (const auto& [place, modes] : planned_) number_.emplace(place, correction_->add(modes.rows, modes.B));
  planned_.clear();
  correction_->finish_adding();
  apply_changes();
  correction_->update();
  const double share = all == 0 ? 0.0 : static_cast<double>(extracted) / static_cast<double>(all);
  return {extracted == all, share * (whole.operations - solve_operations())};
}

/// What was restored is as the factor has it.
void BaseFactor::forget_unchanged(std::optional<Eigen::Index> kept) {
  const std::vector<int> renumbered = kept ? correction_->forget_unchanged(*kept) : correction_->forget_unchanged();
  if (renumbered.empty()) return;
  for (auto place = number_.begin(); place != number_.end();) {
    place->second = renumbered[static_cast<std::size_t>(place->second)];
    if (place->second >= 0) {
      ++place;
      continue;
    }
    changes_.forget(place->first);
    place = number_.erase(place);
  }
}

/// Takes what changed over, and adds what changed for the first time.
void BaseFactor::add_planned() {
  apply_changes();
  forget_unchanged();
  for (const auto& [place, change] : changes_.all()) {
    if (change.extracted || !change.active()) continue;
    const ElementModes& m = planned_.at(place);
    number_.emplace(place, correction_->add(m.rows, m.B));
  }
  planned_.clear();
}

void BaseFactor::apply_changes() {
  for (const auto& [place, number] : number_)
    if (const Eigen::MatrixXd* const D = changes_.extract_changed(place); D != nullptr) correction_->set(number, *D);
}

void BaseFactor::update() {
  add_planned();
  correction_->finish_adding();
  apply_changes();
  correction_->update();
}

void BaseFactor::update(std::span<const int> rows, const Eigen::VectorXd& right_hand_side) {
  add_planned();
  solver_->permute(right_hand_side, along_);
  solver_->mark_paths(rows, marked_);
  correction_->finish_adding({}, &along_, &marked_);
  apply_changes();
  correction_->update();
}

void BaseFactor::solve(Eigen::VectorXd& x, const std::vector<int>* rows) const {
  solver_->permute(x, eliminated_);
  if (rows != nullptr) {
    solver_->mark_paths(*rows, marked_);
    solver_->forward(eliminated_, &marked_);
  } else {
    solver_->forward(eliminated_);
  }
  finish_solve(x);
}

void BaseFactor::forward_along(Eigen::VectorXd& y) const {
  y = along_;
  correction_->correct(y);
}

void BaseFactor::solve_along(Eigen::VectorXd& x) const {
  eliminated_ = along_;
  finish_solve(x);
}

/// From the eliminated right-hand side to the answer.
void BaseFactor::finish_solve(Eigen::VectorXd& x) const {
  correction_->correct(eliminated_);
  solver_->backward(eliminated_);
  solver_->restore(eliminated_, x);
  changes_.clear_dropped(x);
}

/// All columns as far as the backward solve, in columns_.
void BaseFactor::eliminate(const Eigen::MatrixXd& X, const std::vector<int>& rows) const {
  columns_.resize(X.rows(), X.cols());
  for (Eigen::Index j = 0; j < X.cols(); ++j) {
    column_ = X.col(j);
    solver_->permute(column_, eliminated_);
    columns_.col(j) = eliminated_;
  }
  solver_->mark_paths(rows, marked_);
  solver_->forward(columns_, &marked_);
  for (Eigen::Index j = 0; j < X.cols(); ++j) {
    eliminated_ = columns_.col(j);
    correction_->correct(eliminated_);
    columns_.col(j) = eliminated_;
  }
}

void BaseFactor::restore(Eigen::MatrixXd& X) const {
  for (Eigen::Index j = 0; j < X.cols(); ++j) {
    eliminated_ = columns_.col(j);
    solver_->restore(eliminated_, column_);
    changes_.clear_dropped(column_);
    X.col(j) = column_;
  }
}

void BaseFactor::solve(Eigen::MatrixXd& X, const std::vector<int>& rows) const {
  eliminate(X, rows);
  solver_->backward(columns_);
  restore(X);
}

void BaseFactor::solve_on_paths(Eigen::MatrixXd& X, const std::vector<int>& rows, std::vector<char>& known) const {
  eliminate(X, rows);
  solver_->backward(columns_, &marked_);
  restore(X);
  known.resize(static_cast<std::size_t>(X.rows()));
  for (Eigen::Index row = 0; row < X.rows(); ++row) {
    known[static_cast<std::size_t>(row)] = marked_[static_cast<std::size_t>(solver_->block_of(static_cast<int>(row)))];
    if (known[static_cast<std::size_t>(row)] == 0) X.row(row).setZero();
  }
}

void BaseFactor::forward(const Eigen::VectorXd& x, const std::vector<char>& marked, Eigen::VectorXd& y) const {
  solver_->permute(x, y);
  solver_->forward(y, &marked);
  correction_->correct(y);
}

Eigen::MatrixXd BaseFactor::solve_without(std::span<const Loss> losses) {
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
    number_.emplace(changes_.add_unchanged(loss.beam, m.B.cols()), places.back());
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

Eigen::VectorXd BaseFactor::softest_motion() const {
  Eigen::VectorXd y = correction_->softest_motion(), x;
  solver_->backward(y);
  solver_->restore(y, x);
  const double norm = x.norm();
  if (norm > 0) x /= norm;
  return x;
}

double BaseFactor::solve_operations() const {
  return 2 * entry_operations * solver_->entries() + correction_operations * correction_->entries();
}

double BaseFactor::solve_cost() const {
  return predicted_cost(SolveWork{solver_->entries(), static_cast<double>(solver_->blocks())});
}

double BaseFactor::correction_cost() const {
  return changed() ? columns_cost(correction_->entries(), correction_->active_rank(), correction_->place_count()) : 0;
}

}  // namespace topple::solver
