// A standing structure that takes changes: each answer must be the one that a fresh analysis of the changed model
// gives.
#include "topple/solver/reanalysis.h"

#include <catch2/catch.hpp>

#include "frames.h"

using namespace topple::test;

namespace {

std::vector<BeamLoad> weight_of(const FrameModel& model, int beam) {
  const Beam& b = model.beams[static_cast<std::size_t>(beam)];
  const Vec3 down = b.axes * Vec3(0, 0, -4000);
  return {uniform_load(beam, b.length, components(down.x(), down.y(), down.z(), 0, 0, 0))};
}

struct Case {
  FrameModel model = tower(3, 4);
  LoadSet loads;
  Reanalysis standing{model};
  Case() {
    for (int i = 0; i < static_cast<int>(model.beams.size()); ++i) {
      const auto weight = weight_of(model, i);
      standing.set_beam_loads(i, weight);
      loads.beams.insert(loads.beams.end(), weight.begin(), weight.end());
    }
    standing.set_node_load(20, unit(0, 5000));
    loads.nodes = {{20, unit(0, 5000)}};
  }
  /// Largest difference of displacements to a fresh analysis of `model` under `loads`, relative.
  [[nodiscard]] double error() const {
    const StaticSolution fresh = solve_one(model, loads);
    double largest = 0, difference = 0;
    for (std::size_t n = 0; n < model.nodes.size(); ++n) {
      largest = std::max(largest, fresh.displacements[n].norm());
      difference = std::max(difference, (fresh.displacements[n] - standing.displacements()[n]).norm());
    }
    return difference / largest;
  }
};

constexpr double same_answer = 1e-10;  // rounding times the condition of a small frame, 1e5

}  // namespace

TEST_CASE("nothing changed: nothing is computed") {
  Case c;
  REQUIRE(c.standing.solve().stable);
  CHECK(c.error() < same_answer);
  const auto before = c.standing.counters();
  CHECK(c.standing.solve().stable);
  CHECK(c.standing.counters().solves == before.solves);
  CHECK(c.standing.counters().unchanged == before.unchanged + 1);
  CHECK(c.standing.last_operations() == 0);
  // A change that is undone before the solve is none either.
  c.standing.set_node_load(20, unit(0, 5000));
  c.standing.set_beam_loads(3, weight_of(c.model, 3));
  (void)c.standing.solve();
  CHECK(c.standing.counters().solves == before.solves);
}

TEST_CASE("changed loads are solved over the base factor") {
  Case c;
  (void)c.standing.solve();
  const auto before = c.standing.counters();
  c.standing.set_node_load(25, unit(1, 7000));
  c.loads.nodes.push_back({25, unit(1, 7000)});
  c.standing.set_beam_loads(4, {});
  std::erase_if(c.loads.beams, [](const BeamLoad& load) { return load.beam == 4; });
  REQUIRE(c.standing.solve().stable);
  CHECK(c.error() < same_answer);
  CHECK(c.standing.counters().load_solves == before.load_solves + 1);
  CHECK(c.standing.counters().refactorisations == before.refactorisations);
  CHECK(c.standing.counters().low_rank == before.low_rank);
}

TEST_CASE("broken joints, removed and weakened members give the answer of a fresh analysis, and back again") {
  Case c;
  (void)c.standing.solve();
  const std::vector<Vec6> start = c.standing.displacements();
  const FrameModel whole = c.model;
  const LoadSet all_loads = c.loads;

  c.standing.set_end_stiffness(7, 0, Vec6::Zero());
  c.model.beams[7].end_stiffness[0].setZero();
  REQUIRE(c.standing.solve().stable);
  CHECK(c.error() < same_answer);
  CHECK(c.standing.beam_end_forces(7).head<6>().norm() == 0);

  Vec6 spring = fixed();
  spring(4) = 1e6;
  c.standing.set_end_stiffness(9, 1, spring);
  c.model.beams[9].end_stiffness[1] = spring;
  c.standing.set_beam_stiffness_factor(11, 0.25);
  c.model.beams[11].youngs_modulus *= 0.25;
  c.model.beams[11].shear_modulus *= 0.25;
  c.standing.remove_beam(12);
  c.model.beams[12].end_stiffness = {Vec6::Zero(), Vec6::Zero()};
  REQUIRE(c.standing.solve().stable);
  CHECK(c.error() < same_answer);

  c.standing.set_end_stiffness(7, 0, fixed());
  c.standing.set_end_stiffness(9, 1, fixed());
  c.standing.set_beam_stiffness_factor(11, 1);
  c.standing.restore_beam(12);
  c.model = whole;
  REQUIRE(c.standing.solve().stable);
  CHECK(c.error() < same_answer);
  CHECK(c.standing.counters().orderings == 1);
}

