#pragma once
// Which Topple this is.
#include <string>

namespace topple::app {

/// The commit that was built, twelve digits; empty where the source came without its history.
[[nodiscard]] std::string commit();

/// "0.2.0 (commit 0123456789ab)", for --version.
[[nodiscard]] std::string version();

}  // namespace topple::app
