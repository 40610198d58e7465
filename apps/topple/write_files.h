#pragma once
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace topple::app {

/// Writes all files into a folder (made when it is not there), or none: each goes to a temporary name first, and all
/// are renamed when every one is whole. Throws std::runtime_error with the path and the reason.
void write_files(const std::filesystem::path& folder, const std::vector<std::pair<std::string, std::string>>& files);

}  // namespace topple::app