TEST_CASE("a mechanism is an answer that names what moves, and dropping it leaves the rest standing") {
  Case c;
  (void)c.standing.solve();
  // The beams that carry the corner node of the roof, and its post: only one pin is left.
  const int corner = static_cast<int>(c.model.nodes.size()) - 1;
  std::vector<int> reaching;
  for (int i = 0; i < static_cast<int>(c.model.beams.size()); ++i) {
    const auto& node = c.model.beams[static_cast<std::size_t>(i)].node;
    if (node[0] == corner || node[1] == corner) reaching.push_back(i);
  }
  REQUIRE(reaching.size() == 3);
  Vec6 pin = fixed();
  pin(4) = 0;
  const auto far_end = [&](int beam) {
    return c.model.beams[static_cast<std::size_t>(beam)].node[1] == corner ? 0 : 1;
  };
  c.standing.set_end_stiffness(reaching[0], far_end(reaching[0]), Vec6::Zero());
  c.standing.set_end_stiffness(reaching[1], far_end(reaching[1]), Vec6::Zero());
  c.standing.set_end_stiffness(reaching[2], far_end(reaching[2]), pin);
  const ReanalysisAnswer& answer = c.standing.solve();
  REQUIRE_FALSE(answer.stable);
  CHECK(answer.mechanism.nodes == std::vector<int>{corner});
  CHECK_THROWS_AS(c.standing.respond(c.loads), Instability);

  c.standing.drop_nodes(std::span(&corner, 1));
  REQUIRE(c.standing.solve().stable);
  CHECK(c.standing.displacements()[static_cast<std::size_t>(corner)].norm() == 0);
  for (int beam : reaching) CHECK(c.standing.beam_end_forces(beam).norm() == 0);
  FrameModel rest = c.model;
  for (int beam : reaching) rest.beams[static_cast<std::size_t>(beam)].end_stiffness = {Vec6::Zero(), Vec6::Zero()};
  rest.supports.push_back({corner, fixed()});
  c.model = rest;
  CHECK(c.error() < same_answer);
}

TEST_CASE("when a part splits off, what stands keeps its factor") {
  const FrameModel whole = tower(4, 12);
  Reanalysis standing(whole);
  LoadSet loads;
  for (int i = 0; i < static_cast<int>(whole.beams.size()); ++i) {
    const auto weight = weight_of(whole, i);
    standing.set_beam_loads(i, weight);
    loads.beams.insert(loads.beams.end(), weight.begin(), weight.end());
  }
  REQUIRE(standing.solve().stable);
  // Two neighbours at the roof's corner, cut from all others: one part with the members that still hold to it.
  const int corner = static_cast<int>(whole.nodes.size()) - 1;
  const auto in_part = [&](int node) { return node == corner || node == corner - 1; };
  FrameModel rest = whole;
  for (int i = 0; i < static_cast<int>(whole.beams.size()); ++i) {
    const auto& node = whole.beams[static_cast<std::size_t>(i)].node;
    if (in_part(node[0]) || in_part(node[1]))
      rest.beams[static_cast<std::size_t>(i)].end_stiffness = {Vec6::Zero(), Vec6::Zero()};
    if (in_part(node[0]) != in_part(node[1])) standing.set_end_stiffness(i, in_part(node[0]) ? 1 : 0, Vec6::Zero());
  }
  std::erase_if(loads.beams, [&](const BeamLoad& load) {
    return rest.beams[static_cast<std::size_t>(load.beam)].end_stiffness[0].isZero(0);
  });
  const ReanalysisAnswer answer = standing.solve();
  REQUIRE_FALSE(answer.stable);
  for (const int node : answer.mechanism.nodes) CHECK(in_part(node));
  const int part[] = {corner - 1, corner};
  standing.drop_nodes(part);
  REQUIRE(standing.solve().stable);
  CHECK(standing.counters().refactorisations == 0);
  for (const int node : part) rest.supports.push_back({node, fixed()});
  const StaticSolution fresh = solve_one(rest, loads);
  const double size = fresh.displacements[static_cast<std::size_t>(corner - 2)].norm();
  for (std::size_t n = 0; n < rest.nodes.size(); ++n)
    CHECK((fresh.displacements[n] - standing.displacements()[n]).norm() < same_answer * size);
}

