// A standing frame's state as bytes: whoever loads it goes on as the one that was saved, to the bit.
#include <catch2/catch.hpp>
#include <stdexcept>

#include "structure/random_standing.h"
#include "structure/unbraced_rules.h"
#include "topple/structure/error.h"
#include "topple/structure/formats/files.h"
#include "topple/structure/join_shells.h"

using namespace topple::test;

namespace {

/// How often something happened in which a state may differ; tests demand that it did.
struct Seen {
  int saved = 0, in_motion = 0, pending = 0, detached = 0;
};

/// A frame that is never saved, one that is saved now and then, and what loads it from there on. What is otherwise;
/// empty: nothing.
std::string fault_of_states(const StandingStart& start, std::uint64_t seed, int length, Seen& seen) {
  RandomStanding unsaved(start);
  auto saved = std::make_unique<RandomStanding>(start);
  RandomNumbers random(seed);
  for (int n = 0; n < length; ++n) {
    if (random.below(5) == 0) {
      const std::string bytes = saved->saved();
      auto loaded = std::make_unique<RandomStanding>(start);
      loaded->load(*saved, bytes);
      if (saved->saved() != bytes || loaded->saved() != bytes) return "saved twice, the bytes differ";
      ++seen.saved;
      seen.in_motion += saved->frame().in_motion() ? 1 : 0;
      seen.pending += saved->frame().pending() ? 1 : 0;
      seen.detached += saved->frame().has_detached() ? 1 : 0;
      saved = std::move(loaded);
    }
    const bool look = random.below(3) == 0;
    RandomNumbers same(random.bits());
    ToldBits expected, told;
    for (const auto& [one, to] : {std::pair{&unsaved, &expected}, std::pair{saved.get(), &told}}) {
      RandomNumbers own = same;
      one->act(own, *to);
      if (look || n + 1 == length) one->tell(*to);
    }
    if (const std::string fault = told.difference(expected); !fault.empty())
      return "after " + std::to_string(n + 1) + " changes: " + fault;
  }
  return {};
}

/// Portals beside it, apart from all else: components of their own. Panels come last, so it has none.
void add_neighbours(Building& building) {
  if (!building.panels.empty()) return;
  FrameBuilder frame;
  frame.building = building;
  JointCapacity joints = same_capacity(2e5);
  joints.ductility[static_cast<std::size_t>(Sense::moment_y)] = 0.03;
  for (int k = 0; k < 2; ++k) {
    const std::string name = "neighbour-" + std::to_string(k);
    const double x = 100 + 20 * k;
    const NodeId a = frame.node(name + "a", x, 0, 0), b = frame.node(name + "b", x, 0, 4),
                 c = frame.node(name + "c", x + 5, 0, 4), d = frame.node(name + "d", x + 5, 0, 0);
    frame.member(name + "l", MemberKind::post, a, b, joints, joints);
    frame.load(frame.member(name + "m", MemberKind::beam, b, c, joints, joints), -8e3);
    frame.member(name + "r", MemberKind::post, d, c, joints, joints);
    frame.support(a);
    frame.support(d);
  }
  building = frame.building;
}

StandingStart random_start(std::uint64_t seed, bool moves) {
  RandomCollapse collapse = random_collapse(seed);
  add_neighbours(collapse.building);
  StandingStart start{std::move(collapse.building), collapse.scenario.failure, {}};
  RandomNumbers random(seed ^ 0x5aed);
  if (moves) start.motion.emplace();
  if (moves || random.below(3) == 0) start.rules.sudden = 1;
  if (random.below(2) == 0) start.selective_from = 1;
  for (Panel& panel : start.building.panels)
    if (random.below(3) == 0) panel.openings = {{{1, 1}, {2, 1}, {2, 1.5}, {1, 1.5}}};
  return start;
}

/// Histories of many random buildings.
Seen check_histories(bool moves, std::uint64_t first, int count) {
  Seen seen;
  int stood = 0;
  for (std::uint64_t seed = first; seed < first + static_cast<std::uint64_t>(count); ++seed) {
    INFO("seed " << seed);
    try {
      CHECK(fault_of_states(random_start(seed, moves), seed, 60, seen) == "");
      ++stood;
    } catch (const UnstableModel&) {  // as drawn it does not stand
    }
  }
  CHECK(stood > count / 2);
  return seen;
}

/// A wall on its foot, beside a post and another wall, with a beam over it and a third wall on that; edges may break.
const std::string walls_text = R"({"topple": 1, "title": "Walls",
 "materials": {"c": {"youngs_modulus": 30e9, "poisson_ratio": 0.2, "density": 2400, "compressive_strength": 30e6},
               "s": {"youngs_modulus": 210e9, "poisson_ratio": 0.3, "density": 7850}},
 "sections": {"beam": {"shape": "I", "depth": 0.3, "width": 0.2, "web": 0.01, "flange": 0.015},
              "post": {"shape": "box", "depth": 0.3, "width": 0.2, "thickness": 0.015}},
 "joints": {"spring": {"stiffness": {"ry": 2e7}},
            "edge": {"capacity_per_length": {"tension": 6e5, "compression": 5e6, "shear_y": 6e5, "shear_z": 3e5}}},
 "nodes": {"A0": [0, 0, 0], "B0": [6, 0, 0], "C0": [10, 0, 0], "A1": [0, 0, 3], "B1": [6, 0, 3], "C1": [10, 0, 3],
           "A2": [0, 0, 6], "B2": [6, 0, 6]},
 "members": {"PA": {"kind": "post", "nodes": ["A0", "A1"], "section": "post", "material": "s"},
             "PC": {"kind": "post", "nodes": ["C0", "C1"], "section": "post", "material": "s"},
             "AB": {"kind": "beam", "nodes": ["A1", "B1"], "section": "beam", "material": "s",
                    "joints": [null, "spring"]},
             "PB": {"kind": "post", "nodes": ["B2", "B1"], "section": "post", "material": "s"}},
 "panels": {
   "W1": {"kind": "wall", "nodes": ["A0", "B0", "B1", "A1"], "thickness": 0.2, "material": "c", "model": "shell",
          "mesh": [6, 3], "joint": "edge"},
   "W2": {"kind": "wall", "nodes": ["B0", "C0", "C1", "B1"], "thickness": 0.15, "material": "c", "model": "shell",
          "mesh": [3, 2], "joint": "edge"},
   "W3": {"kind": "wall", "nodes": ["A1", "B1", "B2", "A2"], "thickness": 0.12, "material": "c", "model": "shell",
          "mesh": [4, 2], "joint": "edge"}},
 "supports": {"A0": "fixed", "B0": "fixed", "C0": "pinned", "W1:1": "fixed"},
 "loads": {"dead": {"self_weight": 1.0, "panels": {"W1": {"pressure": 2000}},
                    "nodes": {"A2": {"x": 5e4, "y": 3000, "z": -20000}},
                    "members": {"AB": [{"uniform": {"z": -8e3, "y": 500}}]}}}})";

