#include "study/worker_processes.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <new>
#include <optional>
#include <stdexcept>

namespace topple::structure::study {

namespace {

/// Memory that forked processes share: the next sample that nobody has taken.
class SharedCounter {
 public:
  SharedCounter() {
    void* memory =
        ::mmap(nullptr, sizeof(std::atomic<std::size_t>), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED) throw std::bad_alloc();
    next_ = new (memory) std::atomic<std::size_t>(0);
    static_assert(std::atomic<std::size_t>::is_always_lock_free);
  }
  SharedCounter(const SharedCounter&) = delete;
  SharedCounter& operator=(const SharedCounter&) = delete;
  ~SharedCounter() { ::munmap(next_, sizeof *next_); }
  std::size_t next() { return (*next_)++; }
  [[nodiscard]] std::size_t given_out() const { return *next_; }

 private:
  std::atomic<std::size_t>* next_;
};

/// What a worker sends: that it begins a sample, a sample's line, or that it cannot work at all.
struct Message {
  enum class Kind : std::uint8_t { begun, line, fault };
  Kind kind = Kind::begun;
  std::uint64_t index = 0;
  double seconds = 0;
  std::uint64_t length = 0;  ///< of the text that follows
};

void send(int pipe, const Message& message, std::string_view text) {
  std::string bytes(reinterpret_cast<const char*>(&message), sizeof message);
  bytes += text;
  for (std::string_view left = bytes; !left.empty();) {
    const ssize_t written = ::write(pipe, left.data(), left.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) ::_exit(1);  // nobody listens any more
    left.remove_prefix(static_cast<std::size_t>(written));
  }
}

/// Keeps nothing of the parent's but the standard streams and this pipe: a lock on a folder lasts as long as any copy
/// of its file, and a reader that is gone is noticed once the last copy of its end is closed.
void keep_only(int pipe) {
  constexpr unsigned first = STDERR_FILENO + 1;
  const auto kept = static_cast<unsigned>(pipe);
  if (kept > first) ::close_range(first, kept - 1, 0);
  ::close_range(kept + 1, ~0U, 0);
}

/// A worker whose parent was killed works for nobody.
void end_with_parent(pid_t parent) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(1);
}

[[noreturn]] void work(const StudyTask& task, std::size_t count, const std::function<Sample(std::size_t)>& make,
                       SharedCounter& counter, int pipe) {
  // Ctrl-C reaches all processes of a terminal: the first one decides, and ends the others.
  std::signal(SIGINT, SIG_IGN);
  std::signal(SIGTERM, SIG_DFL);
  try {
    const auto evaluator = task.make_evaluator();
    for (std::size_t i = counter.next(); i < count; i = counter.next()) {
      send(pipe, {Message::Kind::begun, i, 0, 0}, {});
      Sample sample = make(i);
      evaluate(*evaluator, sample);
      const std::string line = journal_line(task, sample);
      send(pipe, {Message::Kind::line, i, sample.seconds, line.size()}, line);
    }
  } catch (const std::exception& error) {
    const std::string_view what = error.what();
    send(pipe, {Message::Kind::fault, 0, 0, what.size()}, what);
  }
  ::_exit(0);
}

class Worker {
 public:
  Worker(const StudyTask& task, std::size_t count, const std::function<Sample(std::size_t)>& make,
         SharedCounter& counter) {
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0)
      throw std::runtime_error(std::string("no pipe for a worker: ") + std::strerror(errno));
    const pid_t parent = ::getpid();
    id_ = ::fork();
    if (id_ == 0) {
      keep_only(ends[1]);
      end_with_parent(parent);
      work(task, count, make, counter, ends[1]);
    }
    ::close(ends[1]);
    pipe_ = ends[0];
    if (id_ < 0) throw std::runtime_error(std::string("no process for a worker: ") + std::strerror(errno));
  }
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;
  Worker(Worker&& other) noexcept
      : id_(std::exchange(other.id_, -1)),
        pipe_(std::exchange(other.pipe_, -1)),
        bytes_(std::move(other.bytes_)),
        at_(other.at_) {}
  Worker& operator=(Worker&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(pipe_, other.pipe_);
    bytes_.swap(other.bytes_);
    std::swap(at_, other.at_);
    return *this;
  }
  ~Worker() {
    if (pipe_ >= 0) ::close(pipe_);
    if (id_ <= 0) return;
    ::kill(id_, SIGKILL);
    (void)wait();
  }

