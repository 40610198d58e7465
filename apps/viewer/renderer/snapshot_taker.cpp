#include "renderer/snapshot_taker.h"

#include <algorithm>
#include <cmath>

#include "topple/structure/joint_check.h"

namespace topple::viewer {
namespace {

using structure::Building;
using structure::JointCapacity;
using structure::JointId;
using structure::MemberId;
using structure::NodeId;
using structure::PanelId;
using structure::Sense;
using structure::Simulation;

double ratio(const JointCapacity& capacity, Sense sense, double demand) {
  return std::abs(demand) / capacity.value[static_cast<std::size_t>(sense)];
}

/// Largest ratios among the forces and among the moments.
std::array<double, 2> shares(const JointCapacity& capacity, const structure::Vec6& demand) {
  const Sense axial = demand[0] >= 0 ? Sense::tension : Sense::compression;
  return {std::max({ratio(capacity, axial, demand[0]), ratio(capacity, Sense::shear_y, demand[1]),
                    ratio(capacity, Sense::shear_z, demand[2])}),
          std::max({ratio(capacity, Sense::torsion, demand[3]), ratio(capacity, Sense::moment_y, demand[4]),
                    ratio(capacity, Sense::moment_z, demand[5])})};
}

bool owner_stands(const structure::StandingFrame& frame, const structure::Joint& joint) {
  return joint.member.valid() ? frame.stands(joint.member) : frame.stands(joint.panel);
}

FrameAnswer::Joint joint_answer(const structure::StandingFrame& frame, const Building& building, JointId id) {
  FrameAnswer::Joint result;
  result.intact = frame.intact(id);
  result.standing = owner_stands(frame, building[id]);
  if (!result.intact || !result.standing) return result;
  const structure::Vec6 demand = frame.demand(id);
  for (int c = 0; c < 6; ++c) result.demand[static_cast<std::size_t>(c)] = static_cast<float>(demand[c]);
  const structure::JointCapacity& capacity = building[id].capacity;
  if (!capacity.breakable) return result;
  const structure::Utilisation used = frame.utilisation(id);
  result.utilisation = static_cast<float>(used.value);
  result.sense = used.sense;
  // Both rules of interaction are ratios to the capacity: what is left of it is the share that the use has grown by.
  if (used.value > 0)
    result.strength = static_cast<float>(std::min(1.0, structure::utilisation(capacity, demand).value / used.value));
  // The rule of interaction and a weakened joint both lift the utilisation above the plain ratios: scale to meet it.
  const auto [force, torque] = shares(capacity, demand);
  const double largest = std::max(force, torque), lift = largest > 0 ? used.value / largest : 0;
  result.force_share = static_cast<float>(force * lift);
  result.torque_share = static_cast<float>(torque * lift);
  return result;
}

std::vector<JointId> most_used(const Building& building, const std::vector<FrameAnswer::Joint>& joints) {
  std::vector<JointId> order;
  for (std::size_t i = 0; i < joints.size(); ++i)
    if (building.joints[i].capacity.breakable && joints[i].intact && joints[i].standing) order.emplace_back(i);
  const std::size_t count = std::min<std::size_t>(20, order.size());
  const auto used = [&](JointId id) { return joints[static_cast<std::size_t>(id.index)].utilisation; };
  std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count), order.end(),
                    [&](JointId a, JointId b) { return used(a) != used(b) ? used(a) > used(b) : a < b; });
  order.resize(count);
  return order;
}

