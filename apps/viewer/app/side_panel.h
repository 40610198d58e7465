#pragma once
// The panel beside the scene: switches, legend, shot, counters, times, the most used joints.
#include <array>
#include <vector>

#include "app/controller.h"

namespace topple::viewer {

class SidePanel {
 public:
  /// Width of the strip at the right edge of the window that it covers; needs Dear ImGui to be set up.
  [[nodiscard]] static double width();
  /// Draws it with Dear ImGui; `moment` is what the scene shows.
  void draw(Controller& controller, const Snapshot& moment, const std::string& error);

 private:
  void view(Controller& controller);
  void tools(Controller& controller);
  void state(const Controller& controller, const Snapshot& moment);
  void performance(const Snapshot& moment);
  void joints(Controller& controller, const Snapshot& moment);
  static constexpr std::size_t history_length = 240;  ///< steps drawn: four seconds
  std::array<std::vector<float>, 7> history_;         ///< milliseconds by stage, and of the whole
  std::int64_t last_step_ = -1;
};

}  // namespace topple::viewer
