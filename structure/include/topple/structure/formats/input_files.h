#pragma once
// Files that are read: regular ones, of a size that can be held. A pipe would keep a run waiting and a device never
// end.
#include <cstdint>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

namespace topple::structure {

/// Throws InputError that says why it cannot be read: there is no such file, no right to read it, a folder, a pipe or
/// device, larger than `most` bytes.
void require_readable(const std::filesystem::path& file, std::uintmax_t most = std::uintmax_t{1} << 40);

/// All bytes of a file; throws as require_readable() does.
[[nodiscard]] std::string read_whole_file(const std::filesystem::path& file,
                                          std::uintmax_t most = std::uintmax_t{1} << 28);

/// The names of what lies in a folder, sorted; none where it cannot be opened, and why. (The standard library's
/// iterator ends the program where memory is short.)
[[nodiscard]] std::vector<std::string> names_in(const std::filesystem::path& folder, std::error_code& error);

/// The files that a model is read from: itself, or the tables of its folder.
[[nodiscard]] std::vector<std::filesystem::path> model_files(const std::filesystem::path& model);

}  // namespace topple::structure
