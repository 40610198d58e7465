#include "formats/model_files.h"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <sstream>

#include "topple/structure/error.h"

namespace topple::structure::formats {

std::string ending_of(const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return std::tolower(c); });
  return ending;
}

std::string whole_text(const std::filesystem::path& file) {
  constexpr std::uintmax_t largest = std::uintmax_t{1} << 28;
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (error) throw InputError(file.string() + ": cannot be opened; accepted: a file that exists and can be read");
  if (size > largest)
    throw InputError(file.string() + ": " + std::to_string(size) + " bytes; accepted: at most " +
                     std::to_string(largest));
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  if (!stream) throw InputError(file.string() + ": cannot be read; accepted: a file that exists and can be read");
  return std::move(text).str();
}

std::vector<std::pair<std::string, std::string>> read_tables(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error))
    if (ending_of(entry.path()) == ".csv") files.push_back(entry.path());
  if (error) throw InputError(folder.string() + ": cannot be opened; accepted: a folder of tables");
  std::sort(files.begin(), files.end());
  std::vector<std::pair<std::string, std::string>> tables;
  for (const auto& file : files) tables.emplace_back(file.filename().string(), whole_text(file));
  return tables;
}

}  // namespace topple::structure::formats
