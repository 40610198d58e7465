// Bringing a standing frame's statics up to date, and reading from it what its joints bear.
#include <algorithm>
#include <utility>

#include "index_of.h"
#include "placed_load.h"
#include "standing_state.h"

namespace topple::structure {

/// Contact loads and softening come on slowly: their change moves R0 as much as R, so that no sudden-loss factor acts
/// on them.
void StandingFrame::State::lay_contacts() {
  if (!loads.changed() && !std::exchange(softened, false)) return;
  softened = false;
  write_loads();
  for (int c = 0; c < statics.components(); ++c) {
    if (!statics.changed(c)) continue;
    // Loads alone make no mechanism in a structure that was stable before.
    if (statics.solve(c)) continue;
    read_demands(c, true);
    // On the way to rest, what lies on it is part of that way. So is what the structure cannot bear: that state,
    // however far it lies, is never reached.
    if (!to_check[static_cast<std::size_t>(c)] && bears(c)) {
      account.finish(c, true, breaks);
      if (ductile.any(c)) ductile.base_is_answer(c);
    }
    to_check[static_cast<std::size_t>(c)] = 1;
  }
}

/// True when no joint of the component is over its capacity in the state solved last.
bool StandingFrame::State::bears(int c) const {
  const std::vector<JointId>& all = checked_joints[static_cast<std::size_t>(c)];
  return std::none_of(all.begin(), all.end(), [&](JointId joint) {
    return holds(joint) && label(joint) >= 0 && joints.utilisation(joint).value > 1;
  });
}

void StandingFrame::State::bring_up_to_date() {
  segment_numbers.clear();
  do {
    release();
    write_loads();
  } while (solve_changed());
}

void StandingFrame::State::write_loads() {
  const FrameLoads::Changed changed = loads.take_changed();
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

/// True when a mechanism was found and its moving part cut free: then it is to be released and solved again.
bool StandingFrame::State::solve_changed() {
  bool found = false;
  for (int c = 0; c < statics.components(); ++c) {
    if (!statics.changed(c)) continue;
    if (solved_nodes[static_cast<std::size_t>(c)] == 0) {
      statics.forget(c);
      continue;
    }
    if (const auto mechanism = statics.solve(c)) {
      if (!swing(c, *mechanism)) release_mechanism(*mechanism);
      found = true;
      continue;
    }
    read_demands(c, false);
    to_check[static_cast<std::size_t>(c)] = 1;
  }
  return found;
}

void StandingFrame::State::read_demands(int c, bool slow) {
  forget_bounds(c);
  const auto set = [&](JointId joint, const Vec6& demand) {
    slow ? joints.set_slow_demand(joint, demand) : joints.set_demand(joint, demand);
  };
  MemberId member_read;
  solver::Vec12 end_forces;
  PanelId panel_read;
  std::array<Vec6, 4> of_edges;
  for (JointId joint : checked_joints[static_cast<std::size_t>(c)]) {
    if (!holds(joint) || label(joint) < 0) continue;
    const Joint& own = building[joint];
    if (own.member.valid()) {
      if (own.member != member_read) end_forces = statics.end_forces(own.member);
      member_read = own.member;
      set(joint, member_joint_demand(end_forces, own.end));
    } else {
      if (own.panel != panel_read) of_edges = edge_demands(own.panel);
      panel_read = own.panel;
      set(joint, of_edges[static_cast<std::size_t>(own.end)]);
    }
  }
}

/// The joints that break next, those of components whose joints yield first: in each segment all that are over capacity
/// and within `same_time` of its largest, in order of id. A segment without any has come to rest: R becomes R0.
std::vector<JointId> StandingFrame::State::next_generation() {
  constexpr double same_time = 1e-6;  // relative; symmetric joints differ by rounding only
  std::vector<JointId> next;
  std::vector<double> largest;
  std::vector<std::pair<JointId, double>> over;
  for (int c = 0; c < statics.components(); ++c) {
    if (!to_check[static_cast<std::size_t>(c)]) continue;
    if (const Way way = follow_yielding(c, next); way == Way::breaking) {
      continue;
    } else if (way == Way::resting) {
      if (!buckles(c)) come_to_rest(c);
      continue;
    }
    largest.assign(static_cast<std::size_t>(segments.labels()), 0.0);
    over.clear();
    const std::vector<JointId>& all = checked_joints[static_cast<std::size_t>(c)];
    for (JointId joint : all) {
      const int segment = label(joint);
      if (segment < 0 || !holds(joint)) continue;
      const double used = joints.check(joint).value;
      if (!(used > 1)) continue;
      over.emplace_back(joint, used);
      largest[static_cast<std::size_t>(segment)] = std::max(largest[static_cast<std::size_t>(segment)], used);
    }
    for (JointId joint : all) {
      const int segment = label(joint);
      if (segment >= 0 && largest[static_cast<std::size_t>(segment)] == 0) joints.accept(joint);
    }
    for (const auto& [joint, used] : over)
      if (used >= (1 - same_time) * largest[static_cast<std::size_t>(label(joint))]) next.push_back(joint);
    if (over.empty() && !buckles(c)) come_to_rest(c);
  }
  std::sort(next.begin(), next.end());
  return next;
}

/// A post of the component gives way sideways in the static answer: it is to break next.
bool StandingFrame::State::buckles(int c) {
  if (!buckling) return false;
  const std::optional<BuckledPost> post = buckling->find(c, statics.diverged(c));
  if (!post || !post->joint.valid()) return false;
  buckled.push_back(*post);
  return true;
}

void StandingFrame::State::snap_buckled() {
  for (const BuckledPost& post : std::exchange(buckled, {})) {
    const std::size_t first = breaks.size();
    break_joint(post.joint, BreakCause::buckling);
    if (breaks.size() == first) continue;
    JointBreak& line = breaks[first];
    line.sense = Sense::compression;
    line.demand = post.compression;
    line.capacity = post.bearable;
    line.position = post.bulge;
  }
}

/// The static answer is borne: R becomes R0.
void StandingFrame::State::come_to_rest(int c) {
  for (JointId joint : checked_joints[static_cast<std::size_t>(c)])
    if (label(joint) >= 0) joints.accept(joint);
  to_check[static_cast<std::size_t>(c)] = 0;
  account.finish(c, false, breaks);
  if (ductile.any(c)) ductile.base_is_answer(c);
}

}  // namespace topple::structure
