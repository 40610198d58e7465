// Members lost one at a time: the state after each loss is R0 + f (R1 - R0), where R1 comes from another way to it.
#include "topple/structure/losses.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "example_model.h"
#include "frame_builder.h"
#include "topple/structure/analysis.h"
#include "topple/structure/error.h"
#include "topple/structure/formats/files.h"
#include "topple/structure/scenario.h"
#include "topple/structure/standing_frame.h"

using namespace topple::structure;
using namespace topple::test;

namespace {

Building strong(const std::string& model) {
  Building building = read_model(find_model(model));
  for (Joint& joint : building.joints)
    for (double& value : joint.capacity.value) value *= 100;
  return building;
}

MemberId member(const Building& building, const std::string& name) {
  const auto found = NameIndex(building).member(name);
  REQUIRE(found);
  return *found;
}

LossResult losses(const Building& building, const std::vector<MemberId>& named, double sudden,
                  const std::vector<MemberId>& each = {}) {
  return find_losses(building, {CombinationId(0u)}, {.named = named, .each = each, .sudden = sudden, .motion = {}}, {});
}

/// Two portals beside each other that share the middle post; beams hold at both ends.
struct Portals {
  FrameBuilder frame;
  MemberId left, middle, right, beam_1, beam_2;
  explicit Portals(double capacity) {
    const NodeId a = frame.node("A", 0, 0, 0), b = frame.node("B", 6, 0, 0), c = frame.node("C", 12, 0, 0);
    const NodeId d = frame.node("D", 0, 0, 4), e = frame.node("E", 6, 0, 4), f = frame.node("F", 12, 0, 4);
    const JointCapacity joint = same_capacity(capacity);
    left = frame.member("left", MemberKind::post, a, d, joint);
    middle = frame.member("middle", MemberKind::post, b, e, joint);
    right = frame.member("right", MemberKind::post, c, f, joint);
    beam_1 = frame.member("beam 1", MemberKind::beam, d, e, joint, joint);
    beam_2 = frame.member("beam 2", MemberKind::beam, e, f, joint, joint);
    for (const NodeId node : {a, b, c}) frame.support(node);
    frame.load(beam_1, -10e3);
    frame.load(beam_2, -10e3);
  }
};

}  // namespace

TEST_CASE("the static state after a loss is the one in which a collapse finds the structure") {
  // A post under a wall and slabs, a beam that bears slabs, and a post of the top: the collapse simulation removes them
  // by its own way (segments, bearings, energy accounts); its joints are strong enough not to break.
  const Building building = strong("seed_building");
  for (const std::string name : {"P-2-2-1", "P-1-1-3", "BX-1-1-2", "BY-2-2-4", "P-4-5-6"}) {
    INFO(name);
    const MemberId lost = member(building, name);
    const LossResult result = losses(building, {lost}, 1);
    REQUIRE(result.losses.size() == 1);
    const LossState& state = result.losses[0].states.at(0);
    REQUIRE(state.stands());
    FailureRules rules;
    rules.bracing = BracingRule::none;
    rules.sudden = 1;
    StandingFrame standing(building, CombinationId(0u), rules);
    standing.remove(lost);
    CHECK(standing.settle(1).empty());
    std::size_t holding = 0;
    double difference = 0, largest = 0;
    for (std::size_t j = 0; j < building.joints.size(); ++j)
      holding += building.joints[j].capacity.breakable && standing.intact(JointId(j)) ? 1 : 0;
    for (const auto& [joint, used] : state.joints) {
      REQUIRE(standing.intact(joint));
      const double expected = standing.utilisation(joint).value;
      difference = std::max(difference, std::abs(used.value - expected));
      largest = std::max(largest, expected);
    }
    CHECK(state.joints.size() == holding);
    CHECK(difference < 1e-8 * largest);  // rounding times the condition of the building, about 1e6
    CHECK(state.utilisation.value == Approx(largest));
    CHECK(state.end_forces.size() + 1 == building.members.size());
  }
}

TEST_CASE("a loss is found by correction, once for each, and leaves no trace in the next") {
  const Building building = strong("seed_building");
  const std::vector<MemberId> posts = NameIndex(building).group("posts")->members;
  const LossResult all = losses(building, {}, 2, posts);
  REQUIRE(all.losses.size() == posts.size());
  CHECK(all.counters.orderings == 1);
  CHECK(all.counters.refactorisations == 0);
  // Once as it stands, and again before each further sixteen, which are found together.
  CHECK(all.counters.solves == posts.size() + 1 + (posts.size() - 1) / 16);
  for (std::size_t k = 0; k + 1 < all.losses.size(); ++k)
    CHECK(all.losses[k].states[0].utilisation.value >= all.losses[k + 1].states[0].utilisation.value);
  for (const std::size_t k : {std::size_t{0}, posts.size() / 2, posts.size() - 1}) {
    const MemberLoss& loss = all.losses[k];
    CHECK(loss.states[0].displacements.empty());
    const LossResult alone = losses(building, {loss.member}, 2);
    CHECK(alone.losses[0].states[0].utilisation.value == Approx(loss.states[0].utilisation.value).epsilon(1e-9));
  }
}

