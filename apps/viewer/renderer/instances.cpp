#include "renderer/instances.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "renderer/shapes/arrows.h"
#include "renderer/shapes/diagram.h"
#include "renderer/shapes/looks.h"
#include "renderer/shapes/torn_ends.h"
#include "topple/structure/visual_mesh.h"

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

bool is_shown(const ViewOptions& options, structure::PieceKind kind) {
  const auto& shown = options.shown;
  return std::array{shown.slabs, shown.walls, shown.posts, shown.beams, shown.braces}[static_cast<std::size_t>(kind)];
}

/// Parts of a drawn bent member: fewer when there are many, so that the triangles stay within what a card draws at
/// ease.
int segments_for(const Building& building) { return building.members.size() > 4000 ? 3 : 8; }

/// From so many on, members are drawn straight while nothing bends them so that it is seen.
constexpr std::size_t many_members = 1000;

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

/// Displacements as they are drawn: those of a mode when there is one, else those at the start of the run by one scale
/// and what has come to them by another.
struct DrawnShape {
  using Displacements = std::vector<Eigen::Matrix<float, 6, 1>>;
  const Displacements& displacements;
  const Displacements* at_start = nullptr;  ///< null: all by one scale
  float scale, motion_scale;
  DrawnShape(const Snapshot& snapshot, const ViewOptions& options)
      : displacements(snapshot.shape ? *snapshot.shape : snapshot.answer->displacements),
        scale(snapshot.shape ? snapshot.shape_scale : options.deflection_scale),
        motion_scale(options.motion_scale_now()) {
    if (!snapshot.shape && motion_scale != scale) at_start = snapshot.answer->at_start.get();
  }
  [[nodiscard]] Eigen::Matrix<float, 6, 1> at(structure::NodeId node) const {
    const auto i = static_cast<std::size_t>(node.index);
    const auto& now = displacements[i];
    // A node that is held, or stands no more, has not moved.
    if (at_start == nullptr || now.isZero(0)) return scale * now;
    return scale * (*at_start)[i] + motion_scale * (now - (*at_start)[i]);
  }
};

}  // namespace

/// Rigid motion of a body as a drawing needs it.
struct SceneInstances::Motion {
  glm::dvec3 position, rest_centre;
  glm::dquat turn;
  explicit Motion(const BodyPose& body)
      : position(to_glm(body.position)), rest_centre(to_glm(body.rest_centre)), turn(to_glm(body.orientation)) {}
  [[nodiscard]] glm::dvec3 operator()(const glm::dvec3& point) const { return position + turn * (point - rest_centre); }
};

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
  const Member& member = building_.members[index];
  const DrawnShape shape(snapshot, options);
  MemberInstance instance = member_parts_[index].rest;
  const auto end = [&](std::size_t e, glm::vec3& displacement, glm::vec3& rotation) {
    const Eigen::Matrix<float, 6, 1> d = shape.at(member.nodes[e]);
    rotation = to_glm(Eigen::Vector3f(d.tail<3>()));
    displacement = to_glm(Eigen::Vector3f(d.head<3>())) + glm::cross(rotation, glm::vec3(to_glm(member.offsets[e])));
  };
  end(0, instance.displacement1, instance.rotation1);
  end(1, instance.displacement2, instance.rotation2);
  instance.bulge = glm::vec3(0);
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
  place_piers(snapshot, options);
  draw_diagrams(snapshot, options);
  draw_arrows(snapshot, options);
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

void SceneInstances::draw_diagrams(const Snapshot& snapshot, const ViewOptions& options) {
  diagrams_.clear();
  diagram_range_ = {0, 0};
  const auto& forces = snapshot.answer->forces;
  if (options.diagram < 0 || !forces || forces->internal.empty()) return;
  constexpr std::size_t places = FrameForces::intervals + 1;
  std::vector<std::size_t> drawn;
  for (std::size_t i = 0; i < building_.members.size(); ++i) {
    const Member& member = building_.members[i];
    if (snapshot.membership->member[i] == part_stands && shown(member, options.shown) &&
        shown(member, options.coloured))
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
    add_diagram(diagrams_, standing_member(i, snapshot, options), along.data(), FrameForces::intervals, options.diagram,
                reach);
  }
}