TEST_CASE("supports can be weakened, taken away and given back") {
  Case c;
  (void)c.standing.solve();
  for (const Vec6& stiffness : {components(1e7, 1e7, 1e8, 1e6, 1e6, 1e6), components(0, 0, 0, 0, 0, 0), fixed()}) {
    c.standing.set_support_stiffness(4, stiffness);
    c.model.supports[4].stiffness = stiffness;
    REQUIRE(c.standing.solve().stable);
    CHECK(c.error() < same_answer);
    const StaticSolution fresh = solve_one(c.model, c.loads);
    CHECK((c.standing.reaction(4) - fresh.reactions[4]).norm() < 1e-9 * fresh.reactions[3].norm());
  }
}

TEST_CASE("a reaction is that of the last answer, whatever load was set on its node since") {
  Case c;
  REQUIRE(c.standing.solve().stable);
  const int node = c.model.supports[4].node;
  c.standing.set_node_load(node, unit(2, -3000));
  const StaticSolution before = solve_one(c.model, c.loads);
  CHECK((c.standing.reaction(4) - before.reactions[4]).norm() < 1e-9 * before.reactions[4].norm());
  c.loads.nodes.push_back({node, unit(2, -3000)});
  REQUIRE(c.standing.solve().stable);
  const StaticSolution after = solve_one(c.model, c.loads);
  CHECK((c.standing.reaction(4) - after.reactions[4]).norm() < 1e-9 * after.reactions[4].norm());
}

TEST_CASE("what is removed, softened, hinged or sprung and restored returns to the same answer") {
  Case c;
  c.model.shells.push_back({{9, 10, 13, 12}, 30e9, 0.2, 0.2, 2400, false});
  Reanalysis standing(c.model);
  for (const BeamLoad& load : c.loads.beams) standing.set_beam_loads(load.beam, {load});
  standing.set_node_load(20, unit(0, 5000));
  REQUIRE(standing.solve().stable);
  const std::vector<Vec6> start = standing.displacements();
  Vec6 hinge = fixed(), spring = fixed();
  hinge(4) = 0;
  spring(5) = 1e6;
  standing.set_end_stiffness(8, 1, hinge);
  standing.set_end_stiffness(21, 0, spring);
  standing.set_beam_stiffness_factor(30, 0.1);
  REQUIRE(standing.solve().stable);
  standing.remove_beam(14);
  standing.remove_shell(0);
  standing.set_node_load(25, unit(1, 3e4));
  REQUIRE(standing.solve().stable);
  double moved = 0, difference = 0, largest = 0;
  for (std::size_t n = 0; n < start.size(); ++n)
    moved = std::max(moved, (start[n] - standing.displacements()[n]).norm());
  // Back in another order than away.
  standing.restore_shell(0);
  standing.set_end_stiffness(8, 1, fixed());
  REQUIRE(standing.solve().stable);
  standing.set_beam_stiffness_factor(30, 1);
  standing.restore_beam(14);
  standing.set_end_stiffness(21, 0, fixed());
  standing.set_node_load(25, Vec6::Zero());
  REQUIRE(standing.solve().stable);
  for (std::size_t n = 0; n < start.size(); ++n) {
    difference = std::max(difference, (start[n] - standing.displacements()[n]).norm());
    largest = std::max(largest, start[n].norm());
  }
  CHECK(moved > 0.01 * largest);
  CHECK(difference <= 1e-12 * largest);
}

TEST_CASE("strain energy equals the work of loads that grow from nothing") {
  Case c;
  (void)c.standing.solve();
  // Clapeyron: half the loads times the displacements where they act, here integrated by Simpson on 200 slices of a
  // quartic: exact to 1e-9.
  double work = 0;
  for (const BeamLoad& load : c.loads.beams) {
    const Beam& b = c.model.beams[static_cast<std::size_t>(load.beam)];
    const int slices = 200;
    for (int i = 0; i <= slices; ++i) {
      const double weight = (i == 0 || i == slices ? 1.0 : (i % 2 == 1 ? 4.0 : 2.0)) * b.length / (3 * slices);
      const Vec3 u = c.standing.point_displacement(load.beam, b.length * i / slices, c.standing.displacements(),
                                                   std::span(&load, 1));
      work += weight * (b.axes * u).dot(Vec3(load.first.head<3>())) / 2;
    }
  }
  work += 5000 * c.standing.displacements()[20](0) / 2;
  CHECK(c.standing.strain_energy() == Approx(work).epsilon(1e-8));
}

