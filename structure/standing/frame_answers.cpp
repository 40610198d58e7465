// What standing frames tell: forces of panels and supports, and answers to loads besides their own.
#include "standing/frame_statics.h"

namespace topple::structure {

std::array<Vec6, 4> FrameStatics::corner_forces(PanelId membrane) const {
  const Place& place = membrane_place_[index(membrane)];
  return at(place).shell_corner_forces(place.local);
}

std::vector<Vec6> FrameStatics::node_forces(PanelId panel) const {
  const Place& place = membrane_place_[index(panel)];
  if (patch_[index(panel)] != 0) return at(place).patch_forces(place.local);
  const std::array<Vec6, 4> corners = at(place).shell_corner_forces(place.local);
  return {corners.begin(), corners.end()};
}

std::vector<Vec6> FrameStatics::node_forces(PanelId panel, const std::vector<Vec6>& displacements) const {
  const bool patch = patch_[index(panel)] != 0;
  // From the first node's place, where the ground has no hold: a rigid translation of the whole costs no digits.
  const bool free = !patch && given_stiffness(panel) == nullptr;
  const Vec3 origin = free ? Vec3(displacements.front().head<3>()) : Vec3(Vec3::Zero());
  Eigen::VectorXd u(static_cast<Eigen::Index>(6 * displacements.size()));
  for (std::size_t n = 0; n < displacements.size(); ++n) {
    u.segment<6>(static_cast<Eigen::Index>(6 * n)) = displacements[n];
    u.segment<3>(static_cast<Eigen::Index>(6 * n)) -= origin;
  }
  const Eigen::VectorXd force = patch ? Eigen::VectorXd(shell_stiffness(panel) * u) : membrane_stiffness(panel) * u;
  std::vector<Vec6> forces(displacements.size());
  for (std::size_t n = 0; n < forces.size(); ++n) forces[n] = force.segment<6>(static_cast<Eigen::Index>(6 * n));
  return forces;
}

Vec6 FrameStatics::reaction(std::size_t support) const {
  return at(support_place_[support]).reaction(support_place_[support].local);
}

Vec6 FrameStatics::reaction(NodeId node) const {
  Vec6 sum = Vec6::Zero();
  for (std::size_t s = 0; s < support_node_.size(); ++s)
    if (support_node_[s] == node) sum += reaction(s);
  return sum;
}

Vec6 FrameStatics::reaction(NodeId node, std::size_t edge_support) const {
  Vec6 sum = Vec6::Zero();
  for (std::size_t s = 0; s < support_node_.size(); ++s)
    if (support_node_[s] == node && support_edge_[s] == static_cast<int>(edge_support)) sum += reaction(s);
  return sum;
}

Vec3 FrameStatics::point_displacement(MemberId member, double distance,
                                      const std::vector<solver::BeamLoad>& loads) const {
  const Place& place = member_place_[index(member)];
  const solver::Reanalysis& analysis = at(place);
  const auto& nodes = analysis.model().beams[static_cast<std::size_t>(place.local)].node;
  return analysis.point_displacement(place.local, distance, analysis.displacements_at(nodes),
                                     with_hinges(member, loads));
}

solver::LoadSet FrameStatics::local(const ResponseLoads& loads) const {
  solver::LoadSet set;
  for (const auto& [node, load] : loads.nodes) set.nodes.push_back({node_place_[index(node)].local, load});
  for (const auto& [member, load] : loads.members) {
    set.beams.push_back(load);
    set.beams.back().beam = member_place_[index(member)].local;
  }
  return set;
}

FrameStatics::Response FrameStatics::respond(int component, const ResponseLoads& loads) const {
  return std::move(respond(component, {&loads, 1}).front());
}

FrameStatics::Response FrameStatics::respond_near(int component, const ResponseLoads& loads) const {
  return std::move(respond_near(component, {&loads, 1}).front());
}

std::vector<FrameStatics::Response> FrameStatics::told(int component, std::vector<solver::Reanalysis::Response> answers,
                                                       const std::vector<char>& known) const {
  std::vector<Response> responses(answers.size());
  for (std::size_t i = 0; i < answers.size(); ++i) {
    responses[i].statics_ = this;
    responses[i].component_ = component;
    responses[i].answer_ = std::move(answers[i]);
    responses[i].known_ = known;
  }
  return responses;
}

std::vector<FrameStatics::Response> FrameStatics::respond(int component, std::span<const ResponseLoads> loads) const {
  std::vector<solver::LoadSet> sets;
  for (const ResponseLoads& one : loads) sets.push_back(local(one));
  return told(component, parts(component).analysis->respond(sets), {});
}

std::vector<FrameStatics::Response> FrameStatics::respond_near(int component,
                                                               std::span<const ResponseLoads> loads) const {
  std::vector<solver::LoadSet> sets;
  for (const ResponseLoads& one : loads) sets.push_back(local(one));
  std::vector<char> known;
  std::vector<solver::Reanalysis::Response> answers = parts(component).analysis->respond_near(sets, known);
  return told(component, std::move(answers), known);
}

bool FrameStatics::Response::known(NodeId node) const {
  return known_.empty() || known_[static_cast<std::size_t>(statics_->node_place_[index(node)].local)] != 0;
}

const Vec6& FrameStatics::Response::displacement(NodeId node) const {
  return answer_.displacements[static_cast<std::size_t>(statics_->node_place_[index(node)].local)];
}

solver::Vec12 FrameStatics::Response::end_forces(MemberId member) const {
  const Place& place = statics_->member_place_[index(member)];
  return statics_->at(place).beam_end_forces(place.local, answer_);
}

Vec3 FrameStatics::Response::point_displacement(MemberId member, double distance,
                                                const std::vector<solver::BeamLoad>& loads) const {
  const Place& place = statics_->member_place_[index(member)];
  return statics_->at(place).point_displacement(place.local, distance, answer_.displacements, loads);
}

}  // namespace topple::structure