void SceneInstances::draw_arrows(const Snapshot& snapshot, const ViewOptions& options) {
  arrows_.instances.clear();
  buried_arrows_.instances.clear();
  if (const auto& forces = snapshot.answer->forces) {
    const auto longest = static_cast<float>(0.12 * bounds_.radius()) * options.arrow_scale;
    arrows_.instances = arrow_instances(*forces, options, origin_, longest);
    if (options.reactions) buried_arrows_.instances = reaction_instances(*forces, origin_, longest);
  }
  for (auto* batch : {&arrows_, &buried_arrows_}) {
    batch->standing = batch->instances.size();
    ++batch->revision;
  }
}

void SceneInstances::draw_marks(const Snapshot& snapshot, const ViewOptions& options) {
  constexpr Rgba hovered = rgba(255, 255, 255), selected = rgba(255, 150, 20);
  marks_.clear();
  std::vector<Motion> motions;
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
             place == part_stands ? standing_member(index, snapshot, options)
                                  : moved_member(index, motions[static_cast<std::size_t>(place)], snapshot),
             half, colour);
  };
  const auto mark_panel = [&](structure::PanelId id, Rgba colour) {
    if (!id.valid()) return;
    const auto index = static_cast<std::size_t>(id.index);
    const int place = snapshot.membership->panel[index];
    if (place == part_gone) return;
    add_mark(marks_,
             place == part_stands ? standing_panel(index, snapshot, options)
                                  : moved_panel(index, motions[static_cast<std::size_t>(place)]),
             colour);
  };
  mark_member(options.hovered_member, hovered);
  mark_panel(options.hovered_panel, hovered);
  mark_member(options.selected_member, selected);
  mark_panel(options.selected_panel, selected);
}

void SceneInstances::draw_cables(const Snapshot& snapshot) {
  constexpr Rgba steel = rgba(40, 42, 46);
  for (const BodyPose& body : snapshot.bodies) {
    if (!body.cable_anchor) continue;
    for (const Eigen::Vector3d& end : {*body.cable_anchor, body.position})
      marks_.lines.push_back({glm::vec3(glm::dvec3(end.x(), end.y(), end.z()) - origin_), steel});
  }
  for (const auto& rope : snapshot.ropes)
    for (const Eigen::Vector3d& end : rope)
      marks_.lines.push_back({glm::vec3(glm::dvec3(end.x(), end.y(), end.z()) - origin_), steel});
}

/// It keeps the shape that it let go with, as one body.
MemberInstance SceneInstances::moved_member(std::size_t index, const Motion& motion, const Snapshot& snapshot) const {
  MemberInstance instance = member_parts_[index].rest;
  const glm::vec4 q = instance.rotation;
  instance.first_end = glm::vec3(motion(glm::dvec3(instance.first_end) + origin_) - origin_);
  instance.rotation = packed(motion.turn * glm::dquat(q.w, q.x, q.y, q.z));
  if (const auto& bend = snapshot.membership->bend; index < bend.size()) {
    instance.rotation1 = glm::vec3(motion.turn * glm::dvec3(to_glm(bend[index][0])));
    instance.rotation2 = glm::vec3(motion.turn * glm::dvec3(to_glm(bend[index][1])));
  }
  return instance;
}

PanelInstance SceneInstances::moved_panel(std::size_t index, const Motion& motion) const {
  PanelInstance instance = panel_parts_[index].rest;
  for (glm::vec3& corner : instance.corner) corner = glm::vec3(motion(glm::dvec3(corner) + origin_) - origin_);
  return instance;
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
    members_[member_parts_[moving.index].batch].instances.push_back(moved_member(moving.index, motion, snapshot));
  }
  for (const MovingPart& moving : moving_panels_) {
    const Motion& motion = motions[static_cast<std::size_t>(moving.body)];
    batches(building_.panels[moving.index])[panel_parts_[moving.index].batch].instances.push_back(
        moved_panel(moving.index, motion));
  }
  projectiles_.instances.clear();
  for (const BodyPose& body : snapshot.bodies)
    if (body.radius > 0)
      projectiles_.instances.push_back({glm::vec3(to_glm(body.position) - origin_), packed(to_glm(body.orientation)),
                                        glm::vec3(static_cast<float>(body.radius)), projectile_colour, glm::vec3(0)});
}

