// Collapses whose answers are brought up to date only where a joint may break next, against the same with whole ones.
#include <catch2/catch.hpp>
#include <functional>
#include <random>

#include "structure/frame_builder.h"
#include "topple/structure/standing_frame.h"

namespace {

using namespace topple::test;

/// Four by three posts, four storeys, membrane walls on one side, loads drawn at random.
Building random_building(std::mt19937& random) {
  std::uniform_real_distribution<double> spread(0.7, 1.6);
  FrameBuilder frame = grid_building(4, 3, 4, 5, 3, same_capacity(unlimited), same_capacity(unlimited));
  frame.self_weight(7850);
  for (std::size_t m = 0; m < frame.building.members.size(); ++m)
    if (frame.building.members[m].kind == MemberKind::beam) frame.load(MemberId(m), -4000 * spread(random));
  const auto at = [](std::size_t i, std::size_t k) { return NodeId(k * 12 + i); };
  for (std::size_t k = 0; k < 4; ++k)
    frame.panel("wall-" + std::to_string(k), PanelModel::membrane, {at(1, k), at(2, k), at(2, k + 1), at(1, k + 1)},
                same_capacity(unlimited));
  return frame.building;
}

/// A little above what each joint bears undamaged, different for every one, so that a loss starts a cascade.
void make_brittle(Building& building, const FailureRules& rules, std::mt19937& random) {
  std::uniform_real_distribution<double> spread(1.8, 3.2);
  const StandingFrame sound(building, CombinationId(0u), rules);
  for (std::size_t j = 0; j < building.joints.size(); ++j) {
    if (!building.joints[j].capacity.breakable) continue;
    const Vec6 demand = sound.demand(JointId(j));
    building.joints[j].capacity.value.fill(spread(random) * std::max(1.0, demand.cwiseAbs().maxCoeff()));
  }
}

struct Collapse {
  std::vector<JointBreak> breaks;
  std::size_t left = 0;
  std::vector<double> used, largest;
  FrameEnergy energy;
  std::uint64_t selective = 0;  ///< answers
};

/// `look`: called after each step.
Collapse collapse(const Building& building, const FailureRules& rules, int selective_from,
                  const std::vector<JointId>& cuts, const std::function<void(const StandingFrame&)>& look = {}) {
  StandingFrame frame(building, CombinationId(0u), rules);
  frame.restrict_answers_from(selective_from);
  Collapse result;
  for (const JointId cut : cuts) {
    if (!frame.stands(building[cut].member) || !frame.intact(cut)) continue;
    frame.break_joint(cut, BreakCause::tool);
    // A few generations at a time, as in the steps of a simulation.
    while (frame.pending()) {
      for (const JointBreak& one : frame.settle(3)) result.breaks.push_back(one);
      if (look) look(frame);
    }
  }
  for (const Detached& part : frame.extract_detached()) result.left += part.members.size();
  for (std::size_t j = 0; j < building.joints.size(); ++j) {
    result.used.push_back(frame.utilisation(JointId(j)).value);
    result.largest.push_back(frame.largest_utilisation_so_far(JointId(j)));
  }
  result.energy = frame.energy();
  result.selective = frame.counters().selective;
  return result;
}

/// A random building that fails when three of its joints are cut; every other trial counts on sudden losses.
struct Trial {
  FailureRules rules;
  Building building;
  std::vector<JointId> cuts;
};

Trial brittle_trial(int number, std::mt19937& random) {
  Trial trial;
  trial.rules.bracing = BracingRule::none;
  trial.rules.sudden = number % 2 ? 2 : 1;
  trial.building = random_building(random);
  make_brittle(trial.building, trial.rules, random);
  for (int cut = 0; cut < 3; ++cut) {
    const MemberId member(random() % trial.building.members.size());
    trial.cuts.push_back(trial.building.joint(member, 0));
  }
  return trial;
}

}  // namespace

TEST_CASE("selective answers break the same joints in the same order as whole ones") {
  std::mt19937 random(23);
  std::size_t broken = 0, left = 0;
  int differing_work = 0;
  for (int trial = 0; trial < 24; ++trial) {
    const Trial own = brittle_trial(trial, random);
    const FailureRules& rules = own.rules;
    const Building& building = own.building;
    const std::vector<JointId>& cuts = own.cuts;
    const Collapse whole = collapse(building, rules, std::numeric_limits<int>::max(), cuts);
    const Collapse selective = collapse(building, rules, 0, cuts);
    INFO("trial " << trial);
    REQUIRE(selective.breaks.size() == whole.breaks.size());
    for (std::size_t i = 0; i < whole.breaks.size(); ++i) {
      REQUIRE(selective.breaks[i].joint == whole.breaks[i].joint);
      CHECK(selective.breaks[i].cause == whole.breaks[i].cause);
      // Both are refined to rounding; the frame's condition (1e5 to 1e7) stands between that and the demand.
      CHECK(selective.breaks[i].demand == Approx(whole.breaks[i].demand).epsilon(1e-8));
    }
    CHECK(selective.left == whole.left);
    for (std::size_t i = 0; i < whole.used.size(); ++i) {
      CHECK(selective.used[i] == Approx(whole.used[i]).epsilon(1e-7).margin(1e-9));
      // What a joint bore in between, where it could not break, may not have been looked at.
      CHECK(selective.largest[i] <= whole.largest[i] * (1 + 1e-7) + 1e-9);
      CHECK(selective.largest[i] >= selective.used[i] * (1 - 1e-12));
    }
    CHECK(selective.energy.elastic == Approx(whole.energy.elastic).epsilon(1e-8));
    CHECK(selective.energy.freed == Approx(whole.energy.freed).epsilon(1e-7));
    differing_work += selective.selective > whole.selective ? 1 : 0;
    broken += whole.breaks.size();
    left += whole.left;
  }
  // The comparison means something only when frames do fail, and answers were selective.
  CHECK(broken > 150);
  CHECK(left > 100);
  CHECK(differing_work > 5);
}

TEST_CASE("who looks on at a collapse changes no bit of it") {
  std::mt19937 random(7);
  int looked_on = 0;
  for (int trial = 0; trial < 8; ++trial) {
    const Trial own = brittle_trial(trial, random);
    const FailureRules& rules = own.rules;
    const Building& building = own.building;
    const std::vector<JointId>& cuts = own.cuts;
    const auto look = [&](const StandingFrame& frame) {
      looked_on += frame.pending() ? 1 : 0;
      double sum = 0;
      for (std::size_t j = 0; j < building.joints.size(); ++j)
        sum += frame.utilisation(JointId(j)).value + frame.demand(JointId(j)).norm();
      for (std::size_t m = 0; m < building.members.size(); ++m) sum += frame.end_forces(MemberId(m)).norm();
      for (const NodeSupport& support : building.supports) sum += frame.reaction(support.node).norm();
      CHECK(std::isfinite(sum));
    };
    const Collapse alone = collapse(building, rules, 0, cuts), seen = collapse(building, rules, 0, cuts, look);
    INFO("trial " << trial);
    REQUIRE(seen.breaks.size() == alone.breaks.size());
    for (std::size_t i = 0; i < alone.breaks.size(); ++i) {
      CHECK(seen.breaks[i].joint == alone.breaks[i].joint);
      CHECK(seen.breaks[i].demand == alone.breaks[i].demand);
      CHECK(seen.breaks[i].energy == alone.breaks[i].energy);
    }
    CHECK(seen.used == alone.used);
    CHECK(seen.energy.freed == alone.energy.freed);
  }
  CHECK(looked_on > 20);
}
