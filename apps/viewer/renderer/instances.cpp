#include "renderer/instances.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace topple::viewer {
namespace {

using structure::Building;
using structure::Member;
using structure::MemberKind;
using structure::Panel;
using structure::PanelKind;

glm::dvec3 to_glm(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }
glm::vec3 to_glm(const Eigen::Vector3f& v) { return {v.x(), v.y(), v.z()}; }
glm::dquat to_glm(const Eigen::Quaterniond& q) { return {q.w(), q.x(), q.y(), q.z()}; }
glm::vec4 packed(const glm::dquat& q) { return {q.x, q.y, q.z, q.w}; }

/// Parts of a drawn bent member: fewer when there are many, so that the triangles stay within what a card draws at
/// ease.
int segments_for(const Building& building) { return building.members.size() > 4000 ? 3 : 8; }

Rgba highlighted(Rgba colour, bool hovered, bool selected) {
  if (!hovered && !selected) return colour;
  const glm::vec4 to = selected ? glm::vec4(1.0F, 0.62F, 0.1F, 1.0F) : glm::vec4(1.0F, 1.0F, 1.0F, 1.0F);
  return rgba(glm::mix(unpack(colour), to, selected ? 0.75F : 0.4F));
}

/// Rigid motion of a body as a drawing needs it.
struct Motion {
  glm::dvec3 position, rest_centre;
  glm::dquat turn;
  explicit Motion(const BodyPose& body)
      : position(to_glm(body.position)), rest_centre(to_glm(body.rest_centre)), turn(to_glm(body.orientation)) {}
  [[nodiscard]] glm::dvec3 operator()(const glm::dvec3& point) const { return position + turn * (point - rest_centre); }
};

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

SceneInstances::SceneInstances(const Building& building)
    : building_(building), bounds_(bounds_of(building)), origin_(bounds_.centre()) {
  place_members();
  place_panels();
  projectiles_.mesh = sphere_mesh(24);
}

void SceneInstances::place_members() {
  members_.resize(building_.sections.size());
  for (std::size_t i = 0; i < building_.sections.size(); ++i)
    members_[i].mesh = section_mesh(building_.sections[i], segments_for(building_));
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
    part.rest.base = panel_colour(panel.kind);
    panel_parts_.push_back(part);
  }
}

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
  instance.base = highlighted(member_colour(member.kind), options.hovered_member == id, options.selected_member == id);
  instance.end1 = instance.end2 = 0;
  if (!shown(member, options.coloured)) return;
  const auto colour = [&](int end) {
    const auto j = static_cast<std::size_t>(building_.joint(id, end).index);
    return joint_colour(snapshot.answer->joints[j], building_.joints[j].capacity, options, largest_);
  };
  instance.end1 = colour(0);
  instance.end2 = colour(1);
}

void SceneInstances::colour_panel(std::size_t index, const Snapshot& snapshot, const ViewOptions& options) {
  const Panel& panel = building_.panels[index];
  PanelInstance& instance = panel_parts_[index].rest;
  const structure::PanelId id(index);
  instance.base = highlighted(panel_colour(panel.kind), options.hovered_panel == id, options.selected_panel == id);
  const bool coloured = panel.kind == PanelKind::slab ? options.coloured.slabs : options.coloured.walls;
  // A map along members has no meaning across a panel; its failed edges still show.
  const bool map = options.colouring == Colouring::utilisation || options.colouring == Colouring::component;
  for (int edge = 0; edge < 4; ++edge) {
    const auto j = static_cast<std::size_t>(building_.joint(id, edge).index);
    const FrameAnswer::Joint& joint = snapshot.answer->joints[j];
    const bool plain = !coloured || (map && joint.intact);
    instance.edge[edge] = plain ? 0 : joint_colour(joint, building_.joints[j].capacity, options, largest_);
  }
}

void SceneInstances::add_standing_member(std::size_t index, const Snapshot& snapshot, const ViewOptions& options) {
  const Member& member = building_.members[index];
  const Part& part = member_parts_[index];
  MemberInstance instance = part.rest;
  const auto end = [&](std::size_t e, glm::vec3& displacement, glm::vec3& rotation) {
    const auto& d = snapshot.answer->displacements[static_cast<std::size_t>(member.nodes[e].index)];
    rotation = options.deflection_scale * to_glm(Eigen::Vector3f(d.tail<3>()));
    displacement = options.deflection_scale * to_glm(Eigen::Vector3f(d.head<3>())) +
                   glm::cross(rotation, glm::vec3(to_glm(member.offsets[e])));
  };
  end(0, instance.displacement1, instance.rotation1);
  end(1, instance.displacement2, instance.rotation2);
  members_[part.batch].instances.push_back(instance);
}

