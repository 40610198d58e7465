// A signal that ends the program takes away what is being made, whenever it comes.
#include "formats/files/temporary_name.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <string>
#include <thread>

#include "support/scratch_folder.h"
#include "topple/structure/formats/output_files.h"

using topple::structure::remove_temporaries_on_signals;
using topple::structure::TemporaryName;
using topple::test::ScratchFolder;

namespace {

/// A program of its own makes a file and calls `meanwhile` before the file is known. Returns what ended it (0:
/// nothing).
template <class Meanwhile>
int signal_that_ended(const std::filesystem::path& path, Meanwhile meanwhile) {
  const pid_t child = ::fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    std::signal(SIGINT, SIG_DFL);  // the test's own handler
    remove_temporaries_on_signals();
    TemporaryName name(path);
    name.make([&] {
      const int made = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL, 0600);
      meanwhile();
      return made >= 0;
    });
    ::sleep(20);  // time for a thread that handles the signal
    ::_exit(0);
  }
  int status = 0;
  REQUIRE(::waitpid(child, &status, 0) == child);
  return WIFSIGNALED(status) ? WTERMSIG(status) : 0;
}

}  // namespace

TEST_CASE("an interrupt between making a file and knowing it leaves none") {
  const ScratchFolder folder;
  const auto path = folder / "part";
  CHECK(signal_that_ended(path, [] { (void)::raise(SIGINT); }) == SIGINT);
  CHECK_FALSE(std::filesystem::exists(path));
}

TEST_CASE("an interrupt that another thread handles waits until what is being made is known") {
  const ScratchFolder folder;
  const auto path = folder / "part";
  CHECK(signal_that_ended(path, [&] {
          sigset_t interrupt;
          sigemptyset(&interrupt);
          sigaddset(&interrupt, SIGINT);
          std::thread([&] {
            ::pthread_sigmask(SIG_UNBLOCK, &interrupt, nullptr);  // a thread has the mask of the one that begins it
            (void)::raise(SIGINT);
          }).detach();
          ::usleep(50'000);
        }) == SIGINT);
  CHECK_FALSE(std::filesystem::exists(path));
}

TEST_CASE("an interrupt leaves no file of a thread that makes one after another") {
  const ScratchFolder folder;
  for (int trial = 0; trial < 40; ++trial) {
    const auto making_files = [&] {
      for (int i = 0;; ++i) {
        const auto path = folder / std::to_string(i);
        TemporaryName name(path);
        name.make([&] {
          const int made = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL, 0600);
          ::close(made);
          return made >= 0;
        });
        ::unlink(path.c_str());
      }
    };
    const pid_t child = ::fork();
    REQUIRE(child >= 0);
    if (child == 0) {
      std::signal(SIGINT, SIG_DFL);  // the test's own handler
      remove_temporaries_on_signals();
      sigset_t interrupt;
      sigemptyset(&interrupt);
      sigaddset(&interrupt, SIGINT);
      ::pthread_sigmask(SIG_BLOCK, &interrupt, nullptr);
      std::thread(making_files).detach();  // never handles it itself
      ::pthread_sigmask(SIG_UNBLOCK, &interrupt, nullptr);
      ::usleep(2'000);
      (void)::raise(SIGINT);
      ::_exit(0);
    }
    int status = 0;
    REQUIRE(::waitpid(child, &status, 0) == child);
    CHECK((WIFSIGNALED(status) && WTERMSIG(status) == SIGINT));
    CHECK(std::filesystem::is_empty(folder.path()));
  }
}
