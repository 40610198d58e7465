#pragma once
// When a body had its last impact in this step, and up to which time its state holds since then.
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
