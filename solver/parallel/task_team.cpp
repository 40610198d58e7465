#include "parallel/task_team.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <queue>
#include <system_error>
#include <thread>
#include <vector>

namespace topple::solver {

namespace {

/// Chunks of one item that whoever is idle takes.
struct Loop {
  const std::function<void(int)>& chunk;
  int count;
  std::atomic<int> next{0};
  int helpers = 0;  // guarded by the team's mutex

  void work() {
    for (int i = next.fetch_add(1); i < count; i = next.fetch_add(1)) chunk(i);
  }
};

}  // namespace

struct TaskTeam::State {
  int threads;
  std::mutex mutex;
  std::condition_variable wake;
  // All of this is guarded by the mutex.
  std::priority_queue<int, std::vector<int>, std::greater<>> ready;  // in order: it keeps the waiting updates few
  std::vector<int> waiting_for;                                      // per item: children to come
  std::vector<Loop*> loops;
  int remaining = 0;
  std::exception_ptr failure;
  std::span<const int> parent;
  const std::function<void(int, int)>* work = nullptr;

  void run_worker(int worker);
  void run_item(int item, int worker, std::unique_lock<std::mutex>& lock);
  bool help(std::unique_lock<std::mutex>& lock);
};

TaskTeam::TaskTeam(int threads) : state_(std::make_unique<State>()) { state_->threads = std::max(threads, 1); }
TaskTeam::~TaskTeam() = default;
int TaskTeam::threads() const { return state_->threads; }

void TaskTeam::State::run_item(int item, int worker, std::unique_lock<std::mutex>& lock) {
  const bool skip = failure != nullptr;
  lock.unlock();
  std::exception_ptr thrown;
  if (!skip) {
    try {
      (*work)(item, worker);
    } catch (...) {
      thrown = std::current_exception();
    }
  }
  lock.lock();
  if (thrown && !failure) failure = thrown;
  --remaining;
  const int above = parent[static_cast<std::size_t>(item)];
  if (above >= 0 && --waiting_for[static_cast<std::size_t>(above)] == 0) ready.push(above);
  if (remaining == 0 || ready.size() > 1) wake.notify_all();
}

bool TaskTeam::State::help(std::unique_lock<std::mutex>& lock) {
  for (Loop* loop : loops) {
    if (loop->next.load() >= loop->count) continue;
    ++loop->helpers;
    lock.unlock();
    loop->work();
    lock.lock();
    if (--loop->helpers == 0) wake.notify_all();
    return true;
  }
  return false;
}

void TaskTeam::State::run_worker(int worker) {
  std::unique_lock lock(mutex);
  while (remaining > 0) {
    if (!ready.empty()) {
      const int item = ready.top();
      ready.pop();
      run_item(item, worker, lock);
    } else if (!help(lock)) {
      wake.wait(lock);
    }
  }
}

void TaskTeam::run_tree(std::span<const int> parent, const std::function<void(int, int)>& work) {
  State& s = *state_;
  if (s.threads == 1) {
    for (std::size_t item = 0; item < parent.size(); ++item) work(static_cast<int>(item), 0);
    return;
  }
  s.parent = parent;
  s.work = &work;
  s.waiting_for.assign(parent.size(), 0);
  for (const int p : parent)
    if (p >= 0) ++s.waiting_for[static_cast<std::size_t>(p)];
  for (std::size_t item = 0; item < parent.size(); ++item)
    if (s.waiting_for[item] == 0) s.ready.push(static_cast<int>(item));
  s.remaining = static_cast<int>(parent.size());
  s.failure = nullptr;
  {
    std::vector<std::jthread> helpers;
    helpers.reserve(static_cast<std::size_t>(s.threads - 1));
    try {
      for (int worker = 1; worker < s.threads; ++worker) helpers.emplace_back([&s, worker] { s.run_worker(worker); });
    } catch (const std::system_error&) {
      // The system gives no more threads: those there are do it.
    }
    s.run_worker(0);
  }
  if (s.failure) std::rethrow_exception(s.failure);
}

void TaskTeam::split(int count, const std::function<void(int)>& chunk) {
  State& s = *state_;
  if (s.threads == 1 || count < 2) {
    for (int i = 0; i < count; ++i) chunk(i);
    return;
  }
  Loop loop{chunk, count};
  {
    const std::lock_guard lock(s.mutex);
    s.loops.push_back(&loop);
  }
  s.wake.notify_all();
  loop.work();
  std::unique_lock lock(s.mutex);
  std::erase(s.loops, &loop);
  s.wake.wait(lock, [&] { return loop.helpers == 0; });
}

}  // namespace topple::solver
