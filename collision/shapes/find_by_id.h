#pragma once
// What a world holds, by the ids that it has given.
#include <cstdint>
#include <stdexcept>
#include <string>

namespace topple::collision {

/// `what`: its kind, as errors name it.
[[noreturn]] inline void throw_not_in_the_world(std::int64_t id, const char* what) {
  throw std::out_of_range(std::string(what) + " " + std::to_string(id) + " is not in the world");
}

/// From a map of pointers. Throws out_of_range.
template <typename Map>
auto& find_by_id(Map& map, std::int64_t id, const char* what) {
  const auto found = map.find(id);
  if (found == map.end()) throw_not_in_the_world(id, what);
  return *found->second;
}

}  // namespace topple::collision
