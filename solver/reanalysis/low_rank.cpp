#include "reanalysis/low_rank.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "factor/multiple_right_hand_sides.h"
#include "reanalysis/update_costs.h"
#include "reanalysis/work_count.h"

namespace topple::solver {
namespace {

/// W = Q R by Gram-Schmidt, done twice (Daniel, Gragg, Kaufman and Stewart 1976); a column that depends on the earlier
/// ones becomes zero in Q and R.
void orthonormalise(Eigen::MatrixXd& W, Eigen::MatrixXd& R) {
  constexpr double dependent = 1e-14;
  const int rows = static_cast<int>(W.rows()), columns = static_cast<int>(W.cols());
  const auto norm = [rows](const double* column) {
    double square = 0;
    add_products(column, rows, rows, 1, column, &square);
    return std::sqrt(square);
  };
  R.setZero(columns, columns);
  Eigen::VectorXd part(columns);
  for (int j = 0; j < columns; ++j) {
    double* own = W.col(j).data();
    const double before = norm(own);
    for (int pass = 0; pass < 2 && j > 0; ++pass) {
      part.setZero();
      add_products(W.data(), rows, rows, j, own, part.data());
      subtract_combination(W.data(), rows, rows, j, part.data(), own);
      R.col(j).head(j) += part.head(j);
    }
    const double after = norm(own);
    if (after <= dependent * before || before == 0) {
      W.col(j).setZero();
      continue;
    }
    R(j, j) = after;
    W.col(j) /= after;
  }
}

/// The first entries of a store that only grows, as a matrix.
Eigen::Map<Eigen::MatrixXd> scratch(std::vector<double>& store, Eigen::Index rows, Eigen::Index columns) {
  const auto size = static_cast<std::size_t>(rows * columns);
  if (store.size() < size) store.resize(2 * size);
  return {store.data(), rows, columns};
}

}  // namespace

int LowRankCorrection::add(std::span<const int> rows, const Eigen::MatrixXd& B) {
  Place place;
  place.path = solver_.path(rows);
  place.W.setZero(place.path.rows(), B.cols());
  for (std::size_t i = 0; i < rows.size(); ++i)
    place.W.row(solver_.row_on_path(place.path, rows[i])) += B.row(static_cast<Eigen::Index>(i));
  place.D.setZero(B.cols(), B.cols());
  place.first = static_cast<int>(gram_size_);
  gram_size_ += B.cols();
  place.gram_known.assign(places_.size() + 1, 0);
  places_.push_back(std::move(place));
  return static_cast<int>(places_.size()) - 1;
}

void LowRankCorrection::finish_adding(std::span<const PathColumns> also, Eigen::VectorXd* y,
                                      const std::vector<char>* marked) {
  if (finished_ == places_.size() && also.empty() && y == nullptr) return;
  std::vector<PathColumns> groups(also.begin(), also.end());
  for (std::size_t p = finished_; p < places_.size(); ++p) groups.push_back({&places_[p].path, &places_[p].W});
  solver_.forward(groups, y, marked);
  for (; finished_ < places_.size(); ++finished_) {
    Eigen::MatrixXd& W = places_[finished_].W;
    constexpr double passes = 4;  // each column against those before it and back, twice
    count_work(product_cost(passes / 2 * static_cast<double>(W.size()) * static_cast<double>(W.cols())));
    orthonormalise(W, places_[finished_].R);
  }
  if (gram_.rows() < gram_size_) {
    const Eigen::Index room = std::max<Eigen::Index>(2 * gram_.rows(), gram_size_ + 48);
    gram_.conservativeResize(room, room);
  }
}

/// `other` comes before `place`, or is it. Paths to one root share their ends and nothing else.
void LowRankCorrection::compute_gram(Place& place, const Place& other) {
  char& known = place.gram_known[static_cast<std::size_t>(&other - places_.data())];
  if (known != 0) return;
  known = 1;
  std::size_t i = other.path.block.size(), j = place.path.block.size();
  while (i > 0 && j > 0 && other.path.block[i - 1] == place.path.block[j - 1]) --i, --j;
  const int shared = other.path.rows() - other.path.offset[i];
  const auto rows = static_cast<int>(other.W.cols());
  count_work(product_cost(static_cast<double>(shared) * rows * static_cast<double>(place.W.cols())));
  gram_.block(other.first, place.first, rows, place.W.cols()).setZero();
  add_products(other.W.data() + other.W.rows() - shared, static_cast<int>(other.W.rows()), shared, rows,
               place.W.data() + place.W.rows() - shared, static_cast<int>(place.W.rows()),
               static_cast<int>(place.W.cols()), gram_.col(place.first).data() + other.first,
               static_cast<int>(gram_.rows()));
  if (&other == &place) return;
  gram_.block(place.first, other.first, place.W.cols(), rows) =
      gram_.block(other.first, place.first, rows, place.W.cols()).transpose();
}

void LowRankCorrection::set(int place, const Eigen::Ref<const Eigen::MatrixXd>& D) {
  Place& p = places_[static_cast<std::size_t>(place)];
  Eigen::Map<Eigen::MatrixXd> RD = scratch(product_, p.R.rows(), D.cols());
  RD.noalias() = p.R * D;
  p.D.noalias() = RD * p.R.transpose();
  p.active = (D.array() != 0).any();
  p.factorised = false;
}

std::vector<int> LowRankCorrection::forget_unchanged(Eigen::Index kept_columns) {
  Eigen::Index unchanged = 0;
  for (const Place& place : places_) unchanged += place.active ? 0 : place.W.cols();
  if (unchanged <= kept_columns || 2 * unchanged <= gram_size_) return {};
  std::vector<int> number(places_.size(), -1);
  std::vector<Place> kept;
  for (std::size_t p = 0; p < places_.size(); ++p) {
    if (!places_[p].active) continue;
    number[p] = static_cast<int>(kept.size());
    kept.push_back(std::move(places_[p]));
  }
  const Eigen::MatrixXd old = std::move(gram_);
  gram_.resize(old.rows(), old.cols());
  gram_size_ = 0;
  std::vector<int> first;
  for (const Place& place : kept) {
    first.push_back(static_cast<int>(gram_size_));
    gram_size_ += place.W.cols();
  }
  for (std::size_t i = 0; i < kept.size(); ++i)
    for (std::size_t j = 0; j < kept.size(); ++j)
      gram_.block(first[i], first[j], kept[i].W.cols(), kept[j].W.cols()) =
          old.block(kept[i].first, kept[j].first, kept[i].W.cols(), kept[j].W.cols());
  for (std::size_t i = 0; i < kept.size(); ++i) {
    kept[i].first = first[i];
    std::vector<char> known;
    for (std::size_t p = 0; p < number.size() && known.size() <= i; ++p)
      if (number[p] >= 0) known.push_back(kept[i].gram_known[p]);
    kept[i].gram_known = std::move(known);
  }
  finished_ = kept.size();
  places_ = std::move(kept);
  // What stood before the first one that is forgotten stays in its order.
  for (int& place : active_) place = number[static_cast<std::size_t>(place)];
  active_.erase(std::find(active_.begin(), active_.end(), -1), active_.end());
  return number;
}

bool LowRankCorrection::correct_alone(int place, const Eigen::Ref<const Eigen::MatrixXd>& given,
                                      Eigen::VectorXd& on_path) const {
  const Place& p = places_[static_cast<std::size_t>(place)];
  const Eigen::MatrixXd D = p.R * given * p.R.transpose();
  Eigen::MatrixXd A = D * (p.W.transpose() * p.W);
  A.diagonal().array() += 1;
  const Eigen::VectorXd c = A.partialPivLu().solve(D * (p.W.transpose() * on_path));
  if (!c.allFinite()) return false;
  on_path.noalias() -= p.W * c;
  return true;
}

int LowRankCorrection::rank_before(int place) const {
  int rank = 0;
  for (const int p : active_) {
    if (p == place) break;
    rank += static_cast<int>(places_[static_cast<std::size_t>(p)].W.cols());
  }
  return rank;
}

/// Active places in an order that keeps as many in front as are factorised as they are; the others in order of number.
/// Returns the columns of the former.
int LowRankCorrection::order_active() {
  std::size_t same = 0;
  int columns = 0;
  while (same < active_.size() && places_[static_cast<std::size_t>(active_[same])].factorised)
    columns += static_cast<int>(places_[static_cast<std::size_t>(active_[same++])].W.cols());
  const int kept = capacitance_.keep(columns);
  while (columns > kept) columns -= static_cast<int>(places_[static_cast<std::size_t>(active_[--same])].W.cols());
  active_.resize(same);
  for (Place& place : places_) place.factorised = false;
  for (const int p : active_) places_[static_cast<std::size_t>(p)].factorised = true;
  for (std::size_t p = 0; p < places_.size(); ++p)
    if (places_[p].active && !places_[p].factorised) active_.push_back(static_cast<int>(p));
  active_rank_ = 0;
  for (const int p : active_) active_rank_ += static_cast<int>(places_[static_cast<std::size_t>(p)].W.cols());
  return kept;
}

/// What of I + D G lies behind its first `kept` rows and columns.
void LowRankCorrection::fill_capacitance(int kept) {
  DenseFactor::Matrix A = capacitance_.grow(active_rank_);
  Eigen::Index row = 0;
  for (const int i : active_) {
    Place& p = places_[static_cast<std::size_t>(i)];
    const Eigen::Index rows = p.W.cols();
    Eigen::Index column = 0;
    for (const int j : active_) {
      Place& q = places_[static_cast<std::size_t>(j)];
      if (row >= kept || column >= kept) {
        i < j ? compute_gram(q, p) : compute_gram(p, q);
        auto block = A.block(row, column, rows, q.W.cols());
        block.noalias() = p.D * gram_.block(p.first, q.first, rows, q.W.cols());
        if (i == j) block.diagonal().array() += 1;
      }
      column += q.W.cols();
    }
    row += rows;
  }
}

void LowRankCorrection::update() {
  const int kept = order_active();
  softening_ = 1;
  if (active_.empty()) return;
  fill_capacitance(kept);
  count_work(dense_cost(active_rank_, kept));
  capacitance_.factorise();
  for (const int p : active_) places_[static_cast<std::size_t>(p)].factorised = true;
  softening_ = capacitance_.inverse_norm();
}

double LowRankCorrection::entries() const {
  double sum = 0;
  for (const int i : active_) sum += static_cast<double>(places_[static_cast<std::size_t>(i)].W.size());
  return sum;
}

void LowRankCorrection::gather(const Eigen::VectorXd& y, Eigen::Ref<Eigen::VectorXd> c) const {
  Eigen::Index row = 0;
  for (const int i : active_) {
    const Place& p = places_[static_cast<std::size_t>(i)];
    solver_.multiply(p.path, p.W, y, c.data() + row);
    row += p.W.cols();
  }
}

void LowRankCorrection::subtract(const Eigen::Ref<const Eigen::VectorXd>& c, Eigen::VectorXd& y) const {
  Eigen::Index row = 0;
  for (const int i : active_) {
    const Place& p = places_[static_cast<std::size_t>(i)];
    solver_.subtract(p.path, p.W, c.data() + row, y);
    row += p.W.cols();
  }
}

void LowRankCorrection::correct(Eigen::VectorXd& y) const {
  if (active_.empty()) return;
  count_work(columns_cost(entries(), active_rank_, static_cast<double>(active_.size())));
  // W'y in the first half, D W'y in the second.
  Eigen::Map<Eigen::MatrixXd> c = scratch(coefficients_, active_rank_, 2);
  gather(y, c.col(0));
  Eigen::Index row = 0;
  for (const int i : active_) {
    const Place& p = places_[static_cast<std::size_t>(i)];
    c.col(1).segment(row, p.W.cols()).noalias() = p.D * c.col(0).segment(row, p.W.cols());
    row += p.W.cols();
  }
  capacitance_.solve(c.col(1).data());
  subtract(c.col(1), y);
}

Eigen::VectorXd LowRankCorrection::softest_motion() const {
  Eigen::VectorXd motion = Eigen::VectorXd::Zero(solver_.size());
  if (active_.empty()) return motion;
  // The columns of the inverse are dominated by the null vector; one that stands out names one motion, not a mixture.
  const int column = capacitance_.largest_inverse_column();
  if (column < 0) return motion;
  Eigen::VectorXd q = Eigen::VectorXd::Unit(active_rank_, column);
  capacitance_.solve(q.data());
  if (!q.allFinite()) return motion;
  q.normalize();
  capacitance_.solve(q.data());
  if (!q.allFinite()) return motion;
  q.normalize();
  subtract(-q, motion);
  const double norm = motion.norm();
  if (norm > 0) motion /= norm;
  return motion;
}

}  // namespace topple::solver
