#include "loads/frame_loads.h"

#include <algorithm>

#include "loads/tributary_loads.h"
#include "model/index_of.h"
#include "model/panel_area.h"

namespace topple::structure {

namespace {

/// Resultant force of one load on a member, its own axes.
Vec3 resultant(const solver::BeamLoad& load) {
  switch (load.kind) {
    case solver::BeamLoad::Kind::distributed:
      return (load.first + load.last).head<3>() * (0.5 * (load.to - load.from));
    case solver::BeamLoad::Kind::point:
      return load.first.head<3>();
    default:
      return Vec3::Zero();
  }
}

void insert(std::vector<int>& sorted, int value) {
  const auto place = std::lower_bound(sorted.begin(), sorted.end(), value);
  if (place == sorted.end() || *place != value) sorted.insert(place, value);
}

template <class T>
std::vector<T> sorted_unique(std::vector<T>& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return std::exchange(values, {});
}

}  // namespace

bool same_load(const PlacedLoad& a, const PlacedLoad& b) {
  const auto same_beam = [](const auto& x, const auto& y) {
    return x.first == y.first && x.second.from == y.second.from && x.second.first == y.second.first;
  };
  return a.panel == b.panel && a.nodes == b.nodes &&
         std::equal(a.members.begin(), a.members.end(), b.members.begin(), b.members.end(), same_beam);
}

FrameLoads::FrameLoads(const Building& building, PartLoads loads, const PanelBearings& bearings,
                       const PanelSuperelements& shells)
    : building_(building),
      loads_(std::move(loads)),
      bearings_(bearings),
      shells_(shells),
      shell_gone_(building.panels.size(), 0),
      gravity_(0, 0, -building.gravity),
      handed_(building.panels.size()),
      handing_members_(building.members.size()),
      handing_nodes_(building.nodes.size()),
      events_(building.nodes.size(), Vec6::Zero()),
      edges_version_(building.panels.size(), 0) {
  const double g = building.gravity;
  for (std::size_t m = 0; m < building.members.size(); ++m) {
    double down = 0;
    for (const solver::BeamLoad& load : loads_.members[m])
      down -= building.members[m].axes.col(2).dot(resultant(load));  // column 2: the global z in local axes
    member_mass_.push_back(down / g);
    changed_members_.push_back(MemberId(m));
  }
  for (std::size_t n = 0; n < building.nodes.size(); ++n) {
    node_mass_.push_back(-loads_.nodes[n](2) / g);
    changed_nodes_.push_back(NodeId(n));
  }
  for (std::size_t p = 0; p < building.panels.size(); ++p) {
    hand_on_anew(PanelId(p));
    double down = 0;
    for (const Vec3& force : handed_[p].edge_force) down -= force.z();
    if (!bearings.tracks(PanelId(p))) down = -traction(PanelId(p)).z() * panel_area(building, building.panels[p], true);
    panel_mass_.push_back(down / g);
  }
  whole_panel_mass_ = panel_mass_;
}

/// What acts on a shell panel, condensed to its nodes.
void FrameLoads::hand_on_shell(PanelId panel) {
  TributaryLoads& handed = handed_[index_of(panel)];
  mark(handed);
  handed = {};
  handed.edge_force.fill(Vec3::Zero());
  const PanelSuperelement* shell = shells_.of(panel);
  if (!shell || shell_gone_[index_of(panel)]) return;
  const std::vector<Vec6> loads = shell->loads_at_nodes({traction(panel), {}});
  const std::vector<NodeId> nodes = building_[panel].all_nodes();
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const int node = nodes[n].index;
    handed.nodes.push_back({node, loads[n]});
    insert(handing_nodes_[static_cast<std::size_t>(node)], panel.index);
  }
  mark(handed);
}

Vec3 FrameLoads::traction(PanelId panel) const {
  const PanelAction action = under_gravity(panel, loads_.panels[index_of(panel)]);
  return action.body_force - action.pressure * building_[panel].axes.row(2).transpose();
}

void FrameLoads::remove(PanelId shell) {
  shell_gone_[index_of(shell)] = 1;
  hand_on_anew(shell);
}

void FrameLoads::fracture(PanelId panel, const PanelRemains& remains) {
  holes_[panel] = remains.holes;
  panel_mass_[index_of(panel)] = remains.share * whole_panel_mass_[index_of(panel)];
  hand_on_anew(panel);
}

void FrameLoads::hand_on_anew(PanelId panel) {
  const std::size_t p = index_of(panel);
  ++edges_version_[p];
  if (!bearings_.tracks(panel)) {
    hand_on_shell(panel);
    return;
  }
  mark(handed_[p]);
  if (bearings_.stands(panel)) {
    static const std::vector<std::vector<Vec2>> none;
    const auto broken = holes_.find(panel);
    const auto& holes = broken == holes_.end() ? none : broken->second;
    handed_[p] =
        tributary_loads_of_broken(building_, bearings_.edge_members(), panel, under_gravity(panel, loads_.panels[p]),
                                  bearings_.holds(panel), bearings_.member_stands(), holes);
    for (const solver::BeamLoad& load : handed_[p].beams)
      insert(handing_members_[static_cast<std::size_t>(load.beam)], static_cast<int>(p));
    for (const solver::NodeLoad& load : handed_[p].nodes)
      insert(handing_nodes_[static_cast<std::size_t>(load.node)], static_cast<int>(p));
    mark(handed_[p]);
  } else {
    handed_[p] = {};
    handed_[p].edge_force.fill(Vec3::Zero());
  }
}

