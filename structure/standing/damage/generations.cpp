#include "standing/damage/generations.h"

#include <algorithm>

#include "model/index_of.h"
#include "standing/unstable_model.h"
#include "topple/structure/error.h"

namespace topple::structure {

Generations::Generations(const Parts& parts) : to_(parts) {
  const StructuralState& state = to_.state;
  if (state.rules.bracing == BracingRule::buckling)
    buckling_.emplace(state.building, state.statics, state.parts.segments, state.parts.bearings,
                      state.in_solver.member_loads(), state.in_solver.node_loads(), state.in_solver.held_nodes());
}

bool Generations::start() {
  StructuralState& state = to_.state;
  const Building& building = state.building;
  require_anchored();
  state.write_loads();
  for (int c = 0; c < state.statics.components(); ++c) {
    if (const auto mechanism = state.statics.solve(c)) throw UnstableModel(describe_mechanism(building, *mechanism));
    to_.answers.read(c, true);
    to_.yielding.rest(c);
    if (!buckling_) continue;
    if (const std::optional<BuckledPost> post = buckling_->find(c, state.statics.diverged(c)))
      throw UnstableModel(building.file + ": post " + (post->post.valid() ? building[post->post].name : "") +
                          " buckles under combination " + building[state.combination].name +
                          ": the critical factor is " + std::to_string(post->factor));
  }
  state.account.start();
  // Nothing broke to get here: this state is R0.
  return !next().empty();
}

void Generations::require_anchored() {
  const Building& building = to_.state.building;
  const auto floating = to_.state.parts.segments.extract_unanchored();
  if (floating.empty()) return;
  FrameMechanism mechanism;
  mechanism.nodes = floating.front().nodes;
  mechanism.motion.assign(building.nodes.size(), Vec6::Zero());
  for (NodeId node : mechanism.nodes) mechanism.motion[index_of(node)](2) = -1;
  throw UnstableModel(describe_mechanism(building, mechanism) + "; nothing connects them to a support");
}

void Generations::bring_up_to_date() {
  to_.state.parts.forget_numbers();
  do {
    to_.release.release();
    to_.state.write_loads();
  } while (!solve_changed());
}

/// False: a mechanism was found, and its moving part was cut free: it is to be released, and what stands solved again.
bool Generations::solve_changed() {
  StructuralState& state = to_.state;
  bool moves = false;
  for (int c = 0; c < state.statics.components(); ++c) {
    if (!state.statics.changed(c)) continue;
    if (state.in_solver.nodes_of(c) == 0) {
      state.statics.forget(c);
      continue;
    }
    const std::optional<FrameMechanism> mechanism = to_.answers.solve(c);
    solved(c, mechanism);
    moves = moves || mechanism.has_value();
  }
  return !moves;
}

void Generations::solved(int c, const std::optional<FrameMechanism>& mechanism) {
  if (!mechanism)
    to_.state.check_again(c);
  else if (const auto turned_out = to_.yielding.swing(c, *mechanism))
    to_.damage.break_joints(*turned_out, BreakCause::overload);
  else
    to_.release.cut_free(*mechanism);
}

bool Generations::run(int generations) {
  for (;;) {
    const std::vector<JointId> breaking = next();
    if (breaking.empty() && buckled_.empty()) return false;
    if (to_.breaks.generation() == generations) {
      buckled_.clear();  // found again
      return true;
    }
    to_.damage.break_joints(breaking, BreakCause::overload);
    snap_buckled();
    bring_up_to_date();
    to_.breaks.next_generation();
  }
}

/// The joints that break next, in order of id. A component without any rests, unless a post of it buckles.
std::vector<JointId> Generations::next() {
  std::vector<JointId> breaking;
  for (int c = 0; c < to_.state.statics.components(); ++c) {
    if (!to_.state.to_check[static_cast<std::size_t>(c)]) continue;
    const YieldingWay::End end = to_.yielding.follow(c, breaking);
    if (end == YieldingWay::End::resting) rest(c);
    if (end == YieldingWay::End::unyielding) find_overloads(c, breaking);
  }
  std::sort(breaking.begin(), breaking.end());
  return breaking;
}

/// In each segment all that are over capacity and within `same_time` of its largest. A segment without any has come to
/// rest: R becomes R0.
void Generations::find_overloads(int c, std::vector<JointId>& breaking) {
  constexpr double same_time = 1e-6;  // relative; symmetric joints differ by rounding only
  const StandingParts& parts = to_.state.parts;
  JointStates& joints = to_.state.joints;
  std::vector<double> largest(static_cast<std::size_t>(parts.segments.labels()), 0.0);
  std::vector<std::pair<JointId, double>> over;
  for (JointId joint : to_.state.components.joints[static_cast<std::size_t>(c)]) {
    const double used = joints.amplified(joint).value;
    if (!(used > 1 || used > joints.largest(joint))) continue;
    const int segment = parts.label(joint);
    if (segment < 0 || !parts.holds(joint)) continue;
    joints.remember(joint, used);
    if (!(used > 1)) continue;
    over.emplace_back(joint, used);
    largest[static_cast<std::size_t>(segment)] = std::max(largest[static_cast<std::size_t>(segment)], used);
  }
  if (over.empty()) to_.answers.complete(c);
  if (over.empty() || !parts.one_segment(to_.state.statics.members(c))) accept(c, largest);
  for (const auto& [joint, used] : over)
    if (used >= (1 - same_time) * largest[static_cast<std::size_t>(parts.label(joint))]) breaking.push_back(joint);
  if (over.empty()) rest(c);
}

/// R becomes R0 in segments of which nothing is over capacity; `largest`: use of what is, per label.
void Generations::accept(int c, const std::vector<double>& largest) {
  bool moved = false;
  for (JointId joint : to_.state.components.joints[static_cast<std::size_t>(c)]) {
    const int segment = to_.state.parts.label(joint);
    if (segment >= 0 && largest[static_cast<std::size_t>(segment)] == 0)
      moved = to_.state.joints.accept(joint) || moved;
  }
  if (moved) to_.answers.references_moved(c);
}

void Generations::rest(int c) {
  if (!buckles(c)) come_to_rest(c);
}

bool Generations::buckles(int c) {
  if (!buckling_) return false;
  const std::optional<BuckledPost> post = buckling_->find(c, to_.state.statics.diverged(c));
  if (!post || !post->post.valid()) return false;
  buckled_.push_back(*post);
  return true;
}

void Generations::snap_what_buckles(int c) {
  if (buckles(c)) snap_buckled();
}

/// At a joint, or where the post is cut in two.
void Generations::snap_buckled() {
  for (const BuckledPost& post : std::exchange(buckled_, {})) {
    const std::size_t first = to_.breaks.size();
    if (post.joint.valid())
      to_.damage.break_joint(post.joint, BreakCause::buckling);
    else
      to_.release.cut_in_two(post.post, post.inside);
    if (to_.breaks.size() == first) continue;
    JointBreak& line = to_.breaks.lines()[first];
    line.sense = Sense::compression;
    line.demand = post.compression;
    line.capacity = post.bearable;
    if (!line.inside) line.position = post.bulge;
  }
}

void Generations::come_to_rest(int c) {
  to_.answers.complete(c);
  bool moved = false;
  for (JointId joint : to_.state.components.joints[static_cast<std::size_t>(c)])
    if (to_.state.parts.label(joint) >= 0) moved = to_.state.joints.accept(joint) || moved;
  if (moved) to_.answers.references_moved(c);
  to_.state.to_check[static_cast<std::size_t>(c)] = 0;
  to_.state.account.finish(c, false, to_.breaks.lines());
  to_.yielding.rest(c);
}

}  // namespace topple::structure
