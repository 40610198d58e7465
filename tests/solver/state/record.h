#pragma once
// What runs are compared by: every number that was read of them, bit by bit; and states as bytes.
#include <Eigen/Core>
#include <bit>
#include <cstdint>
#include <sstream>
#include <string>
#include <vector>

namespace topple::test {

class Record {
 public:
  void add(double value) { bits_.push_back(std::bit_cast<std::uint64_t>(value)); }
  template <class Derived>
  void add(const Eigen::MatrixBase<Derived>& matrix) {
    for (Eigen::Index j = 0; j < matrix.cols(); ++j)
      for (Eigen::Index i = 0; i < matrix.rows(); ++i) add(static_cast<double>(matrix(i, j)));
  }
  template <class Value>
  void add(const std::vector<Value>& values) {
    for (const Value& value : values) add(value);
  }
  [[nodiscard]] std::size_t size() const { return bits_.size(); }
  friend bool operator==(const Record&, const Record&) = default;

 private:
  std::vector<std::uint64_t> bits_;
};

template <class Saved>
[[nodiscard]] std::string bytes_of(const Saved& saved) {
  std::ostringstream to;
  saved.save_state(to);
  return std::move(to).str();
}

template <class Loaded>
void load_bytes(Loaded& loaded, const std::string& bytes) {
  std::istringstream from(bytes);
  loaded.load_state(from);
}

}  // namespace topple::test
