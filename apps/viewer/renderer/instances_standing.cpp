// What stands: its colours and where it is drawn.
#include <algorithm>
#include <array>
#include <cmath>

#include "renderer/instance_parts.h"
#include "renderer/shapes/looks.h"

namespace topple::viewer {
namespace {

using structure::Member;
using structure::MemberKind;
using structure::Panel;
using structure::PanelKind;

/// Of a connected part: bodies by their own number, after those that segments usually take.
Rgba part_colour(int place, int segment, const Snapshot& snapshot, const ViewOptions& options) {
  constexpr std::int64_t after_segments = 3;
  const std::int64_t number =
      place >= 0 ? after_segments + snapshot.bodies[static_cast<std::size_t>(place)].id : segment;
  return segment_colour(std::max<std::int64_t>(number, 0), options.colour_blind_safe);
}

/// What cracks a panel shows along an edge, as an alpha: the first at 0.7 of what the edge bears, all where it has
/// failed.
Rgba crack_of(const FrameAnswer::Joint& joint) {
  constexpr float first = 0.7F;
  const float open = joint.intact ? (joint.utilisation - first) / (1 - first) : 1.0F;
  return rgba(0, 0, 0, static_cast<unsigned>(255 * std::clamp(open, 0.0F, 1.0F)));
}

}  // namespace

bool SceneInstances::shown(const Member& member, const PartSwitches& switches) const {
  switch (member.kind) {
    case MemberKind::post:
      return switches.posts;
    case MemberKind::beam:
      return switches.beams;
    case MemberKind::brace:
      return switches.braces;
  }
  return true;
}

void SceneInstances::colour_member(std::size_t index, const Snapshot& snapshot, const ViewOptions& options) {
  const Member& member = building_.members[index];
  MemberInstance& instance = member_parts_[index].rest;
  const structure::MemberId id(index);
  const bool coloured = shown(member, options.coloured);
  if (options.colouring == Colouring::materials) {
    // Names of materials are read once: the alpha tells that this was done.
    if (instance.base >> 24U == 255) instance.base = look_colour(look_of(building_[member.material]));
  } else {
    // Beside the colours of joints, those of kinds would only be read as more of them.
    instance.base = coloured && options.colouring == Colouring::joints ? plain_member : member_colour(member.kind);
  }
  if (options.colouring == Colouring::segments)
    instance.base =
        part_colour(snapshot.membership->member[index], snapshot.membership->segment[index], snapshot, options);
  instance.end1 = instance.end2 = 0;
  if (!coloured) return;
  const auto colour = [&](int end) {
    const structure::JointId joint = building_.joint(id, end);
    const auto j = static_cast<std::size_t>(joint.index);
    const FrameAnswer::Joint& answer = snapshot.answer->joints[j];
    if (options.colouring == Colouring::path && snapshot.path && answer.intact && answer.standing)
      return utilisation_colour(static_cast<double>(std::min((*snapshot.path)[j], 1.0F)));
    return joint_colour(answer, joint_capacity(building_, snapshot, joint), options, largest_);
  };
  instance.end1 = colour(0);
  instance.end2 = colour(1);
}

void SceneInstances::colour_panel(std::size_t index, const Snapshot& snapshot, const ViewOptions& options) {
  const Panel& panel = building_.panels[index];
  PanelInstance& instance = panel_parts_[index].rest;
  const structure::PanelId id(index);
  if (options.colouring != Colouring::materials)
    instance.base = panel_colour(panel.kind);
  else if (instance.base >> 24U == 255)
    instance.base = look_colour(look_of(building_[panel.material]));
  // Which segment a standing panel hangs on is not asked for: it keeps its colour.
  if (const int place = snapshot.membership->panel[index]; options.colouring == Colouring::segments && place >= 0)
    instance.base = part_colour(place, -1, snapshot, options);
  const bool coloured = panel.kind == PanelKind::slab ? options.coloured.slabs : options.coloured.walls;
  // A map along members has no meaning across a panel; its failed edges still show.
  const bool map = options.colouring == Colouring::utilisation || options.colouring == Colouring::component;
  for (int edge = 0; edge < 4; ++edge) {
    const auto j = static_cast<std::size_t>(building_.joint(id, edge).index);
    const FrameAnswer::Joint& joint = snapshot.answer->joints[j];
    if (options.colouring == Colouring::materials) {
      instance.edge[edge] = joint.standing ? crack_of(joint) : 0;
      continue;
    }
    const bool plain = !coloured || (map && joint.intact);
    instance.edge[edge] =
        plain ? 0
              : joint_colour(joint, joint_capacity(building_, snapshot, building_.joint(id, edge)), options, largest_);
  }
}

MemberInstance SceneInstances::standing_member(std::size_t index, const Snapshot& snapshot,
                                               const ViewOptions& options) const {
  MemberInstance instance = member_parts_[index].rest;
  bend(instance, DrawnShape(snapshot, options).of(building_, index));
  if (snapshot.shape && snapshot.shape_bulge)
    instance.bulge = snapshot.shape_scale * to_glm((*snapshot.shape_bulge)[index]);
  return instance;
}

PanelInstance SceneInstances::standing_panel(std::size_t index, const Snapshot& snapshot,
                                             const ViewOptions& options) const {
  const DrawnShape shape(snapshot, options);
  PanelInstance instance = panel_parts_[index].rest;
  for (std::size_t c = 0; c < 4; ++c)
    instance.corner[c] += to_glm(Eigen::Vector3f(shape.at(building_.panels[index].nodes[c]).head<3>()));
  return instance;
}

void SceneInstances::rebuild_standing(const Snapshot& snapshot, const ViewOptions& options) {
  largest_ = 0;
  for (std::size_t i = 0; i < snapshot.answer->joints.size(); ++i) {
    const bool of_member = building_.joints[i].member.valid();
    if (of_member || options.colouring == Colouring::joints)
      largest_ = std::max(largest_, joint_value(snapshot.answer->joints[i], options));
  }
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
  for (std::size_t i = 0; i < member_parts_.size(); ++i) {
    const int place = snapshot.membership->member[i];
    if (place == part_gone || !shown(building_.members[i], options.shown)) continue;
    colour_member(i, snapshot, options);
    if (place == part_stands)
      members_[member_parts_[i].batch].instances.push_back(standing_member(i, snapshot, options));
    else if (options.debris)
      moving_members_.push_back({i, place});
  }
  for (std::size_t i = 0; i < panel_parts_.size(); ++i) {
    const int place = snapshot.membership->panel[i];
    const bool slab = building_.panels[i].kind == PanelKind::slab;
    if (place == part_gone || !(slab ? options.shown.slabs : options.shown.walls)) continue;
    if (snapshot.membership->broken[i]) continue;  // drawn by its own mesh
    colour_panel(i, snapshot, options);
    if (place == part_stands)
      batches(building_.panels[i])[panel_parts_[i].batch].instances.push_back(standing_panel(i, snapshot, options));
    else if (options.debris)
      moving_panels_.push_back({i, place});
  }
  close(members_), close(slabs_), close(walls_);
  seen_bent_ = is_seen_bent(snapshot);
  place_piers(snapshot, options);
  draw_diagrams(snapshot, options);
  draw_arrows(snapshot, options);
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

void SceneInstances::place_piers(const Snapshot& snapshot, const ViewOptions& options) {
  piers_.instances.clear();
  for (const Pier& pier : pier_places_) {
    if (options.colouring != Colouring::materials || !snapshot.membership->supports[pier.support]) continue;
    const glm::vec3 foot(pier.foot - origin_), size(pier.width, pier.width, pier.height);
    piers_.instances.push_back({foot, {0, 0, 0, 1}, size, look_colour(Look::concrete), foot});
  }
  piers_.standing = piers_.instances.size();
  ++piers_.revision;
}

}  // namespace topple::viewer
