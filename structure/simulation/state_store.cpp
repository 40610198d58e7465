#include "topple/structure/state_store.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <stdexcept>
#include <system_error>
#include <utility>
#include <vector>

#include "simulation/accounts/replay_hash.h"
#include "simulation/program_mark.h"
#include "topple/structure/error.h"
#include "topple/structure/formats/input_files.h"
#include "topple/structure/formats/output_files.h"
#include "topple/structure/snapshot.h"

namespace topple::structure {
namespace {

namespace fs = std::filesystem;
constexpr std::string_view ending = ".state";

std::uint64_t hash_of(std::string_view bytes) {
  ReplayHash hash;
  hash.add(bytes);
  return hash.value();
}

std::string bytes_of(std::uint64_t number) { return {reinterpret_cast<const char*>(&number), sizeof number}; }

/// What a state's file begins with: to which snapshot it belongs, and the checksum of what follows.
std::string head_of(const std::string& snapshot, std::string_view state) {
  return "TOPPLEST" + bytes_of(snapshot.size()) + snapshot + bytes_of(state.size()) + bytes_of(hash_of(state));
}

/// The whole file; empty where it is not there, or anybody but this user may write it.
std::string read_own_file(const fs::path& path) {
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
  if (file < 0) return {};
  std::string bytes;
  struct stat what {};
  if (fstat(file, &what) == 0 && S_ISREG(what.st_mode) && what.st_uid == geteuid() &&
      (what.st_mode & (S_IWGRP | S_IWOTH)) == 0) {
    bytes.resize(static_cast<std::size_t>(what.st_size));
    std::size_t had = 0;
    while (had < bytes.size()) {
      const ssize_t now = read(file, bytes.data() + had, bytes.size() - had);
      if (now <= 0) break;
      had += static_cast<std::size_t>(now);
    }
    bytes.resize(had);
  }
  close(file);
  return bytes;
}

}  // namespace

StateStore::StateStore(fs::path folder, const StateLimits& limits) : folder_(std::move(folder)), limits_(limits) {}

std::optional<StateStore> StateStore::of_user() {
  const auto folder = [](const char* variable) {
    const char* const value = std::getenv(variable);
    return value == nullptr ? fs::path() : fs::path(value);
  };
  fs::path cache = folder("XDG_CACHE_HOME");
  if (!cache.is_absolute() && folder("HOME").is_absolute()) cache = folder("HOME") / ".cache";
  if (!cache.is_absolute()) return std::nullopt;
  return StateStore(cache / "topple" / "states");
}

fs::path StateStore::file_of(const std::string& snapshot) const {
  char name[17];
  std::snprintf(name, sizeof name, "%016llx",
                static_cast<unsigned long long>(hash_of(snapshot) ^ hash_of(program_mark())));
  return folder_ / (name + std::string(ending));
}

bool StateStore::keep(const Simulation& simulation) const {
  if (program_mark().empty()) return false;
  std::ostringstream state;
  try {
    simulation.save_state(state);
  } catch (const std::logic_error&) {
    return false;  // an engine of the host's
  }
  const std::string bytes = std::move(state).str(), snapshot = snapshot_bytes(simulation.save());
  if (bytes.size() > limits_.one) return false;
  try {
    fs::create_directories(folder_.parent_path());
    mkdir(folder_.c_str(), S_IRWXU);
    make_room(bytes.size());
    OutputFile file(file_of(snapshot));
    file.write(head_of(snapshot, bytes));
    file.write(bytes);
    file.commit();
    fs::permissions(file.target(), fs::perms::owner_read | fs::perms::owner_write);
  } catch (const std::exception&) {
    return false;  // no place for it: the snapshot says all
  }
  return true;
}

/// Those that were used longest ago go, until so much more finds room.
void StateStore::make_room(std::uintmax_t bytes) const {
  struct Kept {
    fs::file_time_type used;
    std::uintmax_t size;
    fs::path path;
  };
  std::vector<Kept> kept;
  std::uintmax_t all = bytes;
  std::error_code unseen;
  for (const std::string& name : names_in(folder_, unseen)) {
    fs::path path = folder_ / name;
    std::error_code gone;
    if (path.extension() != ending || !fs::is_regular_file(path, gone)) continue;
    const std::uintmax_t size = fs::file_size(path, gone);
    if (gone) continue;
    const fs::file_time_type used = fs::last_write_time(path, gone);
    if (gone) continue;
    kept.push_back({used, size, std::move(path)});
    all += size;
  }
  std::sort(kept.begin(), kept.end(), [](const Kept& a, const Kept& b) { return a.used < b.used; });
  for (const Kept& one : kept) {
    if (all <= limits_.all) break;
    std::error_code gone;
    fs::remove(one.path, gone);
    all -= one.size;
  }
}

bool StateStore::load(const Snapshot& snapshot, Simulation& simulation) const {
  if (program_mark().empty()) return false;
  const std::string asked = snapshot_bytes(snapshot);
  const fs::path path = file_of(asked);
  const std::string file = read_own_file(path);
  const std::size_t head = head_of(asked, {}).size();
  if (file.size() < head) return false;
  const std::string_view state = std::string_view(file).substr(head);
  if (file.compare(0, head, head_of(asked, state)) != 0) return false;
  std::istringstream from{std::string(state)};
  try {
    simulation.load_state(from);
  } catch (const std::runtime_error&) {
    return false;
  }
  if (simulation.hash() != snapshot.hash) throw std::logic_error("a kept state has not the hash of its snapshot");
  std::error_code gone;
  fs::last_write_time(path, fs::file_time_type::clock::now(), gone);  // it was used
  return true;
}

}  // namespace topple::structure
