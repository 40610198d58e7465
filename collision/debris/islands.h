#pragma once
// Bodies that are solved together: those that touch or hang together, or touch or hang at the same obstacle that
// moves. What stands still, or sleeps, joins none.
#include <cstdint>
#include <span>
#include <vector>

#include "debris/debris_parts.h"

namespace topple::collision {

struct Island {
  std::vector<DebrisBody*> bodies;
  std::vector<std::uint32_t> pairs;  ///< that touch
  std::vector<DebrisHinge*> hinges;
  std::vector<DebrisCable*> cables;
  double load = 0;          ///< m/s2
  double substep_rate = 0;  ///< 1/s: the highest of its bodies
  bool carried = false;     ///< in part by an obstacle that moves at a noticeable speed
};

/// What islands are found of. Hinges and cables are those of bodies that are awake.
struct IslandParts {
  const NearPairs& pairs;
  std::span<const std::uint32_t> touching;  ///< pairs that have contacts
  std::span<DebrisBody* const> awake;
  struct Hung {
    DebrisHinge* hinge;
    DebrisBody *body, *other;  ///< other: null, where it hangs on nothing that is a body
    DebrisObstacle* carrier;   ///< an obstacle that moves, at which it hangs, or null
  };
  std::span<const Hung> hinges;
  struct Tied {
    DebrisCable* cable;
    DebrisBody* body;
  };
  std::span<const Tied> cables;
  double carries_from = 0;  ///< m/s: an obstacle that is faster carries what lies on it
};

/// In the order of their first bodies, each with its parts in the order given. Sets DebrisBody::island.
[[nodiscard]] std::vector<Island> find_islands(const IslandParts& parts);

}  // namespace topple::collision
