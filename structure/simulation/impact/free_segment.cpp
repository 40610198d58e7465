#include "simulation/impact/free_segment.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <map>

#include "failure/panel_demand.h"
#include "mesh/shell_edges.h"
#include "model/index_of.h"
#include "model/point_inertia.h"
#include "standing/member_beam.h"
#include "topple/structure/frame.h"
#include "topple/structure/joint_check.h"

namespace topple::structure {

namespace {

Vec3 start_of(const Building& building, const Member& member) {
  return building[member.nodes[0]].position + member.offsets[0];
}

}  // namespace

FreeSegment::FreeSegment(const Building& building, FreeSegmentParts parts, const std::function<bool(JointId)>& holds,
                         const std::function<Eigen::MatrixXd(PanelId)>& shell_stiffness, const FreePanelEdges& edges)
    : building_(building), parts_(std::move(parts)), node_number_(building.nodes.size(), -1) {
  add_members(holds);
  const bool breakable = !joints_.empty();
  for (const PanelId panel : parts_.panels)
    if (shell_stiffness && building[panel].model == PanelModel::shell) add_shell(panel, shell_stiffness(panel), holds);
  if (edges) find_hung_panels(edges);
  add_point_masses();
  for (std::size_t i = 0; i < parts_.members.size(); ++i) {
    const Vec3 along = building[parts_.members[i]].axes.row(0);
    inertia_ += polar(parts_.members[i]) * parts_.member_mass[i] * along * along.transpose();
  }
  centre_ /= mass_;
  // So far about the origin.
  inertia_ -= point_inertia(mass_, centre_);
  const bool shell_asked = std::any_of(hung_.begin(), hung_.end(), [](const Hung& hung) { return hung.patch >= 0; });
  const bool member_asked = breakable && parts_.members.size() > 1;
  can_break_ = !hung_.empty();
  if (!(member_asked || shell_asked) || held_at_ < 0) return;
  analyse();
  can_break_ = can_break_ || analysis_ != nullptr;
}

void FreeSegment::add_members(const std::function<bool(JointId)>& holds) {
  const Building& building = building_;
  for (std::size_t i = 0; i < parts_.members.size(); ++i) {
    const MemberId id = parts_.members[i];
    const Member& member = building[id];
    solver::Beam beam = elastic_beam(building, id);
    for (int end = 0; end < 2; ++end) {
      const auto e = static_cast<std::size_t>(end);
      const JointId joint = building.joint(id, end);
      if (holds(joint)) {
        beam.node[e] = node_at(member.nodes[e]);
        beam.end_stiffness[e] = building[joint].stiffness;
        if (building[joint].capacity.breakable) joints_.push_back(joint);
      } else {  // a free end, with a node of its own
        beam.node[e] = static_cast<int>(model_.nodes.size());
        beam.offset[e].setZero();
        model_.nodes.push_back(building[member.nodes[e]].position + member.offsets[e]);
        point_mass_.push_back(0);
      }
      // Whatever hangs on the node that holds the body holds it in all its motions only if it is rigid there.
      if (held_at_ < 0 && (beam.end_stiffness[e].array() == solver::rigid).all()) held_at_ = beam.node[e];
    }
    model_.beams.push_back(beam);
    const Vec3 first = start_of(building, member), along = member.axes.row(0).transpose() * member.length;
    // An even line of mass: the same first two moments as at its two Gauss points.
    for (const double place : {0.21132486540518713, 0.78867513459481287})
      add_mass(first + place * along, parts_.member_mass[i] / 2);
  }
  std::sort(joints_.begin(), joints_.end());
}

/// Of nodes, and of panels at the corners that take their mass.
void FreeSegment::add_point_masses() {
  for (std::size_t i = 0; i < parts_.nodes.size(); ++i) {
    const int number = node_number_[index_of(parts_.nodes[i])];
    if (number < 0) continue;
    point_mass_[static_cast<std::size_t>(number)] += parts_.node_mass[i];
  }
  for (std::size_t i = 0; i < parts_.panels.size(); ++i) {
    std::vector<int> corners;
    for (NodeId node : building_[parts_.panels[i]].nodes)
      if (includes(parts_.panels[i], node)) corners.push_back(node_number_[index_of(node)]);
    for (int number : corners)
      point_mass_[static_cast<std::size_t>(number)] += parts_.panel_mass[i] / static_cast<double>(corners.size());
  }
  for (std::size_t n = 0; n < point_mass_.size(); ++n) add_mass(model_.nodes[n], point_mass_[n]);
}

void FreeSegment::analyse() {
  if (held_at_ < 0) return;
  model_.supports.assign(1, {held_at_, Vec6::Constant(solver::rigid)});
  try {
    analysis_ = std::make_unique<solver::StaticAnalysis>(model_);
  } catch (const solver::Instability&) {
    is_mechanism_ = true;  // its joints are spared by that motion
  }
}

/// By the nodes at which it has any stiffness and an edge that holds; what it let go of is condensed out.
void FreeSegment::add_shell(PanelId panel, const Eigen::MatrixXd& stiffness,
                            const std::function<bool(JointId)>& holds) {
  std::vector<char> held(building_.nodes.size(), 0);
  for (int edge = 0; edge < 4; ++edge)
    if (holds(building_.joint(panel, edge)))
      for (const NodeId node : nodes_of_edge(building_, panel, edge)) held[index_of(node)] = 1;
  const std::vector<NodeId> nodes = building_[panel].all_nodes();
  solver::Patch patch;
  std::vector<NodeId> at;
  std::vector<int> kept, released;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const auto first = static_cast<Eigen::Index>(6 * n);
    if (stiffness.block<6, 6>(first, first).isZero(0)) continue;
    const bool holds_here = held[index_of(nodes[n])] != 0;
    for (int c = 0; c < 6; ++c) (holds_here ? kept : released).push_back(static_cast<int>(first) + c);
    if (!holds_here) continue;
    patch.node.push_back(node_at(nodes[n]));
    at.push_back(nodes[n]);
  }
  if (kept.empty()) return;
  patch.stiffness = stiffness(kept, kept);
  if (!released.empty()) {
    const Eigen::MatrixXd between = stiffness(released, kept), inner = stiffness(released, released);
    const Eigen::MatrixXd handed_on = between.transpose() * inner.ldlt().solve(between);
    patch.stiffness -= 0.5 * (handed_on + handed_on.transpose());
  }
  model_.patches.push_back(std::move(patch));
  shells_.emplace_back(panel, std::move(at));
}