/// Along a member, the sum of its distributed loads at the middles of even parts (global axes).
void add_spread(FrameForces& forces, const Building& building, MemberId id, const std::vector<solver::BeamLoad>& loads,
                int parts) {
  const structure::Member& member = building[id];
  const structure::Vec3 first = building[member.nodes[0]].position + member.offsets[0];
  for (int i = 0; i < parts; ++i) {
    const double at = member.length * (i + 0.5) / parts;
    structure::Vec3 sum = structure::Vec3::Zero();
    for (const solver::BeamLoad& load : loads) {
      if (load.kind != solver::BeamLoad::Kind::distributed || at < load.from || at > load.to) continue;
      const double share = load.to > load.from ? (at - load.from) / (load.to - load.from) : 0;
      sum += (load.first + share * (load.last - load.first)).head<3>();
    }
    if (sum.isZero(0)) continue;
    const structure::Vec3 place = first + at * member.axes.row(0).transpose();
    forces.spread.push_back({place, (member.axes.transpose() * sum).cast<float>()});
  }
  for (const solver::BeamLoad& load : loads)
    if (load.kind == solver::BeamLoad::Kind::point && !load.first.head<3>().isZero(0))
      forces.points.push_back({first + load.from * member.axes.row(0).transpose(),
                               (member.axes.transpose() * load.first.head<3>()).cast<float>()});
}

void read_arrows(FrameForces& forces, const structure::StandingFrame& frame, const Building& building) {
  // Fewer arrows for each member of a large building: they would cover each other.
  const int parts = building.members.size() > 4000 ? 1 : building.members.size() > 1000 ? 2 : 4;
  for (std::size_t m = 0; m < building.members.size(); ++m)
    add_spread(forces, building, MemberId(m), frame.member_loads(MemberId(m)), parts);
  for (std::size_t n = 0; n < building.nodes.size(); ++n)
    if (const structure::Vec3 force = frame.node_load(NodeId(n)).head<3>(); !force.isZero(0))
      forces.points.push_back({building.nodes[n].position, force.cast<float>()});
  for (std::size_t s = 0; s < building.supports.size(); ++s)
    if (const structure::Vec3 force = frame.reaction(s).head<3>(); !force.isZero(0))
      forces.reactions.push_back({building[building.supports[s].node].position, force.cast<float>()});
  for (const structure::ContactLoad& contact : frame.contact_loads())
    forces.contacts.push_back({contact.place.point, contact.force.cast<float>()});
}

void read_internal(FrameForces& forces, const structure::StandingFrame& frame, const Building& building) {
  constexpr std::size_t places = FrameForces::intervals + 1;
  forces.internal.resize(building.members.size() * places, {});
  for (std::size_t m = 0; m < building.members.size(); ++m) {
    const auto along = frame.internal_forces(MemberId(m), FrameForces::intervals);
    for (std::size_t i = 0; i < along.size(); ++i)
      for (std::size_t c = 0; c < 6; ++c) forces.internal[m * places + i][c] = static_cast<float>(along[i][c]);
  }
}

std::shared_ptr<const FrameForces> read_forces(const Simulation& simulation, Wanted wanted) {
  if (wanted == Wanted()) return nullptr;
  auto forces = std::make_shared<FrameForces>();
  if (wanted.arrows) read_arrows(*forces, simulation.frame(), simulation.building());
  if (wanted.internal_forces) read_internal(*forces, simulation.frame(), simulation.building());
  return forces;
}

std::shared_ptr<FrameAnswer> read_answer(const Simulation& simulation, Wanted wanted,
                                         const structure::StandingShapes& shapes) {
  const Building& building = simulation.building();
  auto answer = std::make_shared<FrameAnswer>();
  static_cast<structure::StandingShapes&>(*answer) = shapes;
  answer->joints.reserve(building.joints.size());
  for (std::size_t i = 0; i < building.joints.size(); ++i)
    answer->joints.push_back(joint_answer(simulation.frame(), building, JointId(i)));
  answer->plastic_rotations = simulation.frame().plastic_rotations();
  answer->most_used = most_used(building, answer->joints);
  answer->forces = read_forces(simulation, wanted);
  return answer;
}

std::shared_ptr<Membership> read_membership(const Simulation& simulation, const structure::KeptShapes& parts) {
  const Building& building = simulation.building();
  auto membership = std::make_shared<Membership>();
  static_cast<structure::KeptShapes&>(*membership) = parts;
  for (std::size_t i = 0; i < building.members.size(); ++i)
    membership->segment.push_back(simulation.frame().segment(MemberId(i)));
  for (std::size_t i = 0; i < building.panels.size(); ++i)
    membership->broken.push_back(simulation.broken_panel(PanelId(i)));
  const auto standing = [&](auto id) { return simulation.frame().stands(id) ? 1 : 0; };
  for (std::size_t i = 0; i < building.members.size(); ++i) membership->members_standing += standing(MemberId(i));
  for (std::size_t i = 0; i < building.panels.size(); ++i) membership->panels_standing += standing(PanelId(i));
  return membership;
}