void SceneInstances::add_standing_panel(std::size_t index, const Snapshot& snapshot, const ViewOptions& options) {
  const Panel& panel = building_.panels[index];
  PanelPart& part = panel_parts_[index];
  PanelInstance instance = part.rest;
  for (std::size_t c = 0; c < 4; ++c) {
    const auto& d = snapshot.answer->displacements[static_cast<std::size_t>(panel.nodes[c].index)];
    instance.corner[c] += options.deflection_scale * to_glm(Eigen::Vector3f(d.head<3>()));
  }
  batches(panel)[part.batch].instances.push_back(instance);
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
      add_standing_member(i, snapshot, options);
    else if (options.debris)
      moving_members_.push_back({i, place});
  }
  for (std::size_t i = 0; i < panel_parts_.size(); ++i) {
    const int place = snapshot.membership->panel[i];
    const bool slab = building_.panels[i].kind == PanelKind::slab;
    if (place == part_gone || !(slab ? options.shown.slabs : options.shown.walls)) continue;
    colour_panel(i, snapshot, options);
    if (place == part_stands)
      add_standing_panel(i, snapshot, options);
    else if (options.debris)
      moving_panels_.push_back({i, place});
  }
  close(members_), close(slabs_), close(walls_);
}

void SceneInstances::append_moving(const Snapshot& snapshot) {
  std::vector<Motion> motions;
  motions.reserve(snapshot.bodies.size());
  for (const BodyPose& body : snapshot.bodies) motions.emplace_back(body);
  for (auto& batch : members_) batch.instances.resize(batch.standing);
  for (auto& batch : slabs_) batch.instances.resize(batch.standing);
  for (auto& batch : walls_) batch.instances.resize(batch.standing);
  for (const MovingPart& moving : moving_members_) {
    const Motion& motion = motions[static_cast<std::size_t>(moving.body)];
    const Part& part = member_parts_[moving.index];
    MemberInstance instance = part.rest;
    const glm::vec4 q = instance.rotation;
    instance.first_end = glm::vec3(motion(glm::dvec3(instance.first_end) + origin_) - origin_);
    instance.rotation = packed(motion.turn * glm::dquat(q.w, q.x, q.y, q.z));
    members_[part.batch].instances.push_back(instance);
  }
  for (const MovingPart& moving : moving_panels_) {
    const Motion& motion = motions[static_cast<std::size_t>(moving.body)];
    PanelInstance instance = panel_parts_[moving.index].rest;
    for (glm::vec3& corner : instance.corner) corner = glm::vec3(motion(glm::dvec3(corner) + origin_) - origin_);
    batches(building_.panels[moving.index])[panel_parts_[moving.index].batch].instances.push_back(instance);
  }
  projectiles_.instances.clear();
  for (const BodyPose& body : snapshot.bodies)
    if (body.radius > 0)
      projectiles_.instances.push_back({glm::vec3(to_glm(body.position) - origin_), packed(to_glm(body.orientation)),
                                        glm::vec3(static_cast<float>(body.radius)), projectile_colour});
}

void SceneInstances::place_chunks(const Snapshot& snapshot) {
  for (auto& batch : chunks_) batch.instances.clear();
  if (!built_options_.debris) return;
  for (const BodyPose& body : snapshot.bodies) {
    if (!body.chunk) continue;
    const bool slab = body.chunk_of == PanelKind::slab;
    if (!(slab ? built_options_.shown.slabs : built_options_.shown.walls)) continue;
    const auto [found, is_new] = chunk_of_body_.try_emplace(body.id, chunks_.size());
    if (is_new) {
      chunks_.emplace_back();
      chunks_.back().mesh = chunk_mesh(*body.chunk);
    }
    chunks_[found->second].instances.push_back({glm::vec3(to_glm(body.position) - origin_),
                                                packed(to_glm(body.orientation)), glm::vec3(1),
                                                panel_colour(body.chunk_of)});
  }
}

void SceneInstances::update(const Snapshot& snapshot, const ViewOptions& options) {
  const bool changed =
      built_answer_ != snapshot.answer || built_membership_ != snapshot.membership || !(built_options_ == options);
  if (changed) rebuild_standing(snapshot, options);
  built_answer_ = snapshot.answer;
  built_membership_ = snapshot.membership;
  built_options_ = options;
  append_moving(snapshot);
  place_chunks(snapshot);
}

}  // namespace topple::viewer
