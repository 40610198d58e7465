#include "parallel/each_on_threads.h"

#include <algorithm>
#include <thread>
#include <vector>

namespace topple::solver {

void each_on_threads(int count, int threads, const std::function<void(int)>& work) {
  const int used = std::clamp(threads, 1, std::max(count, 1));
  const auto share = [&](int t) {
    for (int i = t * count / used; i < (t + 1) * count / used; ++i) work(i);
  };
  std::vector<std::thread> beside;
  for (int t = 1; t < used; ++t) beside.emplace_back(share, t);
  share(0);
  for (std::thread& thread : beside) thread.join();
}

}  // namespace topple::solver
