// The order in which a random frame fails, against an analysis from scratch after every generation.
#include <catch2/catch.hpp>
#include <numeric>
#include <random>

#include "structure/frame_builder.h"
#include "topple/solver/static_analysis.h"
#include "topple/structure/frame.h"
#include "topple/structure/standing_frame.h"

namespace {

using namespace topple::test;
namespace solver = topple::solver;

/// Everything anew for every state: its own connected components, its own model of what stands, its own factor.
class FromScratch {
 public:
  FromScratch(const Building& building, double sudden)
      : building_(building), sudden_(sudden), holds_(building.joints.size(), true), reference_(building.joints.size()) {
    analyse();
    reference_ = demand_;
  }

  void cut(JointId joint) { holds_[static_cast<std::size_t>(joint.index)] = false; }

  /// Breaks until nothing is over capacity; the joints in order, each generation sorted by id.
  std::vector<JointId> fail() {
    std::vector<JointId> order;
    for (;;) {
      analyse();
      std::vector<double> used(holds_.size(), 0);
      std::map<std::size_t, double> largest;
      for (std::size_t j = 0; j < holds_.size(); ++j) {
        if (!checked(j)) continue;
        const Vec6 demand = reference_[j] + sudden_ * (demand_[j] - reference_[j]);
        used[j] = utilisation(building_.joints[j].capacity, demand).value;
        double& most = largest[segment_[building_.nodes.size() + j / 2]];
        most = std::max(most, used[j]);
      }
      bool any = false;
      for (std::size_t j = 0; j < holds_.size(); ++j) {
        if (!checked(j)) continue;
        const double most = largest[segment_[building_.nodes.size() + j / 2]];
        if (most <= 1) reference_[j] = demand_[j];
        if (used[j] > 1 && used[j] >= (1 - 1e-6) * most) {
          order.push_back(JointId(j));
          any = true;
        }
      }
      if (!any) return order;
      for (const JointId joint : order) cut(joint);
    }
  }

 private:
  bool checked(std::size_t j) const { return holds_[j] && anchored_[segment_[building_.nodes.size() + j / 2]]; }

  void analyse() {
    const std::size_t nodes = building_.nodes.size(), members = building_.members.size();
    std::vector<std::size_t> parent(nodes + members);
    std::iota(parent.begin(), parent.end(), 0u);
    const auto find = [&](std::size_t v) {
      while (parent[v] != v) v = parent[v];
      return v;
    };
    for (std::size_t j = 0; j < 2 * members; ++j)
      if (holds_[j])
        parent[find(nodes + j / 2)] = find(static_cast<std::size_t>(building_.members[j / 2].nodes[j % 2].index));
    anchored_.assign(parent.size(), false);
    for (const NodeSupport& support : building_.supports)
      anchored_[find(static_cast<std::size_t>(support.node.index))] = true;
    segment_.resize(parent.size());
    for (std::size_t v = 0; v < parent.size(); ++v) segment_[v] = find(v);
    solve();
  }

