#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <optional>
#include <streambuf>

#include "formats/files/temporary_name.h"
#include "topple/structure/error.h"
#include "topple/structure/formats/output_files.h"
#include "topple/structure/formats/plain_text.h"

namespace topple::structure {

namespace {

namespace fs = std::filesystem;

std::string reason(int error) { return std::strerror(error); }

/// Characters to a file descriptor, a buffer at a time. What failed first is kept, and nothing is written after it.
class DescriptorBuffer : public std::streambuf {
 public:
  explicit DescriptorBuffer(int descriptor) : descriptor_(descriptor) { setp(buffer_.data(), end()); }
  [[nodiscard]] int error() const { return error_; }
  bool put(std::string_view text) {
    if (!send({pbase(), static_cast<std::size_t>(pptr() - pbase())})) return false;
    setp(buffer_.data(), end());
    return send(text);
  }

 protected:
  int sync() override { return put({}) ? 0 : -1; }
  int_type overflow(int_type c) override {
    if (!put({})) return traits_type::eof();
    if (c != traits_type::eof()) sputc(static_cast<char>(c));
    return traits_type::not_eof(c);
  }
  std::streamsize xsputn(const char* text, std::streamsize size) override {
    if (size < epptr() - pptr()) {
      std::memcpy(pptr(), text, static_cast<std::size_t>(size));
      pbump(static_cast<int>(size));
      return size;
    }
    return put({text, static_cast<std::size_t>(size)}) ? size : 0;
  }

 private:
  char* end() { return buffer_.data() + buffer_.size(); }
  bool send(std::string_view text) {
    while (!text.empty() && error_ == 0) {
      const ssize_t sent = ::write(descriptor_, text.data(), text.size());
      if (sent > 0)
        text.remove_prefix(static_cast<std::size_t>(sent));
      else if (errno != EINTR)
        error_ = sent == 0 ? EIO : errno;
    }
    return error_ == 0;
  }

  int descriptor_, error_ = 0;
  std::array<char, 1 << 16> buffer_{};
};

/// What has the target's name now; none: nothing.
std::optional<struct stat> standing_there(const fs::path& target) {
  struct stat found {};
  if (::lstat(target.c_str(), &found) == 0) return found;
  if (errno == ENOENT) return std::nullopt;
  throw InputError(one_line(target.string()) + ": cannot be written: " + reason(errno) +
                   "; accepted: a place where a file can be made");
}

/// A name in the target's folder that no other file of any run has.
fs::path own_name(const fs::path& target, int attempt) {
  static std::atomic<unsigned> next{0};
  const std::string name = ".topple-" + std::to_string(::getpid()) + "-" + std::to_string(next++) + "-" +
                           std::to_string(attempt) + ".part" + target.extension().string();
  return target.parent_path() / name;
}

}  // namespace

struct OutputFile::State {
  fs::path target, temporary;
  TemporaryName name;
  int descriptor = -1;
  bool replaces = false, named = false;
  std::unique_ptr<DescriptorBuffer> buffer;
  std::unique_ptr<std::ostream> stream;

  ~State() {
    if (descriptor >= 0) ::close(descriptor);
    if (!temporary.empty() && !named) ::unlink(temporary.c_str());
  }
  [[noreturn]] void fail(int error) const {
    throw std::runtime_error("cannot write " + one_line(target.string()) + ": " + reason(error));
  }
  void check_target() {
    const auto there = standing_there(target);
    if (there && !S_ISREG(there->st_mode) && !S_ISLNK(there->st_mode))
      throw InputError(one_line(target.string()) + ": is " +
                       (S_ISDIR(there->st_mode) ? "a folder" : "no regular file") + "; accepted: the name of a file");
    replaces = there.has_value();
    if (replaces && S_ISREG(there->st_mode) && ::access(target.c_str(), W_OK) != 0)
      throw InputError(one_line(target.string()) + ": cannot be written: " + reason(errno) +
                       "; accepted: a file that may be replaced");
  }
  void open() {
    constexpr int attempts = 1000;
    for (int i = 0; i < attempts && descriptor < 0; ++i) {
      fs::path own = own_name(target, i);
      name = TemporaryName(own);
      const bool made = name.make([&] {
        descriptor = ::open(own.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0666);
        return descriptor >= 0;
      });
      if (made)
        temporary = std::move(own);
      else if (errno != EEXIST)
        break;
    }
    if (descriptor < 0)
      throw InputError(one_line(target.string()) + ": cannot be written: " + reason(errno) +
                       "; accepted: a place where a file can be made");
    buffer = std::make_unique<DescriptorBuffer>(descriptor);
    stream = std::make_unique<std::ostream>(buffer.get());
  }
  void finish() {
    if (descriptor < 0) return;
    buffer->put({});
    int error = buffer->error();
    if (error == 0 && replaces && ::fsync(descriptor) != 0) error = errno;
    if (::close(std::exchange(descriptor, -1)) != 0 && error == 0) error = errno;
    if (error != 0) fail(error);
  }
};

OutputFile::OutputFile(fs::path target) : state_(std::make_unique<State>()) {
  if (target.filename().empty())
    throw InputError("\"" + one_line(target.string()) + "\": names no file; accepted: the name of a file");
  state_->target = std::move(target);
  state_->check_target();
  state_->open();
}
OutputFile::OutputFile(OutputFile&&) noexcept = default;
OutputFile& OutputFile::operator=(OutputFile&&) noexcept = default;
OutputFile::~OutputFile() = default;

void OutputFile::write(std::string_view text) {
  if (!state_->buffer->put(text)) state_->fail(state_->buffer->error());
}
std::ostream& OutputFile::stream() { return *state_->stream; }
const fs::path& OutputFile::temporary() const { return state_->temporary; }
const fs::path& OutputFile::target() const { return state_->target; }
void OutputFile::finish() { state_->finish(); }

void OutputFile::commit() {
  finish();
  if (::rename(state_->temporary.c_str(), state_->target.c_str()) != 0) state_->fail(errno);
  state_->named = true;
  state_->name.forget();
}

void write_file(const fs::path& target, std::string_view text) {
  OutputFile file(target);
  file.write(text);
  file.commit();
}

void require_writable(const fs::path& target) { OutputFile{target}; }

void require_different(const fs::path& input, const fs::path& output) {
  std::error_code ignored;
  if (fs::equivalent(input, output, ignored))
    throw InputError(one_line(output.string()) + ": is what is read (" + one_line(input.string()) +
                     "); accepted: another file");
}

void write_files(const fs::path& folder, const NamedFiles& files, const std::vector<StreamedFile>& streamed) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error)
    throw InputError(one_line(folder.string()) + ": cannot be made: " + error.message() + "; accepted: a folder");
  std::vector<OutputFile> whole;
  whole.reserve(files.size() + streamed.size());
  for (const auto& [name, text] : files) {
    whole.emplace_back(folder / name).write(text);
    whole.back().finish();
  }
  for (const StreamedFile& file : streamed) {
    OutputFile& out = whole.emplace_back(folder / file.name);
    file.write([&](std::string_view text) { out.write(text); });
    out.finish();
  }
  for (OutputFile& file : whole) file.commit();
}

}  // namespace topple::structure