TEST_CASE("the response to one more load is that load's alone, and reciprocal") {
  Case c;
  (void)c.standing.solve();
  LoadSet at_node, on_beam;
  at_node.nodes = {{30, unit(1, 1)}};
  on_beam.beams = {point_load(5, 1.3, unit(2, 1))};
  const auto a = c.standing.respond(at_node), b = c.standing.respond(on_beam);
  // Maxwell and Betti: what the node's load moves the beam's point, the point's load moves the node.
  const Vec3 point = c.standing.point_displacement(5, 1.3, a.displacements, {});
  const double along = (c.model.beams[5].axes * point).z();
  CHECK(along == Approx(b.displacements[30](1)).epsilon(1e-9));
  LoadSet both = c.loads;
  both.nodes.push_back(at_node.nodes[0]);
  const StaticSolution together = solve_one(c.model, both);
  CHECK(a.backward_error <= 1e-11);  // what a response is refined to
  const Vec6 sum = c.standing.displacements()[30] + a.displacements[30];
  CHECK((together.displacements[30] - sum).norm() < 1e-10 * sum.norm());
  // End forces add up too: of the member that bears the load and of its neighbour.
  LoadSet with_beam = c.loads;
  with_beam.beams.push_back(on_beam.beams[0]);
  const StaticSolution loaded = solve_one(c.model, with_beam);
  for (int beam : {5, 6}) {
    const Vec12& expected = loaded.beam_end_forces[static_cast<std::size_t>(beam)];
    const Vec12 added = c.standing.beam_end_forces(beam) + c.standing.beam_end_forces(beam, b);
    CHECK((added - expected).norm() < 1e-9 * expected.norm());
  }
}

TEST_CASE(
    "a response leaves out a moment on a node that nothing keeps from turning, as if it had turned out of the way") {
  FrameModel model =
      single_beam(2, components(rigid, rigid, rigid, rigid, rigid, rigid), components(0, rigid, rigid, 0, 0, 0));
  model.beams[0].end_stiffness[1].tail<3>().setZero();
  Reanalysis standing(model);
  REQUIRE(standing.solve().stable);
  LoadSet beside, through;
  beside.nodes = {{1, components(1000, 0, 0, 0, 150, 0)}};  // a contact beside the node
  through.nodes = {{1, components(1000, 0, 0, 0, 0, 0)}};
  const auto a = standing.respond(beside), b = standing.respond(through);
  CHECK(a.displacements[1](0) == Approx(b.displacements[1](0)).epsilon(1e-14));
  CHECK(a.displacements[1].tail<3>().norm() < 1e-14);
  // What lies there for good does turn it.
  standing.set_node_load(1, beside.nodes[0].load);
  CHECK_FALSE(standing.solve().stable);
}

TEST_CASE("responses to several loads at once are those to each alone") {
  Case c;
  (void)c.standing.solve();
  for (int broken = 0; broken < 3; ++broken) {
    std::vector<LoadSet> loads(5);
    loads[0].nodes = {{30, unit(1, 1)}};
    loads[1].beams = {point_load(5, 1.3, unit(2, 1))};
    loads[2].beams = {point_load(7, 0, unit(1, 1))};  // at an end: the other one's node bears nothing
    loads[3].nodes = {{11, unit(0, 2)}, {29, unit(2, -1)}};
    loads[4].beams = {point_load(20, 0.7, unit(0, 1)), point_load(21, 0.2, unit(2, 1))};
    std::vector<char> known;
    const auto together = c.standing.respond(loads), near = c.standing.respond_near(loads, known);
    REQUIRE(together.size() == loads.size());
    for (std::size_t i = 0; i < loads.size(); ++i) {
      const auto alone = c.standing.respond(loads[i]);
      CHECK(together[i].backward_error <= 1e-11);
      double size = 0;
      for (const Vec6& u : alone.displacements) size = std::max(size, u.norm());
      for (std::size_t n = 0; n < alone.displacements.size(); ++n) {
        // Refined to 1e-11 backwards, of a frame whose condition is about 1e5.
        CHECK((together[i].displacements[n] - alone.displacements[n]).norm() < 1e-9 * size);
        if (known[n] != 0) CHECK((near[i].displacements[n] - alone.displacements[n]).norm() < 1e-7 * size);
      }
    }
    for (const LoadSet& set : loads) {
      for (const NodeLoad& load : set.nodes) CHECK(known[static_cast<std::size_t>(load.node)] != 0);
      for (const BeamLoad& load : set.beams)
        for (const int node : c.model.beams[static_cast<std::size_t>(load.beam)].node)
          CHECK(known[static_cast<std::size_t>(node)] != 0);
    }
    c.standing.set_end_stiffness(9 + 8 * broken, 0, Vec6::Zero());
    (void)c.standing.solve();
  }
}

