// Membranes with openings from the start: what they bear, what they weigh, and what flies through.
#include <catch2/catch.hpp>
#include <cmath>

#include "standing/panel_superelement.h"
#include "topple/structure/analysis.h"
#include "topple/structure/formats/files.h"
#include "topple/structure/simulation.h"

using namespace topple::structure;

namespace {

/// One storey of four posts and beams, 6 m x 6 m, under a slab.
std::string bay(const std::string& openings) {
  return R"({"topple": 1, "title": "One bay",
 "materials": {"S355": {"youngs_modulus": 210e9, "poisson_ratio": 0.3, "density": 7850},
               "C30": {"youngs_modulus": 30e9, "poisson_ratio": 0, "density": 2400, "compressive_strength": 30e6,
                       "thermal_expansion": 1e-5}},
 "sections": {"tube": {"shape": "box", "depth": 0.3, "width": 0.3, "thickness": 0.015}},
 "nodes": {"A0": [0, 0, 0], "B0": [6, 0, 0], "C0": [6, 6, 0], "D0": [0, 6, 0],
           "A1": [0, 0, 4], "B1": [6, 0, 4], "C1": [6, 6, 4], "D1": [0, 6, 4]},
 "members": {"PA": {"kind": "post", "nodes": ["A0", "A1"], "section": "tube", "material": "S355"},
             "PB": {"kind": "post", "nodes": ["B0", "B1"], "section": "tube", "material": "S355"},
             "PC": {"kind": "post", "nodes": ["C0", "C1"], "section": "tube", "material": "S355"},
             "PD": {"kind": "post", "nodes": ["D0", "D1"], "section": "tube", "material": "S355"},
             "AB": {"kind": "beam", "nodes": ["A1", "B1"], "section": "tube", "material": "S355"},
             "BC": {"kind": "beam", "nodes": ["B1", "C1"], "section": "tube", "material": "S355"},
             "CD": {"kind": "beam", "nodes": ["C1", "D1"], "section": "tube", "material": "S355"},
             "DA": {"kind": "beam", "nodes": ["D1", "A1"], "section": "tube", "material": "S355"}},
 "panels": {"S": {"kind": "slab", "nodes": ["A1", "B1", "C1", "D1"], "thickness": 0.2, "material": "C30")" +
         (openings.empty() ? std::string() : ", \"openings\": [" + openings + "]") + R"(}},
 "supports": {"A0": "fixed", "B0": "fixed", "C0": "fixed", "D0": "fixed"},
 "loads": {"dead": {"self_weight": 1.0, "nodes": {"A1": {"x": 40000}}}}})";
}

Building building(const std::string& openings) { return parse_model(bay(openings), "bay.json", Purpose::demolish); }

const char* const window = "[[2, 2], [4, 2], [4, 4.5], [2, 4.5]]";

/// Forces on the corners when the panel's upper edge (nodes 3 and 4) moves by 1 in y.
Eigen::Matrix<double, 24, 1> stretched(const Building& b) {
  Eigen::Matrix<double, 24, 1> u = Eigen::Matrix<double, 24, 1>::Zero();
  u(13) = u(19) = 1;
  return PanelSuperelement(b, PanelId(0u)).stiffness() * u;
}

}  // namespace

TEST_CASE("strips between openings that go right through bear as strips") {
  // Without Poisson's ratio, strips of 1.5 m and 2.5 m between straight edges: E t w / 6 m each.
  const auto force = stretched(building("[[1.5, 0], [3.5, 0], [3.5, 6], [1.5, 6]]"));
  const double per_metre = 30e9 * 0.2 / 6;
  // Elements of half a metre at the strips' ends turn a little where nothing keeps them: below 1 %.
  CHECK(force(13) + force(19) == Approx(4 * per_metre).epsilon(0.01));
  // Where the middle of their forces is: 1.5 m at 0.75 m and 2.5 m at 4.75 m from the fourth node.
  CHECK(6 * force(13) == Approx((1.5 * 0.75 + 2.5 * 4.75) * per_metre).epsilon(0.01));
  // Oblique sides are meshed as they are: a strip 0.5 m wide at its foot and 1.5 m at its head is stiffer than one of
  // 0.5 m, and softer than a rod whose sections stay plane, E t / integral of dy / w (within what elements of half a
  // metre are too stiff by).
  const auto oblique = stretched(building("[[1, 0], [6, 0], [6, 6], [2, 6]], [[0, 0], [0.5, 0], [0.5, 6], [0, 6]]"));
  const double whole = oblique(13) + oblique(19);
  CHECK(whole < 1.02 * 30e9 * 0.2 / (6 * std::log(1.5 / 0.5)));
  CHECK(whole > 30e9 * 0.2 * 0.5 / 6);
}