/// Those with an edge that holds and can break.
void FreeSegment::find_hung_panels(const FreePanelEdges& edges) {
  for (std::size_t p = 0; p < parts_.panels.size(); ++p) {
    const PanelId panel = parts_.panels[p];
    const std::optional<std::array<double, 4>> length = edges(panel);
    if (!length) continue;
    Hung hung{panel, parts_.panel_mass[p], *length, -1, {}};
    const bool shell = building_[panel].model == PanelModel::shell;
    for (std::size_t s = 0; s < shells_.size(); ++s)
      if (shells_[s].first == panel) {
        hung.patch = static_cast<int>(s);
        hung.nodes = shells_[s].second;
      }
    if (shell && hung.patch < 0) continue;
    bool can_break = false;
    for (std::size_t edge = 0; edge < 4; ++edge) {
      const auto there = [&](std::size_t corner) {
        return node_number_[index_of(building_[panel].nodes[corner % 4])] >= 0;
      };
      if (!shell && !(there(edge) && there(edge + 1))) hung.length[edge] = 0;
      can_break = can_break || (hung.length[edge] > 0 &&
                                building_[building_.joint(panel, static_cast<int>(edge))].capacity.breakable);
    }
    if (can_break) hung_.push_back(std::move(hung));
  }
}

/// Its own weight and inertia at its corners, where its mass is, and what hits it.
std::vector<PanelPush> FreeSegment::pushes_on(const Hung& hung, std::span<const FreePush> pushes, const Answer& motion,
                                              const Vec3& spin, const Vec3& gravity) const {
  std::vector<PanelPush> all;
  for (const NodeId node : building_[hung.panel].nodes)
    if (includes(hung.panel, node)) all.push_back({building_[node].position, Vec3::Zero()});
  for (PanelPush& corner : all)
    corner.force = hung.mass / static_cast<double>(all.size()) * on(corner.point, motion, spin, gravity);
  for (const FreePush& push : pushes)
    if (!push.member.valid() && push.panel == hung.panel) all.push_back({push.point, push.force});
  return all;
}

