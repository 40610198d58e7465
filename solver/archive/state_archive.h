#pragma once
// The state of a running computation as bytes, and back. What was saved is loaded by the same program into an object
// that was made alike; from then on both answer alike, to the bit. The bytes are numbers as they lie in memory: no
// format for other programs, nor for other versions of this one.
//
// A type says what its state is by serialize(), with all of its members named by a structured binding, so that none can
// be added and forgotten:
//   template <class Archive> void serialize(Archive& archive) {
//     auto& [system, u, v, scratch] = *this;
//     archive(u, v);  // `system` is another object's, `scratch` lives no longer than a call
//   }
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cereal/archives/binary.hpp>
#include <cereal/cereal.hpp>
#include <cereal/types/array.hpp>
#include <cereal/types/map.hpp>
#include <cereal/types/memory.hpp>
#include <cereal/types/optional.hpp>
#include <cereal/types/set.hpp>
#include <cereal/types/string.hpp>
#include <cereal/types/utility.hpp>
#include <cereal/types/variant.hpp>
#include <cereal/types/vector.hpp>

namespace topple {

using StateWriter = cereal::BinaryOutputArchive;
/// Throws cereal::Exception where bytes are missing.
using StateReader = cereal::BinaryInputArchive;

}  // namespace topple

namespace cereal {

/// Vectors and matrices of numbers, with their sizes where they have no fixed ones.
template <class Archive, class Scalar, int rows, int cols, int options, int max_rows, int max_cols>
void save(Archive& archive, const Eigen::Matrix<Scalar, rows, cols, options, max_rows, max_cols>& matrix) {
  if constexpr (rows == Eigen::Dynamic || cols == Eigen::Dynamic)
    archive(static_cast<std::int64_t>(matrix.rows()), static_cast<std::int64_t>(matrix.cols()));
  archive(binary_data(matrix.data(), sizeof(Scalar) * static_cast<std::size_t>(matrix.size())));
}
template <class Archive, class Scalar, int rows, int cols, int options, int max_rows, int max_cols>
void load(Archive& archive, Eigen::Matrix<Scalar, rows, cols, options, max_rows, max_cols>& matrix) {
  if constexpr (rows == Eigen::Dynamic || cols == Eigen::Dynamic) {
    std::int64_t saved_rows = 0, saved_cols = 0;
    archive(saved_rows, saved_cols);
    matrix.resize(saved_rows, saved_cols);
  }
  archive(binary_data(matrix.data(), sizeof(Scalar) * static_cast<std::size_t>(matrix.size())));
}
template <class Archive, class Scalar, int options>
void serialize(Archive& archive, Eigen::Quaternion<Scalar, options>& rotation) {
  archive(rotation.coeffs());
}

}  // namespace cereal
