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

std::vector<Displacement> read_displacements(const Simulation& simulation) {
  const structure::StandingFrame& frame = simulation.frame();
  std::vector<Displacement> read(simulation.building().nodes.size(), Displacement::Zero());
  for (std::size_t i = 0; i < read.size(); ++i)
    if (frame.stands(NodeId(i))) read[i] = frame.displacement(NodeId(i)).cast<float>();
  return read;
}

std::shared_ptr<FrameAnswer> read_answer(const Simulation& simulation, Wanted wanted,
                                         const std::vector<bool>& yielded) {
  const Building& building = simulation.building();
  const structure::StandingFrame& frame = simulation.frame();
  auto answer = std::make_shared<FrameAnswer>();
  answer->displacements = read_displacements(simulation);
  answer->shapes = read_member_shapes(frame, building, yielded, answer->displacements);
  answer->joints.reserve(building.joints.size());
  for (std::size_t i = 0; i < building.joints.size(); ++i)
    answer->joints.push_back(joint_answer(frame, building, JointId(i)));
  answer->most_used = most_used(building, answer->joints);
  answer->forces = read_forces(simulation, wanted);
  return answer;
}

std::shared_ptr<Membership> read_membership(const Simulation& simulation) {
  const Building& building = simulation.building();
  auto membership = std::make_shared<Membership>();
  const auto place = [](auto id, const Simulation& from) { return from.frame().stands(id) ? part_stands : part_gone; };
  for (std::size_t i = 0; i < building.members.size(); ++i) {
    membership->member.push_back(place(MemberId(i), simulation));
    membership->segment.push_back(simulation.frame().segment(MemberId(i)));
    membership->members_standing += membership->member.back() == part_stands ? 1 : 0;
  }
  for (std::size_t i = 0; i < building.panels.size(); ++i) {
    membership->panel.push_back(place(PanelId(i), simulation));
    membership->panels_standing += membership->panel.back() == part_stands ? 1 : 0;
    membership->broken.push_back(simulation.broken_panel(PanelId(i)));
  }
  int index = 0;
  for (const structure::BodyView& body : simulation.bodies()) {
    for (const MemberId id : body.members) membership->member[static_cast<std::size_t>(id.index)] = index;
    for (const PanelId id : body.panels) membership->panel[static_cast<std::size_t>(id.index)] = index;
    ++index;
  }
  return membership;
}

MemberShape shape_in(const FrameAnswer& answer, const Building& building, std::size_t member) {
  const MemberShape* own = answer.shapes ? answer.shapes->find(member) : nullptr;
  return own != nullptr ? *own : shape_of_nodes(building, MemberId(member), answer.displacements);
}

Eigen::Vector3d end_of(const Building& building, const structure::Member& member, std::size_t end) {
  return building[member.nodes[end]].position + member.offsets[end];
}

/// What lets go now as one body.
struct LettingGo {
  std::vector<std::size_t> members, panels;
};

void keep_shape(Membership& now, const LettingGo& part, const FrameAnswer& stood_by, const Building& building) {
  NearestMotion motion;
  const auto moved = [&](NodeId node) { return stood_by.displacements[static_cast<std::size_t>(node.index)]; };
  for (const std::size_t i : part.members) {
    const MemberShape shape = shape_in(stood_by, building, i);
    for (const std::size_t end : {0U, 1U}) motion.add(end_of(building, building.members[i], end), shape.ends[end]);
  }
  for (const std::size_t i : part.panels)
    for (const NodeId node : building.panels[i].nodes) motion.add(building[node].position, moved(node));
  motion.solve();
  for (const std::size_t i : part.members) {
    auto kept = std::make_shared<MemberShape>(shape_in(stood_by, building, i));
    for (const std::size_t end : {0U, 1U})
      kept->ends[end] = motion.beside(end_of(building, building.members[i], end), kept->ends[end]);
    now.member_shape[i] = std::move(kept);
  }
  for (const std::size_t i : part.panels) {
    auto kept = std::make_shared<std::array<Eigen::Vector3f, 4>>();
    for (std::size_t c = 0; c < 4; ++c) {
      const NodeId node = building.panels[i].nodes[c];
      (*kept)[c] = motion.beside(building[node].position, moved(node)).head<3>();
    }
    now.panel_shape[i] = std::move(kept);
  }
}