/// What the nodes along an edge do to the shell: what its stiffness takes up of them, less what acts on it there. A
/// corner between two edges that hold counts half for each.
std::array<Vec6, 4> FreeSegment::shell_edge_demands(const Hung& hung, std::span<const PanelPush> pushes,
                                                    const std::vector<Vec6>& displacements) const {
  const auto count = static_cast<Eigen::Index>(hung.nodes.size());
  Eigen::VectorXd moved(6 * count);
  for (Eigen::Index n = 0; n < count; ++n)
    moved.segment<6>(6 * n) =
        displacements[static_cast<std::size_t>(node_number_[index_of(hung.nodes[static_cast<std::size_t>(n)])])];
  Eigen::VectorXd force = model_.patches[static_cast<std::size_t>(hung.patch)].stiffness * moved;
  const auto place_of = [&](NodeId node) { return std::find(hung.nodes.begin(), hung.nodes.end(), node); };
  solver::LoadSet own;
  for (const PanelPush& push : pushes) push_corners(hung.panel, push.point, push.force, own);
  for (const solver::NodeLoad& load : own.nodes)
    for (Eigen::Index n = 0; n < count; ++n)
      if (node_number_[index_of(hung.nodes[static_cast<std::size_t>(n)])] == load.node)
        force.segment<6>(6 * n) -= load.load;
  std::array<std::vector<NodeId>, 4> along;
  std::map<NodeId, int> edges_at;
  for (std::size_t edge = 0; edge < 4; ++edge) {
    if (!(hung.length[edge] > 0)) continue;
    along[edge] = nodes_of_edge(building_, hung.panel, static_cast<int>(edge));
    for (const NodeId node : along[edge]) ++edges_at[node];
  }
  std::array<Vec6, 4> demands{Vec6::Zero(), Vec6::Zero(), Vec6::Zero(), Vec6::Zero()};
  for (std::size_t edge = 0; edge < 4; ++edge) {
    if (!(hung.length[edge] > 0)) continue;
    Vec6 sum = Vec6::Zero();
    for (const NodeId node : along[edge])
      if (const auto place = place_of(node); place != hung.nodes.end())
        sum += force.segment<6>(6 * (place - hung.nodes.begin())) / edges_at[node];
    const Mat3 axes = edge_axes(building_, building_[hung.panel], edge);
    demands[edge] << axes * sum.head<3>(), axes * sum.tail<3>();
    demands[edge] /= hung.length[edge];
  }
  return demands;
}

int FreeSegment::node_at(NodeId node) {
  int& number = node_number_[index_of(node)];
  if (number < 0) {
    number = static_cast<int>(model_.nodes.size());
    model_.nodes.push_back(building_[node].position);
    point_mass_.push_back(0);
  }
  return number;
}

/// Squared radius of gyration of the section: what keeps a straight bar from turning freely about itself.
double FreeSegment::polar(MemberId member) const {
  const Section& section = building_[building_[member].section];
  return (section.Iy + section.Iz) / section.area;
}

void FreeSegment::add_mass(const Vec3& at, double mass) {
  mass_ += mass;
  centre_ += mass * at;
  inertia_ += point_inertia(mass, at);
}

