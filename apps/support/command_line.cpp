#include "support/command_line.h"

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <iostream>
#include <new>
#include <system_error>

#include "topple/structure/error.h"
#include "topple/structure/formats/output_files.h"
#include "topple/structure/formats/plain_text.h"

namespace topple::app {

namespace {

/// Whether a path is wrong, rather than the disk.
bool wrong_path(const std::error_code& code) {
  for (const std::errc one :
       {std::errc::too_many_symbolic_link_levels, std::errc::filename_too_long, std::errc::not_a_directory,
        std::errc::is_a_directory, std::errc::no_such_file_or_directory, std::errc::permission_denied})
    if (code == one) return true;
  return false;
}

}  // namespace

int print_error(const char* program, const std::string& what, Status status) {
  std::fprintf(stderr, "%s: %s\n", program, structure::one_line(what).c_str());
  return status;
}

int run_program(const char* program, const std::function<int()>& run) {
  try {
    structure::remove_temporaries_on_signals();
    // Beyond the limit of a file's size, and where nobody reads, a write fails and says so; files come to their end.
    for (const int signal : {SIGXFSZ, SIGPIPE}) std::signal(signal, SIG_IGN);
    const int status = run();
    std::cout.flush();
    errno = 0;
    if (std::fflush(stdout) == 0 && !std::ferror(stdout) && std::cout.good()) return status;
    const std::string reason = errno != 0 ? std::strerror(errno) : "not all was taken";
    return print_error(program, "cannot write to standard output: " + reason, failure);
  } catch (const structure::InputError& error) {
    return print_error(program, error.what(), bad_input);
  } catch (const structure::UnstableModel& error) {
    return print_error(program, error.what(), unstable);
  } catch (const std::filesystem::filesystem_error& error) {
    return print_error(program, error.path1().string() + ": " + error.code().message(),
                       wrong_path(error.code()) ? bad_input : failure);
  } catch (const std::bad_alloc&) {
    return print_error(program, "there is not enough memory", failure);
  } catch (const std::exception& error) {
    return print_error(program, error.what(), failure);
  }
}

}  // namespace topple::app
