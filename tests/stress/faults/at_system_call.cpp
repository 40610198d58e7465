// Runs a program and ends it at one of its system calls, whichever that is, of any of its threads and processes:
//   at_system_call CALL SIGNAL PROGRAM [ARGUMENT...]
// CALL counts from 1, SIGNAL is a number. CALL 0 runs to the end and writes how many there were into the file
// that COUNT_FILE names. Ends as
// the program does: with its status, or by the signal that it had.
#include <sys/ptrace.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>

namespace {

[[noreturn]] void give_up(const char* what) {
  std::perror(what);
  std::exit(125);
}

void end_as(int status) {
  if (!WIFSIGNALED(status)) std::exit(WEXITSTATUS(status));
  const rlimit none{0, 0};  // no core file of this one
  (void)setrlimit(RLIMIT_CORE, &none);
  std::signal(WTERMSIG(status), SIG_DFL);
  raise(WTERMSIG(status));
  std::exit(125);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) return 125;
  const long call = std::atol(argv[1]);
  const int with = std::atoi(argv[2]);
  const pid_t program = fork();
  if (program == 0) {
    ptrace(PTRACE_TRACEME, 0, nullptr, nullptr);
    raise(SIGSTOP);
    execvp(argv[3], argv + 3);
    _exit(125);
  }
  int status = 0;
  if (waitpid(program, &status, 0) < 0) give_up("waitpid");
  constexpr long options = PTRACE_O_TRACESYSGOOD | PTRACE_O_TRACECLONE | PTRACE_O_TRACEFORK | PTRACE_O_TRACEVFORK |
                           PTRACE_O_TRACEEXEC | PTRACE_O_EXITKILL;
  if (ptrace(PTRACE_SETOPTIONS, program, nullptr, options) != 0) give_up("ptrace");
  ptrace(PTRACE_SYSCALL, program, nullptr, nullptr);
  long stops = 0;  // two for each call: as it begins and as it ends
  bool done = false;
  for (pid_t thread = waitpid(-1, &status, __WALL); thread > 0; thread = waitpid(-1, &status, __WALL)) {
    if (WIFEXITED(status) || WIFSIGNALED(status)) {
      if (thread == program) break;
      continue;
    }
    const int stop = WSTOPSIG(status);
    long handed_on = 0;
    if (stop == (SIGTRAP | 0x80)) {
      if (!done && ++stops == 2 * call - 1) {
        done = true;
        kill(program, with);
      }
    } else if (stop != SIGTRAP && stop != SIGSTOP) {
      handed_on = stop;
    }
    ptrace(PTRACE_SYSCALL, thread, nullptr, handed_on);
  }
  if (call == 0) {
    const char* const name = std::getenv("COUNT_FILE");
    std::FILE* const file = name != nullptr ? std::fopen(name, "w") : nullptr;
    if (file == nullptr || std::fprintf(file, "%ld\n", stops / 2) < 0 || std::fclose(file) != 0) give_up("COUNT_FILE");
  }
  end_as(status);
}
