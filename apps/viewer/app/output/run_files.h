#pragma once
// Files of a run: its moment, saved and taken up again, and the run so far for other programs.
#include <future>
#include <optional>
#include <string>

#include "app/playback/playback.h"

namespace topple::viewer {

class RunFiles {
 public:
  /// All must outlive it. `message`: what a person is told.
  RunFiles(Driver& driver, Playback& playback, std::optional<std::string>& message)
      : driver_(driver), playback_(playback), message_(message) {}

  /// Writes the moment of the run, or takes the run up again where such a file was written. Throw
  /// structure::InputError, std::runtime_error.
  void save(const std::string& file);
  void load(const std::string& file);
  /// Writes the run so far, by the file's ending: .html, .usda or .glb. The simulation waits for it, drawing does not;
  /// the message tells when it is there. Throws structure::InputError for another ending.
  void export_run(const std::string& file);
  /// Waits for what is being exported. Throws what went wrong.
  void finish_export();
  /// Tells of what has been exported by now, or what went wrong with it.
  void print_exported();

 private:
  Driver& driver_;
  Playback& playback_;
  std::optional<std::string>& message_;
  std::future<std::string> exporting_;  ///< the file, when it is whole
};

}  // namespace topple::viewer
