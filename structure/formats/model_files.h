#pragma once
// Files of models as text.
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace topple::structure::formats {

/// The ending in lower case, with its point.
[[nodiscard]] std::string ending_of(const std::filesystem::path& file);
/// Throws InputError for a file that cannot be read or is larger than 256 MiB.
[[nodiscard]] std::string whole_text(const std::filesystem::path& file);
/// Every file of the folder that ends in .csv, by name, in order of the names. Throws InputError.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> read_tables(const std::filesystem::path& folder);

}  // namespace topple::structure::formats
