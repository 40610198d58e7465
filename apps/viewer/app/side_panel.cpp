#include "app/side_panel.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <string>
#include <utility>

#include "app/widgets.h"
#include "renderer/shapes/arrows.h"

namespace topple::viewer {
namespace {

constexpr const char* component_words[] = {"axial", "shear y", "shear z", "torsion", "moment y", "moment z"};

double text_size() { return static_cast<double>(ImGui::GetIO().Fonts->Fonts[0]->FontSize); }

void colour_bar(Rgba (*colour)(double), double low, double high) {
  constexpr int steps = 60;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = 0.92F * ImGui::GetContentRegionAvail().x, height = 0.8F * ImGui::GetFontSize();
  for (int i = 0; i < steps; ++i) {
    const double share = low + (high - low) * (i + 0.5) / steps;
    const float x0 = at.x + width * static_cast<float>(i) / steps,
                x1 = at.x + width * static_cast<float>(i + 1) / steps;
    ImGui::GetWindowDrawList()->AddRectFilled(ImVec2(x0, at.y), ImVec2(x1, at.y + height),
                                              ImGui::GetColorU32(to_imgui(colour(share))));
  }
  ImGui::Dummy(ImVec2(width, height));
}

void legend(const ViewOptions& options, const SceneInstances& scene) {
  const JointPalette palette = joint_palette(options.colour_blind_safe);
  const bool capacity = options.scale == Scale::capacity;
  char text[96];
  switch (options.colouring) {
    case Colouring::joints:
      legend_entry("force", palette.force);
      ImGui::SameLine();
      legend_entry("moment", palette.torque);
      ImGui::SameLine();
      legend_entry("both", palette.both);
      if (capacity)
        ImGui::TextUnformatted("full colour: at capacity");
      else
        ImGui::Text("full colour: %.1f %% of capacity", 100 * scene.largest());
      break;
    case Colouring::utilisation:
      colour_bar(utilisation_colour, 0, 1);
      ImGui::TextUnformatted("0          50 %       100 %  red: above");
      break;
    case Colouring::path:
      colour_bar(utilisation_colour, 0, 1);
      ImGui::TextUnformatted("share of the force: 0 to 100 %");
      break;
    case Colouring::component:
      colour_bar(signed_colour, -1, 1);
      if (capacity)
        std::snprintf(text, sizeof text, "- capacity        0        + capacity");
      else
        std::snprintf(text, sizeof text, "-%.3g        0        +%.3g %s", scene.largest() / 1e3, scene.largest() / 1e3,
                      options.component < 3 ? "kN" : "kN m");
      ImGui::TextUnformatted(text);
      break;
    default:
      break;
  }
  if (options.colouring != Colouring::materials) legend_entry("failed", failed_colour(options));
}

void switches(const char* title, PartSwitches& parts) {
  ImGui::PushID(title);
  ImGui::TextUnformatted(title);
  ImGui::Checkbox("posts", &parts.posts);
  ImGui::SameLine();
  ImGui::Checkbox("beams", &parts.beams);
  ImGui::SameLine();
  ImGui::Checkbox("braces", &parts.braces);
  ImGui::Checkbox("slabs", &parts.slabs);
  ImGui::SameLine();
  ImGui::Checkbox("walls", &parts.walls);
  ImGui::PopID();
}

void scale_slider(const char* label, float& value, float high) {
  ImGui::SliderFloat(label, &value, 0, high, "x %.1f", ImGuiSliderFlags_Logarithmic);
}

void diagrams(ViewOptions& options, const SceneInstances& scene) {
  int choice = options.diagram + 1;
  constexpr const char* choices[] = {"none", "axial", "shear y", "shear z", "torsion", "moment y", "moment z"};
  if (ImGui::Combo("diagram", &choice, choices, IM_ARRAYSIZE(choices))) options.diagram = choice - 1;
  if (options.diagram < 0) return;
  scale_slider("its scale", options.diagram_scale, 10);
  const auto& [low, high] = scene.diagram_range();
  ImGui::Text("%.4g ... %.4g %s", low / 1e3, high / 1e3, options.diagram < 3 ? "kN" : "kN m");
}

void arrows(ViewOptions& options, const Snapshot& moment) {
  ImGui::Checkbox("loads", &options.loads);
  ImGui::SameLine();
  ImGui::Checkbox("reactions", &options.reactions);
  ImGui::SameLine();
  ImGui::Checkbox("contacts", &options.contacts);
  if (!(options.loads || options.reactions || options.contacts)) return;
  scale_slider("arrows", options.arrow_scale, 10);
  if (!moment.answer->forces) return;
  const ArrowScale scale = arrow_scale(*moment.answer->forces);
  const auto entry = [](const char* what, double largest, const char* unit, Rgba colour) {
    if (largest <= 0) return;
    char text[64];
    std::snprintf(text, sizeof text, "%s, longest %.4g %s", what, largest / 1e3, unit);
    legend_entry(text, colour);
  };
  if (options.loads) entry("spread", scale.spread, "kN/m", load_colour);
  if (options.loads) entry("at points", scale.points, "kN", load_colour);
  if (options.reactions) entry("reactions", scale.reactions, "kN", reaction_colour);
  if (options.contacts) entry("contacts", scale.contacts, "kN", contact_colour);
}

void mode_choice(Controller& controller) {
  ModeView& mode = controller.mode;
  int kind = mode.kind ? 1 + static_cast<int>(*mode.kind) : 0;
  constexpr const char* kinds[] = {"none", "vibration", "buckling"};
  if (ImGui::Combo("mode", &kind, kinds, IM_ARRAYSIZE(kinds)))
    mode.kind = kind == 0 ? std::nullopt : std::optional(static_cast<ModeKind>(kind - 1));
  if (!mode.kind) return;
  const auto* known = controller.modes().find(*mode.kind);
  if (known == nullptr) return ImGui::TextUnformatted("being worked out ...");
  if (known->empty()) return ImGui::TextWrapped("no mode: %s", controller.modes().error(*mode.kind).c_str());
  int number = mode.number + 1;
  if (ImGui::SliderInt("number", &number, 1, static_cast<int>(known->size()))) mode.number = number - 1;
  scale_slider("swing", mode.scale, 10);
  const double value = (*known)[std::min(static_cast<std::size_t>(mode.number), known->size() - 1)].value;
  ImGui::Text(*mode.kind == ModeKind::vibration ? "%.3f Hz, undamaged" : "at %.2f times the loads, undamaged", value);
}

void help_window(bool& open) {
  ImGui::SetNextWindowPos(ImVec2(20, 20), ImGuiCond_FirstUseEver);
  if (ImGui::Begin("Help", &open, ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse)) {
    const TableFont columns;
    ImGui::TextUnformatted(Controller::key_help());
  }
  ImGui::End();
}

void leave_window(Controller& controller, glm::dvec2 scene) {
  ImGui::SetNextWindowPos(ImVec2(static_cast<float>(scene.x / 2), static_cast<float>(scene.y / 2)), ImGuiCond_Always,
                          ImVec2(0.5F, 0.5F));
  if (ImGui::Begin("Leave?", &controller.asks_to_leave,
                   ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoMove)) {
    ImGui::TextUnformatted("End the program? The run is lost unless it was saved.");
    if (ImGui::Button("End (Enter)")) controller.leaves = true;
    ImGui::SameLine();
    if (ImGui::Button("Stay (Esc)")) controller.asks_to_leave = false;
  }
  ImGui::End();
}

/// Slow runs keep two digits.
std::string ratio_text(double ratio) {
  char text[32];
  std::snprintf(text, sizeof text, ratio < 0.1 ? "x %.2g" : "x %.2f", ratio);
  return text;
}

}  // namespace

glm::dvec2 SidePanel::scene_size(glm::dvec2 window) {
  return {std::max(window.x - 25 * text_size(), 0.25 * window.x),
          std::max(window.y - 6.2 * text_size(), 0.25 * window.y)};
}

void SidePanel::run_bar(Controller& controller) {
  Driver& driver = controller.driver();
  if (ImGui::Button(driver.paused() ? "Run" : "Pause")) {
    controller.look_at_present();
    driver.set_paused(!driver.paused());
  }
  if (std::exchange(controller.panels_wanted, false)) ImGui::SetKeyboardFocusHere(-1);
  const auto key_button = [&](const char* label, const char* key) {
    ImGui::SameLine();
    if (ImGui::Button(label)) controller.key(key);
  };
  key_button("Step", "n");
  key_button("Undo", "u");
  key_button("Restart", "r");
  key_button("Help", "h");
  ImGui::SameLine();
  if (ImGui::Button("Scenes")) controller.wants_another = true;
  double speed = driver.speed();
  const std::string pace = driver.paused() ? "x %.2f, paused" : "x %.2f, runs at " + ratio_text(driver.ratio());
  if (slider("speed", speed, 0.02, 1, pace.c_str())) driver.set_speed(speed);
  ImGui::TextUnformatted("A click will");
  for (std::size_t i = 0; i < tool_names.size(); ++i) {
    if (i % 3 != 0) ImGui::SameLine();
    if (toggle_button(tool_names[i], controller.tool == static_cast<ToolKind>(i)))
      controller.tool = static_cast<ToolKind>(i);
  }
  if (controller.tool == ToolKind::fire) {
    slider("shot", controller.shot.speed, 5, 300, "%.0f m/s");
    slider("mass", controller.shot.mass, 10, 20000, "%.0f kg");
    slider("radius", controller.shot.radius, 0.1, 2, "%.2f m");
    if (ImGui::Button("Usual shot")) controller.shot = Shot();
  }
  if (controller.tool == ToolKind::swing) {
    slider("cable", controller.swing.cable, 2, 60, "%.1f m");
    slider("angle", controller.swing.angle, 0.1, 1.57, "%.2f rad", ImGuiSliderFlags_None);
    slider("mass", controller.swing.mass, 100, 20000, "%.0f kg");
    slider("radius", controller.swing.radius, 0.2, 2, "%.2f m");
  }
  if (controller.tool == ToolKind::burn) {
    slider("reach", controller.burning.reach, 0.5, 30, "%.1f m");
    slider("over", controller.burning.over, 1, 7200, "%.0f s");
    slider("strength left", controller.burning.strength, 0, 1, "x %.2f", ImGuiSliderFlags_None);
    slider("stiffness left", controller.burning.stiffness, 0.01, 1, "x %.2f", ImGuiSliderFlags_None);
  }
  if (controller.tool == ToolKind::thermite) slider("over", controller.thermite_over, 0.5, 60, "%.1f s");
  if (controller.tool == ToolKind::hook) {
    double kilonewtons = controller.hauling.force / 1e3;
    if (slider("force", kilonewtons, 10, 20000, "%.0f kN")) controller.hauling.force = 1e3 * kilonewtons;
    slider("over", controller.hauling.over, 0.1, 60, "%.1f s");
  }
  if (controller.tool == ToolKind::explosion) slider("TNT", controller.explosive, 0.5, 1000, "%.1f kg");
  if (controller.tool == ToolKind::charge) slider("reach", controller.charge_radius, 0.5, 20, "%.1f m");
  ImGui::InputText("##saved", saved_.data(), saved_.size());
  const auto with_file = [&](const char* label, void (Controller::*what)(const std::string&)) {
    ImGui::SameLine();
    if (!ImGui::Button(label)) return;
    try {
      (controller.*what)(saved_.data());
    } catch (const std::exception& failed) {
      controller.message = failed.what();
    }
  };
  with_file("Save", &Controller::save);
  with_file("Load", &Controller::load);
}

void SidePanel::view(Controller& controller, const Snapshot& moment, const SceneInstances& scene) {
  ViewOptions& options = controller.options;
  constexpr const char* colourings[] = {
      "materials", "parts", "joints: force and moment", "utilisation", "one component", "segments", "load path"};
  int colouring = static_cast<int>(options.colouring);
  if (ImGui::Combo("colours", &colouring, colourings, IM_ARRAYSIZE(colourings)))
    options.colouring = static_cast<Colouring>(colouring);
  if (options.colouring == Colouring::component)
    ImGui::Combo("component", &options.component, component_words, IM_ARRAYSIZE(component_words));
  bool largest = options.scale == Scale::largest_in_view;
  if (ImGui::Checkbox("scale by the largest in view", &largest))
    options.scale = largest ? Scale::largest_in_view : Scale::capacity;
  legend(options, scene);
  ImGui::Separator();
  diagrams(options, scene);
  arrows(options, moment);
  mode_choice(controller);
  ImGui::SliderFloat("deflection", &options.deflection_scale, 0, 1000, "x %.0f", ImGuiSliderFlags_Logarithmic);
  float motion = options.motion_scale_now();
  if (ImGui::SliderFloat("motion", &motion, 0, 1000, options.motion_scale < 0 ? "x %.0f, as above" : "x %.0f",
                         ImGuiSliderFlags_Logarithmic))
    options.motion_scale = motion;
  if (options.motion_scale >= 0 && ImGui::Button("Motion as deflection"))
    options.motion_scale = ViewOptions::as_deflection;
  ImGui::Separator();
  switches("shown", options.shown);
  switches("joints coloured", options.coloured);
  ImGui::Checkbox("failed joints", &options.failed_joints);
  ImGui::SameLine();
  ImGui::Checkbox("colour-blind safe", &options.colour_blind_safe);
  const auto opacity = [](const char* label, float& value, float now) {
    if (ImGui::SliderFloat(label, &now, 0.05F, 1, "%.2f")) value = now;
  };
  opacity("slabs##opacity", options.slab_opacity, options.slab_opacity_now());
  opacity("walls##opacity", options.wall_opacity, options.wall_opacity_now());
  ImGui::Checkbox("shadows", &options.shadows);
  ImGui::SameLine();
  ImGui::Checkbox("occlusion", &options.ambient_occlusion);
  ImGui::SameLine();
  ImGui::Checkbox("grid", &options.grid);
  ImGui::Checkbox("debris", &options.debris);
  ImGui::SameLine();
  ImGui::Checkbox("dust", &options.dust);
}

void SidePanel::part(Controller& controller, const Snapshot& moment) {
  ImGui::InputTextWithHint("##search", "search by name, * for any", search_.data(), search_.size());
  for (const structure::JointId id : controller.search(search_.data(), 8)) {
    const structure::Joint& joint = controller.building()[id];
    const bool whole = std::string_view(search_.data()).find(':') == std::string_view::npos;
    const std::string& name = !whole                 ? joint.name
                              : joint.member.valid() ? controller.building()[joint.member].name
                                                     : controller.building()[joint.panel].name;
    if (ImGui::Selectable(name.c_str(), controller.options.selected_joint == id)) controller.select(id);
  }
  if (controller.options.selected_joint.valid()) {
    ImGui::Separator();
    const structure::Joint& chosen = controller.building()[controller.options.selected_joint];
    ImGui::TextWrapped("%s", part_text(controller.building(), controller.options.selected_joint).c_str());
    const int joints = chosen.member.valid() ? 2 : 4;
    for (int end = 0; end < joints; ++end) {
      if (end > 0) ImGui::SameLine();
      const structure::JointId id = chosen.member.valid() ? controller.building().joint(chosen.member, end)
                                                          : controller.building().joint(chosen.panel, end);
      if (toggle_button(controller.building()[id].name.c_str(), id == controller.options.selected_joint))
        controller.select(id);
    }
    draw_joint(controller, moment, controller.options.selected_joint, true);
  } else {
    ImGui::TextWrapped("Right click a part, or choose one below.");
  }
  ImGui::Separator();
  ImGui::TextUnformatted("most used joints");
  joints(controller, moment);
}

void SidePanel::state(const Controller& controller, const Snapshot& moment) {
  ImGui::Text("%.2f s, step %lld%s", moment.time, static_cast<long long>(moment.step),
              moment.at_rest ? ", at rest" : "");
  ImGui::Text("standing: %d/%zu members, %d/%zu panels", moment.membership->members_standing,
              controller.building().members.size(), moment.membership->panels_standing,
              controller.building().panels.size());
  const auto asleep =
      std::count_if(moment.bodies.begin(), moment.bodies.end(), [](const BodyPose& b) { return b.asleep; });
  ImGui::Text("bodies: %zu, asleep %zu", moment.bodies.size(), static_cast<std::size_t>(asleep));
}

void SidePanel::performance(const Controller& controller, const Snapshot& moment) {
  const Driver& driver = controller.driver();
  ImGui::Text("pace: %s asked, %s reached", ratio_text(driver.speed()).c_str(),
              driver.paused() ? "paused," : ratio_text(driver.ratio()).c_str());
  const auto& c = moment.counters;
  const auto number = [](std::uint64_t n) { return static_cast<unsigned long long>(n); };
  ImGui::TextUnformatted("solved");
  ImGui::Text("  %llu answers: %llu corrections, %llu factors", number(c.solves), number(c.low_rank),
              number(c.refactorisations));
  ImGui::Text("  %llu segmentations, %llu collision steps", number(c.segmentations), number(c.collision_steps));
  ImGui::TextUnformatted("skipped");
  ImGui::Text("  %llu steps: nothing was awake or changed", number(c.steps_idle));
  ImGui::Text("  %llu changes of contact: within the dead band", number(c.contacts_ignored));
  ImGui::TextUnformatted("time of each stage");
  if (moment.step != last_step_) {
    const double whole = std::accumulate(moment.stage_seconds.begin(), moment.stage_seconds.end(), 0.0);
    for (std::size_t i = 0; i < history_.size(); ++i) {
      const double seconds = i < 6 ? moment.stage_seconds[i] : whole;
      history_[i].push_back(static_cast<float>(1e3 * seconds));
      if (history_[i].size() > history_length) history_[i].erase(history_[i].begin());
    }
    last_step_ = moment.step;
  }
  for (std::size_t i = 0; i < history_.size(); ++i) {
    const auto& values = history_[i];
    if (values.empty()) continue;
    char text[48];
    std::snprintf(text, sizeof text, "%.3f ms", static_cast<double>(values.back()));
    const char* name = i < 6 ? structure::stage_names[i] : "step";
    (void)plot_line(name, values, text, 1.6F * ImGui::GetFontSize());
  }
  picture_history_.push_back(static_cast<float>(controller.picture_processor));
  if (picture_history_.size() > history_length) picture_history_.erase(picture_history_.begin());
  char text[64];
  std::snprintf(text, sizeof text, "%.2f ms of processor time", controller.picture_processor);
  (void)plot_line("picture", picture_history_, text, 1.6F * ImGui::GetFontSize());
  const auto curve = [](const char* name, std::vector<float>& history, double value, const char* format) {
    history.push_back(static_cast<float>(value));
    if (history.size() > history_length) history.erase(history.begin());
    char shown[64];
    std::snprintf(shown, sizeof shown, format, value);
    (void)plot_line(name, history, shown, 1.6F * ImGui::GetFontSize());
  };
  curve("graphics", graphics_history_, controller.picture_graphics, "%.2f ms on the graphics card");
  curve("pace", pace_history_, driver.paused() ? 0 : driver.ratio(), "x %.2f of real time");
  ImGui::Text("a picture each %.1f ms, drawing and waiting included",
              static_cast<double>(1000.0F / ImGui::GetIO().Framerate));
}

void SidePanel::joints(Controller& controller, const Snapshot& moment) {
  const TableFont columns;
  for (const structure::JointId id : moment.answer->most_used) {
    const auto& joint = moment.answer->joints[static_cast<std::size_t>(id.index)];
    char text[96];
    std::snprintf(text, sizeof text, "%5.1f %%  %-12s %s", 100.0 * static_cast<double>(joint.utilisation),
                  structure::sense_names[static_cast<std::size_t>(joint.sense)],
                  controller.building()[id].name.c_str());
    if (ImGui::Selectable(text, controller.options.selected_joint == id)) controller.select(id);
  }
}

void SidePanel::draw(Controller& controller, const Snapshot& moment, const SceneInstances& scene,
                     const std::string& error) {
  if (controller.photo) return;
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  const glm::dvec2 left = scene_size({display.x, display.y});
  const float width = display.x - static_cast<float>(left.x);
  ImGui::SetNextWindowPos(ImVec2(static_cast<float>(left.x), 0));
  ImGui::SetNextWindowSize(ImVec2(width, display.y));
  if (controller.panels_wanted) ImGui::SetNextWindowFocus();
  ImGui::Begin(
      "Topple", nullptr,
      ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoTitleBar);
  ImGui::PushItemWidth(0.62F * width);
  ImGui::TextWrapped("%s", controller.building().title.empty() ? "Topple" : controller.building().title.c_str());
  if (!error.empty()) ImGui::TextWrapped("The simulation stopped: %s", error.c_str());
  run_bar(controller);
  if (!controller.driver().begun()) ImGui::TextWrapped("How it stands is being found; until then it is seen unloaded.");
  state(controller, moment);
  ImGui::TextWrapped("%s", controller.message ? controller.message->c_str() : "");
  if (ImGui::BeginTabBar("tabs")) {
    const auto tab = [](const char* name, const auto& content) {
      if (!ImGui::BeginTabItem(name)) return;
      ImGui::BeginChild(name, ImVec2(0, 0), false, ImGuiWindowFlags_NavFlattened);
      content();
      ImGui::EndChild();
      ImGui::EndTabItem();
    };
    tab("View", [&] { view(controller, moment, scene); });
    tab("Part", [&] { part(controller, moment); });
    tab("Tune", [&] { tuning_.draw(controller, moment); });
    tab("Files", [&] { output_.draw(controller); });
    tab("Energy", [&] { energies_.draw(controller, moment); });
    tab("Times", [&] { performance(controller, moment); });
    tab("Play", [&] { play_.draw(controller); });
    ImGui::EndTabBar();
  }
  ImGui::PopItemWidth();
  ImGui::End();
  draw_timeline(controller, moment, left, static_cast<double>(display.y));
  if (controller.help) help_window(controller.help);
  if (controller.asks_to_leave) leave_window(controller, left);
}

}  // namespace topple::viewer
