#include "app/start/recent_files.h"

#include <algorithm>
#include <cstdlib>
#include <sstream>

#include "topple/structure/error.h"
#include "topple/structure/formats/input_files.h"
#include "topple/structure/formats/output_files.h"

namespace topple::viewer {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> lines_of(const fs::path& file) {
  constexpr std::uintmax_t most = std::uintmax_t{1} << 16;
  std::vector<std::string> lines;
  std::string text;
  try {
    text = structure::read_whole_file(file, most);
  } catch (const structure::InputError&) {  // none, or a pipe, a device, another's: nothing is remembered
    return lines;
  }
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line) && lines.size() < most_recent_files;)
    if (!line.empty()) lines.push_back(line);
  return lines;
}

}  // namespace

fs::path recent_files_place() {
  // The specification: a path that is not absolute is to be ignored.
  const char* state = std::getenv("XDG_STATE_HOME");
  if (state != nullptr && fs::path(state).is_absolute()) return fs::path(state) / "topple" / "recent";
  const char* home = std::getenv("HOME");
  if (home != nullptr && fs::path(home).is_absolute()) return fs::path(home) / ".local" / "state" / "topple" / "recent";
  return {};
}

std::vector<std::string> recent_files() {
  std::vector<std::string> names;
  const fs::path place = recent_files_place();
  if (!place.empty()) names = lines_of(place);
  std::erase_if(names, [](const std::string& name) {
    std::error_code ignored;
    return fs::path(name).is_absolute() && !fs::exists(name, ignored);
  });
  return names;
}

void remember_file(const std::string& name) {
  const fs::path place = recent_files_place();
  if (place.empty() || name.find('\n') != std::string::npos) return;
  std::error_code failed;
  const std::string kept = fs::exists(name, failed) ? fs::absolute(name, failed).lexically_normal().string() : name;
  std::vector<std::string> names = recent_files();
  std::erase(names, kept);
  names.insert(names.begin(), kept);
  if (names.size() > most_recent_files) names.resize(most_recent_files);
  fs::create_directories(place.parent_path(), failed);
  if (failed) return;
  std::string text;
  for (const std::string& line : names) text += line + '\n';
  try {
    structure::write_file(place, text);
  } catch (const std::exception&) {  // a list of convenience is no reason to end
    return;
  }
}

}  // namespace topple::viewer
