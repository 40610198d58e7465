#include "failure/buckling_bracing.h"

#include <algorithm>
#include <cmath>

#include "failure/panel_bearings.h"
#include "model/index_of.h"
#include "topple/solver/buckling.h"
#include "topple/solver/geometric_forces.h"

namespace topple::structure {

namespace {
/// Of the lower bound. Beams that hold a post softly can bring it below the bound; a half of it they do not.
constexpr double tested_share = 0.5;
/// A post that was stable is tested again when it uses this much more of its bound.
constexpr double tested_again = 1.02;
/// Rayleigh quotients above this go to the tangent: one cubic member for each post is up to 22 % on the safe side of a
/// pinned one, and the quotient comes from below.
constexpr double suspicious_quotient = 0.7;
/// A post that bears more than this share of its pinned Euler load may buckle between nodes at rest, which the
/// iteration does not see.
constexpr double inner_share = 0.7;
/// Factors above this are not looked for; well above 1, so that an enclosure of one below 1 lies within.
constexpr double sought = 2;
constexpr int iterations = 12;
constexpr double settled = 1e-3;
/// Places whose bends differ by less, relative, bend as much.
constexpr double same_bend = 1e-3;
/// A post that bends most so near to its end, as a share of its length, does so at the end.
constexpr double at_the_end = 0.01;
constexpr double pi = 3.14159265358979323846;

double least_euler(const Building& building, const FrameStatics& statics, MemberId member, double length) {
  const Section& section = building[building[member].section];
  const double modulus = building[building[member].material].youngs_modulus * statics.stiffness(member);
  return pi * pi * modulus * std::min(section.Iy, section.Iz) / (length * length);
}

}  // namespace

BucklingBracing::BucklingBracing(const Building& building, const FrameStatics& statics, const Segmentation& segments,
                                 const PanelBearings& bearings,
                                 const std::vector<std::vector<solver::BeamLoad>>& applied,
                                 const std::vector<Vec6>& node_applied, const std::vector<char>& node_solved)
    : building_(building),
      statics_(statics),
      segments_(segments),
      bearings_(bearings),
      applied_(applied),
      node_applied_(node_applied),
      node_solved_(node_solved),
      members_at_(building.nodes.size()),
      plates_at_(building.nodes.size()),
      supported_(building.nodes.size(), 0),
      tested_(building.members.size(), 0.0) {
  for (std::size_t m = 0; m < building.members.size(); ++m)
    for (NodeId node : building.members[m].nodes) members_at_[index_of(node)].push_back(MemberId(m));
  for (std::size_t p = 0; p < building.panels.size(); ++p)
    if (building.panels[p].model != PanelModel::cladding)
      for (NodeId node : building.panels[p].nodes) plates_at_[index_of(node)].push_back(PanelId(p));
  for (const NodeSupport& support : building.supports) supported_[index_of(support.node)] = 1;
}

bool BucklingBracing::braced(NodeId node) const {
  if (supported_[index_of(node)] != 0) return true;
  for (MemberId member : members_at_[index_of(node)]) {
    if (building_[member].kind == MemberKind::post || segments_.label(member) < 0) continue;
    if (segments_.holds(building_.joint(member, 0)) && segments_.holds(building_.joint(member, 1))) return true;
  }
  return std::any_of(plates_at_[index_of(node)].begin(), plates_at_[index_of(node)].end(), [&](PanelId panel) {
    return bearings_.tracks(panel) ? bearings_.membrane(panel) : segments_.label(panel) >= 0;
  });
}

double BucklingBracing::unbraced_length(MemberId post) const {
  double length = building_[post].length;
  for (int end = 0; end < 2; ++end) {
    MemberId from = post;
    NodeId node = building_[post].nodes[static_cast<std::size_t>(end)];
    for (std::size_t turns = 0; turns < building_.members.size() && !braced(node); ++turns) {
      MemberId next;
      for (MemberId member : members_at_[index_of(node)])
        if (member != from && building_[member].kind == MemberKind::post && segments_.label(member) >= 0 &&
            segments_.holds(building_.joint(member, building_[member].nodes[0] == node ? 0 : 1)))
          next = member;
      if (!next.valid()) break;
      length += building_[next].length;
      node = building_[next].nodes[building_[next].nodes[0] == node ? 1 : 0];
      from = next;
    }
  }
  return length;
}

/// Remembers what each post uses of its bound when any is to be tested.
bool BucklingBracing::suspicious(int c) {
  bool found = false;
  std::vector<std::pair<MemberId, double>> used;
  for (MemberId member : statics_.members(c)) {
    const Member& own = building_[member];
    if (own.kind != MemberKind::post || segments_.label(member) < 0) continue;
    const solver::Vec12& force = statics_.end_forces(member);
    const double compression = std::max(force(0), -force(6));
    // Without any walk: the bound is no higher than that of the post alone.
    if (!(compression > 0)) continue;
    const double alone = compression / least_euler(building_, statics_, member, 2 * own.length);
    if (alone < tested_share / 400) continue;  // twenty storeys without bracing would still bear it
    const double share = compression / least_euler(building_, statics_, member, 2 * unbraced_length(member));
    if (share < tested_share) continue;
    used.emplace_back(member, share);
    found = found || share > tested_again * tested_[index_of(member)];
  }
  if (found)
    for (const auto& [member, share] : used) tested_[index_of(member)] = share;
  return found;
}

/// From a push sideways without any symmetry of its own.
BucklingBracing::Iteration BucklingBracing::begin(int c) const {
  Iteration first;
  double step = 0;
  for (NodeId node : statics_.nodes(c)) {
    if (node_solved_[index_of(node)] == 0) continue;
    step += 1;
    Vec6 push = Vec6::Zero();
    push(0) = 1 + 0.3 * std::sin(0.7 * step);
    push(1) = 0.8 + 0.3 * std::sin(1.1 * step + 1);
    first.loads.nodes.emplace_back(node, push);
  }
  return first;
}

/// One step towards the Rayleigh quotient of -Kg over K in the shape that the iteration comes to. True when it is
/// there.
bool BucklingBracing::iterate(int c, Iteration& iteration) const {
  const FrameStatics::Response shape = statics_.respond(c, iteration.loads);
  double done = 0, geometric = 0, size = 0;
  for (const auto& [node, load] : iteration.loads.nodes) {
    done += load.dot(shape.displacement(node));
    size = std::max(size, shape.displacement(node).cwiseAbs().maxCoeff());
  }
  if (!(done > 0) || !(size > 0)) return true;
  std::vector<Vec6> at(building_.nodes.size(), Vec6::Zero());
  for (MemberId member : statics_.members(c)) {
    if (segments_.label(member) < 0) continue;
    const auto& nodes = building_[member].nodes;
    const solver::Beam& beam = statics_.beam(member);
    const solver::Vec12 push = -solver::node_forces(
        beam, solver::geometric_forces(beam, statics_.end_forces(member), shape.displacement(nodes[0]),
                                       shape.displacement(nodes[1])));
    for (int end = 0; end < 2; ++end) at[index_of(nodes[static_cast<std::size_t>(end)])] += push.segment<6>(6 * end);
  }
  for (auto& [node, load] : iteration.loads.nodes) {
    geometric += at[index_of(node)].dot(shape.displacement(node));
    load = at[index_of(node)] / size;
  }
  const double before = std::exchange(iteration.quotient, geometric / done);
  ++iteration.steps;
  return iteration.steps == iterations ||
         (iteration.steps > 3 && std::abs(iteration.quotient - before) < settled * std::abs(iteration.quotient));
}

double BucklingBracing::quotient(int c) const {
  Iteration iteration = begin(c);
  while (!iterate(c, iteration)) {
  }
  return iteration.quotient;
}

BucklingBracing::Standing BucklingBracing::what_stands(int c) const {
  Standing standing;
  standing.number.assign(building_.nodes.size(), -1);
  for (NodeId node : statics_.nodes(c)) {
    if (node_solved_[index_of(node)] == 0 || segments_.label(node) < 0) continue;
    const int number = static_cast<int>(standing.model.nodes.size());
    standing.number[index_of(node)] = number;
    standing.model.nodes.push_back(building_[node].position);
    if (!node_applied_[index_of(node)].isZero(0))
      standing.loads.nodes.push_back({number, node_applied_[index_of(node)]});
  }
  add_members(c, standing);
  add_panels(c, standing);
  for (const solver::Support& support : statics_.supports(c)) {
    solver::Support own = support;
    own.node = standing.number[index_of(statics_.nodes(c)[static_cast<std::size_t>(support.node)])];
    if (own.node >= 0 && !own.stiffness.isZero(0)) standing.model.supports.push_back(own);
  }
  return standing;
}

void BucklingBracing::add_members(int c, Standing& standing) const {
  for (MemberId member : statics_.members(c)) {
    if (segments_.label(member) < 0) continue;
    solver::Beam beam = statics_.beam(member);
    for (int end = 0; end < 2; ++end) {
      const auto e = static_cast<std::size_t>(end);
      beam.node[e] = standing.number[index_of(building_[member].nodes[e])];
    }
    if (beam.node[0] < 0 || beam.node[1] < 0) continue;
    for (solver::BeamLoad load : applied_[index_of(member)]) {
      load.beam = static_cast<int>(standing.model.beams.size());
      standing.loads.beams.push_back(load);
    }
    standing.model.beams.push_back(beam);
    standing.members.push_back(member);
  }
}

/// Membranes, and shells by the stiffness that their nodes feel of them.
void BucklingBracing::add_panels(int c, Standing& standing) const {
  solver::FrameModel& model = standing.model;
  for (PanelId panel : statics_.membranes(c)) {
    if (!statics_.stiff(panel)) continue;
    solver::Shell shell = statics_.shell(panel);
    for (std::size_t corner = 0; corner < 4; ++corner) {
      const NodeId node = building_[panel].nodes[corner];
      shell.node[corner] = standing.number[index_of(node)];
      if (shell.node[corner] >= 0) continue;
      // Nothing of the panel is left there.
      shell.node[corner] = static_cast<int>(model.nodes.size());
      model.nodes.push_back(building_[node].position);
      model.supports.push_back({shell.node[corner], Vec6::Constant(unlimited)});
    }
    if (const Mat24* stiffness = statics_.given_stiffness(panel))
      model.shell_stiffness.emplace(static_cast<int>(model.shells.size()), *stiffness);
    model.shells.push_back(shell);
  }
  for (PanelId panel : statics_.shells(c)) {
    if (!statics_.stiff(panel)) continue;
    const std::vector<NodeId> nodes = building_[panel].all_nodes();
    const Eigen::MatrixXd& stiffness = statics_.shell_stiffness(panel);
    std::vector<int> kept;  // of its nodes: those that stand
    solver::Patch patch;
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      if (standing.number[index_of(nodes[n])] < 0) continue;
      patch.node.push_back(standing.number[index_of(nodes[n])]);
      for (int c6 = 0; c6 < 6; ++c6) kept.push_back(static_cast<int>(6 * n) + c6);
    }
    patch.stiffness = stiffness(kept, kept);
    model.patches.push_back(std::move(patch));
  }
}