TEST_CASE("sudden loss swings past the static state by the factor") {
  Portals p(1e9);
  const auto use = [&](double sudden) { return losses(p.frame.building, {p.middle}, sudden).losses[0].states[0]; };
  const LossState still = use(1), swung = use(2);
  const LossState before = losses(p.frame.building, {p.right}, 1).losses[0].states[0];
  CHECK(before.stands());
  // By hand: R0 is half of the way from the swing at f = 2 to ... R = 2 R1 - R0, so R0 = 2 R1 - R(2) for each node.
  AnalysisRequest request;
  const AnalysisResult whole = analyse(p.frame.building, request);
  for (std::size_t n = 0; n < still.displacements.size(); ++n) {
    const Vec6 expected = 2 * still.displacements[n] - whole.combinations[0].displacements[n];
    CHECK((swung.displacements[n] - expected).norm() < 1e-12 * (still.displacements[n].norm() + 1e-6));
  }
  // The span is doubled: the middle goes down.
  CHECK(still.displacements[4](2) < 10 * whole.combinations[0].displacements[4](2));
}

TEST_CASE("a loss that leaves a mechanism names what moves, and the next loss is found all the same") {
  FrameBuilder frame;
  const NodeId a = frame.node("A", 0, 0, 0), b = frame.node("B", 0, 0, 3), c = frame.node("C", 4, 0, 3);
  const NodeId d = frame.node("D", 8, 0, 3), e = frame.node("E", 8, 0, 0);
  const MemberId post = frame.member("post", MemberKind::post, a, b);
  const MemberId inner = frame.member("inner", MemberKind::beam, b, c, same_capacity(1e6));
  const MemberId outer = frame.member("outer", MemberKind::beam, c, d);
  const MemberId other = frame.member("other", MemberKind::post, e, d);
  frame.support(a);
  frame.support(e);
  frame.load(inner, -1e3);
  frame.load(outer, -1e3);
  // Hinges at both ends of the outer beam: without the other post, nothing keeps it from swinging.
  for (int end = 0; end < 2; ++end) frame.building.joints[2 * 2 + static_cast<std::size_t>(end)].stiffness(4) = 0;
  const LossResult result = losses(frame.building, {post, inner, outer, other}, 2);
  REQUIRE(result.losses.size() == 4);
  const auto of = [&](MemberId lost) -> const LossState& {
    for (const MemberLoss& loss : result.losses)
      if (loss.member == lost) return loss.states[0];
    throw std::logic_error("the loss is missing");
  };
  CHECK_FALSE(of(other).stands());
  CHECK(of(other).mechanism.find("node D moves") != std::string::npos);
  CHECK_FALSE(of(post).stands());
  // The post's foot is left without any member: that is no mechanism. Nor is the end of a beam whose neighbour left.
  REQUIRE(of(outer).stands());
  CHECK(of(outer).worst == frame.building.joint(inner, 0));
  // What is left is a cantilever of 4 m under 1 kN/m.
  CHECK(losses(frame.building, {outer}, 1).losses[0].states[0].utilisation.demand == Approx(8e3));
  CHECK_FALSE(of(inner).stands());
}

TEST_CASE("what losses do not go with is refused by name") {
  Building tie = Portals(1).frame.building;
  tie.members[3].axial = AxialAction::tension;
  const std::vector<MemberId> first{MemberId(0u)};
  CHECK_THROWS_WITH(losses(tie, first, 2), Catch::Contains("beam 1") && Catch::Contains("accepted"));
  AnalysisRequest request;
  request.losses.named = first;
  request.second_order = topple::solver::SecondOrder::exact;
  CHECK_THROWS_AS(analyse(Portals(1).frame.building, request), InputError);
}

TEST_CASE("losses are written as the format has them, in the model's units") {
  const std::string text = replaced(replaced(R"({"topple": 1, UNITS
    "materials": {"steel": {"youngs_modulus": MODULUS, "poisson_ratio": 0.3}},
    "sections": {"s": {"area": 0.01, "Iy": 2e-4, "Iz": 3e-5, "J": 5e-6}},
    "joints": {"j": {"capacity": {"moment_y": 50}}},
    "nodes": {"A": [0, 0, 0], "B": [0, 0, 3], "C": [4, 0, 3], "D": [4, 0, 0]},
    "members": {"P": {"kind": "post", "nodes": ["A", "B"], "section": "s", "material": "steel"},
                "Q": {"kind": "post", "nodes": ["D", "C"], "section": "s", "material": "steel"},
                "R": {"nodes": ["B", "C"], "section": "s", "material": "steel", "joints": ["j", "j"]}},
    "supports": {"A": "fixed", "D": "fixed"}, "loads": {"dead": {"nodes": {"C": {"z": -10}}}}})",
                                             "UNITS", R"("units": {"force": "kN"},)"),
                                    "MODULUS", "2e8");
  const Building building = parse_model(text, "portal.json");
  AnalysisRequest request;
  request.losses.named = {member(building, "Q")};
  request.losses.each = {member(building, "P"), member(building, "R")};
  const auto json = nlohmann::json::parse(results_json(building, request, analyse(building, request), {}));
  const auto& lost = json.at("losses").at("Q").at("dead");
  // A cantilever of 4 m with 10 kN at its end, which the post bore before: close to 2 (40) kN m.
  CHECK(lost.at("worst").at("joint") == "R:1");
  CHECK(lost.at("worst").at("utilisation").get<double>() == Approx(80 / 50.0).epsilon(0.02));
  CHECK(lost.at("survives") == false);
  CHECK(lost.at("members").at("R").at("end_forces").size() == 12);
  CHECK_FALSE(lost.at("members").contains("Q"));
  CHECK(lost.at("displacements").at("C").size() == 6);
  CHECK(json.at("losses").at("P").at("dead").at("joints").empty());
  CHECK(json.at("losses").at("R").at("dead").at("survives") == true);
}
