#pragma once
// A moment of a simulation, to come back to: in memory (undo) or in a file.
//
// A snapshot holds what was done to the simulation from outside, and when. Coming back does it again from the start.
// That is exact to the bit, in the middle of a collapse too, because the simulation is a pure function of it (the
// collision engine's inner caches included); it costs what the way there costs.
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "topple/structure/host_contact.h"
#include "topple/structure/scenario.h"

namespace topple::structure {

/// Joints that were given other capacities.
struct CapacityChange {
  std::vector<std::pair<JointId, JointCapacity>> joints;  ///< each with what it bears from then on, SI
};

/// What was done to a simulation from outside, and when.
struct Snapshot {
  std::int64_t step = 0;    ///< steps made so far
  std::uint64_t hash = 0;   ///< of the simulation then
  std::uint64_t scene = 0;  ///< hash of the building and the scenario that it began with
  /// One thing that was done.
  struct Action {
    std::int64_t step = 0;                                 ///< after which it was asked for; it acts in the next
    std::variant<Tool, HostContact, CapacityChange> what;  ///< a tool, a contact of the host's, or other capacities
  };
  std::vector<Action> actions;  ///< beside the scenario's events, in order
};

/// Format 3: magic, format, version of Topple, the snapshot and a checksum; little endian, doubles as raw bits.
[[nodiscard]] std::string snapshot_bytes(const Snapshot& snapshot);
/// Throws InputError naming the file: no snapshot, another format, cut short.
[[nodiscard]] Snapshot read_snapshot(const std::filesystem::path& file);
[[nodiscard]] Snapshot parse_snapshot(const std::string& bytes, const std::string& name);

}  // namespace topple::structure
