#pragma once
// States that snapshots lead to, kept in a folder of the user's own: a snapshot whose state is there is loaded at once,
// where doing its actions again takes as long as it took. The snapshot alone says what a run is: a state is found by
// its bytes and by the build of the program that runs, and where there is none, or it is damaged, nothing is lost but
// time.
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "topple/structure/simulation.h"

namespace topple::structure {

/// What a store may take of the disk, in bytes.
struct StateLimits {
  std::uintmax_t one = std::uintmax_t{256} << 20;   ///< a larger state is not kept
  std::uintmax_t all = std::uintmax_t{1024} << 20;  ///< beyond, those go that were used longest ago
};

/// Keeps states and finds them: files in one folder, one for each snapshot.
class StateStore {
 public:
  /// `folder` is made, for this user alone, when something is kept first.
  explicit StateStore(std::filesystem::path folder, const StateLimits& limits = {});
  /// topple/states in $XDG_CACHE_HOME, else in $HOME/.cache; none where neither is an absolute path.
  [[nodiscard]] static std::optional<StateStore> of_user();

  /// Keeps the state of a simulation, to be found by the snapshot of this moment. Returns false where it is not kept:
  /// it is too large, the folder cannot be written, or the collision engine cannot write its state.
  bool keep(const Simulation& simulation) const;
  /// Brings a simulation of the same building, scenario and options to the snapshot's moment. Returns false, and leaves
  /// it as it was, where there is no such state of this program's, or one that does not lead there.
  bool load(const Snapshot& snapshot, Simulation& simulation) const;

 private:
  [[nodiscard]] std::filesystem::path file_of(const std::string& snapshot) const;
  void make_room(std::uintmax_t bytes) const;

  std::filesystem::path folder_;
  StateLimits limits_;
};

}  // namespace topple::structure
