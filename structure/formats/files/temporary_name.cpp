#include "formats/files/temporary_name.h"

#include <poll.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <mutex>
#include <utility>
#include <vector>

#include "topple/structure/formats/output_files.h"

namespace topple::structure {

/// One name at a time, again and again; a slot that was made stays until the program ends, as a signal may read it.
struct TemporaryName::Slot {
  std::atomic<char*> path{nullptr};
  Slot* next = nullptr;
};

namespace {

std::atomic<TemporaryName::Slot*> slots{nullptr};
std::atomic<bool> ending{false};
std::atomic<int> making{0};  ///< threads that are between making something and knowing it
constexpr std::array ending_signals{SIGINT, SIGTERM, SIGHUP};

/// Slots that no name has: handed out under a lock, which a signal's handler never takes.
struct FreeSlots {
  std::mutex mutex;
  std::vector<TemporaryName::Slot*> all;
};
FreeSlots& free_slots() {
  static FreeSlots* const kept = new FreeSlots;  // outlives whatever is written at the very end
  return *kept;
}

TemporaryName::Slot* claim_slot() {
  FreeSlots& free = free_slots();
  const std::lock_guard lock(free.mutex);
  if (!free.all.empty()) {
    TemporaryName::Slot* const slot = free.all.back();
    free.all.pop_back();
    return slot;
  }
  std::size_t count = 1;
  for (const TemporaryName::Slot* slot = slots; slot != nullptr; slot = slot->next) ++count;
  free.all.reserve(count);  // to give one back takes no memory
  auto* const slot = new TemporaryName::Slot;
  slot->next = slots.load();
  slots = slot;
  return slot;
}

/// Only what a handler may do (signal-safety(7)). Files first: a folder goes when it is empty.
void remove_and_end(int signal) {
  const int error = errno;
  ending = true;
  // Not for ever: a file system that does not answer must not keep a program from being ended.
  for (int tries = 0; making > 0 && tries < 1000; ++tries) (void)::poll(nullptr, 0, 1);
  const auto each = [](auto remove) {
    for (const TemporaryName::Slot* slot = slots; slot != nullptr; slot = slot->next)
      if (const char* path = slot->path) (void)remove(path);
  };
  each(::unlink);
  each(::rmdir);
  errno = error;
  std::signal(signal, SIG_DFL);
  (void)::raise(signal);  // ends the program when this handler returns
}

}  // namespace

TemporaryName::TemporaryName(const std::filesystem::path& path) : slot_(claim_slot()) {
  const std::string& text = path.native();
  try {
    path_ = new char[text.size() + 1];
  } catch (...) {
    forget();
    throw;
  }
  std::memcpy(path_, text.c_str(), text.size() + 1);
}

TemporaryName::TemporaryName(TemporaryName&& other) noexcept
    : slot_(std::exchange(other.slot_, nullptr)), path_(std::exchange(other.path_, nullptr)) {}

TemporaryName& TemporaryName::operator=(TemporaryName&& other) noexcept {
  std::swap(slot_, other.slot_);
  std::swap(path_, other.path_);
  return *this;
}

TemporaryName::~TemporaryName() { forget(); }

TemporaryName::Making::Making() noexcept {
  sigset_t held;
  sigemptyset(&held);
  for (const int signal : ending_signals) sigaddset(&held, signal);
  ::pthread_sigmask(SIG_BLOCK, &held, &before_);
  ++making;
  if (!ending) return;
  // The handler has looked, or is looking, through the names: it would not know this one.
  --making;
  for (;;) ::pause();  // until the signal ends the program
}

TemporaryName::Making::~Making() {
  --making;
  ::pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

void TemporaryName::known() noexcept {
  slot_->path = path_;
  if (ending) (void)::unlink(path_);  // the handler may have passed this slot already
}

void TemporaryName::forget() noexcept {
  if (slot_ == nullptr) return;
  slot_->path = nullptr;
  if (!ending) delete[] path_;  // else the handler may be reading it
  path_ = nullptr;
  FreeSlots& free = free_slots();
  const std::lock_guard lock(free.mutex);
  free.all.push_back(std::exchange(slot_, nullptr));
}

void remove_temporaries_on_signals() {
  (void)free_slots();
  for (const int signal : ending_signals) {
    struct sigaction now {};
    if (::sigaction(signal, nullptr, &now) != 0 || now.sa_handler != SIG_DFL) continue;  // nohup ignores SIGHUP
    now = {};
    now.sa_handler = remove_and_end;
    ::sigaction(signal, &now, nullptr);
  }
}

}  // namespace topple::structure
