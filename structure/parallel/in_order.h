#pragma once
// Texts that are made on several threads and taken in their order.
#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

namespace topple::structure {

/// As many threads as asked for; 0: one for each processor. At least 1, at most `count`.
[[nodiscard]] int workers_for(std::size_t count, int threads);

/// Calls make(0, text) ... make(count - 1, text) in any order and at once, and write() with each of the texts in their
/// order, one at a time, while later ones are made. `text` arrives with the storage of an earlier one, to be written
/// over. Throws what the first of them in order threw; nothing is written after that.
void in_order(std::size_t count, int threads, const std::function<void(std::size_t, std::string& text)>& make,
              const std::function<void(std::string_view)>& write);

}  // namespace topple::structure
