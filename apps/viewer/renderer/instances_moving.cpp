// What has come off and is whole: members with their torn ends, panels, projectiles.
#include <array>
#include <map>

#include "renderer/instance_parts.h"
#include "renderer/shapes/looks.h"
#include "renderer/shapes/torn_ends.h"

namespace topple::viewer {

using structure::Member;

/// It keeps the shape that it let go with, as one body.
MemberInstance SceneInstances::moved_member(std::size_t index, const Motion& motion, const Snapshot& snapshot) const {
  MemberInstance instance = member_parts_[index].rest;
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

PanelInstance SceneInstances::moved_panel(std::size_t index, const Motion& motion, const Snapshot& snapshot) const {
  PanelInstance instance = panel_parts_[index].rest;
  if (const auto& kept = snapshot.membership->panel_shape; index < kept.size() && kept[index])
    for (std::size_t c = 0; c < 4; ++c) instance.corner[c] += to_glm((*kept[index])[c]);
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
        moved_panel(moving.index, motion, snapshot));
  }
  projectiles_.instances.clear();
  // Bare steel where materials are seen.
  const Rgba ball = built_options_.colouring == Colouring::materials
                        ? (projectile_colour & 0xffffffU) | static_cast<Rgba>(Look::steel) << 24U
                        : projectile_colour;
  for (const BodyPose& body : snapshot.bodies)
    if (body.radius > 0)
      projectiles_.instances.push_back({glm::vec3(to_glm(body.position) - origin_), packed(to_glm(body.orientation)),
                                        glm::vec3(static_cast<float>(body.radius)), ball, glm::vec3(0)});
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

}  // namespace topple::viewer
