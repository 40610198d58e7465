#pragma once
// The options of `topple analyse` about motion: --dynamic with --over, --for, --damping, --history, and --time-history.
#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "topple/structure/analysis.h"

namespace topple::app {

struct MotionOptions {
  bool dynamic = false;
  std::optional<double> over, duration, damping;
  std::vector<std::string> history;
  std::string time_history;
};

void declare_motion_options(CLI::App& app, MotionOptions& options);
/// Throws InputError for an option without what it belongs to.
void check_motion_options(const MotionOptions& options, bool anything_lost, bool folder_named);
/// Throws InputError for names that the building has not, and for a time history that cannot be read.
void request_motion(const MotionOptions& options, const structure::Building& building,
                    structure::AnalysisRequest& request);

}  // namespace topple::app
