#pragma once
// How a subcommand of `topple` makes itself known: each file of this folder defines one Command and registers it, so
// that no list of commands has to be kept.
#include <functional>
#include <string>
#include <vector>

#include "support/command_line.h"

namespace topple::app {

struct Command {
  std::string name, purpose;
  /// Declares the options on the subcommand and returns what runs when it was chosen (its result is the exit status).
  std::function<std::function<int()>(CLI::App&)> declare;
};

/// All registered commands; order of registration does not matter, they are shown by name.
std::vector<Command>& commands();

struct Registration {
  explicit Registration(Command command) { commands().push_back(std::move(command)); }
};

}  // namespace topple::app
