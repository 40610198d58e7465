// The append-only journal of a run.
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <stdexcept>

#include "study/study_value.h"
#include "topple/structure/error.h"
#include "topple/structure/formats/input_files.h"

namespace topple::structure {

namespace {

constexpr const char* journal_name = "journal.jsonl";
constexpr const char* times_name = "times.csv";
constexpr double sync_every = 1;  // s

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

[[noreturn]] void cannot(const char* what, const std::filesystem::path& file) {
  throw std::runtime_error(file.string() + ": cannot be " + what + ": " + std::strerror(errno));
}

/// A file, not a pipe that would keep the run waiting, nor a device or a link to somewhere else.
int open_to_append(const std::filesystem::path& file) {
  const int opened = ::open(file.c_str(), O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, 0666);
  struct stat state {};
  const bool other = opened < 0 ? errno == ENXIO || errno == ELOOP || errno == EISDIR
                                : ::fstat(opened, &state) == 0 && !S_ISREG(state.st_mode);
  if (other) {
    if (opened >= 0) ::close(opened);
    throw InputError(file.string() + ": is no regular file; accepted: another folder (-o)");
  }
  if (opened < 0) cannot("opened", file);
  return opened;
}

/// One write where the system takes it whole, which it does for files unless the disk is full.
void append(int file, std::string_view text, const std::filesystem::path& name) {
  while (!text.empty()) {
    const ssize_t written = ::write(file, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) cannot("written", name);
    text.remove_prefix(static_cast<std::size_t>(written));
  }
}

}  // namespace

StudyJournal::StudyJournal(const StudyTask& task, const std::filesystem::path& folder, Found found)
    : task_(task), folder_(folder), has_(task.sampler.samples()) {
  const std::filesystem::path file = folder / journal_name;
  std::size_t whole = 0;
  if (std::filesystem::exists(std::filesystem::symlink_status(file))) {
    if (found == Found::refuse)
      throw InputError(file.string() + ": is there already; accepted: --resume, or another folder");
    const std::string text = read_whole_file(file, std::uintmax_t{1} << 36);
    std::size_t line_number = 0;
    for (std::size_t end = text.find('\n'); end != std::string::npos; end = text.find('\n', whole)) {
      ++line_number;
      std::optional<Sample> sample = read_journal_line(task, std::string_view(text).substr(whole, end - whole));
      if (!sample || sample->number >= has_.size())
        throw InputError(file.string() + ", line " + std::to_string(line_number) +
                         ": it is damaged, or of another study; accepted: the journal of this study, its files and "
                         "this version of the program");
      keep(std::move(*sample));
      whole = end + 1;
    }
  }
  if (found == Found::retry_failed)
    std::erase_if(found_, [&](const Sample& sample) {
      if (!sample.failed.empty()) has_[sample.number] = false;
      return !sample.failed.empty();
    });
  file_ = open_to_append(file);
  // A run that was killed in the middle of a line.
  if (::ftruncate(file_, static_cast<off_t>(whole)) != 0) cannot("written", file);
  times_ = open_to_append(folder / times_name);
  struct stat state {};
  if (::fstat(times_, &state) == 0 && state.st_size == 0) append(times_, "sample,seconds,where\n", folder / times_name);
  synced_at_ = now();
}

/// One that failed may have been tried again further on.
void StudyJournal::keep(Sample sample) {
  if (!has_[sample.number]) {
    has_[sample.number] = true;
    found_.push_back(std::move(sample));
    return;
  }
  const auto before =
      std::find_if(found_.begin(), found_.end(), [&](const Sample& one) { return one.number == sample.number; });
  if (!before->failed.empty()) *before = std::move(sample);
}

StudyJournal::~StudyJournal() {
  if (file_ >= 0) {
    ::fsync(file_);
    ::close(file_);
  }
  if (times_ >= 0) ::close(times_);
}

bool StudyJournal::has(std::uint64_t sample) const { return sample < has_.size() && has_[sample]; }

void StudyJournal::add(const Sample& sample) {
  add_line(sample.number, journal_line(task_, sample), sample.seconds, "0");
}

void StudyJournal::add_line(std::uint64_t sample, std::string_view line, double seconds, std::string_view where) {
  if (has(sample)) return;
  append(file_, std::string(line) + "\n", folder_ / journal_name);
  has_[sample] = true;
  append(times_, std::to_string(sample) + "," + study::number_text(seconds) + "," + std::string(where) + "\n",
         folder_ / times_name);
  if (now() - synced_at_ > sync_every) sync();
}

void StudyJournal::sync() {
  if (::fsync(file_) != 0) cannot("written", folder_ / journal_name);
  synced_at_ = now();
}

}  // namespace topple::structure