/// Those that are in the body; of a shell those that it holds on to, if it does to any.
bool FreeSegment::includes(PanelId panel, NodeId corner) const {
  if (node_number_[index_of(corner)] < 0) return false;
  const auto shell = std::find_if(shells_.begin(), shells_.end(), [&](const auto& one) { return one.first == panel; });
  if (shell == shells_.end()) return true;
  const auto holds = [&](NodeId node) {
    return std::find(shell->second.begin(), shell->second.end(), node) != shell->second.end();
  };
  const auto& corners = building_[panel].nodes;
  return holds(corner) || std::none_of(corners.begin(), corners.end(), holds);
}

/// By bilinear shares of those corners.
void FreeSegment::push_corners(PanelId id, const Vec3& point, const Vec3& force, solver::LoadSet& loads) const {
  const Panel& panel = building_[id];
  const Vec3 origin = building_[panel.nodes[0]].position;
  const Vec3 along = building_[panel.nodes[1]].position - origin, across = building_[panel.nodes[3]].position - origin;
  const double x = std::clamp((point - origin).dot(along) / along.squaredNorm(), 0.0, 1.0);
  const double y = std::clamp((point - origin).dot(across) / across.squaredNorm(), 0.0, 1.0);
  const std::array<double, 4> share{(1 - x) * (1 - y), x * (1 - y), x * y, (1 - x) * y};
  double held = 0;
  for (std::size_t corner = 0; corner < 4; ++corner)
    if (includes(id, panel.nodes[corner])) held += share[corner];
  for (std::size_t corner = 0; corner < 4; ++corner) {
    const int number = node_number_[index_of(panel.nodes[corner])];
    if (!includes(id, panel.nodes[corner]) || !(held > 0)) continue;
    Vec6 load = Vec6::Zero();
    load.head<3>() = share[corner] / held * force;
    loads.nodes.push_back({number, load});
  }
}

solver::LoadSet FreeSegment::loads_of(std::span<const FreePush> pushes) const {
  solver::LoadSet loads;
  for (const FreePush& push : pushes) {
    if (!push.member.valid()) {
      push_corners(push.panel, push.point, push.force, loads);
      continue;
    }
    const auto found = std::find(parts_.members.begin(), parts_.members.end(), push.member);
    const Member& member = building_[push.member];
    const Vec3 first = start_of(building_, member);
    const double at = std::clamp(Vec3(member.axes.row(0)).dot(push.point - first), 0.0, member.length);
    solver::BeamLoad load;
    load.beam = static_cast<int>(found - parts_.members.begin());
    load.kind = solver::BeamLoad::Kind::point;
    load.from = at;
    const Vec3 arm = push.point - (first + at * member.axes.row(0).transpose());
    load.first << member.axes * push.force, member.axes * arm.cross(push.force);
    loads.beams.push_back(load);
  }
  return loads;
}

/// What a unit of mass at a place pushes with: its weight less its inertia.
Vec3 FreeSegment::on(const Vec3& at, const Answer& motion, const Vec3& spin, const Vec3& gravity) const {
  const Vec3 r = at - centre_;
  return gravity - (motion.acceleration + motion.angular_acceleration.cross(r) + spin.cross(spin.cross(r)));
}

