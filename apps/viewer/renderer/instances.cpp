#include "renderer/instances.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

#include "renderer/instance_parts.h"
#include "renderer/shapes/arrows.h"
#include "renderer/shapes/looks.h"
#include "renderer/shapes/torn_ends.h"

namespace topple::viewer {
namespace {

using structure::Building;
using structure::Member;
using structure::Panel;

/// Parts of a drawn bent member: fewer when there are many, so that the triangles stay within what a card draws at
/// ease.
int segments_for(const Building& building) { return building.members.size() > 4000 ? 3 : 8; }

/// From so many on, members are drawn straight while nothing bends them so that it is seen.
constexpr std::size_t many_members = 1000;

}  // namespace

Bounds bounds_of(const Building& building) {
  Bounds bounds;
  if (building.nodes.empty()) return bounds;
  bounds.low = bounds.high = to_glm(building.nodes.front().position);
  for (const structure::Node& node : building.nodes) {
    bounds.low = glm::min(bounds.low, to_glm(node.position));
    bounds.high = glm::max(bounds.high, to_glm(node.position));
  }
  return bounds;
}

SceneInstances::SceneInstances(const Building& building, std::optional<double> ground)
    : building_(building), bounds_(bounds_of(building)), origin_(bounds_.centre()) {
  place_members();
  place_panels();
  projectiles_.mesh = sphere_mesh(24);
  piers_.mesh = pier_mesh();
  if (ground) pier_places_ = piers_of(building_, *ground);
  arrows_.mesh = buried_arrows_.mesh = arrow_mesh(10);
}

void SceneInstances::place_members() {
  members_.resize(building_.sections.size());
  for (std::size_t i = 0; i < building_.sections.size(); ++i) {
    const structure::Section& section = building_.sections[i];
    members_[i].mesh = section_mesh(section, segments_for(building_));
    if (building_.members.size() > many_members)
      members_[i].coarse = {section_mesh(section, 1), section_tube_mesh(section), section_box_mesh(section)};
  }
  for (const structure::Section& section : building_.sections)
    for (unsigned variant = 0; variant < torn_end_variants; ++variant) {
      torn_ends_.emplace_back();
      torn_ends_.back().mesh = torn_end_mesh(section, variant);
    }
  for (const Member& member : building_.members) {
    Part part;
    part.batch = static_cast<std::size_t>(member.section.index);
    part.rest = {};
    part.rest.first_end = to_glm(structure::Vec3(building_[member.nodes[0]].position + member.offsets[0])) - origin_;
    part.rest.rotation = packed(to_glm(Eigen::Quaterniond(structure::Mat3(member.axes.transpose()))));
    part.rest.length = static_cast<float>(member.length);
    part.rest.base = member_colour(member.kind);
    member_parts_.push_back(part);
  }
  std::vector<double> widths;
  for (const Member& member : building_.members) {
    const structure::Section& section = building_[member.section];
    const double square = std::sqrt(section.area);
    widths.push_back(std::min(section.width > 0 ? section.width : square, section.depth > 0 ? section.depth : square));
  }
  if (widths.empty()) return;
  const auto middle = widths.begin() + static_cast<std::ptrdiff_t>(widths.size() / 2);
  std::nth_element(widths.begin(), middle, widths.end());
  member_width_ = static_cast<float>(*middle);
}

void SceneInstances::place_panels() {
  for (const Panel& panel : building_.panels) {
    auto& shapes = batches(panel);
    if (shapes.empty()) {
      shapes.emplace_back();
      Panel whole;
      whole.nodes = panel.nodes;
      shapes.back().mesh = panel_mesh(building_, whole);
    }
    has_glass_ = has_glass_ || look_of(building_[panel.material]) == Look::glass;
    PanelPart part;
    if (!panel.openings.empty()) {
      part.batch = shapes.size();
      shapes.emplace_back();
      shapes.back().mesh = panel_mesh(building_, panel);
    }
    part.rest = {};
    for (std::size_t c = 0; c < 4; ++c)
      part.rest.corner[c] = glm::vec3(to_glm(building_[panel.nodes[c]].position) - origin_);
    part.rest.thickness = static_cast<float>(panel.thickness);
    for (std::size_t c = 0; c < 3; ++c) part.rest.rest[c] = part.rest.corner[c + (c == 2 ? 1 : 0)];
    part.rest.base = panel_colour(panel.kind);
    panel_parts_.push_back(part);
  }
}

void SceneInstances::update(const Snapshot& snapshot, const ViewOptions& options) {
  const bool changed = built_answer_ != snapshot.answer || built_membership_ != snapshot.membership ||
                       !built_options_.same_but_marks(options) || built_shape_ != snapshot.shape ||
                       built_tuned_ != snapshot.tuned || built_path_ != snapshot.path ||
                       (snapshot.shape && built_scale_ != snapshot.shape_scale);
  if (changed) rebuild_standing(snapshot, options);
  built_answer_ = snapshot.answer;
  built_membership_ = snapshot.membership;
  built_options_ = options;
  built_shape_ = snapshot.shape;
  built_tuned_ = snapshot.tuned;
  built_path_ = snapshot.path;
  built_scale_ = snapshot.shape_scale;
  if (changed) find_torn_ends();
  append_moving(snapshot);
  place_chunks(snapshot);
  place_torn_ends(snapshot);
  draw_marks(snapshot, options);
  draw_cables(snapshot);
  place_broken_panels(snapshot, changed);
  place_drawn(snapshot, changed);
  dust_.clear();
  if (options.dust && snapshot.dust) place_dust(*snapshot.dust, snapshot.time, origin_, dust_);
}
}  // namespace topple::viewer