void SceneInstances::place_chunks(const Snapshot& snapshot) {
  for (auto& batch : chunks_) batch.instances.clear();
  if (!built_options_.debris) return;
  const bool materials = built_options_.colouring == Colouring::materials;
  for (const BodyPose& body : snapshot.bodies) {
    if (!body.chunk) continue;
    if (!is_shown(built_options_, body.chunk_of)) continue;
    const auto [found, is_new] = chunk_of_body_.try_emplace(body.id, chunks_.size());
    if (is_new) {
      chunks_.emplace_back();
      chunks_.back().mesh = chunk_mesh(*body.chunk);
      mark_broken(chunks_.back().mesh, nullptr, nullptr);
      add_bars(chunks_.back().mesh, bars_of_chunk(body.material));
    }
    chunks_[found->second].instances.push_back(
        {glm::vec3(to_glm(body.position) - origin_), packed(to_glm(body.orientation)), glm::vec3(1),
         materials && body.material.valid() ? look_colour(look_of(building_[body.material]))
                                            : piece_colour(body.chunk_of),
         glm::vec3(to_glm(body.rest_centre) - origin_)});
  }
}

/// Fewer where there are many pieces, of which each is small in the picture.
std::size_t SceneInstances::bars_of_chunk(structure::MaterialId material) const {
  if (!material.valid() || look_of(building_[material]) != Look::concrete) return 0;
  return chunks_.size() < 300 ? 16 : chunks_.size() < 1500 ? 6 : 0;
}

/// A member was torn from all that was at its end where its own joint failed, or where nothing else of its body hangs.
void SceneInstances::find_torn_ends() {
  std::map<std::pair<int, int>, int> hang;  // by body and node
  const auto intact = [&](std::size_t index, int end) {
    const structure::JointId joint = building_.joint(structure::MemberId(index), end);
    return built_answer_->joints[static_cast<std::size_t>(joint.index)].intact;
  };
  const auto key = [&](const MovingPart& moving, int end) {
    const Member& member = building_.members[moving.index];
    return std::pair(moving.body, static_cast<int>(member.nodes[static_cast<std::size_t>(end)].index));
  };
  for (const MovingPart& moving : moving_members_)
    for (int end = 0; end < 2; ++end) hang[key(moving, end)] += intact(moving.index, end) ? 1 : 0;
  torn_.clear();
  for (const MovingPart& moving : moving_members_) {
    const auto torn = [&](int end) { return !intact(moving.index, end) || hang[key(moving, end)] < 2; };
    torn_.push_back({torn(0), torn(1)});
  }
}

void SceneInstances::add_torn_end(std::size_t index, int end, const MemberInstance& instance) {
  const glm::vec4 q = instance.rotation;
  const glm::dquat turn(q.w, q.x, q.y, q.z);
  const glm::vec3 far_end(turn * glm::dvec3(static_cast<double>(instance.length), 0, 0));
  const glm::vec3 place =
      end == 0 ? instance.first_end + instance.displacement1 : instance.first_end + far_end + instance.displacement2;
  // The first end looks the other way: half a turn about the section's z.
  const glm::dquat facing = end == 0 ? turn * glm::dquat(0, 0, 0, 1) : turn;
  const std::size_t variant = (index + static_cast<std::size_t>(end)) % torn_end_variants;
  torn_ends_[member_parts_[index].batch * torn_end_variants + variant].instances.push_back(
      {place, packed(facing), glm::vec3(1), look_colour(Look::concrete), member_parts_[index].rest.first_end});
}

void SceneInstances::place_torn_ends(const Snapshot& snapshot) {
  for (auto& batch : torn_ends_) batch.instances.clear();
  // So many ends are too small in the picture to be told from plain ones.
  constexpr std::size_t most = 2000;
  if (built_options_.colouring != Colouring::materials || moving_members_.size() > most) return;
  // In this view the alpha of a part's colour is what it is made of.
  const auto of_concrete = [&](std::size_t index) {
    return member_parts_[index].rest.base >> 24U == static_cast<Rgba>(Look::concrete);
  };
  std::vector<Motion> motions;
  motions.reserve(snapshot.bodies.size());
  for (const BodyPose& body : snapshot.bodies) motions.emplace_back(body);
  for (std::size_t i = 0; i < moving_members_.size(); ++i) {
    const MovingPart& moving = moving_members_[i];
    if (!of_concrete(moving.index)) continue;
    const MemberInstance instance =
        moved_member(moving.index, motions[static_cast<std::size_t>(moving.body)], snapshot);
    for (const int end : {0, 1})
      if (torn_[i][static_cast<std::size_t>(end)]) add_torn_end(moving.index, end, instance);
  }
}

Rgba SceneInstances::broken_colour(std::size_t panel) const {
  return built_options_.colouring == Colouring::materials
             ? look_colour(look_of(building_[building_.panels[panel].material]))
             : panel_colour(building_.panels[panel].kind);
}

