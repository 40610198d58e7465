#include "topple/structure/formats/input_files.h"

#include <dirent.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>
#include <string_view>

#include "topple/structure/error.h"
#include "topple/structure/formats/plain_text.h"

namespace topple::structure {

namespace {

/// A file that is open for reading.
class OpenFile {
 public:
  OpenFile(const std::filesystem::path& file, std::uintmax_t most) : name_(one_line(file.string())) {
    // Without O_NONBLOCK a pipe is waited for until somebody writes into it.
    descriptor_ = ::open(file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY);
    if (descriptor_ < 0)
      throw InputError(name_ + ": cannot be opened: " + std::strerror(errno) +
                       "; accepted: a file that exists and can be read");
    struct stat found {};
    const bool known = ::fstat(descriptor_, &found) == 0;
    if (known && S_ISREG(found.st_mode)) {
      size = static_cast<std::uintmax_t>(found.st_size);
      if (size <= most) return;
    }
    ::close(descriptor_);
    if (known && S_ISDIR(found.st_mode)) throw InputError(name_ + ": is a folder; accepted: a file");
    if (!known || !S_ISREG(found.st_mode))
      throw InputError(name_ + ": is no regular file; accepted: a file on a disk, no pipe and no device");
    throw InputError(name_ + ": " + std::to_string(size) + " bytes; accepted: at most " + std::to_string(most));
  }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
  ~OpenFile() { ::close(descriptor_); }

  std::string read(std::uintmax_t most) const {
    std::string text(static_cast<std::size_t>(size), '\0');
    std::size_t have = 0;
    for (;;) {
      if (have == text.size()) text.resize(have + (have == size ? 1 : 1 << 16));  // one that grows meanwhile
      const ssize_t got = ::read(descriptor_, text.data() + have, text.size() - have);
      if (got < 0 && errno == EINTR) continue;
      if (got < 0)
        throw InputError(name_ + ": cannot be read: " + std::strerror(errno) +
                         "; accepted: a file that exists and can be read");
      if (got == 0) break;
      have += static_cast<std::size_t>(got);
      if (have > most) throw InputError(name_ + ": more than " + std::to_string(most) + " bytes; accepted: fewer");
    }
    text.resize(have);
    return text;
  }
  std::uintmax_t size = 0;

 private:
  std::string name_;
  int descriptor_ = -1;
};

}  // namespace

void require_readable(const std::filesystem::path& file, std::uintmax_t most) { OpenFile{file, most}; }

std::string read_whole_file(const std::filesystem::path& file, std::uintmax_t most) {
  return OpenFile(file, most).read(most);
}

std::vector<std::string> names_in(const std::filesystem::path& folder, std::error_code& error) {
  error.clear();
  const auto close = [](DIR* open) { ::closedir(open); };
  const std::unique_ptr<DIR, decltype(close)> open(::opendir(folder.c_str()), close);
  if (!open) {
    error = {errno, std::generic_category()};
    return {};
  }
  std::vector<std::string> names;
  while (const dirent* entry = ::readdir(open.get()))
    if (const std::string_view name = entry->d_name; name != "." && name != "..") names.emplace_back(name);
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace topple::structure
