#include "simulation/free_segment.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <map>
#include <numeric>

#include "index_of.h"
#include "shell_edges.h"
#include "topple/structure/frame.h"
#include "topple/structure/joint_check.h"

namespace topple::structure {

namespace {

solver::Beam beam_of(const Building& building, MemberId id) {
  const Member& member = building[id];
  const Section& section = building[member.section];
  const Material& material = building[member.material];
  solver::Beam beam;
  beam.offset = member.offsets;
  beam.axes = member.axes;
  beam.length = member.length;
  beam.youngs_modulus = material.youngs_modulus;
  beam.shear_modulus = material.shear_modulus;
  beam.area = section.area;
  beam.shear_area_y = section.shear_area_y;
  beam.shear_area_z = section.shear_area_z;
  beam.Iy = section.Iy;
  beam.Iz = section.Iz;
  beam.J = section.J;
  return beam;
}

Vec3 start_of(const Building& building, const Member& member) {
  return building[member.nodes[0]].position + member.offsets[0];
}

}  // namespace

FreeSegment::FreeSegment(const Building& building, FreeSegmentParts parts, const std::function<bool(JointId)>& holds,
                         const std::function<Eigen::MatrixXd(PanelId)>& shell_stiffness)
    : building_(building), parts_(std::move(parts)), node_number_(building.nodes.size(), -1) {
  int held_at = -1;
  bool breakable = false;
  for (std::size_t i = 0; i < parts_.members.size(); ++i) {
    const MemberId id = parts_.members[i];
    const Member& member = building[id];
    solver::Beam beam = beam_of(building, id);
    for (int end = 0; end < 2; ++end) {
      const auto e = static_cast<std::size_t>(end);
      const JointId joint = building.joint(id, end);
      if (holds(joint)) {
        beam.node[e] = node_at(member.nodes[e]);
        beam.end_stiffness[e] = building[joint].stiffness;
        if (building[joint].capacity.breakable) {
          joints_.push_back(joint);
          breakable = true;
        }
      } else {  // a free end, with a node of its own
        beam.node[e] = static_cast<int>(model_.nodes.size());
        beam.offset[e].setZero();
        model_.nodes.push_back(building[member.nodes[e]].position + member.offsets[e]);
        point_mass_.push_back(0);
      }
      // Whatever hangs on the node that holds the body holds it in all its motions only if it is rigid there.
      if (held_at < 0 && (beam.end_stiffness[e].array() == solver::rigid).all()) held_at = beam.node[e];
    }
    model_.beams.push_back(beam);
    const Vec3 first = start_of(building, member), along = member.axes.row(0).transpose() * member.length;
    // An even line of mass: the same first two moments as at its two Gauss points.
    for (const double place : {0.21132486540518713, 0.78867513459481287})
      add_mass(first + place * along, parts_.member_mass[i] / 2);
  }
  std::sort(joints_.begin(), joints_.end());
  for (const PanelId panel : parts_.panels)
    if (shell_stiffness && building[panel].model == PanelModel::shell) add_shell(panel, shell_stiffness(panel));
  for (std::size_t i = 0; i < parts_.nodes.size(); ++i) {
    const int number = node_number_[index_of(parts_.nodes[i])];
    if (number < 0) continue;
    point_mass_[static_cast<std::size_t>(number)] += parts_.node_mass[i];
  }
  for (std::size_t i = 0; i < parts_.panels.size(); ++i) {
    std::vector<int> corners;
    for (NodeId node : building[parts_.panels[i]].nodes)
      if (const int number = node_number_[index_of(node)]; number >= 0) corners.push_back(number);
    for (int number : corners)
      point_mass_[static_cast<std::size_t>(number)] += parts_.panel_mass[i] / static_cast<double>(corners.size());
  }
  for (std::size_t n = 0; n < point_mass_.size(); ++n) add_mass(model_.nodes[n], point_mass_[n]);
  for (std::size_t i = 0; i < parts_.members.size(); ++i) {
    const Vec3 along = building[parts_.members[i]].axes.row(0);
    inertia_ += polar(parts_.members[i]) * parts_.member_mass[i] * along * along.transpose();
  }
  centre_ /= mass_;
  // So far about the origin.
  inertia_ -= mass_ * (centre_.squaredNorm() * Mat3::Identity() - centre_ * centre_.transpose());
  if (!breakable || parts_.members.size() < 2 || held_at < 0) return;
  model_.supports.push_back({held_at, Vec6::Constant(solver::rigid)});
  try {
    analysis_ = std::make_unique<solver::StaticAnalysis>(model_);
  } catch (const solver::Instability&) {
    // It can move within itself: its joints are spared by that motion.
  }
}

/// By the nodes at which it has any stiffness.
void FreeSegment::add_shell(PanelId panel, const Eigen::MatrixXd& stiffness) {
  const std::vector<NodeId> nodes = building_[panel].all_nodes();
  solver::Patch patch;
  std::vector<int> kept;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const auto first = static_cast<Eigen::Index>(6 * n);
    if (stiffness.block<6, 6>(first, first).isZero(0)) continue;
    patch.node.push_back(node_at(nodes[n]));
    for (int c = 0; c < 6; ++c) kept.push_back(static_cast<int>(first) + c);
  }
  patch.stiffness = stiffness(kept, kept);
  model_.patches.push_back(std::move(patch));
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
  inertia_ += mass * (at.squaredNorm() * Mat3::Identity() - at * at.transpose());
}

