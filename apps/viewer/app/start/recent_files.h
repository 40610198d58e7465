#pragma once
// Scenes that were opened last, kept from one run to the next: one a line, the latest first, in
// $XDG_STATE_HOME/topple/recent ($HOME/.local/state where that is not set; XDG Base Directory Specification 0.8).
#include <filesystem>
#include <string>
#include <vector>

namespace topple::viewer {

inline constexpr std::size_t most_recent_files = 12;

/// Empty where neither variable is set: then nothing is remembered.
[[nodiscard]] std::filesystem::path recent_files_place();
/// Those that are still there; shipped ones by their names. Empty when there are none.
[[nodiscard]] std::vector<std::string> recent_files();
/// Puts one first; files by their absolute paths. What cannot be written is not remembered.
void remember_file(const std::string& name);

}  // namespace topple::viewer
