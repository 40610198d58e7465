#include "topple/structure/shape_watcher.h"

#include <map>

#include "model/index_of.h"

namespace topple::structure {
namespace {

std::vector<Displacement> read_displacements(const Simulation& simulation) {
  const StandingFrame& frame = simulation.frame();
  std::vector<Displacement> read(simulation.building().nodes.size(), Displacement::Zero());
  for (std::size_t i = 0; i < read.size(); ++i)
    if (frame.stands(NodeId(i))) read[i] = frame.displacement(NodeId(i)).cast<float>();
  return read;
}

std::shared_ptr<KeptShapes> read_places(const Simulation& simulation) {
  const Building& building = simulation.building();
  auto parts = std::make_shared<KeptShapes>();
  const auto place = [&](auto id) { return simulation.frame().stands(id) ? part_stands : part_gone; };
  for (std::size_t i = 0; i < building.members.size(); ++i) parts->member.push_back(place(MemberId(i)));
  for (std::size_t i = 0; i < building.panels.size(); ++i) parts->panel.push_back(place(PanelId(i)));
  int index = 0;
  for (const BodyView& body : simulation.bodies()) {
    for (const MemberId id : body.members) parts->member[index_of(id)] = index;
    for (const PanelId id : body.panels) parts->panel[index_of(id)] = index;
    ++index;
  }
  parts->member_shape.resize(parts->member.size());
  parts->panel_shape.resize(parts->panel.size());
  return parts;
}

Vec3 end_of(const Building& building, const Member& member, std::size_t end) {
  return building[member.nodes[end]].position + member.offsets[end];
}

/// What lets go now as one body.
struct LettingGo {
  std::vector<std::size_t> members, panels;
};

void keep_shape(KeptShapes& now, const LettingGo& part, const StandingShapes& stood_by, const Building& building) {
  NearestMotion motion;
  const auto moved = [&](NodeId node) { return stood_by.displacements[index_of(node)]; };
  for (const std::size_t i : part.members) {
    const MemberShape shape = stood_by.of(building, i);
    for (const std::size_t end : {0U, 1U}) motion.add(end_of(building, building.members[i], end), shape.ends[end]);
  }
  for (const std::size_t i : part.panels)
    for (const NodeId node : building.panels[i].nodes) motion.add(building[node].position, moved(node));
  motion.solve();
  for (const std::size_t i : part.members) {
    auto kept = std::make_shared<MemberShape>(stood_by.of(building, i));
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
void keep_shapes(KeptShapes& now, const KeptShapes& before, const StandingShapes& stood_by, const Building& building) {
  now.member_shape = before.member_shape;
  now.panel_shape = before.panel_shape;
  std::map<int, LettingGo> parts;  // by body
  for (std::size_t i = 0; i < now.member.size(); ++i)
    if (before.member[i] == part_stands && now.member[i] >= 0) parts[now.member[i]].members.push_back(i);
  for (std::size_t i = 0; i < now.panel.size(); ++i)
    if (before.panel[i] == part_stands && now.panel[i] >= 0) parts[now.panel[i]].panels.push_back(i);
  for (const auto& [body, part] : parts) keep_shape(now, part, stood_by, building);
}

bool same(const FrameCounters& a, const FrameCounters& b) {
  return a.solves == b.solves && a.low_rank == b.low_rank && a.refactorisations == b.refactorisations &&
         a.segmentations == b.segmentations;
}

}  // namespace

MemberShape StandingShapes::of(const Building& building, std::size_t member) const {
  const MemberShape* own = shapes ? shapes->find(member) : nullptr;
  return own != nullptr ? *own : shape_of_nodes(building, MemberId(member), displacements);
}

void ShapeWatcher::read_yields(const Simulation& simulation) {
  const auto& events = simulation.events();
  if (events.size() < yielded_events_) yielded_.clear(), yielded_events_ = 0;
  yielded_.resize(simulation.building().members.size(), false);
  for (; yielded_events_ < events.size(); ++yielded_events_) {
    const SimulationEvent& event = events[yielded_events_];
    if (event.kind != SimulationEvent::Kind::joint_yielded) continue;
    if (const MemberId member = simulation.building()[event.joint.joint].member; member.valid())
      yielded_[index_of(member)] = true;
  }
}

std::shared_ptr<const StandingShapes> ShapeWatcher::read(const Simulation& simulation) {
  read_yields(simulation);
  auto read = std::make_shared<StandingShapes>();
  read->displacements = read_displacements(simulation);
  read->shapes = read_member_shapes(simulation.frame(), simulation.building(), yielded_, read->displacements);
  return read;
}

void ShapeWatcher::watch(const Simulation& simulation) {
  std::vector<std::int64_t> ids;
  for (const BodyView& body : simulation.bodies()) ids.push_back(body.id.value);
  const bool old = !standing_ || was_pending_ || !same(seen_, simulation.frame().counters()) ||
                   seen_events_ != simulation.events().size();
  const auto stood_by = standing_;
  if (old) standing_ = read(simulation);
  if (old || ids != seen_bodies_) {
    auto parts = read_places(simulation);
    if (parts_) keep_shapes(*parts, *parts_, *stood_by, simulation.building());
    parts_ = std::move(parts);
  }
  seen_ = simulation.frame().counters();
  seen_events_ = simulation.events().size();
  was_pending_ = simulation.frame().pending();
  seen_bodies_ = std::move(ids);
}

}  // namespace topple::structure
