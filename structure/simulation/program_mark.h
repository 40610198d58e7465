#pragma once
#include <string>

namespace topple::structure {

/// What tells this build of the program from every other one: the linker's build id of the file that this code was
/// loaded from, as bytes. Empty where the linker has written none.
[[nodiscard]] std::string program_mark();

}  // namespace topple::structure