std::optional<BuckledPost> BucklingBracing::judge(int c) const {
  const Standing standing = what_stands(c);
  const std::vector<solver::BucklingMode> modes = solver::buckling_modes(standing.model, standing.loads, 1, {}, sought);
  if (modes.empty() || modes.front().factor > 1) return std::nullopt;
  return give_way(most_bent(bent_posts(standing, modes.front())), modes.front().factor);
}

std::vector<BucklingBracing::Bent> BucklingBracing::bent_posts(const Standing& standing,
                                                               const solver::BucklingMode& mode) const {
  std::vector<Bent> bent;
  for (std::size_t i = 0; i < standing.members.size(); ++i) {
    const MemberId member = standing.members[i];
    if (building_[member].kind != MemberKind::post) continue;
    const solver::Vec12& force = statics_.end_forces(member);
    const double compression = (force(0) - force(6)) / 2;
    if (!(compression > 0)) continue;
    const solver::Beam& beam = standing.model.beams[i];
    Bent one;
    one.post = member;
    one.compression = compression;
    for (std::size_t end = 0; end < 2; ++end) one.motion[end] = mode.shape[static_cast<std::size_t>(beam.node[end])];
    const solver::Vec12 rigid_ends = solver::rigid_end_displacements(beam, one.motion[0], one.motion[1]);
    one.rests = rigid_ends.isZero(0);
    if (one.rests) one.share = compression / solver::buckling_load_between_resting_ends(beam);
    one.bend = solver::buckling_bend(beam, mode.factor * compression, rigid_ends);
    bent.push_back(one);
  }
  return bent;
}