/// What remains of panels that are broken in part: at rest where it stood, else moved with its body.
void SceneInstances::place_broken_panels(const Snapshot& snapshot) {
  for (std::size_t i = 0; i < building_.panels.size(); ++i) {
    const auto& mesh = snapshot.membership->broken[i];
    const int place = snapshot.membership->panel[i];
    const PanelKind kind = building_.panels[i].kind;
    if (!mesh || place == part_gone || mesh->triangles.empty()) continue;
    if (!(kind == PanelKind::slab ? built_options_.shown.slabs : built_options_.shown.walls)) continue;
    if (place != part_stands && !built_options_.debris) continue;
    auto& [drawn, batch] = chunk_of_panel_[i];
    if (drawn != mesh) {
      drawn = mesh;
      batch = chunks_.size();
      chunks_.emplace_back();
      chunks_.back().mesh = chunk_mesh(*mesh);
      mark_broken(chunks_.back().mesh, &building_, &building_.panels[i]);
      add_bars(chunks_.back().mesh, bars_of_chunk(building_.panels[i].material));
    }
    glm::dvec3 position(0);
    glm::dquat turn(1, 0, 0, 0);
    if (place != part_stands) {
      const Motion motion(snapshot.bodies[static_cast<std::size_t>(place)]);
      position = motion(glm::dvec3(0));
      turn = motion.turn;
    }
    chunks_[batch].instances.push_back(
        {glm::vec3(position - origin_), packed(turn), glm::vec3(1), broken_colour(i), glm::vec3(-origin_)});
  }
}

/// Its vertices follow the parts that they hang on, as these are drawn.
void SceneInstances::bend_drawn(const DrawnPiece& piece, const Snapshot& snapshot,
                                InstanceBatch<RigidInstance>& batch) const {
  const DrawnShape shape(snapshot, built_options_);
  const structure::BentBuilding bent{
      [&](structure::NodeId node) -> structure::Vec6 { return shape.at(node).cast<double>(); },
      [&](structure::JointId joint) { return snapshot.answer->joints[static_cast<std::size_t>(joint.index)].intact; }};
  for (std::size_t v = 0; v < piece.mesh->positions.size(); ++v) {
    const Eigen::Vector3d& at = piece.mesh->positions[v];
    const Eigen::Vector3f now =
        (at + structure::displacement_with(building_, (*piece.bones)[v], at, bent)).cast<float>();
    batch.mesh.vertices[v].position = {now.x(), now.y(), now.z()};
  }
  ++batch.mesh_revision;
}

/// A model that is drawn around the building. `bend`: what stands is bent otherwise than before.
void SceneInstances::place_drawn(const Snapshot& snapshot, bool bend) {
  for (auto& batch : drawn_) batch.instances.clear();
  if (!snapshot.drawn || !built_options_.drawn) return;
  for (const DrawnPiece& piece : *snapshot.drawn) {
    const auto body = std::lower_bound(snapshot.bodies.begin(), snapshot.bodies.end(), piece.body,
                                       [](const BodyPose& pose, std::int64_t id) { return pose.id < id; });
    const bool stands = piece.body == part_stands;
    if (!stands && (!built_options_.debris || body == snapshot.bodies.end() || body->id != piece.body)) continue;
    const auto [found, is_new] = batch_of_drawn_.try_emplace(piece.mesh, DrawnBatch{drawn_.size(), false});
    if (is_new) {
      drawn_.emplace_back();
      drawn_.back().mesh = chunk_mesh(*piece.mesh);
    }
    DrawnBatch& own = found->second;
    InstanceBatch<RigidInstance>& batch = drawn_[own.batch];
    if (stands && piece.bones && (bend || !own.bent)) {
      bend_drawn(piece, snapshot, batch);
      own.bent = true;
    } else if (!stands && own.bent) {
      batch.mesh = chunk_mesh(*piece.mesh);
      ++batch.mesh_revision;
      own.bent = false;
    }
    glm::dvec3 position(0);
    glm::dquat turn(1, 0, 0, 0);
    if (!stands) {
      const Motion motion(*body);
      position = motion(glm::dvec3(0));
      turn = motion.turn;
    }
    const Rgba colour = built_options_.colouring == Colouring::materials ? look_colour(Look::plaster) : drawn_colour;
    batch.instances.push_back({glm::vec3(position - origin_), packed(turn), glm::vec3(1), colour, glm::vec3(-origin_)});
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
  place_broken_panels(snapshot);
  place_drawn(snapshot, changed);
  dust_.clear();
  if (options.dust && snapshot.dust) place_dust(*snapshot.dust, snapshot.time, origin_, dust_);
}

}  // namespace topple::viewer
