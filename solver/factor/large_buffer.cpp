#include "factor/large_buffer.h"

#include <algorithm>
#include <new>
#include <utility>

namespace topple::solver {
namespace {
constexpr std::size_t line = 64;
/// Entries that may lie idle in a pool: 32 MiB.
constexpr std::size_t most_spare = std::size_t{1} << 22;
}  // namespace

void LargeBuffer::Free::operator()(double* p) const { ::operator delete (p, std::align_val_t{line}); }

LargeBuffer::LargeBuffer(std::size_t entries)
    : memory_(static_cast<double*>(::operator new (entries * sizeof(double), std::align_val_t{line}))),
      size_(entries) {}

LargeBuffer BufferPool::take(std::size_t entries) {
  const std::lock_guard lock(mutex_);
  const auto fits = [&](const LargeBuffer& b) { return b.size() >= entries && b.size() / 4 <= entries; };
  auto best = free_.end();
  std::size_t sum = 0;
  for (auto buffer = free_.begin(); buffer != free_.end(); ++buffer) {
    sum += buffer->size();
    if (fits(*buffer) && (best == free_.end() || buffer->size() < best->size())) best = buffer;
  }
  if (best != free_.end()) {
    LargeBuffer buffer = std::move(*best);
    free_.erase(best);
    return buffer;
  }
  if (sum > most_spare) free_.clear();
  return LargeBuffer(entries);
}

void BufferPool::give_back(LargeBuffer buffer) {
  const std::lock_guard lock(mutex_);
  free_.push_back(std::move(buffer));
}

void BufferPool::clear() { free_.clear(); }

}  // namespace topple::solver
