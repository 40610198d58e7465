#pragma once
// Threads that work through the items of a tree, children before parents, and help each other with the chunks of large
// items. Which thread does what depends on the clock; what comes out must not: an item may only touch its own results
// and its children's, a chunk only its own part.
#include <functional>
#include <memory>
#include <span>

namespace topple::solver {

class TaskTeam {
 public:
  /// `threads` workers, the calling thread included; at least 1.
  explicit TaskTeam(int threads);
  ~TaskTeam();
  TaskTeam(const TaskTeam&) = delete;
  TaskTeam& operator=(const TaskTeam&) = delete;

  /// Runs work(item, worker) for all items, an item after its children. `parent[i]` is greater than i, or -1. What an
  /// item throws is thrown again here (one of it, if several do) after all have ended; items above it are not run.
  void run_tree(std::span<const int> parent, const std::function<void(int item, int worker)>& work);
  /// From inside of an item: runs chunk(0) ... chunk(count - 1), which must not throw; idle workers help.
  void split(int count, const std::function<void(int)>& chunk);
  [[nodiscard]] int threads() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace topple::solver
