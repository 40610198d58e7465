#include "renderer/instances/part_instances.h"

#include <algorithm>

#include "renderer/shapes/looks.h"

namespace topple::viewer {
namespace {

using structure::Member;
using structure::Panel;

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

PartInstances::PartInstances(const structure::Building& building, const glm::dvec3& origin)
    : building_(building), origin_(origin) {
  for (const Member& member : building_.members) {
    MemberInstance rest{};
    rest.first_end = to_glm(structure::Vec3(building_[member.nodes[0]].position + member.offsets[0])) - origin_;
    rest.rotation = packed(to_glm(Eigen::Quaterniond(structure::Mat3(member.axes.transpose()))));
    rest.length = static_cast<float>(member.length);
    rest.base = member_colour(member.kind);
    members_.push_back(rest);
  }
  for (const Panel& panel : building_.panels) {
    PanelInstance rest{};
    for (std::size_t c = 0; c < 4; ++c)
      rest.corner[c] = glm::vec3(to_glm(building_[panel.nodes[c]].position) - origin_);
    rest.thickness = static_cast<float>(panel.thickness);
    for (std::size_t c = 0; c < 3; ++c) rest.rest[c] = rest.corner[c + (c == 2 ? 1 : 0)];
    rest.base = panel_colour(panel.kind);
    panels_.push_back(rest);
  }
}

void PartInstances::find_largest(const Snapshot& snapshot, const ViewOptions& options) {
  largest_ = 0;
  for (std::size_t i = 0; i < snapshot.answer->joints.size(); ++i) {
    const bool of_member = building_.joints[i].member.valid();
    if (of_member || options.colouring == Colouring::joints)
      largest_ = std::max(largest_, joint_value(snapshot.answer->joints[i], options));
  }
}

void PartInstances::colour_member(std::size_t index, const Snapshot& snapshot, const ViewOptions& options) {
  const Member& member = building_.members[index];
  MemberInstance& instance = members_[index];
  const structure::MemberId id(index);
  const bool coloured = is_on(options.coloured, member);
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

void PartInstances::colour_panel(std::size_t index, const Snapshot& snapshot, const ViewOptions& options) {
  const Panel& panel = building_.panels[index];
  PanelInstance& instance = panels_[index];
  const structure::PanelId id(index);
  if (options.colouring != Colouring::materials)
    instance.base = panel_colour(panel.kind);
  else if (instance.base >> 24U == 255)
    instance.base = look_colour(look_of(building_[panel.material]));
  // Which segment a standing panel hangs on is not asked for: it keeps its colour.
  if (const int place = snapshot.membership->panel[index]; options.colouring == Colouring::segments && place >= 0)
    instance.base = part_colour(place, -1, snapshot, options);
  const bool coloured = is_on(options.coloured, panel);
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

MemberInstance PartInstances::standing_member(std::size_t index, const Snapshot& snapshot,
                                              const ViewOptions& options) const {
  MemberInstance instance = members_[index];
  bend(instance, DrawnShape(snapshot, options).of(building_, index));
  if (snapshot.shape && snapshot.shape_bulge)
    instance.bulge = snapshot.shape_scale * to_glm((*snapshot.shape_bulge)[index]);
  return instance;
}

PanelInstance PartInstances::standing_panel(std::size_t index, const Snapshot& snapshot,
                                            const ViewOptions& options) const {
  const DrawnShape shape(snapshot, options);
  PanelInstance instance = panels_[index];
  for (std::size_t c = 0; c < 4; ++c)
    instance.corner[c] += to_glm(Eigen::Vector3f(shape.at(building_.panels[index].nodes[c]).head<3>()));
  return instance;
}

/// It keeps the shape that it let go with, as one body.
MemberInstance PartInstances::moved_member(std::size_t index, const BodyMotion& motion,
                                           const Snapshot& snapshot) const {
  MemberInstance instance = members_[index];
  const glm::vec4 q = instance.rotation;
  instance.first_end = glm::vec3(motion(glm::dvec3(instance.first_end) + origin_) - origin_);
  instance.rotation = packed(motion.turn * glm::dquat(q.w, q.x, q.y, q.z));
  if (const auto& kept = snapshot.membership->member_shape; index < kept.size() && kept[index]) {
    bend(instance, *kept[index]);
    for (glm::vec3* way :
         {&instance.displacement1, &instance.rotation1, &instance.displacement2, &instance.rotation2, &instance.bulge})
      *way = glm::vec3(motion.turn * glm::dvec3(*way));
  }
  return instance;
}

PanelInstance PartInstances::moved_panel(std::size_t index, const BodyMotion& motion, const Snapshot& snapshot) const {
  PanelInstance instance = panels_[index];
  if (const auto& kept = snapshot.membership->panel_shape; index < kept.size() && kept[index])
    for (std::size_t c = 0; c < 4; ++c) instance.corner[c] += to_glm((*kept[index])[c]);
  for (glm::vec3& corner : instance.corner) corner = glm::vec3(motion(glm::dvec3(corner) + origin_) - origin_);
  return instance;
}

}  // namespace topple::viewer
