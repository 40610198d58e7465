#pragma once
#include <string>

#include "renderer/recording.h"

namespace topple::viewer {

/// True when this program was built with the replay page (npm was there).
[[nodiscard]] bool can_write_replay();

/// One page that shows the run again, to turn and scrub, without a network. Throws std::runtime_error when the program
/// was built without the page or the file cannot be written.
void write_html_replay(const structure::Building& building, const Recording& recording, const std::string& file);

}  // namespace topple::viewer