/// Keeps the shapes of those that let go before, and takes those of who does now from the answer that they stood by.
void keep_shapes(Membership& now, const Membership& before, const FrameAnswer& stood_by, const Building& building) {
  now.member_shape = before.member_shape;
  now.panel_shape = before.panel_shape;
  now.member_shape.resize(now.member.size());
  now.panel_shape.resize(now.panel.size());
  std::map<int, LettingGo> parts;  // by body
  for (std::size_t i = 0; i < now.member.size(); ++i)
    if (before.member[i] == part_stands && now.member[i] >= 0) parts[now.member[i]].members.push_back(i);
  for (std::size_t i = 0; i < now.panel.size(); ++i)
    if (before.panel[i] == part_stands && now.panel[i] >= 0) parts[now.panel[i]].panels.push_back(i);
  for (const auto& [body, part] : parts) keep_shape(now, part, stood_by, building);
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

bool same(const structure::FrameCounters& a, const structure::FrameCounters& b) {
  return a.solves == b.solves && a.low_rank == b.low_rank && a.refactorisations == b.refactorisations &&
         a.segmentations == b.segmentations;
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

bool SnapshotTaker::answer_is_old(const Simulation& simulation) const {
  return !answer_ || !(wanted_ == read_) || was_pending_ || !same(seen_, simulation.frame().counters()) ||
         seen_events_ != simulation.events().size();
}

void SnapshotTaker::read_yields(const Simulation& simulation) {
  const auto& events = simulation.events();
  if (events.size() < yielded_events_) yielded_.clear(), yielded_events_ = 0;
  yielded_.resize(simulation.building().members.size(), false);
  for (; yielded_events_ < events.size(); ++yielded_events_) {
    const structure::SimulationEvent& event = events[yielded_events_];
    if (event.kind != structure::SimulationEvent::Kind::joint_yielded) continue;
    if (const MemberId member = simulation.building()[event.joint.joint].member; member.valid())
      yielded_[static_cast<std::size_t>(member.index)] = true;
  }
}

void SnapshotTaker::begin(const Simulation& simulation) {
  at_start_ = std::make_shared<const std::vector<Displacement>>(read_displacements(simulation));
  read_yields(simulation);
  shapes_at_start_ = read_member_shapes(simulation.frame(), simulation.building(), yielded_, *at_start_);
}

Snapshot SnapshotTaker::take(const Simulation& simulation, structure::VisualMesh* drawn) {
  std::vector<std::int64_t> ids;
  for (const structure::BodyView& body : simulation.bodies()) ids.push_back(body.id.value);
  const bool old = answer_is_old(simulation);
  const auto stood_by = last_answer_;
  if (old) {
    read_yields(simulation);
    auto answer = read_answer(simulation, wanted_, yielded_);
    answer->at_start = at_start_;
    answer->shapes_at_start = shapes_at_start_;
    answer_ = last_answer_ = std::move(answer);
  }
  read_ = wanted_;
  if (old || ids != seen_bodies_) {
    auto membership = read_membership(simulation);
    if (membership_ && stood_by) keep_shapes(*membership, *membership_, *stood_by, simulation.building());
    for (const structure::NodeSupport& support : simulation.building().supports)
      membership->supports.push_back(std::none_of(taken_supports_.begin(), taken_supports_.end(), [&](const auto& one) {
        return one.first == support.node && one.second <= simulation.time();
      }));
    membership_ = std::move(membership);
  }
  seen_ = simulation.frame().counters();
  seen_events_ = simulation.events().size();
  was_pending_ = simulation.frame().pending();
  seen_bodies_ = std::move(ids);

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
