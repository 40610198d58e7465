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

void write_files(const std::filesystem::path& folder, const std::vector<std::pair<std::string, std::string>>& files) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw std::runtime_error("cannot make the folder " + folder.string() + ": " + error.message());
  for (const auto& [name, text] : files) {
    const auto path = temporary(folder / name);
    std::ofstream out(path, std::ios::binary);
    out.write(text.data(), static_cast<std::streamsize>(text.size()));
    out.close();
    if (!out) {
      for (const auto& [other, unused] : files) std::filesystem::remove(temporary(folder / other), error);
      fail(path);
    }
  }
  for (const auto& [name, text] : files) std::filesystem::rename(temporary(folder / name), folder / name);
}

}  // namespace topple::app