TEST_CASE("removed and restored panels change the answer as a fresh analysis says, and drop with their nodes") {
  FrameModel model = tower(3, 2);
  for (int first : {9, 10, 18}) {
    Shell panel;
    panel.node = {first, first + 1, first + 4, first + 3};
    panel.youngs_modulus = 30e9;
    panel.poisson_ratio = 0.2;
    panel.thickness = 0.2;
    model.shells.push_back(panel);
  }
  Reanalysis standing(model);
  LoadSet loads;
  loads.nodes = {{26, components(2e4, -1e4, -3e4, 0, 0, 0)}};
  standing.set_node_load(26, loads.nodes[0].load);
  const auto agrees = [&](const FrameModel& expected) {
    REQUIRE(standing.solve().stable);
    const StaticSolution fresh = solve_one(expected, loads);
    const double size = fresh.displacements[26].norm();
    for (std::size_t n = 0; n < expected.nodes.size(); ++n) {
      CHECK((fresh.displacements[n] - standing.displacements()[n]).norm() < same_answer * size);
    }
    double work = standing.displacements()[26].dot(loads.nodes[0].load) / 2;
    CHECK(standing.strain_energy() == Approx(work).epsilon(1e-9));
  };
  agrees(model);
  standing.remove_shell(1);
  FrameModel without = model;
  without.shells.erase(without.shells.begin() + 1);
  agrees(without);
  CHECK(standing.shell_corner_forces(1)[0].norm() == 0);
  standing.restore_shell(1);
  agrees(model);
}

TEST_CASE("supports of a floor that is rigid in its plane can be weakened and given back") {
  FrameModel model = tower(2, 2);
  model.diaphragms.push_back({{4, 5, 6, 7}});
  model.supports.push_back({5, components(2e6, 0, 3e6, 0, 0, 0)});
  Reanalysis standing(model);
  LoadSet loads;
  loads.nodes = {{6, components(2e4, -1e4, -3e4, 0, 0, 0)}};
  standing.set_node_load(6, loads.nodes[0].load);
  for (const double stiffness : {2e6, 1e9, 0.0, 2e6}) {
    model.supports.back().stiffness = components(stiffness, 0, stiffness, 0, 0, 0);
    standing.set_support_stiffness(static_cast<int>(model.supports.size()) - 1, model.supports.back().stiffness);
    REQUIRE(standing.solve().stable);
    const StaticSolution fresh = solve_one(model, loads);
    for (std::size_t n = 0; n < model.nodes.size(); ++n)
      CHECK((fresh.displacements[n] - standing.displacements()[n]).norm() <
            same_answer * fresh.displacements[6].norm());
  }
}

