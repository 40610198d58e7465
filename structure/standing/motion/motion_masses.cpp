#include "standing/motion/motion_masses.h"

#include <utility>

#include "model/own_mass.h"

namespace topple::structure {
namespace {

/// Global force of one load on a member.
Vec3 resultant(const Member& member, const solver::BeamLoad& load) {
  Vec3 local = Vec3::Zero();
  if (load.kind == solver::BeamLoad::Kind::point) local = load.first.head<3>();
  if (load.kind == solver::BeamLoad::Kind::distributed)
    local = (load.first + load.last).head<3>() * (0.5 * (load.to - load.from));
  return member.axes.transpose() * local;
}

}  // namespace

MotionMasses::MotionMasses(const Building& building, const FrameLoads& loads, const PanelBearings& bearings)
    : building_(building),
      loads_(loads),
      bearings_(bearings),
      shares_(building.panels.size()),
      version_(building.panels.size(), -1),
      hung_members_(building.members.size(), 0.0),
      hung_nodes_(building.nodes.size(), 0.0) {
  (void)update();
}

double MotionMasses::own(MemberId id) const {
  if (const double mass = loads_.mass(id); mass > 0) return mass;
  return own_mass(building_, id);
}

std::vector<MotionMasses::Rehung> MotionMasses::update() {
  std::vector<Rehung> rehung;
  for (std::size_t p = 0; p < shares_.size(); ++p) {
    const PanelId panel(p);
    if (version_[p] == loads_.edges_version(panel)) continue;
    version_[p] = loads_.edges_version(panel);
    Shares now = read(panel);
    if (now.members.empty() && now.nodes.empty() && bearings_.stands(panel)) continue;  // it weighs nothing now
    hang(shares_[p], -1);
    rehung.push_back({panel, std::exchange(shares_[p], std::move(now))});
    hang(shares_[p], 1);
  }
  return rehung;
}

void MotionMasses::hang(const Shares& shares, double sign) {
  for (const auto& [member, mass] : shares.members) hung_members_[index(member)] += sign * mass;
  for (const auto& [node, mass] : shares.nodes) hung_nodes_[index(node)] += sign * mass;
}

/// As its weight is shared out, so is its mass. A shell has its own in the frame.
MotionMasses::Shares MotionMasses::read(PanelId panel) const {
  Shares shares;
  if (!bearings_.tracks(panel)) return shares;
  const TributaryLoads& handed = loads_.handed(panel);
  Vec3 total = Vec3::Zero();
  for (const solver::BeamLoad& load : handed.beams)
    total += resultant(building_.members[static_cast<std::size_t>(load.beam)], load);
  for (const solver::NodeLoad& load : handed.nodes) total += load.load.head<3>();
  if (!(total.squaredNorm() > 0)) return shares;
  const double mass = loads_.mass(panel);
  const auto share = [&](const Vec3& force) { return mass * force.dot(total) / total.squaredNorm(); };
  for (const solver::BeamLoad& load : handed.beams) {
    const auto member = static_cast<std::size_t>(load.beam);
    shares.members.emplace_back(member, share(resultant(building_.members[member], load)));
  }
  for (const solver::NodeLoad& load : handed.nodes)
    shares.nodes.emplace_back(static_cast<std::size_t>(load.node), share(load.load.head<3>()));
  return shares;
}

}  // namespace topple::structure