/// The pushes, and the inertia that holds them in balance with the spin and the weight.
solver::LoadSet FreeSegment::balanced(std::span<const FreePush> pushes, const Vec3& spin, const Vec3& gravity,
                                      Answer& answer) const {
  solver::LoadSet loads = loads_of(pushes);
  Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
  for (const solver::NodeLoad& load : loads.nodes) {
    const Vec3 r = model_.nodes[static_cast<std::size_t>(load.node)] - centre_;
    force += load.load.head<3>();
    moment += r.cross(load.load.head<3>());
  }
  for (const solver::BeamLoad& load : loads.beams) {
    const Member& member = building_[parts_.members[static_cast<std::size_t>(load.beam)]];
    const Vec3 global = member.axes.transpose() * load.first.head<3>();
    const Vec3 r = start_of(building_, member) + load.from * member.axes.row(0).transpose() - centre_;
    force += global;
    moment += r.cross(global) + member.axes.transpose() * load.first.tail<3>();
  }
  answer.acceleration = gravity + force / mass_;
  answer.angular_acceleration = inertia_.inverse() * (moment - spin.cross(inertia_ * spin));
  for (std::size_t i = 0; i < parts_.members.size(); ++i) {
    const Member& member = building_[parts_.members[i]];
    const Vec3 first = start_of(building_, member), last = first + member.length * member.axes.row(0).transpose();
    solver::BeamLoad load;
    load.beam = static_cast<int>(i);
    load.to = member.length;
    const double per_length = parts_.member_mass[i] / member.length;
    load.first.head<3>() = member.axes * (per_length * on(first, answer, spin, gravity));
    load.last.head<3>() = member.axes * (per_length * on(last, answer, spin, gravity));
    const Vec3 along = member.axes.row(0);
    const Vec3 turning = along * along.dot(answer.angular_acceleration) + spin.cross(along) * along.dot(spin);
    load.first.tail<3>() = load.last.tail<3>() = -per_length * polar(parts_.members[i]) * (member.axes * turning);
    loads.beams.push_back(load);
  }
  for (std::size_t n = 0; n < point_mass_.size(); ++n) {
    if (point_mass_[n] == 0) continue;
    Vec6 load = Vec6::Zero();
    load.head<3>() = point_mass_[n] * on(model_.nodes[n], answer, spin, gravity);
    loads.nodes.push_back({static_cast<int>(n), load});
  }
  return loads;
}

/// What its joints bear in a state that was solved for.
void FreeSegment::read_demands(const solver::StaticSolution* solution, std::span<const FreePush> pushes,
                               const Vec3& spin, const Vec3& gravity, Answer& answer) const {
  if (solution) {
    std::map<MemberId, std::size_t> number;
    for (std::size_t i = 0; i < parts_.members.size(); ++i) number[parts_.members[i]] = i;
    for (JointId joint : joints_)
      answer.demands.emplace_back(
          joint, member_joint_demand(solution->beam_end_forces[number[building_[joint].member]], building_[joint].end));
  }
  for (const Hung& hung : hung_) {
    if (hung.patch >= 0 && !solution) continue;
    const std::vector<PanelPush> own = pushes_on(hung, pushes, answer, spin, gravity);
    const std::array<Vec6, 4> demands = hung.patch >= 0
                                            ? shell_edge_demands(hung, own, solution->displacements)
                                            : free_panel_edge_demands(building_, hung.panel, hung.length, own);
    for (int edge = 0; edge < 4; ++edge)
      if (const JointId joint = building_.joint(hung.panel, edge);
          hung.length[static_cast<std::size_t>(edge)] > 0 && building_[joint].capacity.breakable)
        answer.demands.emplace_back(joint, demands[static_cast<std::size_t>(edge)]);
  }
  std::sort(answer.demands.begin(), answer.demands.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
}

FreeSegment::Answer FreeSegment::bear(std::span<const FreePush> pushes, const Vec3& spin, const Vec3& gravity) {
  Answer answer;
  const solver::LoadSet loads = balanced(pushes, spin, gravity, answer);
  std::optional<solver::StaticSolution> solution;
  if (analysis_) {
    solution = analysis_->solve({&loads, 1}).front();
    double largest = mass_ * gravity.norm();
    for (const FreePush& push : pushes) largest = std::max(largest, push.force.norm());
    answer.imbalance = largest > 0 ? solution->reactions.front().head<3>().norm() / largest : 0;
  }
  read_demands(solution ? &*solution : nullptr, pushes, spin, gravity, answer);
  return answer;
}

}  // namespace topple::structure
