#include "motion_options.h"

#include <optional>

#include "topple/structure/error.h"
#include "topple/structure/number_range.h"

namespace topple::app {

using namespace topple::structure;

namespace {

/// As a check of an option.
auto within(const NumberRange& range) {
  return [range](const std::string& given) {
    const std::optional<double> number = number_of(given);
    return number && range.contains(*number) ? std::string() : "found " + given + "; accepted: " + range.text();
  };
}

}  // namespace

void declare_motion_options(CLI::App& app, MotionOptions& options) {
  app.add_flag("--dynamic", options.dynamic, "Follow each loss through time: peaks, and how much statics fall short");
  app.add_option("--over", options.over, "With --dynamic: seconds through which the member is lost (0: at once)")
      ->check(within(ranges::instant));
  app.add_option("--for", options.duration,
                 "Seconds to follow (two of the lowest period, or the time history's length)")
      ->check(within(ranges::duration));
  app.add_option("--damping", options.damping, "Share of the critical damping (0.02); 0: none")->check(within({0, 10}));
  app.add_option("--history", options.history, "Node or joint whose course is written to history-NAME.csv")
      ->expected(1)
      ->take_all();
  app.add_option("--time-history", options.time_history,
                 "CSV file by which the ground shakes (time,ax,ay,az) or load cases act (time,CASE)");
}

void check_motion_options(const MotionOptions& options, bool anything_lost, bool folder_named) {
  const bool moves = options.dynamic || !options.time_history.empty();
  if (options.dynamic && !anything_lost)
    throw InputError("--dynamic: nothing is lost; accepted: with --lose or --lose-each");
  if (!options.time_history.empty() && anything_lost)
    throw InputError("--time-history: a loss is not followed under it; accepted: without --lose and --lose-each");
  if (options.over && !options.dynamic)
    throw InputError("--over: nothing is lost through time; accepted: with --dynamic");
  for (const auto& [asked, name] : {std::pair{options.duration.has_value(), "--for"},
                                    {options.damping.has_value(), "--damping"},
                                    {!options.history.empty(), "--history"}})
    if (asked && !moves)
      throw InputError(std::string(name) + ": nothing moves; accepted: with --dynamic or --time-history");
  if (!options.history.empty() && !folder_named) throw InputError("--history: name the folder for it with -o");
  if (options.duration && options.over && *options.duration <= *options.over)
    throw InputError("--for: ends before the member is lost; accepted: a time longer than --over");
}

void request_motion(const MotionOptions& options, const Building& building, AnalysisRequest& request) {
  MotionRequest& motion = request.losses.motion;
  motion.asked = options.dynamic;
  motion.over = options.over.value_or(0);
  motion.duration = options.duration;
  if (options.damping) motion.damping = *options.damping;
  const NameIndex names(building);
  for (const std::string& name : options.history) {
    const std::vector<NodeId> nodes = names.nodes_matching(name);
    const std::vector<JointId> joints = names.joints_matching(name);
    if (nodes.empty() && joints.empty())
      throw InputError(building.file + ": --history " + name +
                       ": no such node or joint; accepted: a name, in which * stands for any run of characters");
    motion.nodes.insert(motion.nodes.end(), nodes.begin(), nodes.end());
    motion.joints.insert(motion.joints.end(), joints.begin(), joints.end());
  }
  if (!options.time_history.empty()) request.time_history = read_time_history(options.time_history, building);
}

}  // namespace topple::app
