// The folder of a run's results. Claimed by a lock on the folder itself (flock), which ends with the process and leaves
// nothing behind; where the file system has no locks, nothing is claimed.
#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "formats/files/temporary_name.h"
#include "topple/structure/building.h"
#include "topple/structure/error.h"
#include "topple/structure/formats/input_files.h"
#include "topple/structure/formats/output_files.h"
#include "topple/structure/formats/plain_text.h"

namespace topple::structure {

namespace {

namespace fs = std::filesystem;

/// An input that lies in the folder under the name of a result would be lost.
void refuse_inputs(const fs::path& folder, const std::vector<fs::path>& inputs,
                   const std::vector<std::string>& results) {
  for (const fs::path& input : inputs) {
    std::error_code ignored;
    for (const std::string& name : names_in(folder, ignored)) {
      const bool result = std::any_of(results.begin(), results.end(),
                                      [&](const std::string& pattern) { return matches_pattern(pattern, name); });
      if (result) require_different(input, folder / name);
    }
  }
}

}  // namespace

OutputFolder::OutputFolder(fs::path folder, const std::vector<fs::path>& inputs,
                           const std::vector<std::string>& results)
    : folder_(std::move(folder)) {
  const auto refuse = [&](const std::string& why, const char* accepted) {
    if (claim_ >= 0) ::close(claim_);
    throw InputError(one_line(folder_.string()) + ": " + why + "; accepted: " + accepted);
  };
  std::error_code error;
  name_ = std::make_unique<TemporaryName>(folder_);
  made_ = name_->make([&] { return fs::create_directories(folder_, error); });
  if (!made_) name_->forget();
  if (error) refuse("cannot be made: " + error.message(), "a folder for the results");
  claim_ = ::open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (claim_ < 0) refuse("cannot be opened: " + std::string(std::strerror(errno)), "a folder for the results");
  if (::flock(claim_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
    refuse("another run is writing into this folder", "a folder of its own, or when that run has ended");
  try {
    require_writable(folder_ / ".topple");
    refuse_inputs(folder_, inputs, results);
  } catch (...) {
    ::close(claim_);
    throw;
  }
}

OutputFolder::~OutputFolder() {
  std::error_code ignored;
  if (made_ && fs::is_empty(folder_, ignored)) fs::remove(folder_, ignored);
  if (claim_ >= 0) ::close(claim_);
}

void OutputFolder::remove_numbered(std::string_view prefix, std::string_view ending,
                                   const std::vector<std::string>& kept) const {
  std::error_code ignored;
  for (const std::string& name : names_in(folder_, ignored)) {
    if (name.size() <= prefix.size() + ending.size() || !name.starts_with(prefix) || !name.ends_with(ending)) continue;
    const std::string number = name.substr(prefix.size(), name.size() - prefix.size() - ending.size());
    const bool digits = std::all_of(number.begin(), number.end(), [](char c) { return c >= '0' && c <= '9'; });
    if (digits && std::find(kept.begin(), kept.end(), name) == kept.end()) fs::remove(folder_ / name, ignored);
  }
}

}  // namespace topple::structure
