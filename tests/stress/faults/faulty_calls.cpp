// A library to be preloaded: lets one call of a program fail, or ends the program there, as a full disk, a short memory
// and a power cut do. FAULT_CALL names the call, FAULT_AT says which one (from 1), FAULT_HOW is "fail" or "kill";
// FAULT_COUNT names a file that takes how many there were, when nothing is to fail.
//   write, rename, fsync, close, open: through which files are made (open: for writing alone; write: to regular files)
//   new: operator new, called by the program itself (through the C++ library or not), not by libraries of the system
#include <dlfcn.h>
#include <execinfo.h>
#include <fcntl.h>
#include <link.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>

namespace {

std::atomic<bool> counting{false};  // from main() on: what comes before is the loader's
std::atomic<long> calls{0};
const char* wanted = nullptr;
const char* counted_to = nullptr;
long fault_at = 0;
bool kills = false;

template <class Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

/// Whether this call is the one; one that kills does not come back.
bool fails(const char* call) {
  if (!counting.load() || wanted == nullptr || std::strcmp(call, wanted) != 0) return false;
  if (calls.fetch_add(1) + 1 != fault_at) return false;
  if (kills) raise(SIGKILL);
  return true;
}

bool regular(int descriptor) {
  struct stat found {};
  return fstat(descriptor, &found) == 0 && S_ISREG(found.st_mode);
}

void tell_count() {
  counting = false;
  if (counted_to == nullptr) return;
  if (std::FILE* file = std::fopen(counted_to, "w")) {
    std::fprintf(file, "%ld\n", calls.load());
    std::fclose(file);
  }
}

/// Where the program and the C++ library lie in memory.
struct Range {
  std::uintptr_t from = 0, to = 0;
  [[nodiscard]] bool has(const void* at) const {
    const auto place = reinterpret_cast<std::uintptr_t>(at);
    return place >= from && place < to;
  }
};
Range own, library;

int note_range(dl_phdr_info* info, std::size_t, void*) {
  Range all{~std::uintptr_t{0}, 0};
  for (int i = 0; i < info->dlpi_phnum; ++i) {
    if (info->dlpi_phdr[i].p_type != PT_LOAD) continue;
    const std::uintptr_t from = info->dlpi_addr + info->dlpi_phdr[i].p_vaddr;
    all.from = from < all.from ? from : all.from;
    const std::uintptr_t to = from + info->dlpi_phdr[i].p_memsz;
    all.to = to > all.to ? to : all.to;
  }
  if (info->dlpi_name[0] == '\0' && own.to == 0) own = all;
  if (std::strstr(info->dlpi_name, "libstdc++") != nullptr) library = all;
  return 0;
}

/// Whether the program asks, by itself or in the C++ library: an exception through others would break them.
__attribute__((noinline)) bool asked_by_program(const void* caller) {
  if (own.has(caller)) return true;
  if (!library.has(caller)) return false;
  void* frames[12];
  const int count = backtrace(frames, 12);
  for (int i = 1; i < count; ++i)
    if (!library.has(frames[i])) return own.has(frames[i]);
  return false;
}

int (*program)(int, char**, char**) = nullptr;

int counted_program(int argc, char** argv, char** environment) {
  wanted = getenv("FAULT_CALL");
  counted_to = getenv("FAULT_COUNT");
  if (const char* at = getenv("FAULT_AT")) fault_at = atol(at);
  const char* how = getenv("FAULT_HOW");
  kills = how != nullptr && std::strcmp(how, "kill") == 0;
  void* frame = nullptr;
  (void)backtrace(&frame, 1);  // takes memory the first time
  dl_iterate_phdr(note_range, nullptr);
  counting = true;
  const int status = program(argc, argv, environment);
  tell_count();
  return status;
}

}  // namespace

extern "C" {

int __libc_start_main(int (*main)(int, char**, char**), int argc, char** argv, void (*init)(), void (*fini)(),
                      void (*ld_fini)(), void* stack_end) {
  program = main;
  return next<int(int (*)(int, char**, char**), int, char**, void (*)(), void (*)(), void (*)(), void*)>(
      "__libc_start_main")(counted_program, argc, argv, init, fini, ld_fini, stack_end);
}

void quick_exit(int status) {
  tell_count();
  next<void(int)>("quick_exit")(status);
  __builtin_unreachable();
}

ssize_t write(int descriptor, const void* bytes, size_t size) {
  if (regular(descriptor) && fails("write")) return errno = ENOSPC, -1;
  return next<ssize_t(int, const void*, size_t)>("write")(descriptor, bytes, size);
}

int rename(const char* from, const char* to) {
  if (fails("rename")) return errno = EIO, -1;
  return next<int(const char*, const char*)>("rename")(from, to);
}

int fsync(int descriptor) {
  if (fails("fsync")) return errno = EIO, -1;
  return next<int(int)>("fsync")(descriptor);
}

int close(int descriptor) {
  if (counting.load() && regular(descriptor) && fails("close")) {
    next<int(int)>("close")(descriptor);
    return errno = EDQUOT, -1;
  }
  return next<int(int)>("close")(descriptor);
}

int open(const char* path, int flags, ...) {
  va_list more;
  va_start(more, flags);
  const mode_t mode = (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(more, mode_t) : 0;
  va_end(more);
  if ((flags & O_CREAT) != 0 && fails("open")) return errno = ENOSPC, -1;
  return next<int(const char*, int, ...)>("open")(path, flags, mode);
}

}  // extern "C"

void* operator new(std::size_t size) {
  if (counting.load() && wanted != nullptr && std::strcmp(wanted, "new") == 0 &&
      asked_by_program(__builtin_return_address(0)) && fails("new"))
    throw std::bad_alloc();
  if (void* memory = std::malloc(size > 0 ? size : 1)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
