#include "formats/model_files.h"

#include <algorithm>
#include <cctype>

#include "topple/structure/error.h"
#include "topple/structure/formats/input_files.h"

namespace topple::structure::formats {

std::string ending_of(const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return std::tolower(c); });
  return ending;
}

std::string whole_text(const std::filesystem::path& file) { return read_whole_file(file); }

std::vector<std::pair<std::string, std::string>> read_tables(const std::filesystem::path& folder) {
  std::error_code error;
  const std::vector<std::string> names = names_in(folder, error);
  if (error)
    throw InputError(folder.string() + ": cannot be opened: " + error.message() + "; accepted: a folder of tables");
  std::vector<std::pair<std::string, std::string>> tables;
  for (const std::string& name : names)
    if (ending_of(name) == ".csv") tables.emplace_back(name, whole_text(folder / name));
  return tables;
}

}  // namespace topple::structure::formats

namespace topple::structure {

std::vector<std::filesystem::path> model_files(const std::filesystem::path& model) {
  std::vector<std::filesystem::path> files{model};
  std::error_code ignored;
  for (const std::string& name : names_in(model, ignored))
    if (formats::ending_of(name) == ".csv") files.push_back(model / name);
  return files;
}

}  // namespace topple::structure
