#pragma once
// Where in a step a body that has struck something stands in time.
#include <cstdint>
#include <map>

namespace topple::structure {

struct StruckClock {
  double at = 0;    ///< s: time of its last impact, as swept
  double base = 0;  ///< s: the same in the body's own time since its state
};
/// By body.
using StruckClocks = std::map<std::int64_t, StruckClock>;

}  // namespace topple::structure