/// Those that bend most, within what counts as the same. Where all nodes rest only the one that uses most of what it
/// bears between them bends.
std::vector<BucklingBracing::Bent> BucklingBracing::most_bent(std::vector<Bent> bent) {
  const bool all_rest = std::all_of(bent.begin(), bent.end(), [](const Bent& one) { return one.rests; });
  const auto size = [&](const Bent& one) { return all_rest ? one.share : one.rests ? 0 : one.bend.moment; };
  double most = 0;
  for (const Bent& one : bent) most = std::max(most, size(one));
  std::erase_if(bent, [&](const Bent& one) { return size(one) < (1 - same_bend) * most; });
  if (all_rest && bent.size() > 1) bent.resize(1);
  return bent;
}

/// Of places that bend as much, a joint that can break goes first.
BuckledPost BucklingBracing::give_way(const std::vector<Bent>& bent, double factor) const {
  BuckledPost found;
  found.factor = factor;
  if (bent.empty()) return found;
  const auto bends_less = [](const Bent& a, const Bent& b) { return a.bend.moment < b.bend.moment; };
  const Bent* chosen = &*std::max_element(bent.begin(), bent.end(), bends_less);
  const double most = chosen->bend.moment;
  const auto holds_at = [&](const Bent& one, int end) { return segments_.holds(building_.joint(one.post, end)); };
  for (auto one = bent.begin(); one != bent.end() && !found.joint.valid(); ++one)
    for (int end = 0; end < 2 && !found.joint.valid(); ++end) {
      const JointId joint = building_.joint(one->post, end);
      if (!building_[joint].capacity.breakable || !holds_at(*one, end) ||
          one->bend.at_ends[static_cast<std::size_t>(end)] < (1 - same_bend) * most)
        continue;
      chosen = &*one;
      found.joint = joint;
    }
  const Member& own = building_[chosen->post];
  found.post = chosen->post;
  found.inside = chosen->bend.place / own.length;
  const int near = found.inside < 0.5 ? 0 : 1;
  if (!found.joint.valid() && std::min(found.inside, 1 - found.inside) < at_the_end && holds_at(*chosen, near))
    found.joint = building_.joint(chosen->post, near);
  found.compression = chosen->compression;
  found.bearable = factor * chosen->compression;
  const Vec3 first = chosen->motion[0].head<3>(), second = chosen->motion[1].head<3>();
  const double apart = (first - second).norm(), moved = std::max(first.norm(), second.norm());
  found.bulge = apart < 0.5 * moved ? 0.5 * (building_[own.nodes[0]].position + building_[own.nodes[1]].position)
                : first.norm() > second.norm() ? building_[own.nodes[0]].position
                                               : building_[own.nodes[1]].position;
  return found;
}

/// A post bears so much that it may buckle between nodes at rest.
bool BucklingBracing::buckles_inside(int c) const {
  for (MemberId member : statics_.members(c)) {
    if (segments_.label(member) < 0) continue;
    const solver::Vec12& force = statics_.end_forces(member);
    if ((force(0) - force(6)) / 2 > inner_share * least_euler(building_, statics_, member, building_[member].length))
      return true;
  }
  return false;
}

std::optional<BuckledPost> BucklingBracing::find(int c, bool certain) {
  ++counters_.screened;
  if (!suspicious(c) && !certain) return std::nullopt;
  ++counters_.iterated;
  if (!certain && !buckles_inside(c) && quotient(c) < suspicious_quotient) return std::nullopt;
  ++counters_.judged;
  std::optional<BuckledPost> buckled = judge(c);
  if (buckled) std::fill(tested_.begin(), tested_.end(), 0.0);
  return buckled;
}

}  // namespace topple::structure
