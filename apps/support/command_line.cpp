#include "support/command_line.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <iostream>
#include <new>

#include "topple/structure/error.h"
#include "topple/structure/output_files.h"
#include "topple/structure/plain_text.h"

namespace topple::app {

int tell_error(const char* program, const std::string& what, Status status) {
  std::fprintf(stderr, "%s: %s\n", program, structure::one_line(what).c_str());
  return status;
}

int run_program(const char* program, const std::function<int()>& run) {
  try {
    structure::remove_temporaries_on_signals();
    const int status = run();
    std::cout.flush();
    errno = 0;
    if (std::fflush(stdout) == 0 && !std::ferror(stdout) && std::cout.good()) return status;
    const std::string reason = errno != 0 ? std::strerror(errno) : "not all was taken";
    return tell_error(program, "cannot write to standard output: " + reason, failure);
  } catch (const structure::InputError& error) {
    return tell_error(program, error.what(), bad_input);
  } catch (const structure::UnstableModel& error) {
    return tell_error(program, error.what(), unstable);
  } catch (const std::bad_alloc&) {
    return tell_error(program, "there is not enough memory", failure);
  } catch (const std::exception& error) {
    return tell_error(program, error.what(), failure);
  }
}

}  // namespace topple::app
