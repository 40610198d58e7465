// What a host asks about what stands.
#include <algorithm>

#include "simulation/call_checks.h"
#include "simulation/debris/mass_properties.h"
#include "simulation/simulation_state.h"

namespace topple::structure {

namespace {

/// Force that a joint passes on, global axes.
Vec3 global_force(const Building& building, JointId id, const Vec6& demand) {
  const Joint& joint = building[id];
  if (joint.member.valid()) return building[joint.member].axes.transpose() * demand.head<3>();
  const Panel& panel = building[joint.panel];
  const auto end = static_cast<std::size_t>(joint.end);
  const Vec3 y = (building[panel.nodes[(end + 1) % 4]].position - building[panel.nodes[end]].position);
  const Vec3 z = panel.axes.row(2).transpose(), along = y.normalized();
  // Per length of edge: x across it, y along it, z the normal.
  return y.norm() * (along.cross(z) * demand(0) + along * demand(1) + z * demand(2));
}

std::vector<Carrier> carriers_of(const Scene& scene, const ContactPlace& place) {
  constexpr double least = 0.01;  // smaller shares say nothing about where a load goes
  std::vector<Carrier> carriers;
  if (!(place.member.valid() ? scene.frame->stands(place.member) : scene.frame->stands(place.panel))) return carriers;
  const Vec3 down = scene.gravity.norm() > 0 ? Vec3(scene.gravity.normalized()) : Vec3(-Vec3::UnitZ());
  for (const auto& [joint, demand] : scene.frame->respond(place, down).demands) {
    const double share = std::abs(global_force(scene.building, joint, demand).dot(down));
    if (share >= least) carriers.push_back({joint, share});
  }
  std::stable_sort(carriers.begin(), carriers.end(),
                   [](const Carrier& a, const Carrier& b) { return a.share > b.share; });
  return carriers;
}

}  // namespace

std::vector<Carrier> Simulation::what_carries(MemberId member) const {
  require_id(building(), member, "what_carries");
  const Member& own = building()[member];
  const Vec3 middle = member_start(building(), own) + own.axes.row(0).transpose() * (own.length / 2);
  return carriers_of(state_->scene, {member, {}, middle});
}

std::vector<Carrier> Simulation::what_carries(PanelId panel) const {
  require_id(building(), panel, "what_carries");
  Vec3 middle = Vec3::Zero();
  for (const NodeId node : building()[panel].nodes) middle += building()[node].position / 4;
  return carriers_of(state_->scene, {{}, panel, middle});
}

std::vector<std::pair<JointId, Utilisation>> Simulation::next_to_break(std::size_t count) const {
  const State& s = *state_;
  std::vector<std::pair<JointId, Utilisation>> closest;
  for (std::size_t i = 0; i < s.scene.building.joints.size(); ++i) {
    const Utilisation used = s.scene.frame->utilisation(JointId(i));
    if (used.value > 0) closest.emplace_back(JointId(i), used);
  }
  count = std::min(count, closest.size());
  const auto closer = [](const auto& a, const auto& b) {
    return a.second.value != b.second.value ? a.second.value > b.second.value : a.first < b.first;
  };
  std::partial_sort(closest.begin(), closest.begin() + static_cast<std::ptrdiff_t>(count), closest.end(), closer);
  closest.resize(count);
  return closest;
}

}  // namespace topple::structure
