#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace topple::app {

/// A file that is made as it is written: `write` hands its text to a sink, in order.
struct StreamedFile {
  std::string name;
  std::function<void(const std::function<void(std::string_view)>& sink)> write;
};

/// Writes all files into a folder (made when it is not there), or none: each goes to a temporary name first, and all
/// are renamed when every one is whole. Throws std::runtime_error with the path and the reason.
void write_files(const std::filesystem::path& folder, const std::vector<std::pair<std::string, std::string>>& files,
                 const std::vector<StreamedFile>& streamed = {});

}  // namespace topple::app
