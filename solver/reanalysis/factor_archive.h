#pragma once
// Factors in an archive: what each was made of, from which it is made anew with the same bits, and the corrections that
// it has since then.
#include <bit>
#include <cstdint>
#include <utility>
#include <vector>

#include "reanalysis/factor_refresh.h"
#include "reanalysis/serving_factor.h"

namespace topple::solver {

/// Values of a matrix that was like this one not long ago: where they are others.
template <class Archive>
void save_values(Archive& archive, const std::vector<double>& values, const SparseSymmetric& now) {
  std::vector<std::int64_t> place;
  std::vector<double> there;
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (std::bit_cast<std::uint64_t>(values[k]) == std::bit_cast<std::uint64_t>(now.value[k])) continue;
    place.push_back(static_cast<std::int64_t>(k));
    there.push_back(values[k]);
  }
  archive(place, there);
}

/// The matrix, by the one that it was compared with.
template <class Archive>
SparseSymmetric load_matrix(Archive& archive, const SparseSymmetric& now) {
  SparseSymmetric matrix = now;
  std::vector<std::int64_t> place;
  std::vector<double> there;
  archive(place, there);
  for (std::size_t k = 0; k < place.size(); ++k) matrix.value[static_cast<std::size_t>(place[k])] = there[k];
  return matrix;
}

/// As it was once; where that had failed, it fails again.
inline std::unique_ptr<Factor> make_again(const SparseSymmetric& matrix, const std::vector<int>& order,
                                          const AnalysisOptions& options) {
  auto factor = std::make_unique<Factor>(matrix, order, options.factorisation, options.threads);
  (void)factor->factorise(matrix);
  return factor;
}

template <class Archive>
void ServingFactor::save(Archive& archive) const {
  // System and options are the owner's, the rows those of its matrix; what was left over in an answer is scratch.
  const auto& [system, options, order, factor, values, rows, base, condition, correction_paid, looked_at_softening,
               left_over] = *this;
  archive(order, condition, correction_paid, looked_at_softening, factor != nullptr, base != nullptr);
  if (factor) save_values(archive, values, system.matrix());
  if (base) archive(*base);
}

template <class Archive>
void ServingFactor::load(Archive& archive) {
  bool made = false, corrected = false;
  archive(order_, condition_, correction_paid_, looked_at_softening_, made, corrected);
  base_.reset();
  if (made) {
    SparseSymmetric matrix = load_matrix(archive, system_.matrix());
    factor_ = make_again(matrix, order_, options_);
    rows_ = std::make_unique<MatrixRows>(matrix);
    values_ = std::move(matrix.value);
  }
  if (corrected) {
    base_ = std::make_unique<BaseFactor>(system_);
    base_->install(*factor_);
    archive(*base_);
  }
}

template <class Archive>
void FactorRefresh::save(Archive& archive, const FrameSystem& system) const {
  // A factor that is not needed any more is only waited for.
  const auto& [rules, base, making, unwanted, factor, values, condition, paid, due, allowed] = *this;
  archive(rules.columns, rules.least_operations, rules.share, condition, paid, due, allowed);
  archive(base != nullptr, making != nullptr);
  if (!base) return;
  save_values(archive, making ? making->matrix().value : values, system.matrix());
  archive(*base);
}

template <class Archive>
void FactorRefresh::load(Archive& archive, const FrameSystem& system, const std::vector<int>& order,
                         const AnalysisOptions& options) {
  drop();
  bool begun = false, being_made = false;
  archive(rules_.columns, rules_.least_operations, rules_.share, condition_, paid_, due_, allowed_);
  archive(begun, being_made);
  if (!begun) return;
  SparseSymmetric matrix = load_matrix(archive, system.matrix());
  base_ = std::make_unique<BaseFactor>(system);
  if (being_made) {
    unwanted_.reset();
    making_ = std::make_unique<BackgroundFactor>(matrix, order, options, rules_.on_worker);
  } else {
    factor_ = make_again(matrix, order, options);
    values_ = std::move(matrix.value);
    base_->install(*factor_);
  }
  archive(*base_);
}

template <class Visit>
void LowRankCorrection::each_known_product(const Visit& visit) const {
  for (const Place& place : places_)
    for (std::size_t other = 0; other < place.gram_known.size(); ++other)
      if (place.gram_known[other] != 0) visit(place, places_[other]);
}

template <class Archive>
void LowRankCorrection::save(Archive& archive) const {
  // The solver goes with the factor; coefficients and product are scratch.
  const auto& [solver, places, gram, gram_size, finished, active, active_rank, capacitance, softening, coefficients,
               product] = *this;
  archive(places, gram_size, finished, active, active_rank, capacitance, softening, gram.rows());
  each_known_product([&, &products = gram](const Place& place, const Place& other) {
    const Eigen::MatrixXd block = products.block(other.first, place.first, other.W.cols(), place.W.cols());
    archive(block);
  });
}

template <class Archive>
void LowRankCorrection::load(Archive& archive) {
  Eigen::Index room = 0;
  archive(places_, gram_size_, finished_, active_, active_rank_, capacitance_, softening_, room);
  gram_.setZero(room, room);
  each_known_product([&](const Place& place, const Place& other) {
    Eigen::MatrixXd block;
    archive(block);
    gram_.block(other.first, place.first, other.W.cols(), place.W.cols()) = block;
    if (&other != &place) gram_.block(place.first, other.first, place.W.cols(), other.W.cols()) = block.transpose();
  });
}

}  // namespace topple::solver
