// Bringing a standing frame's statics up to date, and reading from it what its joints bear.
#include <algorithm>
#include <utility>

#include "loads/placed_load.h"
#include "model/index_of.h"
#include "standing/standing_watch.h"

namespace topple::structure {

/// Contact loads and softening come on slowly: their change moves R0 as much as R, so that no sudden-loss factor acts
/// on them.
void StandingFrame::State::lay_contacts() {
  if (!loads.changed() && !softened) return;
  softened = false;
  write_loads();
  for (int c = 0; c < statics.components(); ++c) {
    if (!statics.changed(c)) continue;
    complete(c);  // what changed suddenly before is read as such
    laid(c, solve_slow(c).has_value());
  }
}

void StandingFrame::State::laid(int c, bool mechanism) {
  // Loads alone make no mechanism in a structure that was stable before.
  if (mechanism) return;
  // On the way to rest, what lies on it is part of that way. So is what the structure cannot bear: that state,
  // however far it lies, is never reached.
  if (!to_check[static_cast<std::size_t>(c)] && bears(c)) {
    account.finish(c, true, breaks);
    yielding.rest(c);
  }
  to_check[static_cast<std::size_t>(c)] = 1;
}

/// True when no joint of the component is over its capacity in the state solved last.
bool StandingFrame::State::bears(int c) const {
  const std::vector<JointId>& all = components.joints[static_cast<std::size_t>(c)];
  return std::none_of(all.begin(), all.end(),
                      [&](JointId joint) { return parts.standing(joint) && joints.utilisation(joint).value > 1; });
}

void StandingFrame::State::bring_up_to_date() {
  parts.forget_numbers();
  do {
    release();
    write_loads();
  } while (!solve_changed());
}

void StandingFrame::State::write_loads() {
  const FrameLoads::Changed changed = loads.take_changed();
  if (motion && !changed.none()) motion->update_masses();
  for (MemberId member : changed.members) {
    if (!stands(member)) continue;
    account.write(member);
    applied[index_of(member)] = loads.on(member);
    statics.set_loads(member, applied[index_of(member)]);
  }
  for (NodeId node : changed.nodes) {
    if (!node_solved[index_of(node)]) continue;
    account.write(node, node_applied[index_of(node)]);
    node_applied[index_of(node)] = loads.on(node);
    statics.set_load(node, node_applied[index_of(node)]);
  }
}

/// False: a mechanism was found, and its moving part was cut free: it is to be released, and what stands solved again.
bool StandingFrame::State::solve_changed() {
  bool moves = false;
  for (int c = 0; c < statics.components(); ++c) {
    if (!statics.changed(c)) continue;
    if (solved_nodes[static_cast<std::size_t>(c)] == 0) {
      statics.forget(c);
      continue;
    }
    const std::optional<FrameMechanism> mechanism = solve(c);
    solved(c, mechanism);
    moves = moves || mechanism.has_value();
  }
  return !moves;
}

void StandingFrame::State::solved(int c, const std::optional<FrameMechanism>& mechanism) {
  if (!mechanism)
    to_check[static_cast<std::size_t>(c)] = 1;
  else if (const auto turned_out = yielding.swing(c, *mechanism))
    break_joints(*turned_out, BreakCause::overload);
  else
    release_mechanism(*mechanism);
}

/// Solves where it may matter to what breaks next, and reads what the joints there bear.
std::optional<FrameMechanism> StandingFrame::State::solve(int c) {
  if (!may_restrict(c)) {
    auto mechanism = statics.solve(c);
    if (!mechanism) read_demands(c, false);
    return mechanism;
  }
  response.forget_bounds(c);
  Watch watch(*this);
  auto mechanism = statics.solve(c, watch);
  if (!mechanism) {
    demands_behind[static_cast<std::size_t>(c)] = statics.partial(c);
    read_panel_demands(c, false);
  }
  return mechanism;
}

/// After contact loads or stiffness changed slowly; the answer is whole.
std::optional<FrameMechanism> StandingFrame::State::solve_slow(int c) {
  if (!may_restrict(c)) {
    auto mechanism = statics.solve(c);
    if (!mechanism) read_demands(c, true);
    return mechanism;
  }
  response.forget_bounds(c);
  Watch watch(*this, true);
  auto mechanism = statics.solve(c, watch);
  if (mechanism) return mechanism;
  statics.complete(c, watch);
  read_panel_demands(c, true);
  return std::nullopt;
}

/// Uses after a sudden loss count from them.
void StandingFrame::State::references_moved(int c) {
  if (rules.sudden != 1) statics.forget_references(c);
}

/// A way on which joints yield needs all of an answer, as do shells, whose edges bear what all of their nodes do; where
/// few nodes stand, telling apart what may matter costs more than a whole answer.
bool StandingFrame::State::may_restrict(int c) const {
  return static_cast<int>(statics.nodes(c).size()) >= selective_from && !rules.second_order && !yielding.any(c) &&
         statics.shells(c).empty() && parts.one_segment(statics.members(c));
}

/// For whoever asks from outside: demands that the answers of a collapse under way have left out. These go on from
/// where they are, to the same bits.
void StandingFrame::State::know_demands() {
  for (int c = 0; c < statics.components(); ++c) {
    if (!std::exchange(demands_behind[static_cast<std::size_t>(c)], 0)) continue;
    read_demands(c, false);
    remember_demands(c);
  }
}

/// For largest_utilisation_so_far().
void StandingFrame::State::remember_demands(int c) {
  for (const JointId joint : components.joints[static_cast<std::size_t>(c)])
    if (parts.standing(joint)) (void)joints.check(joint);
}

/// The rest of what solve() read.
void StandingFrame::State::complete(int c) {
  if (!statics.partial(c)) return;
  demands_behind[static_cast<std::size_t>(c)] = 0;
  Watch watch(*this);
  statics.complete(c, watch);
  read_panel_demands(c, false);
  remember_demands(c);
}

void StandingFrame::State::read_demands(int c, bool slow) {
  response.forget_bounds(c);
  MemberId member_read;
  solver::Vec12 end_forces;
  for (JointId joint : components.joints[static_cast<std::size_t>(c)]) {
    const Joint& own = building[joint];
    if (!own.member.valid() || !parts.standing(joint)) continue;
    if (own.member != member_read) end_forces = statics.end_forces(own.member);
    member_read = own.member;
    const Vec6 demand = member_joint_demand(end_forces, own.end);
    slow ? joints.set_slow_demand(joint, demand) : joints.set_demand(joint, demand);
  }
  for (const PanelId panel : statics.membranes(c))
    if (parts.bearings.membrane(panel)) edge_loads.set_corner_forces(panel, statics.corner_forces(panel));
  read_panel_demands(c, slow);
}

/// Loads that panels hand on change without anything moving. Shells are read from what their corners do.
void StandingFrame::State::read_panel_demands(int c, bool slow, bool in_motion) {
  PanelId panel_read;
  std::array<Vec6, 4> shell;
  const std::array<Vec6, 4>* of_edges = nullptr;
  for (JointId joint : components.edges[static_cast<std::size_t>(c)]) {
    const Joint& own = building[joint];
    if (own.panel != panel_read) {
      of_edges = nullptr;
      if (!parts.bearings.serves(own.panel)) {
        of_edges = &(shell = edge_demands(own.panel, in_motion));
      } else if (edge_loads.changed(own.panel)) {
        of_edges = &edge_loads.read(own.panel);
      }
    }
    panel_read = own.panel;
    if (of_edges == nullptr || !parts.standing(joint)) continue;
    const Vec6& demand = (*of_edges)[static_cast<std::size_t>(own.end)];
    slow ? joints.set_slow_demand(joint, demand) : joints.set_demand(joint, demand);
  }
}

/// The joints that break next, those of components whose joints yield first: in each segment all that are over capacity
/// and within `same_time` of its largest, in order of id. A segment without any has come to rest: R becomes R0.
std::vector<JointId> StandingFrame::State::next_generation() {
  constexpr double same_time = 1e-6;  // relative; symmetric joints differ by rounding only
  std::vector<JointId> next;
  std::vector<double> largest;
  std::vector<std::pair<JointId, double>> over;
  const auto rests = [&](int c) {
    if (!buckles(c)) come_to_rest(c);
  };
  for (int c = 0; c < statics.components(); ++c) {
    if (!to_check[static_cast<std::size_t>(c)]) continue;
    const YieldingWay::End end = yielding.follow(c, next);
    if (end == YieldingWay::End::resting) rests(c);
    if (end != YieldingWay::End::unyielding) continue;
    largest.assign(static_cast<std::size_t>(parts.segments.labels()), 0.0);
    over.clear();
    const std::vector<JointId>& all = components.joints[static_cast<std::size_t>(c)];
    for (JointId joint : all) {
      const double used = joints.felt(joint).value;
      if (!(used > 1 || used > joints.largest(joint))) continue;
      const int segment = parts.label(joint);
      if (segment < 0 || !parts.holds(joint)) continue;
      joints.remember(joint, used);
      if (!(used > 1)) continue;
      over.emplace_back(joint, used);
      largest[static_cast<std::size_t>(segment)] = std::max(largest[static_cast<std::size_t>(segment)], used);
    }
    if (over.empty()) complete(c);
    if (over.empty() || !parts.one_segment(statics.members(c))) {
      bool moved = false;
      for (JointId joint : all) {
        const int segment = parts.label(joint);
        if (segment >= 0 && largest[static_cast<std::size_t>(segment)] == 0) moved = joints.accept(joint) || moved;
      }
      if (moved) references_moved(c);
    }
    for (const auto& [joint, used] : over)
      if (used >= (1 - same_time) * largest[static_cast<std::size_t>(parts.label(joint))]) next.push_back(joint);
    if (over.empty()) rests(c);
  }
  std::sort(next.begin(), next.end());
  return next;
}

/// A post of the component gives way sideways in the static answer: it is to break next.
bool StandingFrame::State::buckles(int c) {
  if (!buckling) return false;
  const std::optional<BuckledPost> post = buckling->find(c, statics.diverged(c));
  if (!post || !post->post.valid()) return false;
  buckled.push_back(*post);
  return true;
}

/// At a joint, or where the post is cut in two.
void StandingFrame::State::snap_buckled() {
  for (const BuckledPost& post : std::exchange(buckled, {})) {
    const std::size_t first = breaks.size();
    if (post.joint.valid())
      break_joint(post.joint, BreakCause::buckling);
    else
      cut_in_two(post.post, post.inside);
    if (breaks.size() == first) continue;
    JointBreak& line = breaks[first];
    line.sense = Sense::compression;
    line.demand = post.compression;
    line.capacity = post.bearable;
    if (!line.inside) line.position = post.bulge;
  }
}

/// The static answer is borne: R becomes R0.
void StandingFrame::State::come_to_rest(int c) {
  complete(c);
  bool moved = false;
  for (JointId joint : components.joints[static_cast<std::size_t>(c)])
    if (parts.label(joint) >= 0) moved = joints.accept(joint) || moved;
  if (moved) references_moved(c);
  to_check[static_cast<std::size_t>(c)] = 0;
  account.finish(c, false, breaks);
  yielding.rest(c);
}

}  // namespace topple::structure