/// Of the corners that are in the body, by bilinear shares.
void FreeSegment::push_corners(const Panel& panel, const Vec3& point, const Vec3& force, solver::LoadSet& loads) const {
  const Vec3 origin = building_[panel.nodes[0]].position;
  const Vec3 along = building_[panel.nodes[1]].position - origin, across = building_[panel.nodes[3]].position - origin;
  const double x = std::clamp((point - origin).dot(along) / along.squaredNorm(), 0.0, 1.0);
  const double y = std::clamp((point - origin).dot(across) / across.squaredNorm(), 0.0, 1.0);
  const std::array<double, 4> share{(1 - x) * (1 - y), x * (1 - y), x * y, (1 - x) * y};
  double held = 0;
  for (std::size_t corner = 0; corner < 4; ++corner)
    if (node_number_[index_of(panel.nodes[corner])] >= 0) held += share[corner];
  for (std::size_t corner = 0; corner < 4; ++corner) {
    const int number = node_number_[index_of(panel.nodes[corner])];
    if (number < 0 || !(held > 0)) continue;
    Vec6 load = Vec6::Zero();
    load.head<3>() = share[corner] / held * force;
    loads.nodes.push_back({number, load});
  }
}

solver::LoadSet FreeSegment::place(std::span<const FreePush> pushes) const {
  solver::LoadSet loads;
  for (const FreePush& push : pushes) {
    if (!push.member.valid()) {
      push_corners(building_[push.panel], push.point, push.force, loads);
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

FreeSegment::Answer FreeSegment::bear(std::span<const FreePush> pushes, const Vec3& spin, const Vec3& gravity) {
  solver::LoadSet loads = place(pushes);
  Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
  double largest = mass_ * gravity.norm();
  for (const solver::NodeLoad& load : loads.nodes) {
    const Vec3 r = model_.nodes[static_cast<std::size_t>(load.node)] - centre_;
    force += load.load.head<3>();
    moment += r.cross(load.load.head<3>());
    largest = std::max(largest, load.load.head<3>().norm());
  }
  for (const solver::BeamLoad& load : loads.beams) {
    const Member& member = building_[parts_.members[static_cast<std::size_t>(load.beam)]];
    const Vec3 global = member.axes.transpose() * load.first.head<3>();
    const Vec3 r = start_of(building_, member) + load.from * member.axes.row(0).transpose() - centre_;
    force += global;
    moment += r.cross(global) + member.axes.transpose() * load.first.tail<3>();
    largest = std::max(largest, global.norm());
  }
  Answer answer;
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
  const solver::StaticSolution solution = analysis_->solve({&loads, 1}).front();
  answer.imbalance = largest > 0 ? solution.reactions.front().head<3>().norm() / largest : 0;
  std::map<MemberId, std::size_t> number;
  for (std::size_t i = 0; i < parts_.members.size(); ++i) number[parts_.members[i]] = i;
  for (JointId joint : joints_)
    answer.demands.emplace_back(
        joint, member_joint_demand(solution.beam_end_forces[number[building_[joint].member]], building_[joint].end));
  return answer;
}

std::vector<FreeSegmentParts> connected_parts(const Building& building, const FreeSegmentParts& whole,
                                              const std::function<bool(JointId)>& holds) {
  // Vertices: members, then nodes, then panels, of which only shells are joined to anything.
  const std::size_t members = whole.members.size(), first_panel = members + whole.nodes.size();
  std::map<NodeId, std::size_t> node_vertex;
  for (std::size_t n = 0; n < whole.nodes.size(); ++n) node_vertex[whole.nodes[n]] = members + n;
  std::vector<std::size_t> parent(first_panel + whole.panels.size());
  std::iota(parent.begin(), parent.end(), std::size_t{0});
  const auto find = [&](std::size_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  for (std::size_t m = 0; m < members; ++m)
    for (int end = 0; end < 2; ++end) {
      const NodeId node = building[whole.members[m]].nodes[static_cast<std::size_t>(end)];
      const auto vertex = node_vertex.find(node);
      if (vertex == node_vertex.end() || !holds(building.joint(whole.members[m], end))) continue;
      const std::size_t a = find(m), b = find(vertex->second);
      parent[std::max(a, b)] = std::min(a, b);
    }
  const auto is_shell = [&](std::size_t p) { return building[whole.panels[p]].model == PanelModel::shell; };
  for (std::size_t p = 0; p < whole.panels.size(); ++p)
    for (int edge = 0; edge < 4 && is_shell(p); ++edge) {
      if (!holds(building.joint(whole.panels[p], edge))) continue;
      for (const NodeId node : nodes_of_edge(building, whole.panels[p], edge)) {
        const auto vertex = node_vertex.find(node);
        if (vertex == node_vertex.end()) continue;
        const std::size_t a = find(first_panel + p), b = find(vertex->second);
        parent[std::max(a, b)] = std::min(a, b);
      }
    }
  std::vector<FreeSegmentParts> parts;
  std::vector<int> part_of(parent.size(), -1);
  const auto part = [&](std::size_t vertex) -> FreeSegmentParts& {
    int& number = part_of[find(vertex)];
    if (number < 0) {
      number = static_cast<int>(parts.size());
      parts.emplace_back();
    }
    return parts[static_cast<std::size_t>(number)];
  };
  for (std::size_t m = 0; m < members; ++m) {
    FreeSegmentParts& own = part(m);
    own.members.push_back(whole.members[m]);
    own.member_mass.push_back(whole.member_mass[m]);
  }
  for (std::size_t n = 0; n < whole.nodes.size(); ++n) {
    FreeSegmentParts& own = part(members + n);
    own.nodes.push_back(whole.nodes[n]);
    own.node_mass.push_back(whole.node_mass[n]);
  }
  for (std::size_t p = 0; p < whole.panels.size(); ++p) {
    if (is_shell(p)) {
      FreeSegmentParts& own = part(first_panel + p);
      own.panels.push_back(whole.panels[p]);
      own.panel_mass.push_back(whole.panel_mass[p]);
      continue;
    }
    std::vector<int> corners(parts.size(), 0);
    for (NodeId node : building[whole.panels[p]].nodes)
      if (const auto vertex = node_vertex.find(node); vertex != node_vertex.end())
        ++corners[static_cast<std::size_t>(part_of[find(vertex->second)])];
    const auto most = std::max_element(corners.begin(), corners.end());
    if (most == corners.end() || *most == 0) parts.emplace_back();
    FreeSegmentParts& own =
        most == corners.end() || *most == 0 ? parts.back() : parts[static_cast<std::size_t>(most - corners.begin())];
    own.panels.push_back(whole.panels[p]);
    own.panel_mass.push_back(whole.panel_mass[p]);
  }
  return parts;
}

}  // namespace topple::structure
