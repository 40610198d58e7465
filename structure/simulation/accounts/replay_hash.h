#pragma once
// A hash of raw bits that tells two runs apart: FNV-1a, 64 bits (Fowler, Noll, Vo).
#include <bit>
#include <cstdint>
#include <string_view>

#include "topple/structure/building.h"

namespace topple::structure {

class ReplayHash {
 public:
  void add(std::string_view text) {
    for (const char c : text) add_byte(static_cast<unsigned char>(c));
    add_byte(0);  // so that "ab", "c" and "a", "bc" differ
  }
  void add(double value) { add(std::bit_cast<std::uint64_t>(value)); }
  void add(std::uint64_t bits) {
    for (int shift = 0; shift < 64; shift += 8) add_byte(static_cast<unsigned char>(bits >> shift));
  }
  template <int rows>
  void add(const Eigen::Matrix<double, rows, 1>& vector) {
    for (int i = 0; i < rows; ++i) add(vector[i]);
  }
  [[nodiscard]] std::uint64_t value() const { return value_; }

 private:
  void add_byte(unsigned char byte) { value_ = (value_ ^ byte) * 1099511628211ull; }
  std::uint64_t value_ = 14695981039346656037ull;
};

}  // namespace topple::structure