StandingStart walls(bool moves) {
  StandingStart start{parse_model(walls_text, "walls.json", Purpose::demolish), unbraced_rules(), {}};
  join_shells(start.building);
  if (moves) start.motion.emplace();
  return start;
}

}  // namespace

TEST_CASE("A frame that goes from rest to rest goes on from its saved state to the bit, whatever was done to it") {
  const Seen seen = check_histories(false, 1, 60);
  CHECK(seen.saved > 300);
  CHECK(seen.pending > 50);
  CHECK(seen.detached > 20);
}

TEST_CASE("A frame that moves goes on from its saved state to the bit, in motion as at rest") {
  const Seen seen = check_histories(true, 101, 60);
  CHECK(seen.saved > 300);
  CHECK(seen.in_motion > 100);
  CHECK(seen.saved - seen.in_motion > 20);
  CHECK(seen.detached > 20);
}

TEST_CASE("Shell panels that have lost parts and edges go on from their saved state to the bit") {
  for (const bool moves : {false, true}) {
    Seen seen;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      INFO((moves ? "moving, seed " : "seed ") << seed);
      CHECK(fault_of_states(walls(moves), seed, 60, seen) == "");
    }
    CHECK(seen.saved > 100);
    if (moves) CHECK(seen.in_motion > 30);
  }
}

TEST_CASE("The state of a standing frame that breaks off is refused, wherever it does") {
  StandingStart start = random_start(3, true);
  RandomStanding standing(start);
  RandomNumbers random(7);
  ToldBits told;
  for (int n = 0; n < 20; ++n) standing.act(random, told);
  const std::string bytes = standing.saved();
  for (std::size_t cut = 0; cut < 40; ++cut) {
    RandomStanding fresh(start);
    CHECK_THROWS_AS(fresh.load(standing, bytes.substr(0, cut * bytes.size() / 40)), std::runtime_error);
  }
  CHECK_THROWS_AS(RandomStanding(start).load(standing, bytes.substr(0, bytes.size() - 1)), std::runtime_error);
}
