#pragma once
// What a long run does and how far it is, on the terminal's error stream.
#include <string_view>

namespace topple::app {

/// Says a stage and its share (0 to 1; below 0: not known) once a run has lasted a second, at most once a second, and
/// every five seconds within a stage; may be called from several threads.
void report_progress(std::string_view stage, double share);

}  // namespace topple::app
