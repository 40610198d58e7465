#pragma once
// The panels beside and below the scene: view, part, tools, tuning, times; and the timeline.
#include <array>
#include <string>
#include <vector>

#include "app/controller.h"
#include "app/output/output_panel.h"
#include "app/panels/energy_panel.h"
#include "app/panels/play_panel.h"
#include "app/panels/tuning_panel.h"
#include "renderer/instances/scene_instances.h"

namespace topple::viewer {

class SidePanel {
 public:
  /// What the panels leave of a window of this size (at least a quarter of it each way), from its upper left corner;
  /// needs Dear ImGui to be set up.
  [[nodiscard]] static glm::dvec2 scene_size(glm::dvec2 window);
  /// Draws all with Dear ImGui; `moment` is what the scene shows.
  void draw(Controller& controller, const Snapshot& moment, const SceneInstances& scene, const std::string& error);

 private:
  void run_bar(Controller& controller);
  void run_files(Controller& controller);
  void view(Controller& controller, const Snapshot& moment, const SceneInstances& scene);
  void part(Controller& controller, const Snapshot& moment);
  void state(const Controller& controller, const Snapshot& moment);
  void performance(const Controller& controller, const Snapshot& moment);
  void joints(Controller& controller, const Snapshot& moment);
  TuningPanel tuning_;
  EnergyPanel energies_;
  PlayPanel play_;
  OutputPanel output_;
  static constexpr std::size_t history_length = 240;       ///< steps drawn: four seconds
  std::array<std::vector<float>, 7> history_;              ///< milliseconds by stage, and of the whole
  std::vector<float> picture_history_, graphics_history_;  ///< ms of processor time, ms of the graphics card
  std::vector<float> pace_history_;                        ///< simulated seconds for each second
  std::int64_t last_step_ = -1;
  std::array<char, 64> search_{};
  std::array<char, 256> saved_{"run.topple"};
};

/// Play, pause, scrub, and the events as marks; below the scene.
void draw_timeline(Controller& controller, const Snapshot& moment, glm::dvec2 scene_size, double window_height);

/// Name, section, forces and capacities of what lies under the pointer.
void draw_hover_text(Controller& controller, const Snapshot& moment);

/// The joint's six components with capacities, its utilisation, and how that went.
void draw_joint(Controller& controller, const Snapshot& moment, structure::JointId joint, bool with_history);
/// "x 0.25"; slow runs keep two digits.
[[nodiscard]] std::string ratio_text(double ratio);
/// "PA: post, box 300, steel, 3.50 m"
[[nodiscard]] std::string part_text(const structure::Building& building, structure::JointId joint);
/// "moment_y turned plastically by 0.0213 of 0.0750 rad": a line for each sense in which the joint has yielded.
[[nodiscard]] std::vector<std::string> yield_text(const Snapshot& moment, structure::JointId joint);

}  // namespace topple::viewer
