#include "write_files.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <stdexcept>

namespace topple::app {

namespace {

std::filesystem::path temporary(const std::filesystem::path& path) { return path.string() + ".part"; }

[[noreturn]] void fail(const std::filesystem::path& path) {
  throw std::runtime_error("cannot write " + path.string() + ": " + std::strerror(errno));
}

}  // namespace

void write_files(const std::filesystem::path& folder, const std::vector<std::pair<std::string, std::string>>& files,
                 const std::vector<StreamedFile>& streamed) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw std::runtime_error("cannot make the folder " + folder.string() + ": " + error.message());
  std::vector<std::string> names;
  const auto write = [&](const std::string& name, const auto& hand_over) {
    names.push_back(name);
    const auto path = temporary(folder / name);
    std::ofstream out(path, std::ios::binary);
    hand_over([&](std::string_view text) { out.write(text.data(), static_cast<std::streamsize>(text.size())); });
    out.close();
    if (!out) {
      for (const std::string& other : names) std::filesystem::remove(temporary(folder / other), error);
      fail(path);
    }
  };
  for (const auto& [name, text] : files) write(name, [&](const auto& sink) { sink(text); });
  for (const StreamedFile& file : streamed) write(file.name, file.write);
  for (const std::string& name : names) {
    // A file that takes another one's name is put on the disk at once by some file systems (ext4), which takes longer
    // than all of an analysis. Both are whole at all times: results need no more.
    std::filesystem::remove(folder / name);
    std::filesystem::rename(temporary(folder / name), folder / name);
  }
}

}  // namespace topple::app