  void solve() {
    // Cantilevers get a node of their own at the broken end, so that no solver feature is shared with the reanalysis.
    const Frame frame = make_frame(building_);
    const PartLoads loads = part_loads(building_, CombinationId(0u));
    solver::FrameModel model;
    solver::LoadSet set;
    std::vector<int> number(building_.nodes.size(), -1), beam_number(building_.members.size(), -1);
    const auto copy = [&](NodeId node) {
      int& n = number[static_cast<std::size_t>(node.index)];
      if (n < 0) {
        n = static_cast<int>(model.nodes.size());
        model.nodes.push_back(building_[node].position);
        set.nodes.push_back({n, loads.nodes[static_cast<std::size_t>(node.index)]});
      }
      return n;
    };
    for (std::size_t m = 0; m < building_.members.size(); ++m) {
      if (!anchored_[segment_[building_.nodes.size() + m]] || !(holds_[2 * m] || holds_[2 * m + 1])) continue;
      solver::Beam beam = frame.model.beams[m];
      for (std::size_t end = 0; end < 2; ++end) {
        if (holds_[2 * m + end]) {
          beam.node[end] = copy(building_.members[m].nodes[end]);
        } else {
          beam.node[end] = static_cast<int>(model.nodes.size());
          model.nodes.push_back(building_[building_.members[m].nodes[end]].position);
        }
      }
      beam_number[m] = static_cast<int>(model.beams.size());
      for (solver::BeamLoad load : loads.members[m]) {
        load.beam = beam_number[m];
        set.beams.push_back(load);
      }
      model.beams.push_back(beam);
    }
    for (const NodeSupport& support : building_.supports)
      if (number[static_cast<std::size_t>(support.node.index)] >= 0)
        model.supports.push_back({number[static_cast<std::size_t>(support.node.index)], support.stiffness});
    demand_.assign(holds_.size(), Vec6::Zero());
    if (model.beams.empty()) return;
    solver::StaticAnalysis analysis(model);
    const auto solution = analysis.solve({&set, 1}).front();
    for (std::size_t j = 0; j < holds_.size(); ++j)
      if (holds_[j] && beam_number[j / 2] >= 0)
        demand_[j] = member_joint_demand(solution.beam_end_forces[static_cast<std::size_t>(beam_number[j / 2])],
                                         static_cast<int>(j % 2));
  }

  const Building& building_;
  double sudden_;
  std::vector<bool> holds_, anchored_;
  std::vector<std::size_t> segment_;
  std::vector<Vec6> reference_, demand_;
};

}  // namespace

TEST_CASE("random frames fail in the order that analyses from scratch give") {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> spread(0.7, 1.6);
  std::size_t broken = 0, left = 0;
  for (int trial = 0; trial < 16; ++trial) {
    FrameBuilder frame = grid_building(3, 2, 3, 5, 3, same_capacity(unlimited), same_capacity(unlimited));
    frame.self_weight(7850);
    for (std::size_t m = 0; m < frame.building.members.size(); ++m)
      if (frame.building.members[m].kind == MemberKind::beam) frame.load(MemberId(m), -4000 * spread(random));
    FailureRules rules;
    rules.bracing = BracingRule::none;
    rules.sudden = trial % 2 ? 2 : 1;
    {
      // Capacities a little above the undamaged demand, different for every joint, so that a loss starts a cascade.
      const StandingFrame sound(frame.building, CombinationId(0u), rules);
      for (std::size_t j = 0; j < frame.building.joints.size(); ++j) {
        if (!frame.building.joints[j].capacity.breakable) continue;
        const Vec6 demand = sound.demand(JointId(j));
        frame.building.joints[j].capacity.value.fill((1.5 + spread(random)) * demand.cwiseAbs().maxCoeff());
      }
    }
    const MemberId post(random() % frame.building.members.size());
    const JointId first = frame.building.joint(post, 0), second = frame.building.joint(MemberId(0u), 0);
    FromScratch expected(frame.building, rules.sudden);
    StandingFrame standing(frame.building, CombinationId(0u), rules);
    REQUIRE_FALSE(standing.pending());
    for (const JointId cut : {first, second}) {
      if (!standing.stands(frame.building[cut].member) || !standing.intact(cut)) continue;
      standing.break_joint(cut, BreakCause::tool);
      expected.cut(cut);
      std::vector<JointId> order;
      for (const JointBreak& one : standing.settle(1000))
        if (one.cause == BreakCause::overload) order.push_back(one.joint);
      INFO("trial " << trial);
      REQUIRE(order == expected.fail());
      broken += order.size();
    }
    for (const Detached& part : standing.extract_detached()) left += part.members.size();
  }
  // The comparison means something only when frames do fail.
  CHECK(broken > 100);
  CHECK(left > 50);
}
