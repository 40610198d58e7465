// topple: static analysis and demolition from the command line. Exit status: 0 done, 1 failure, 2 bad input, 3 the
// model is not stable.
#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "command.h"
#include "support/version.h"
#include "topple/solver/blas_kernel.h"

namespace topple::app {

std::vector<Command>& commands() {
  static std::vector<Command> list;
  return list;
}

namespace {

int run(int argc, char** argv) {
  CLI::App app{"Topple analyses buildings statically and demolishes them.", "topple"};
  app.set_version_flag("--version", version());
  app.require_subcommand(1);
  auto list = commands();
  std::sort(list.begin(), list.end(), [](const Command& a, const Command& b) { return a.name < b.name; });
  std::vector<std::pair<CLI::App*, std::function<int()>>> chosen;
  for (const Command& command : list) {
    CLI::App* sub = app.add_subcommand(command.name, command.purpose);
    chosen.emplace_back(sub, command.declare(*sub));
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& asked) {  // --help, --version
    return app.exit(asked);
  } catch (const CLI::ParseError& error) {
    return print_error("topple", error.what(), bad_input);
  }
  for (auto& [sub, action] : chosen)
    if (sub->parsed()) return action();
  return bad_input;
}

}  // namespace
}  // namespace topple::app

int main(int argc, char** argv) {
  using namespace topple::app;
  topple::solver::prepare_blas(argv);
  const int status = run_program("topple", [&] { return run(argc, argv); });
  std::fflush(nullptr);
  std::quick_exit(status);  // what lives to the end goes with the process
}
