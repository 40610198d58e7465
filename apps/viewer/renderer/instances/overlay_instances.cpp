#include "renderer/instances/overlay_instances.h"

#include <algorithm>
#include <cmath>

#include "renderer/shapes/arrows.h"
#include "renderer/shapes/diagram.h"
#include "renderer/shapes/hinge_marks.h"

namespace topple::viewer {

using structure::Member;

OverlayInstances::OverlayInstances(const structure::Building& building, const Bounds& bounds)
    : building_(building), bounds_(bounds) {
  arrows_.mesh = buried_arrows_.mesh = arrow_mesh(10);
  hinges_.mesh = sphere_mesh(12);
}

void OverlayInstances::draw_forces(const PartInstances& parts, const Snapshot& snapshot, const ViewOptions& options) {
  draw_diagrams(parts, snapshot, options);
  draw_arrows(snapshot, options);
  draw_hinges(parts, snapshot, options);
}

void OverlayInstances::draw_diagrams(const PartInstances& parts, const Snapshot& snapshot, const ViewOptions& options) {
  diagrams_.clear();
  diagram_range_ = {0, 0};
  const auto& forces = snapshot.answer->forces;
  if (options.diagram < 0 || !forces || forces->internal.empty()) return;
  constexpr std::size_t places = FrameForces::intervals + 1;
  std::vector<std::size_t> drawn;
  for (std::size_t i = 0; i < building_.members.size(); ++i) {
    const Member& member = building_.members[i];
    if (snapshot.membership->member[i] == part_stands && is_on(options.shown, member) &&
        is_on(options.coloured, member))
      drawn.push_back(i);
  }
  const auto value = [&](std::size_t member, std::size_t place) {
    return forces->internal[member * places + place][static_cast<std::size_t>(options.diagram)];
  };
  for (const std::size_t i : drawn)
    for (std::size_t k = 0; k < places; ++k) {
      diagram_range_[0] = std::min<double>(diagram_range_[0], value(i, k));
      diagram_range_[1] = std::max<double>(diagram_range_[1], value(i, k));
    }
  const double most = std::max(-diagram_range_[0], diagram_range_[1]);
  if (!(most > 0)) return;
  const auto reach = static_cast<float>(0.1 * bounds_.radius() * options.diagram_scale / most);
  for (const std::size_t i : drawn) {
    std::array<float, places> along{};
    for (std::size_t k = 0; k < places; ++k) along[k] = value(i, k);
    add_diagram(diagrams_, parts.standing_member(i, snapshot, options), along.data(), FrameForces::intervals,
                options.diagram, reach);
  }
}

void OverlayInstances::draw_arrows(const Snapshot& snapshot, const ViewOptions& options) {
  arrows_.instances.clear();
  buried_arrows_.instances.clear();
  if (const auto& forces = snapshot.answer->forces) {
    const auto longest = static_cast<float>(0.12 * bounds_.radius()) * options.arrow_scale;
    arrows_.instances = arrow_instances(*forces, options, bounds_.centre(), longest);
    if (options.reactions) buried_arrows_.instances = reaction_instances(*forces, bounds_.centre(), longest);
  }
  for (auto* batch : {&arrows_, &buried_arrows_}) {
    batch->standing = batch->instances.size();
    ++batch->revision;
  }
}

void OverlayInstances::draw_hinges(const PartInstances& parts, const Snapshot& snapshot, const ViewOptions& options) {
  hinges_.instances.clear();
  // Senses of one joint follow each other: the one that is nearest to its limit is marked.
  const auto& turned = snapshot.answer->plastic_rotations;
  for (std::size_t i = 0; i < turned.size() && options.yielded_joints && options.analysis();) {
    const structure::JointId joint = turned[i].joint;
    double share = 0;
    for (; i < turned.size() && turned[i].joint == joint; ++i)
      share = std::max(share, std::abs(turned[i].turned) / turned[i].limit);
    const structure::Joint& own = building_[joint];
    const Member& member = building_[own.member];
    const auto index = static_cast<std::size_t>(own.member.index);
    if (snapshot.membership->member[index] != part_stands || !is_on(options.shown, member) ||
        !is_on(options.coloured, member))
      continue;
    hinges_.instances.push_back(hinge_mark(parts.standing_member(index, snapshot, options), building_[member.section],
                                           own.end, share, joint_palette(options.colour_blind_safe).yielded));
  }
  hinges_.standing = hinges_.instances.size();
  ++hinges_.revision;
}

void OverlayInstances::draw_marks(const PartInstances& parts, const Snapshot& snapshot, const ViewOptions& options) {
  constexpr Rgba hovered = rgba(255, 255, 255), selected = rgba(255, 150, 20);
  marks_.clear();
  std::vector<BodyMotion> motions;
  for (const BodyPose& body : snapshot.bodies) motions.emplace_back(body);
  const auto mark_member = [&](structure::MemberId id, Rgba colour) {
    if (!id.valid()) return;
    const auto index = static_cast<std::size_t>(id.index);
    const int place = snapshot.membership->member[index];
    if (place == part_gone) return;
    const structure::Section& section = building_[building_[id].section];
    const double side = std::sqrt(section.area);
    const glm::vec2 half(section.width > 0 ? section.width / 2 : side / 2,
                         section.depth > 0 ? section.depth / 2 : side / 2);
    add_mark(marks_,
             place == part_stands ? parts.standing_member(index, snapshot, options)
                                  : parts.moved_member(index, motions[static_cast<std::size_t>(place)], snapshot),
             half, colour);
  };
  const auto mark_panel = [&](structure::PanelId id, Rgba colour) {
    if (!id.valid()) return;
    const auto index = static_cast<std::size_t>(id.index);
    const int place = snapshot.membership->panel[index];
    if (place == part_gone) return;
    add_mark(marks_,
             place == part_stands ? parts.standing_panel(index, snapshot, options)
                                  : parts.moved_panel(index, motions[static_cast<std::size_t>(place)], snapshot),
             colour);
  };
  mark_member(options.hovered_member, hovered);
  mark_panel(options.hovered_panel, hovered);
  mark_member(options.selected_member, selected);
  mark_panel(options.selected_panel, selected);
  draw_cables(snapshot);
}

void OverlayInstances::draw_cables(const Snapshot& snapshot) {
  constexpr Rgba steel = rgba(40, 42, 46);
  for (const BodyPose& body : snapshot.bodies) {
    if (!body.cable_anchor) continue;
    for (const Eigen::Vector3d& end : {*body.cable_anchor, body.position})
      marks_.lines.push_back({glm::vec3(glm::dvec3(end.x(), end.y(), end.z()) - bounds_.centre()), steel});
  }
  for (const auto& rope : snapshot.ropes)
    for (const Eigen::Vector3d& end : rope)
      marks_.lines.push_back({glm::vec3(glm::dvec3(end.x(), end.y(), end.z()) - bounds_.centre()), steel});
}

}  // namespace topple::viewer
