#pragma once
// Independent pieces of work on several threads. Each writes what is its own, so that results do not depend on the
// number of threads.
#include <cstddef>
#include <functional>

namespace topple::structure {

/// As many threads as asked for; 0: one for each processor, at most `count`.
[[nodiscard]] std::size_t workers_for(std::size_t count, int threads);

/// Calls work(0) ... work(count - 1), in any order and at once; throws what the first of them in order threw.
void side_by_side(std::size_t count, int threads, const std::function<void(std::size_t)>& work);

}  // namespace topple::structure
