#pragma once
#include <functional>

namespace topple::solver {

/// Calls work(0) ... work(count - 1) on up to `threads` threads, each with neighbouring ones. Throws one of what they
/// threw, when all have ended.
void each_on_threads(int count, int threads, const std::function<void(int)>& work);

}  // namespace topple::solver
