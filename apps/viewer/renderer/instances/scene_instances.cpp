#include "renderer/instances/scene_instances.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

#include "renderer/shapes/looks.h"

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
    : building_(building),
      bounds_(bounds_of(building)),
      origin_(bounds_.centre()),
      parts_(building, origin_),
      chunks_(building, origin_),
      drawn_(building, origin_),
      torn_ends_(building),
      overlays_(building, bounds_) {
  build_members();
  build_panels();
  projectiles_.mesh = sphere_mesh(24);
  piers_.mesh = pier_mesh();
  if (ground) pier_places_ = piers_of(building_, *ground);
}

void SceneInstances::build_members() {
  members_.resize(building_.sections.size());
  for (std::size_t i = 0; i < building_.sections.size(); ++i) {
    const structure::Section& section = building_.sections[i];
    members_[i].mesh = section_mesh(section, segments_for(building_));
    if (building_.members.size() > many_members)
      members_[i].coarse = {section_mesh(section, 1), section_tube_mesh(section), section_box_mesh(section)};
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

void SceneInstances::build_panels() {
  for (const Panel& panel : building_.panels) {
    auto& shapes = batches(panel);
    if (shapes.empty()) {
      shapes.emplace_back();
      Panel whole;
      whole.nodes = panel.nodes;
      shapes.back().mesh = panel_mesh(building_, whole);
    }
    has_glass_ = has_glass_ || look_of(building_[panel.material]) == Look::glass;
    panel_batch_.push_back(panel.openings.empty() ? 0 : shapes.size());
    if (panel.openings.empty()) continue;
    shapes.emplace_back();
    shapes.back().mesh = panel_mesh(building_, panel);
  }
}

void SceneInstances::update(const Snapshot& snapshot, const ViewOptions& options) {
  const bool changed = !built_.same(snapshot, options);
  if (changed) rebuild_standing(snapshot, options);
  built_ = {snapshot.answer,      snapshot.membership, options,      snapshot.shape,
            snapshot.shape_scale, snapshot.tuned,      snapshot.path};
  if (changed) torn_ends_.find(moving_members_, *snapshot.answer);
  append_moving(snapshot);
  torn_ends_.update(moving_members_, parts_, snapshot, options);
  overlays_.draw_marks(parts_, snapshot, options);
  chunks_.update(snapshot, options, changed);
  drawn_.update(snapshot, options, changed);
  dust_.clear();
  if (options.dust && snapshot.dust) append_dust(*snapshot.dust, snapshot.time, origin_, dust_);
}

bool SceneInstances::Built::same(const Snapshot& snapshot, const ViewOptions& now) const {
  return answer == snapshot.answer && membership == snapshot.membership && options.same_but_marks(now) &&
         shape == snapshot.shape && tuned == snapshot.tuned && path == snapshot.path &&
         (!snapshot.shape || scale == snapshot.shape_scale);
}

void SceneInstances::rebuild_standing(const Snapshot& snapshot, const ViewOptions& options) {
  parts_.find_largest(snapshot, options);
  const auto clear = [](auto& shapes) {
    for (auto& batch : shapes) batch.instances.clear();
  };
  const auto close = [](auto& shapes) {
    for (auto& batch : shapes) {
      batch.standing = batch.instances.size();
      ++batch.revision;
    }
  };
  clear(members_), clear(slabs_), clear(walls_);
  moving_members_.clear();
  moving_panels_.clear();
  for (std::size_t i = 0; i < building_.members.size(); ++i) {
    const int place = snapshot.membership->member[i];
    if (place == part_gone || !is_on(options.shown, building_.members[i])) continue;
    parts_.colour_member(i, snapshot, options);
    if (place == part_stands)
      members_[section_of(i)].instances.push_back(parts_.standing_member(i, snapshot, options));
    else if (options.debris)
      moving_members_.push_back({i, place});
  }
  for (std::size_t i = 0; i < building_.panels.size(); ++i) {
    const int place = snapshot.membership->panel[i];
    if (place == part_gone || !is_on(options.shown, building_.panels[i])) continue;
    if (snapshot.membership->broken[i]) continue;  // drawn by its own mesh
    parts_.colour_panel(i, snapshot, options);
    if (place == part_stands)
      batches(building_.panels[i])[panel_batch_[i]].instances.push_back(parts_.standing_panel(i, snapshot, options));
    else if (options.debris)
      moving_panels_.push_back({i, place});
  }
  close(members_), close(slabs_), close(walls_);
  seen_bent_ = is_seen_bent(snapshot);
  build_piers(snapshot, options);
  overlays_.draw_forces(parts_, snapshot, options);
}

/// More than a hundredth of a radian between an end and the line between both is seen.
bool SceneInstances::is_seen_bent(const Snapshot& snapshot) const {
  const auto bends = [&](const MemberShape& shape, const Member& member) {
    constexpr float seen = 0.01F;
    const Eigen::Vector3f axis = member.axes.row(0).transpose().cast<float>();
    const Eigen::Vector3f way = shape.ends[1].head<3>() - shape.ends[0].head<3>();
    const Eigen::Vector3f chord = axis.cross(way) / static_cast<float>(member.length);
    return std::any_of(shape.ends.begin(), shape.ends.end(), [&](const Displacement& end) {
      return axis.cross(Eigen::Vector3f(end.tail<3>() - chord)).norm() > seen;
    });
  };
  const auto& shapes = snapshot.answer->shapes;
  const auto& kept = snapshot.membership->member_shape;
  for (std::size_t i = 0; i < building_.members.size(); ++i) {
    const MemberShape* own = shapes ? shapes->find(i) : nullptr;
    if (own == nullptr && i < kept.size()) own = kept[i].get();
    if (own != nullptr && bends(*own, building_.members[i])) return true;
  }
  return false;
}

void SceneInstances::build_piers(const Snapshot& snapshot, const ViewOptions& options) {
  piers_.instances.clear();
  for (const Pier& pier : pier_places_) {
    if (options.colouring != Colouring::materials || !snapshot.membership->supports[pier.support]) continue;
    const glm::vec3 foot(pier.foot - origin_), size(pier.width, pier.width, pier.height);
    piers_.instances.push_back({foot, {0, 0, 0, 1}, size, look_colour(Look::concrete), foot});
  }
  piers_.standing = piers_.instances.size();
  ++piers_.revision;
}

void SceneInstances::append_moving(const Snapshot& snapshot) {
  std::vector<BodyMotion> motions;
  motions.reserve(snapshot.bodies.size());
  for (const BodyPose& body : snapshot.bodies) motions.emplace_back(body);
  for (auto& batch : members_) batch.instances.resize(batch.standing);
  for (auto& batch : slabs_) batch.instances.resize(batch.standing);
  for (auto& batch : walls_) batch.instances.resize(batch.standing);
  for (const MovingPart& moving : moving_members_) {
    const BodyMotion& motion = motions[static_cast<std::size_t>(moving.body)];
    members_[section_of(moving.index)].instances.push_back(parts_.moved_member(moving.index, motion, snapshot));
  }
  for (const MovingPart& moving : moving_panels_) {
    const BodyMotion& motion = motions[static_cast<std::size_t>(moving.body)];
    batches(building_.panels[moving.index])[panel_batch_[moving.index]].instances.push_back(
        parts_.moved_panel(moving.index, motion, snapshot));
  }
  projectiles_.instances.clear();
  // Bare steel where materials are seen.
  const Rgba ball = built_.options.colouring == Colouring::materials
                        ? (projectile_colour & 0xffffffU) | static_cast<Rgba>(Look::steel) << 24U
                        : projectile_colour;
  for (const BodyPose& body : snapshot.bodies)
    if (body.radius > 0)
      projectiles_.instances.push_back({glm::vec3(to_glm(body.position) - origin_), packed(to_glm(body.orientation)),
                                        glm::vec3(static_cast<float>(body.radius)), ball, glm::vec3(0)});
}

}  // namespace topple::viewer
