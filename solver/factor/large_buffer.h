#pragma once
// Memory for many numbers that is not touched when it is asked for. (Large pages are not asked for: where memory is
// fragmented the system takes longer to find them than it ever saves.)
#include <cstddef>
#include <memory>
#include <mutex>
#include <vector>

namespace topple::solver {

class LargeBuffer {
 public:
  LargeBuffer() = default;
  /// Not initialised. Throws std::bad_alloc.
  explicit LargeBuffer(std::size_t entries);
  [[nodiscard]] double* data() const { return memory_.get(); }
  [[nodiscard]] std::size_t size() const { return size_; }
  void release() { *this = LargeBuffer(); }

 private:
  struct Free {
    Free() {}  // NOLINT(modernize-use-equals-default): a default one is not there before the class around it ends
    explicit Free(std::size_t entries) : size(entries) {}
    void operator()(double* p) const;
    std::size_t size = 0;  ///< of the block, which may be larger than what was asked for
  };
  std::unique_ptr<double, Free> memory_;
  std::size_t size_ = 0;
};

/// Buffers that have served and may serve again, for several threads: memory that is in use already need not be cleared
/// by the system once more. When nothing fits and much lies idle, that is let go.
class BufferPool {
 public:
  /// At least so many entries, at most four times as many.
  [[nodiscard]] LargeBuffer acquire(std::size_t entries);
  void give_back(LargeBuffer buffer);
  void clear();

 private:
  std::mutex mutex_;
  std::vector<LargeBuffer> free_;
};

}  // namespace topple::solver