void FrameLoads::mark(const TributaryLoads& handed) {
  for (const solver::BeamLoad& load : handed.beams)
    changed_members_.push_back(MemberId(static_cast<std::size_t>(load.beam)));
  for (const solver::NodeLoad& load : handed.nodes)
    changed_nodes_.push_back(NodeId(static_cast<std::size_t>(load.node)));
}

void FrameLoads::mark(const PlacedLoad& placed) {
  for (const auto& [member, load] : placed.members) changed_members_.push_back(member);
  for (const auto& [node, load] : placed.nodes) changed_nodes_.push_back(node);
  if (placed.panel.valid()) ++edges_version_[index_of(placed.panel)];
}

void FrameLoads::set_gravity(const Vec3& gravity) {
  if (gravity == gravity_) return;
  gravity_ = gravity;
  usual_gravity_ = gravity == Vec3(0, 0, -building_.gravity);
  for (std::size_t m = 0; m < building_.members.size(); ++m) changed_members_.push_back(MemberId(m));
  for (std::size_t n = 0; n < building_.nodes.size(); ++n) changed_nodes_.push_back(NodeId(n));
  for (std::size_t p = 0; p < building_.panels.size(); ++p)
    if (bearings_.stands(PanelId(p)) || !bearings_.tracks(PanelId(p))) hand_on_anew(PanelId(p));
}

void FrameLoads::add_load(NodeId node, const Vec6& load) {
  if (load.isZero(0)) return;
  events_[index_of(node)] += load;
  changed_nodes_.push_back(node);
}

bool FrameLoads::set_contact(std::int64_t key, PlacedLoad load) {
  PlacedLoad& own = contacts_[key];
  if (same_load(own, load)) return false;
  mark(own);
  own = std::move(load);
  mark(own);
  return true;
}

bool FrameLoads::remove_contact(std::int64_t key) {
  const auto found = contacts_.find(key);
  if (found == contacts_.end()) return false;
  mark(found->second);
  contacts_.erase(found);
  return true;
}

FrameLoads::Changed FrameLoads::extract_changed() {
  return {sorted_unique(changed_members_), sorted_unique(changed_nodes_)};
}

std::vector<solver::BeamLoad> FrameLoads::own(MemberId member) const {
  std::vector<solver::BeamLoad> all;
  for (const solver::BeamLoad& load : loads_.members[index_of(member)]) all.push_back(under_gravity(member, load));
  return all;
}

std::vector<solver::BeamLoad> FrameLoads::own_and_handed(MemberId member) const {
  std::vector<solver::BeamLoad> all = own(member);
  for (int panel : handing_members_[index_of(member)])
    for (const solver::BeamLoad& load : handed_[static_cast<std::size_t>(panel)].beams)
      if (load.beam == member.index) all.push_back(load);
  return all;
}

std::vector<solver::BeamLoad> FrameLoads::on(MemberId member) const {
  std::vector<solver::BeamLoad> all = own_and_handed(member);
  for (const auto& [key, placed] : contacts_)
    for (const auto& [bearing, load] : placed.members)
      if (bearing == member) all.push_back(load);
  return all;
}

Vec6 FrameLoads::own_and_handed(NodeId node) const {
  Vec6 sum = own(node);
  for (int panel : handing_nodes_[index_of(node)])
    for (const solver::NodeLoad& load : handed_[static_cast<std::size_t>(panel)].nodes)
      if (load.node == node.index) sum += load.load;
  return sum;
}

Vec6 FrameLoads::on(NodeId node) const {
  Vec6 sum = own_and_handed(node) + events_[index_of(node)];
  for (const auto& [key, placed] : contacts_)
    for (const auto& [bearing, load] : placed.nodes)
      if (bearing == node) sum += load;
  return sum;
}

Vec3 FrameLoads::edge_force(PanelId panel, int edge) const {
  const auto e = static_cast<std::size_t>(edge);
  Vec3 force = handed_[index_of(panel)].edge_force[e];
  for (const auto& [key, placed] : contacts_)
    if (placed.panel == panel) force += placed.edge_force[e];
  return force;
}

/// What points down is weight and turns with gravity; everything else stays.
solver::BeamLoad FrameLoads::under_gravity(MemberId member, solver::BeamLoad load) const {
  if (usual_gravity_ || load.kind == solver::BeamLoad::Kind::temperature) return load;
  const Mat3& axes = building_[member].axes;
  for (Vec6* part : {&load.first, &load.last}) {
    const double weight = -axes.col(2).dot(part->head<3>());
    part->head<3>() += axes * (weight / building_.gravity * gravity_ + weight * Vec3::UnitZ());
  }
  return load;
}

Vec6 FrameLoads::under_gravity(const Vec6& load) const {
  if (usual_gravity_) return load;
  Vec6 turned = load;
  turned.head<3>() += load(2) * (-gravity_ / building_.gravity - Vec3::UnitZ());
  return turned;
}

PanelAction FrameLoads::under_gravity(PanelId panel, PanelAction action) const {
  if (usual_gravity_) return action;
  const Vec3 normal = building_[panel].axes.row(2);
  const Vec3 force = action.body_force - action.pressure * normal;
  action.pressure = 0;
  action.body_force = force + force.z() * (-gravity_ / building_.gravity - Vec3::UnitZ());
  return action;
}

}  // namespace topple::structure