  [[nodiscard]] int pipe() const { return pipe_; }
  /// Reads what is there; false at the end.
  [[nodiscard]] bool read() {
    char buffer[1 << 16];
    const ssize_t count = ::read(pipe_, buffer, sizeof buffer);
    if (count < 0 && errno == EINTR) return true;
    if (count <= 0) return false;
    bytes_.append(buffer, static_cast<std::size_t>(count));
    return true;
  }
  /// The next whole message.
  [[nodiscard]] std::optional<std::pair<Message, std::string>> next() {
    Message message;
    if (bytes_.size() < sizeof message) return std::nullopt;
    std::memcpy(&message, bytes_.data(), sizeof message);
    if (bytes_.size() < sizeof message + message.length) return std::nullopt;
    std::string text = bytes_.substr(sizeof message, message.length);
    bytes_.erase(0, sizeof message + message.length);
    at_ = message.kind == Message::Kind::begun ? std::optional(message.index) : std::nullopt;
    return std::pair{message, std::move(text)};
  }
  /// The sample that it was at.
  [[nodiscard]] std::optional<std::uint64_t> at() const { return at_; }
  /// How it ended, in words.
  [[nodiscard]] std::string wait() {
    int status = 0;
    while (::waitpid(id_, &status, 0) < 0 && errno == EINTR) continue;
    id_ = -1;
    if (WIFSIGNALED(status)) return "the process was ended by signal " + std::to_string(WTERMSIG(status));
    return "the process ended with status " + std::to_string(WEXITSTATUS(status));
  }

 private:
  pid_t id_ = -1;
  int pipe_ = -1;
  std::string bytes_;
  std::optional<std::uint64_t> at_;
};

}  // namespace

void run_in_processes(const StudyTask& task, const StudyRun& run, std::size_t count, std::size_t workers,
                      const std::function<Sample(std::size_t)>& make, const std::function<void(Sample&&)>& take) {
  SharedCounter counter;
  std::vector<Worker> all;
  for (std::size_t w = 0; w < workers; ++w) all.emplace_back(task, count, make, counter);
  std::uint64_t done = 0;
  const auto hand_on = [&](Sample&& sample) {
    take(std::move(sample));
    if (run.progress) run.progress(++done, count);
  };
  const auto drain = [&](Worker& worker) {
    while (const auto message = worker.next()) {
      if (message->first.kind == Message::Kind::fault) throw std::runtime_error(message->second);
      if (message->first.kind == Message::Kind::begun) continue;
      std::optional<Sample> sample = read_journal_line(task, message->second);
      if (!sample) throw std::runtime_error("a worker has sent a damaged line");
      sample->seconds = message->first.seconds;
      hand_on(std::move(*sample));
    }
  };
  while (!all.empty()) {
    if (run.stopped && run.stopped()) return;  // what is not whole is computed again
    std::vector<pollfd> ready;
    for (const Worker& worker : all) ready.push_back({worker.pipe(), POLLIN, 0});
    constexpr int look_up = 100;  // ms: how soon a stop is noticed
    if (::poll(ready.data(), ready.size(), look_up) <= 0) continue;
    for (std::size_t w = all.size(); w-- > 0;) {
      if (ready[w].revents == 0) continue;
      const bool more = all[w].read();
      drain(all[w]);
      if (more) continue;
      const std::optional<std::uint64_t> at = all[w].at();
      const std::string how = all[w].wait();
      all.erase(all.begin() + static_cast<std::ptrdiff_t>(w));
      if (!at) continue;
      Sample sample = make(*at);
      sample.failed = how;
      hand_on(std::move(sample));
      if (counter.given_out() < count) all.emplace_back(task, count, make, counter);
    }
  }
}

}  // namespace topple::structure::study
