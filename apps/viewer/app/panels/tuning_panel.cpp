#include "app/panels/tuning_panel.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>

#include "app/widgets.h"
#include "topple/structure/formats/files.h"
#include "topple/structure/formats/output_files.h"

namespace topple::viewer {
namespace {

using structure::JointChange;
using structure::Sense;

constexpr const char* targets[] = {"all joints", "posts", "beams", "braces", "slabs", "walls", "selected", "pattern"};
constexpr const char* selectors[] = {"*", "posts", "beams", "braces", "slabs", "walls"};
constexpr int selected_target = 6, pattern_target = 7;

/// Joints that the selector means; none when it is not yet a whole name.
std::vector<structure::JointId> meant(const Controller& controller, const std::string& selector) {
  try {
    return structure::joints_of(controller.building(), controller.names(), selector);
  } catch (const std::exception&) {
    return {};
  }
}

}  // namespace

void write_tuned_model(const Scene& scene, const Snapshot& moment, const std::string& file,
                       const std::vector<structure::MaterialChange>& materials) {
  const std::string text = structure::model_with_strengths(
      structure::model_with_changes(scene.model, moment.tuned ? moment.tuned->changes : std::vector<JointChange>()),
      materials);
  structure::write_file(file, text);
}

std::string TuningPanel::selector(const Controller& controller) const {
  if (target_ == pattern_target) return pattern_.data();
  if (target_ != selected_target) return selectors[target_];
  const structure::JointId chosen = controller.options.selected_joint;
  return chosen.valid() ? controller.building()[chosen].name : "";
}

void TuningPanel::capacities(Controller& controller, const Snapshot& moment) {
  ImGui::Combo("joints", &target_, targets, IM_ARRAYSIZE(targets));
  if (target_ == pattern_target) ImGui::InputText("pattern", pattern_.data(), pattern_.size());
  const std::string name = selector(controller);
  const auto joints = meant(controller, name);
  if (joints.empty()) return ImGui::TextWrapped("%s", name.empty() ? "none is selected" : "no joint has this name");
  // Of several the first that can break stands for all.
  auto first = std::find_if(joints.begin(), joints.end(), [&](structure::JointId j) {
    return joint_capacity(controller.building(), moment, j).breakable;
  });
  if (first == joints.end()) first = joints.begin();
  ImGui::Text("%zu joints, values of %s", joints.size(), controller.building()[*first].name.c_str());
  double strength =
      moment.tuned ? static_cast<double>(moment.tuned->strength[static_cast<std::size_t>(first->index)]) : 1;
  const double multiplier = strength;
  JointChange change;
  change.joints = name;
  if (slider("strength", strength, 0.05, 10, "x %.3f")) change.strength = strength;
  const structure::JointCapacity& now = joint_capacity(controller.building(), moment, *first);
  for (std::size_t s = 0; s < 7; ++s) {
    const double unit = structure::capacity_unit(controller.building(), *first, static_cast<Sense>(s));
    const bool limited = now.breakable && std::isfinite(now.value[s]);
    double value = (limited ? now.value[s] / multiplier : 1e6) / 1e3;
    if (slider(structure::sense_names[s], value, 1, 1e5, limited ? "%.1f k" : "unlimited"))
      change.capacity[s] = 1e3 * value / unit;
  }
  if (!change.empty()) controller.tune(change);
}

void TuningPanel::gravity(Controller& controller) {
  if (gravity_ < 0) gravity_ = controller.building().gravity;
  slider("gravity", gravity_, 0, 30, "%.2f m/s2", ImGuiSliderFlags_None);
  if (ImGui::IsItemDeactivatedAfterEdit()) controller.set_gravity(gravity_);
}

/// How panels break that say nothing of their own.
void TuningPanel::panels() {
  constexpr const char* methods[] = {"stay whole", "voronoi", "quadrilateral", "local"};
  int method = rules_->fracture ? 1 + static_cast<int>(rules_->fracture->method) : 0;
  if (ImGui::Combo("panels", &method, methods, IM_ARRAYSIZE(methods))) {
    fracture::PanelSettings settings = rules_->fracture.value_or(fracture::PanelSettings());
    settings.method = static_cast<fracture::Method>(std::max(0, method - 1));
    rules_->fracture = method == 0 ? std::nullopt : std::optional(settings);
  }
  if (rules_->fracture && rules_->fracture->method != fracture::Method::local)
    slider("cell", rules_->fracture->cell, 0.1, 3, "%.2f m");
  if (rules_->fracture && rules_->fracture->method == fracture::Method::local) {
    slider("least reach", rules_->fracture->local.length[0], 0.05, rules_->fracture->local.length[1], "%.2f m");
    slider("most reach", rules_->fracture->local.length[1], rules_->fracture->local.length[0], 5, "%.2f m");
  }
}

/// Strengths of materials, each a multiple of the model's.
void TuningPanel::materials(Controller& controller) {
  if (materials_.empty())
    for (const structure::Material& material : controller.building().materials)
      if (material.yield_strength || material.compressive_strength || material.tensile_strength)
        materials_.push_back({material.name, 1});
  for (structure::MaterialChange& change : materials_)
    slider((change.material + " strength").c_str(), change.strength, 0.05, 10, "x %.3f");
}

/// Those that differ from the model.
std::vector<structure::MaterialChange> TuningPanel::changed_materials() const {
  std::vector<structure::MaterialChange> changed;
  std::copy_if(materials_.begin(), materials_.end(), std::back_inserter(changed),
               [](const structure::MaterialChange& change) { return change.strength != 1; });
  return changed;
}

void TuningPanel::rules(Controller& controller) {
  if (!rules_) rules_ = RunRules{controller.scene().scenario.failure, controller.scene().scenario.fracture, nullptr};
  structure::FailureRules& failure = rules_->failure;
  slider("sudden loss", failure.sudden, 1, 2, "x %.2f", ImGuiSliderFlags_None);
  int bracing = static_cast<int>(failure.bracing);
  constexpr const char* bracings[] = {"buckling", "classic", "none"};
  if (ImGui::Combo("bracing", &bracing, bracings, IM_ARRAYSIZE(bracings)))
    failure.bracing = static_cast<structure::BracingRule>(bracing);
  int mechanism = static_cast<int>(failure.mechanism);
  constexpr const char* mechanisms[] = {"hinge", "detach"};
  if (ImGui::Combo("mechanisms", &mechanism, mechanisms, IM_ARRAYSIZE(mechanisms)))
    failure.mechanism = static_cast<structure::MechanismRule>(mechanism);
  ImGui::Checkbox("second order", &failure.second_order);
  panels();
  materials(controller);
  if (ImGui::Button("Restart by these rules")) restart(controller);
}

void TuningPanel::restart(Controller& controller) {
  try {
    RunRules rules = *rules_;
    rules.building = building_with_strengths(controller.scene(), changed_materials());
    controller.restart(rules);
  } catch (const std::exception& refused) {
    controller.message = refused.what();
  }
}

void TuningPanel::file(Controller& controller, const Snapshot& moment) {
  ImGui::InputText("file", file_.data(), file_.size());
  if (!ImGui::Button("Write the changed model")) return;
  try {
    write_tuned_model(controller.scene(), moment, file_.data(), changed_materials());
    controller.message = std::string("model written to ") + file_.data();
  } catch (const std::exception& failed) {
    controller.message = failed.what();
  }
}

void TuningPanel::draw(Controller& controller, const Snapshot& moment) {
  capacities(controller, moment);
  ImGui::Separator();
  gravity(controller);
  ImGui::Separator();
  rules(controller);
  ImGui::Separator();
  file(controller, moment);
}

}  // namespace topple::viewer