TEST_CASE("an opening makes a membrane softer, and the larger the softer") {
  double before = 1e300;
  for (const char* const openings :
       {"", "[[2.5, 2.5], [3, 2.5], [3, 3], [2.5, 3]]", window, "[[1, 1], [5, 1], [5, 5], [1, 5]]"}) {
    const auto force = stretched(building(openings));
    const double stiffness = force(13) + force(19);
    CHECK(stiffness > 0);
    CHECK(stiffness < before);
    before = stiffness;
    // Rigid motions ask for no force.
    Eigen::Matrix<double, 24, 1> turned = Eigen::Matrix<double, 24, 1>::Zero();
    const Building b = building(openings);
    for (int n = 0; n < 4; ++n) {
      const Vec3 place = b[b.panels[0].nodes[static_cast<std::size_t>(n)]].position;
      turned.segment<3>(6 * n) = Vec3(0.1 - place.y(), 0.2 + place.x(), 0);
      turned(6 * n + 5) = 1;
    }
    CHECK((PanelSuperelement(b, PanelId(0u)).stiffness() * turned).norm() < 1e-7 * 30e9 * 0.2);
  }
}

TEST_CASE("a slab that breaks is made from a whole one of its shape, which lies elsewhere and the other way round") {
  // 6 m x 4 m, and the same turned by a right angle and moved.
  const auto placed = [](std::array<std::array<int, 2>, 4> corners) {
    Building b = building("");
    for (std::size_t n = 0; n < 8; ++n) b.nodes[n].position.head<2>() = Vec2(corners[n % 4][0], corners[n % 4][1]);
    const Vec3 x = (b.nodes[5].position - b.nodes[4].position).normalized();
    b.panels[0].axes << x.transpose(), Vec3::UnitZ().cross(x).transpose(), Vec3::UnitZ().transpose();
    return b;
  };
  const Building here = placed({{{0, 0}, {6, 0}, {6, 4}, {0, 4}}}),
                 there = placed({{{1, 2}, {1, 8}, {-3, 8}, {-3, 2}}});
  const PanelSuperelement whole(here, PanelId(0u));
  PanelSuperelement made(whole, there, PanelId(0u)), fresh(there, PanelId(0u));
  const auto equal = [&] {
    const Eigen::MatrixXd expected = fresh.stiffness();
    CHECK((made.stiffness() - expected).norm() < 1e-12 * expected.norm());
    PanelLoading loading;
    loading.traction = Vec3(100, 200, 300);
    loading.forces.push_back({Vec3(0, 6, 4), Vec3(1000, -500, 0)});
    const std::vector<Vec6> loads = made.loads_at_nodes(loading), wanted = fresh.loads_at_nodes(loading);
    double largest = 0;
    for (const Vec6& load : wanted) largest = std::max(largest, load.norm());
    for (std::size_t n = 0; n < 4; ++n) CHECK((loads[n] - wanted[n]).norm() < 1e-9 * largest);
  };
  equal();
  PanelRemains remains;
  remains.holes = {{{1, 1}, {3, 1}, {3, 2.2}, {1, 2.2}}};
  made.fracture(remains);
  fresh.fracture(remains);
  CHECK(made.stiffness().norm() < 0.99 * whole.stiffness().norm());
  equal();
}

TEST_CASE("an analysis and a standing frame agree on a slab with an opening, and its weight is what is there") {
  const Building b = building(window);
  const AnalysisResult analysis = analyse(b);
  const CombinationResult& result = analysis.combinations.front();
  StandingFrame frame(b, CombinationId(0u), FailureRules{});
  CHECK(frame.mass(PanelId(0u)) == Approx((36 - 5) * 0.2 * 2400).epsilon(1e-12));
  double up = 0;
  for (std::size_t n = 0; n < b.nodes.size(); ++n)
    CHECK((frame.displacement(NodeId(n)) - result.displacements[n]).norm() < 1e-9 * 1e-2);
  for (std::size_t s = 0; s < b.supports.size(); ++s) up += frame.reaction(s)(2);
  double steel = 0;
  for (std::size_t m = 0; m < b.members.size(); ++m) steel += frame.mass(MemberId(m));
  CHECK(up == Approx(9.80665 * ((36 - 5) * 0.2 * 2400 + steel)).epsilon(1e-10));
  // A whole slab is stiffer against the sideways push.
  StandingFrame whole(building(""), CombinationId(0u), FailureRules{});
  CHECK(std::abs(frame.displacement(NodeId(4u))(0) - frame.displacement(NodeId(7u))(0)) >
        1.001 * std::abs(whole.displacement(NodeId(4u))(0) - whole.displacement(NodeId(7u))(0)));
}

TEST_CASE("a ball falls through the opening of a slab and hits it beside") {
  for (const bool through : {true, false}) {
    Scenario scenario;
    scenario.standing = StandingRule::statics;
    scenario.step = 1.0 / 60;
    scenario.duration = 1;
    Simulation simulation(building(window), scenario);
    Projectile ball;
    ball.from = Vec3(through ? 3 : 1, 3, 5.5);
    ball.velocity = Vec3(0, 0, -5);
    ball.mass = 50;
    ball.radius = 0.2;
    simulation.apply(ball);
    bool hit = false;
    while (!simulation.finished()) {
      simulation.step();
      for (const SimulationEvent& event : simulation.events())
        hit = hit || (event.kind == SimulationEvent::Kind::impact && event.name == "S");
    }
    CHECK(hit != through);
    const auto ray = simulation.ray_cast(through ? Vec3(3, 3, 5.5) : Vec3(1, 5, 5.5), -Vec3::UnitZ());
    CHECK((ray && ray->panel == PanelId(0u)) != through);
  }
}
