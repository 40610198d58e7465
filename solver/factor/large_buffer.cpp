#include "factor/large_buffer.h"

#include "topple/solver/kept_memory.h"

#include <algorithm>
#include <new>
#include <utility>

namespace topple::solver {
namespace {
constexpr std::size_t line = 64;
/// Entries that may lie idle in a pool: 32 MiB.
constexpr std::size_t most_spare = std::size_t{1} << 22;
/// Kept are so many blocks at most, none below so many entries (8 MiB); in sum so many times the largest.
constexpr std::size_t most_kept = 6, least_kept = std::size_t{1} << 20, most_idle = 3;

/// What is kept while somebody asks for it (KeptMemory).
struct KeptBlocks {
  struct Block {
    double* memory;
    std::size_t size;
  };
  std::mutex mutex;
  int users = 0;
  std::vector<Block> blocks;

  /// Null where none fits.
  Block acquire(std::size_t entries) {
    const std::lock_guard lock(mutex);
    auto best = blocks.end();
    for (auto block = blocks.begin(); block != blocks.end(); ++block)
      if (block->size >= entries && block->size / 2 <= entries && (best == blocks.end() || block->size < best->size))
        best = block;
    if (best == blocks.end()) return {nullptr, 0};
    const Block found = *best;
    blocks.erase(best);
    return found;
  }

  /// Returns what is to be freed: this one, or the smallest that was kept where it is larger and there are many.
  double* keep(const Block& block) {
    const std::lock_guard lock(mutex);
    if (users == 0 || block.size < least_kept) return block.memory;
    std::size_t sum = block.size, largest = block.size;
    for (const Block& one : blocks) {
      sum += one.size;
      largest = std::max(largest, one.size);
    }
    if (sum > most_idle * largest) return block.memory;
    blocks.push_back(block);
    if (blocks.size() <= most_kept) return nullptr;
    const auto smallest =
        std::min_element(blocks.begin(), blocks.end(), [](const Block& a, const Block& b) { return a.size < b.size; });
    double* const memory = smallest->memory;
    blocks.erase(smallest);
    return memory;
  }
};

KeptBlocks& kept_blocks() {
  static KeptBlocks kept;
  return kept;
}

void free_memory(double* p) { ::operator delete (p, std::align_val_t{line}); }

}  // namespace

KeptMemory::KeptMemory() {
  const std::lock_guard lock(kept_blocks().mutex);
  ++kept_blocks().users;
}

KeptMemory::~KeptMemory() {
  const std::lock_guard lock(kept_blocks().mutex);
  if (--kept_blocks().users > 0) return;
  for (const KeptBlocks::Block& block : kept_blocks().blocks) free_memory(block.memory);
  kept_blocks().blocks.clear();
}

void LargeBuffer::Free::operator()(double* p) const {
  if (double* const unwanted = kept_blocks().keep({p, size})) free_memory(unwanted);
}

LargeBuffer::LargeBuffer(std::size_t entries) : size_(entries) {
  KeptBlocks::Block block{nullptr, entries};
  if (entries >= least_kept) block = kept_blocks().acquire(entries);
  if (block.memory == nullptr)
    block = {static_cast<double*>(::operator new (entries * sizeof(double), std::align_val_t{line})), entries};
  memory_ = std::unique_ptr<double, Free>(block.memory, Free{block.size});
}

LargeBuffer BufferPool::acquire(std::size_t entries) {
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
