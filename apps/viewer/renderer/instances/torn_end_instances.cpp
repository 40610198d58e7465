#include "renderer/instances/torn_end_instances.h"

#include <map>

#include "renderer/shapes/looks.h"
#include "renderer/shapes/torn_ends.h"

namespace topple::viewer {

using structure::Member;

TornEndInstances::TornEndInstances(const structure::Building& building) : building_(building) {
  for (const structure::Section& section : building.sections)
    for (unsigned variant = 0; variant < torn_end_variants; ++variant) {
      batches_.emplace_back();
      batches_.back().mesh = torn_end_mesh(section, variant);
    }
}

void TornEndInstances::find(const std::vector<MovingPart>& members, const FrameAnswer& answer) {
  std::map<std::pair<int, int>, int> hang;  // by body and node
  const auto intact = [&](std::size_t index, int end) {
    const structure::JointId joint = building_.joint(structure::MemberId(index), end);
    return answer.joints[static_cast<std::size_t>(joint.index)].intact;
  };
  const auto key = [&](const MovingPart& moving, int end) {
    const Member& member = building_.members[moving.index];
    return std::pair(moving.body, static_cast<int>(member.nodes[static_cast<std::size_t>(end)].index));
  };
  for (const MovingPart& moving : members)
    for (int end = 0; end < 2; ++end) hang[key(moving, end)] += intact(moving.index, end) ? 1 : 0;
  torn_.clear();
  for (const MovingPart& moving : members) {
    const auto torn = [&](int end) { return !intact(moving.index, end) || hang[key(moving, end)] < 2; };
    torn_.push_back({torn(0), torn(1)});
  }
}

void TornEndInstances::add(std::size_t index, int end, const MemberInstance& instance, const glm::vec3& rest) {
  const glm::vec4 q = instance.rotation;
  const glm::dquat turn(q.w, q.x, q.y, q.z);
  const glm::vec3 far_end(turn * glm::dvec3(static_cast<double>(instance.length), 0, 0));
  const glm::vec3 place =
      end == 0 ? instance.first_end + instance.displacement1 : instance.first_end + far_end + instance.displacement2;
  // The first end looks the other way: half a turn about the section's z.
  const glm::dquat facing = end == 0 ? turn * glm::dquat(0, 0, 0, 1) : turn;
  const std::size_t variant = (index + static_cast<std::size_t>(end)) % torn_end_variants;
  const auto section = static_cast<std::size_t>(building_.members[index].section.index);
  batches_[section * torn_end_variants + variant].instances.push_back(
      {place, packed(facing), glm::vec3(1), look_colour(Look::concrete), rest});
}

void TornEndInstances::update(const std::vector<MovingPart>& members, const PartInstances& parts,
                              const Snapshot& snapshot, const ViewOptions& options) {
  for (auto& batch : batches_) batch.instances.clear();
  // So many ends are too small in the picture to be told from plain ones.
  constexpr std::size_t most = 2000;
  if (options.colouring != Colouring::materials || members.size() > most) return;
  // In this view the alpha of a part's colour is what it is made of.
  const auto of_concrete = [&](std::size_t index) {
    return parts.member(index).base >> 24U == static_cast<Rgba>(Look::concrete);
  };
  std::vector<BodyMotion> motions;
  motions.reserve(snapshot.bodies.size());
  for (const BodyPose& body : snapshot.bodies) motions.emplace_back(body);
  for (std::size_t i = 0; i < members.size(); ++i) {
    const MovingPart& moving = members[i];
    if (!of_concrete(moving.index)) continue;
    const MemberInstance instance =
        parts.moved_member(moving.index, motions[static_cast<std::size_t>(moving.body)], snapshot);
    for (const int end : {0, 1})
      if (torn_[i][static_cast<std::size_t>(end)])
        add(moving.index, end, instance, parts.member(moving.index).first_end);
  }
}

}  // namespace topple::viewer