BodyPose pose_of(const structure::BodyView& body) {
  return {body.id.value,
          body.pose.position,
          body.rest_centre,
          body.pose.orientation,
          body.radius,
          body.asleep,
          body.chunk,
          body.chunk_of,
          {},
          body.cable_anchor};
}

std::shared_ptr<const std::vector<DrawnPiece>> read_drawn(const structure::VisualMesh& model) {
  auto drawn = std::make_shared<std::vector<DrawnPiece>>();
  for (const structure::VisualMesh::Piece& piece : model.pieces())
    if (piece.body.value >= part_stands) drawn->push_back({piece.mesh, piece.bones, piece.body.value});
  return drawn;
}

}  // namespace

/// Chunks are named after the panel or member that they broke out of: "W#3".
structure::MaterialId SnapshotTaker::material_of(const Simulation& simulation, const structure::BodyView& body) {
  const auto [known, is_new] = material_of_chunk_.try_emplace(body.id.value);
  if (!is_new) return known->second;
  if (!names_) names_ = std::make_unique<structure::NameIndex>(simulation.building());
  const std::string name(body.name.substr(0, body.name.rfind('#')));
  if (const auto panel = names_->panel(name)) return known->second = simulation.building()[*panel].material;
  if (const auto member = names_->member(name)) return known->second = simulation.building()[*member].material;
  return known->second;
}

void SnapshotTaker::begin(const Simulation& simulation) { at_start_ = shapes_.read(simulation); }

Snapshot SnapshotTaker::capture(const Simulation& simulation, structure::VisualMesh* drawn) {
  const auto seen_standing = shapes_.standing();
  const auto seen_parts = shapes_.parts();
  shapes_.watch(simulation);
  const bool old = !answer_ || !(wanted_ == read_) || seen_standing != shapes_.standing();
  if (old) {
    auto answer = read_answer(simulation, wanted_, *shapes_.standing());
    if (at_start_) {
      answer->at_start = {at_start_, &at_start_->displacements};
      answer->shapes_at_start = at_start_->shapes;
    }
    answer_ = std::move(answer);
  }
  read_ = wanted_;
  if (old || seen_parts != shapes_.parts()) {
    auto membership = read_membership(simulation, *shapes_.parts());
    for (const structure::NodeSupport& support : simulation.building().supports)
      membership->supports.push_back(std::none_of(taken_supports_.begin(), taken_supports_.end(), [&](const auto& one) {
        return one.first == support.node && one.second <= simulation.time();
      }));
    membership_ = std::move(membership);
  }

  Snapshot snapshot;
  snapshot.time = simulation.time();
  snapshot.step = simulation.steps();
  snapshot.at_rest = simulation.at_rest();
  snapshot.finished = simulation.finished();
  snapshot.answer = answer_;
  snapshot.membership = membership_;
  for (const structure::BodyView& body : simulation.bodies()) {
    snapshot.bodies.push_back(pose_of(body));
    if (body.chunk) snapshot.bodies.back().material = material_of(simulation, body);
  }
  snapshot.dust = dust_.watch(simulation);
  if (drawn) {
    drawn->update(simulation);
    if (!drawn_ || drawn_revision_ != drawn->revision()) drawn_ = read_drawn(*drawn);
    drawn_revision_ = drawn->revision();
    snapshot.drawn = drawn_;
  }
  snapshot.counters = simulation.counters();
  if (old || !snapshot.at_rest || !rested_) energies_ = simulation.ledger();
  rested_ = snapshot.at_rest;
  snapshot.energies = energies_;
  snapshot.stage_seconds = simulation.stage_seconds();
  snapshot.collision_engine_seconds = simulation.collision_engine_seconds();
  return snapshot;
}

}  // namespace topple::viewer