TEST_CASE(
    "a correction that leaves hardly any stiffness warns, and below the limit it is a mechanism, as a fresh analysis") {
  // A portal whose four joints become hinges with weaker and weaker springs: it sways more and more easily.
  const auto portal = [] {
    FrameModel model;
    model.nodes = {Vec3(0, 0, 0), Vec3(0, 0, 3), Vec3(5, 0, 3), Vec3(5, 0, 0)};
    add_beam(model, 0, 1);
    add_beam(model, 1, 2);
    add_beam(model, 2, 3);
    model.supports = {{0, fixed()}, {3, fixed()}};
    for (const int node : {1, 2}) model.supports.push_back({node, components(0, rigid, 0, rigid, 0, rigid)});
    return model;
  };
  LoadSet loads;
  loads.nodes = {{1, unit(0, 1)}};
  int firm = 0, warned = 0, mechanisms = 0;
  for (double spring = 1e6; spring > 1e-9; spring /= 10) {
    Reanalysis standing(portal());
    standing.set_node_load(1, unit(0, 1));
    REQUIRE(standing.solve().stable);
    CHECK_FALSE(standing.solve().nearly_unstable);
    FrameModel changed = portal();
    for (const int post : {0, 2}) {
      for (int end = 0; end < 2; ++end) {
        const Vec6 hinge = components(rigid, rigid, rigid, rigid, spring, rigid);
        changed.beams[static_cast<std::size_t>(post)].end_stiffness[static_cast<std::size_t>(end)] = hinge;
        standing.set_end_stiffness(post, end, hinge);
      }
    }
    const ReanalysisAnswer answer = standing.solve();
    INFO("spring " << spring);
    bool stable = true, nearly = false;
    try {
      StaticAnalysis fresh(changed);
      const StaticSolution solution = fresh.solve(std::span(&loads, 1)).front();
      nearly = fresh.statistics().nearly_unstable;
      if (answer.stable)
        CHECK((solution.displacements[1] - standing.displacements()[1]).norm() <
              std::max(1e-10, 10 * solution.quality.condition * 1e-16) * solution.displacements[1].norm());
    } catch (const Instability&) {
      stable = false;
    }
    // The two measure the same smallest stiffness by other norms: a decade at the borders of the band is left to them.
    if (stable && !nearly) CHECK(answer.stable);
    if (!stable) CHECK((!answer.stable || answer.nearly_unstable));
    if (!answer.stable) {
      CHECK(answer.mechanism.nodes.size() == 2);
      CHECK(std::abs(answer.mechanism.motion[1](0)) == Approx(1).epsilon(1e-6));
    }
    firm += answer.stable && !answer.nearly_unstable ? 1 : 0;
    warned += answer.stable && answer.nearly_unstable ? 1 : 0;
    mechanisms += answer.stable ? 0 : 1;
  }
  CHECK(firm >= 5);
  CHECK(warned >= 2);
  CHECK(mechanisms >= 2);
}

TEST_CASE("the warning of a nearly unstable structure comes back with what caused it") {
  // The posts of one storey of a tall frame become hinges with weak springs, at both ends and both ways.
  const FrameModel model = tower(3, 20);
  std::vector<int> posts;
  for (int i = 0; i < static_cast<int>(model.beams.size()); ++i) {
    const auto& node = model.beams[static_cast<std::size_t>(i)].node;
    if (node[0] / 9 == 10 && node[1] - node[0] == 9) posts.push_back(i);
  }
  REQUIRE(posts.size() == 9);
  const auto hinge = [&](Reanalysis& standing, double spring) {
    for (const int post : posts)
      for (int end = 0; end < 2; ++end)
        standing.set_end_stiffness(post, end, components(rigid, rigid, rigid, rigid, spring, spring));
  };
  const auto stand = [&] {
    Reanalysis standing(model);
    standing.set_node_load(180, unit(0, 1000));
    const ReanalysisAnswer& answer = standing.solve();
    REQUIRE(answer.stable);
    REQUIRE_FALSE(answer.nearly_unstable);
    return standing;
  };
  // The first of weaker and weaker springs that is warned of: well above a mechanism, and found by the correction.
  double spring = 40;
  for (bool warned = false; !warned;) {
    spring /= 1.1;
    REQUIRE(spring > 1);
    Reanalysis trial = stand();
    hinge(trial, spring);
    REQUIRE(trial.solve().stable);
    warned = trial.solve().nearly_unstable;
  }
  Reanalysis standing = stand();
  for (int round = 0; round < 3; ++round) {
    INFO("round " << round);
    hinge(standing, spring);
    CHECK(standing.solve().nearly_unstable);
    hinge(standing, rigid);
    CHECK_FALSE(standing.solve().nearly_unstable);
  }
  CHECK(standing.counters().refactorisations == 0);
  // The two measure the same smallest stiffness by other norms: half a decade is left to them.
  FrameModel changed = model;
  for (const int post : posts)
    changed.beams[static_cast<std::size_t>(post)].end_stiffness.fill(
        components(rigid, rigid, rigid, rigid, spring / 5, spring / 5));
  LoadSet loads;
  loads.nodes = {{180, unit(0, 1000)}};
  StaticAnalysis fresh(changed);
  (void)fresh.solve(std::span(&loads, 1));
  CHECK(fresh.statistics().nearly_unstable);
}
