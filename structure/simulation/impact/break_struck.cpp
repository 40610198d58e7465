// What breaks and turns in an impact of bodies: joints that fail, the pieces that are left, hinges that stay turned.
#include <algorithm>

#include "simulation/impact/body_impacts.h"

namespace topple::structure {

namespace {

/// How far the unloaded places lie behind after a break. What is left stiffer holds the force that it had: the rest of
/// the way belonged to what came off. What is left softer is pressed as far as it was.
Eigen::VectorXd shift_of_break(const Eigen::MatrixXd& before, const Eigen::MatrixXd& after,
                               const Eigen::VectorXd& force) {
  const bool stiffer = force.dot(after * force) < force.dot(before * force);
  return stiffer ? Eigen::VectorXd((before - after) * force) : Eigen::VectorXd(Eigen::VectorXd::Zero(force.size()));
}

}  // namespace

/// What hinges of joints that are about to break took.
void BodyImpacts::account_turns_of(const std::vector<JointBreak>& broken, const YieldingPush& yielding) {
  std::vector<StandingFrame::ImpactTurn> turns;
  for (StandingFrame::ImpactTurn turn : yielding.joints.turns()) {
    turn.turned = 0;
    if (std::any_of(broken.begin(), broken.end(), [&](const JointBreak& one) { return one.joint == turn.joint; }))
      turns.push_back(turn);
  }
  account_turns(turns, yielding);
}

/// The impact is over: rotations stay, and what they took was lost in the impact. No more than that: what the struck
/// nodes took up is theirs, and turns hinges as they move.
void BodyImpacts::keep_turns(const YieldingPush& yielding) { account_turns(yielding.joints.left(), yielding); }

void BodyImpacts::account_turns(std::vector<StandingFrame::ImpactTurn> turns, const YieldingPush& yielding) {
  if (turns.empty()) return;
  const double work = yielding.joints.work(turns),
               lost = std::max(0.0, sums_.ledger.lost_in_impacts - yielding.lost_before);
  if (work > lost)
    for (StandingFrame::ImpactTurn& turn : turns) {
      turn.turned *= lost / work;
      turn.dissipated *= lost / work;
    }
  sums_.ledger.lost_in_impacts -= scene_.frame->turn_in_impact(turns);
}

/// Joints of the frame break there as well. Returns the lines of the events.
std::vector<std::size_t> BodyImpacts::record_breaks(const std::vector<JointBreak>& broken) {
  std::vector<std::size_t> lines;
  std::vector<JointBreak> of_frame;
  for (const JointBreak& one : broken) {
    JointBreak line = one;
    const collision::BodyId id{debris_.body_of(one.joint)};
    if (id.value < 0) {
      line.position = scene_.joint_position(one.joint);
      of_frame.push_back(one);
      lines.push_back(log_.size());
      log_.record(line);
      continue;
    }
    break_up_.lose(one.joint);
    const collision::BodyState state = scene_.world->state(id);
    line.position = state.pose * (scene_.joint_position(one.joint) - debris_.bodies.at(id.value).rest.centre);
    lines.push_back(log_.size());
    log_.record(line);
  }
  if (!of_frame.empty()) scene_.frame->break_in_impact(of_frame);
  return lines;
}

/// Sides that lost joints are the pieces that were hit. False: a piece is no body.
bool BodyImpacts::fall_apart(BodyImpact& impact, const std::vector<JointBreak>& broken) {
  for (ImpactSide& side : impact.sides) {
    if (side.id.value < 0) continue;
    const bool of_this = std::any_of(broken.begin(), broken.end(), [&](const JointBreak& one) {
      return debris_.body_of(one.joint) == side.id.value;
    });
    if (!of_this) continue;
    break_up_.forget(side.id);
    (void)break_up_.come_apart(side.id);
    const std::int64_t piece = debris_.body_of_part[static_cast<std::size_t>(side.tags.front())];
    if (!debris_.bodies.contains(piece)) return false;
    side = side_again(side, {piece});
  }
  return true;
}

/// These joints fail; bodies fall apart, and the push goes on with the pieces that touch. False: it is over.
bool BodyImpacts::break_joints(BodyImpact& impact, Impact& push, YieldingPush& yielding,
                               const std::vector<JointBreak>& broken) {
  if (yielding.joints.any()) {
    yielding.joints.hold();
    yielding.lay(push);
  }
  const double stored = push.stored();
  const Eigen::MatrixXd compliance = impact.compliance;
  const Eigen::VectorXd force = push.force().head(compliance.rows());
  const ImpactSide before_break = impact.sides[1];
  const Eigen::VectorXd moved = push.indentation().tail(before_break.mode_compliance.size()),
                        moving = push.closing_speed().tail(before_break.mode_compliance.size());
  const std::vector<std::size_t> lines = record_breaks(broken);
  std::vector<int> kept;
  if (!fall_apart(impact, broken)) return false;
  const auto holds = [&](const ImpactSide& side, std::size_t place) {
    if (side.held) return scene_.stands(part_of_number(scene_.building, side.tags[place]));
    return side.id.value < 0 || side.tags[place] < 0 ||
           debris_.body_of_part[static_cast<std::size_t>(side.tags[place])] == side.id.value;
  };
  for (std::size_t i = 0; i < impact.places.size(); ++i)
    if (push.may_touch(i) && holds(impact.sides[0], i) && holds(impact.sides[1], i))
      kept.push_back(static_cast<int>(i));
  double left = 0;
  bool goes_on = !kept.empty();
  if (goes_on) {
    impact.keep(kept);
    push.keep(kept);
    yielding.keep(kept);
    goes_on = prepare_push(impact);
  }
  if (goes_on) {
    const std::vector<int> apart = independent_places(impact.compliance);
    impact.keep(apart);
    push.keep(apart);
    yielding.keep(apart);
    Eigen::MatrixXd before = compliance(kept, kept);
    Eigen::VectorXd pressed = force(kept);
    before = Eigen::MatrixXd(before(apart, apart));
    pressed = Eigen::VectorXd(pressed(apart));
    const Eigen::Index n = impact.compliance.rows();
    push.change(impact.followed_mobility().topLeftCorner(n, n), impact.compliance,
                shift_of_break(before, impact.compliance, pressed));
    if (impact.sides[1].held)
      push.bind(impact.followed_mobility(), impact.followed_compliance(),
                carried_over(before_break, moved, impact.sides[1]),
                carried_over(before_break, moving, impact.sides[1]));
    yielding.renew(impact, push);
    left = push.stored();
  }
  for (const std::size_t line : lines)
    log_[line].joint.energy = std::max(0.0, stored - left) / static_cast<double>(lines.size());
  return goes_on;
}

}  // namespace topple::structure
