#pragma once
#include <cstddef>
#include <new>
#include <system_error>
#include <thread>
#include <vector>

namespace topple::structure {

/// Threads that do the same work as the caller does, and are waited for at the end, whatever is thrown meanwhile. Where
/// the system gives fewer than asked for, those that there are do it. The work must not throw.
class ThreadsBeside {
 public:
  template <class Work>
  ThreadsBeside(std::size_t count, Work& work) {
    threads_.reserve(count);
    try {
      while (threads_.size() < count) threads_.emplace_back([&work] { work(); });
    } catch (const std::system_error&) {
      return;
    } catch (const std::bad_alloc&) {
      return;
    }
  }

 private:
  std::vector<std::jthread> threads_;
};

}  // namespace topple::structure
