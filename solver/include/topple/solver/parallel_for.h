#pragma once
// A loop whose turns are independent of each other. Each turn writes what is its own, so that results do not depend on
// the number of threads.
#include <concepts>
#include <cstddef>
#include <functional>

namespace topple::solver {

/// parallel_for() without the type of the index.
void run_turns(std::size_t count, int threads, const std::function<void(std::size_t)>& work);

/// Calls work(0) ... work(count - 1), in any order, on up to `threads` threads, the caller's among them. Where the
/// system gives fewer, those that there are do all. When all have ended, throws what the first turn that failed threw.
/// On one thread the turns come in order, and the first failure ends them.
template <std::integral Index, class Work>
void parallel_for(Index count, int threads, const Work& work) {
  run_turns(static_cast<std::size_t>(count), threads, [&work](std::size_t i) { work(static_cast<Index>(i)); });
}

}  // namespace topple::solver
