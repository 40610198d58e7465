// The .3dd reader: what it makes of the published examples, and where it says that a file is wrong.
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <sstream>

#include "formats/frame3dd/frame3dd.h"
#include "support/shared_data.h"
#include "topple/structure/analysis.h"
#include "topple/structure/error.h"

using namespace topple::structure;

namespace {

const char* const two_posts = R"(A post and a beam
3                    # nodes
1  0 0 0   0
2  0 0 3000 0
3  2000 0 3000 0.0
1                    # reactions
1  1 1 1 1 1 1
2                    # elements
1 1 2  100 50 60 10 20 30 200000 80000 0   7.85e-9
2 2 3  100 50 60 10 20 30 200000 80000 90. 7.85e-9
1
0
1 1 -1
1
0 0 -9806.65
1
3  0 0 -1000 0 0 0
0
1
2  0 0 0 0
   500 1500 0.1 0.2
   0 0 0 0
1
2 0 -5 0 2000
1
1 12e-6 100 200  10 20 30 70
1
1 0 0 -2.5 0 0 0
0
)";

std::string read_shared(const std::string& file) {
  std::ifstream stream(topple::test::shared_path(file));
  std::stringstream text;
  text << stream.rdbuf();
  return text.str();
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  text.replace(text.find(from), from.size(), to);
  return text;
}

std::string message(const std::string& text) {
  try {
    (void)parse_frame3dd(text, "f.3dd");
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

}  // namespace

TEST_CASE("a .3dd file keeps its numbers, names, axes and loads") {
  const Building building = parse_frame3dd(two_posts, "f.3dd");
  CHECK(building.title == "A post and a beam");
  CHECK(building.units.consistent);
  REQUIRE(building.nodes.size() == 3);
  REQUIRE(building.members.size() == 2);
  CHECK(building.joints.size() == 4);
  CHECK(building.sections.size() == 1);
  CHECK(building.sections[0].Iy == 20);
  CHECK(building.sections[0].Iz == 30);
  CHECK(building.sections[0].shear_area_z == 60);
  // Vertical and pointing up: y = +Y, z = -X, as Frame3DD has it.
  CHECK(building.members[0].axes.row(1).transpose().isApprox(Vec3(0, 1, 0)));
  CHECK(building.members[0].axes.row(2).transpose().isApprox(Vec3(-1, 0, 0)));
  // Horizontal, rolled by 90 degrees: y was +Y and is now up.
  CHECK((building.members[1].axes.row(1).transpose() - Vec3(0, 0, 1)).norm() < 1e-15);
  CHECK(building.gravity == 9806.65);
  const LoadCase& load_case = building.cases.at(0);
  CHECK(load_case.self_weight == Vec3(0, 0, -1));
  REQUIRE(load_case.members.size() == 3);
  CHECK(load_case.members[0].kind == MemberLoad::Kind::distributed);
  CHECK(load_case.members[0].from == 500);
  CHECK(load_case.members[0].last[1] == 0.2);
  CHECK(load_case.members[1].kind == MemberLoad::Kind::point);
  CHECK(load_case.members[1].from == 2000);
  CHECK(load_case.members[2].temperature == 32.5);
  CHECK(load_case.members[2].gradient_y == Approx(-0.1));
  CHECK(load_case.members[2].gradient_z == Approx(-0.2));
  REQUIRE(load_case.settlements.size() == 1);
  CHECK(load_case.settlements[0].value == -2.5);
  CHECK(building.combinations.at(0).name == "case 1");
}

TEST_CASE("comments, separators and the end of the data are Frame3DD's own") {
  std::string text = replaced(two_posts, "3                    # nodes", "3 ? nodes");
  text = replaced(text, "1  0 0 0   0", "\"1\", 0; 0, 0 ,0 % the foot");
  text = replaced(text, "3  2000 0 3000 0.0", "3,2000,0,3000,-0.0");
  const Building same = parse_frame3dd(two_posts, "f.3dd"),
                 read = parse_frame3dd(text + "_ 1 2 what stands behind", "f.3dd");
  REQUIRE(read.nodes.size() == 3);
  for (std::size_t i = 0; i < 3; ++i) CHECK(read.nodes[i].position == same.nodes[i].position);
  CHECK(read.requested.modes == 0);
  // The size of a radius counts, as there.
  const Building stout = parse_frame3dd(replaced(two_posts, "1  0 0 0   0", "1  0 0 0  -40"), "f.3dd");
  CHECK(stout.members[0].length == 2960);
}

TEST_CASE("a radius makes an element shorter without an arm, as in Frame3DD, and leaves its weight whole") {
  const auto tip = [](double force, double gravity) {
    std::ostringstream text;
    text << "A cantilever\n2\n1 0 0 0 0\n2 4 0 0 1\n1\n1 1 1 1 1 1 1\n1\n1 1 2 2 1 1 5 3 7 1000 400 0 6\n0 0 1 1 "
            "-1\n1\n0 0 "
         << gravity << "\n1\n2 0 0 " << force << " 0 0 0\n0 0 0 0 0\n0\n";
    return analyse(parse_frame3dd(text.str(), "f.3dd"));
  };
  constexpr double EI = 1000 * 3, L = 4, Le = 3, q = 6 * 2 * 0.1;
  const Vec6 pushed = tip(-2, 0).combinations[0].displacements[1];
  CHECK(pushed.z() == Approx(-2 * Le * Le * Le / (3 * EI)).epsilon(1e-12));
  CHECK(pushed(4) == Approx(2 * Le * Le / (2 * EI)).epsilon(1e-12));
  // Half the weight of the distance between the nodes and its end moment q L2/12 on the tip of the shorter element.
  const CombinationResult heavy = tip(0, -0.1).combinations[0];
  const double force = q * L / 2, moment = q * L * L / 12;
  CHECK(heavy.displacements[1].z() ==
        Approx(-force * Le * Le * Le / (3 * EI) + moment * Le * Le / (2 * EI)).epsilon(1e-12));
  CHECK(heavy.reactions[0].z() == Approx(q * L).epsilon(1e-12));
}

TEST_CASE("radii are told") {
  const Building stout = parse_frame3dd(replaced(two_posts, "1  0 0 0   0", "1  0 0 0  40"), "f.3dd");
  REQUIRE(stout.warnings.size() == 1);
  CHECK(stout.warnings[0] == frame3dd_radius_warning);
  CHECK(parse_frame3dd(two_posts, "f.3dd").warnings.empty());
}

/// Frame3DD's example I, a triangular tower under geometric stiffness, from what its published output says of the
/// input.
std::string triangular_tower() {
  std::ostringstream text;
  text << "Example I: a triangular tower  (kip in)\n15\n";
  int node = 0;
  for (const int z : {0, 80, 180, 310, 510})
    for (const auto& [x, y] : {std::pair{-100, 0}, {100, 0}, {0, 70}})
      text << ++node << ' ' << x << ' ' << y << ' ' << z << " 0\n";
  text << "3\n1 1 1 1 1 1 1\n2 1 1 1 1 1 1\n3 1 1 1 1 1 1\n24\n";
  int element = 0;
  const auto add = [&](int a, int b) {
    text << ++element << ' ' << a << ' ' << b << " 100 60 60 500 1000 1000 9990 3800 0 2.4e-10\n";
  };
  for (int k = 1; k <= 12; ++k) add(k, k + 3);
  for (int k = 3; k <= 12; k += 3) add(k + 1, k + 2), add(k + 2, k + 3), add(k + 3, k + 1);
  text << "1 1 10 1 20\n1\n0 -386.4 0\n1\n15 0 200 0 0 0 0\n12\n";
  for (int k = 13; k <= 24; ++k) text << k << " 0 0 -2.361\n";
  text << "0 0 0 0\n0\n";
  return text.str();
}

TEST_CASE("Frame3DD's triangular tower under geometric stiffness answers to the digits that it holds") {
  const Building tower = parse_frame3dd(triangular_tower(), "exI.3dd");
  AnalysisRequest request;
  request.second_order = topple::solver::SecondOrder::frame3dd;
  const AnalysisResult result = analyse(tower, request);
  const CombinationResult& c = result.combinations[0];
  // Frame3DD keeps loads in single precision (-2.36100006), which moves it by 2.5e-8 of everything.
  const auto near = [](double value, double printed, double digit) {
    CHECK(std::abs(value - printed) < digit + 5e-8 * std::abs(printed));
  };
  const std::array<std::pair<std::size_t, Vec6>, 3> moved{
      {{4, (Vec6() << 0.000525, 2.648229, -0.022594, -0.056296, 0.000570, -0.000052).finished()},
       {13, (Vec6() << 0.006309, 56.796981, -0.065620, -0.105949, -0.010216, 0.000294).finished()},
       {15, (Vec6() << 0, 56.831651, -1.002374, -0.058237, 0, 0).finished()}}};
  for (const auto& [node, printed] : moved)
    for (int i = 0; i < 6; ++i) near(c.displacements[node - 1](i), printed(i), 6e-7);
  const std::array<double, 12> ends{-120.416, 0.930,  -129.468, 699.596,  15398.937, 30.431,
                                    120.417,  -0.931, 417.665,  -699.596, 18106.882, 79.289};
  for (std::size_t i = 0; i < 12; ++i) near(c.members[22].end_forces(static_cast<Eigen::Index>(i)), ends[i], 6e-4);
  const Vec6 foot = (Vec6() << 4.806, -76.186, 282.144, 10345.100, 122.085, 1.244).finished();
  for (int i = 0; i < 6; ++i) near(c.reactions[0](i), foot(i), 1e-3);  // its last digits are not symmetric themselves
}

TEST_CASE("without the shear flag a .3dd file's shear areas do not count") {
  const Building building = parse_frame3dd(replaced(two_posts, "\n1\n0\n1 1 -1", "\n0\n1\n1 1 -1"), "f.3dd");
  CHECK(building.sections[0].shear_area_y == 0);
  CHECK(building.requested.cubic_p_delta);
}

TEST_CASE("a wrong .3dd file is refused with the line and what is accepted") {
  CHECK(message(replaced(two_posts, "2  0 0 3000 0", "1  0 0 3000 0")) == "f.3dd:4: node 1 is given twice");
  CHECK(message(replaced(two_posts, "3  2000", "3  nan")) ==
        "f.3dd:5: x of node 3: found 'nan', accepted is a finite number");
  CHECK(message(replaced(two_posts, "2 2 3  100", "2 2 7  100")) ==
        "f.3dd:10: node 2 of element 2: found 7, accepted is a whole number from 1 to 3");
  CHECK(message(replaced(two_posts, "2 2 3  100", "2 2 2  100")) == "f.3dd:10: element 2 has no length");
  CHECK(message(replaced(two_posts, "3                    # nodes", "3000000 # nodes")) ==
        "f.3dd:2: the number of nodes: found 3000000, more than the rest of the file holds");
  CHECK_THAT(message(replaced(two_posts, "2 0 -5 0 2000", "2 0 -5 0 2001")),
             Catch::Contains("a load lies beyond the end of element 2"));
  CHECK_THAT(message(replaced(two_posts, "1 0 0 -2.5 0 0 0", "2 0 0 -2.5 0 0 0")), Catch::Contains("no reaction"));
  CHECK(message("only a title\n") == "f.3dd:1: the file ends where the number of nodes is expected");
}

TEST_CASE("the published .3dd examples are read whole") {
  if (!topple::test::have_shared("reference/frame3dd/exE.3dd")) return;
  const Building a = parse_frame3dd(read_shared("reference/frame3dd/exA.3dd"), "exA.3dd");
  CHECK(a.nodes.size() == 12);
  CHECK(a.combinations.size() == 2);
  CHECK(a.cases[1].members.size() == 3);
  const Building e = parse_frame3dd(read_shared("reference/frame3dd/exE.3dd"), "exE.3dd");
  CHECK(e.requested.modes == 4);
  CHECK(e.masses.nodes.at(0).inertia.z() == 839.37);
  CHECK_THAT(e.warnings.at(0), Catch::Contains("condensation"));
  const Building h = parse_frame3dd(read_shared("reference/frame3dd/exH.3dd"), "exH.3dd");
  CHECK(h.members.size() == 295);
  CHECK(h.masses.members.size() == 163);
}

TEST_CASE("an element between radii has the mass of the whole distance between its nodes in the modes too") {
  // A cantilever that is stiff over what the radii leave and heavy over the whole: two freedoms in each plane.
  constexpr double L = 3000, Le = L - 200 - 300, E = 200000, area = 100, density = 7.85e-9;
  const Building stub = parse_frame3dd(R"(A stub
2
1 0 0 0 200
2 3000 0 0 300
1
1 1 1 1 1 1 1
1
1 1 2  100 50 60 10 20000 50000 200000 80000 0 7.85e-9
0
0
1 1 -1
1
0 0 0
0
0
0
0
0
0
2
1
0
1e-9
0
1
0
0
)",
                                       "stub.3dd");
  for (const bool lumped : {false, true}) {
    AnalysisRequest request;
    request.modes = 2;
    request.mass = lumped ? topple::solver::MassDistribution::lumped : topple::solver::MassDistribution::consistent;
    request.torsional_mass = topple::solver::TorsionalMass::torsion_constant;
    request.rotary_inertia = true;
    const AnalysisResult result = analyse(stub, request);
    REQUIRE(result.modes.size() == 2);
    for (std::size_t m = 0; m < 2; ++m) {
      const double I = m == 0 ? 20000 : 50000, k = E * I / (Le * Le * Le);
      const double t = density * area * L, r = density * I;
      const double a = lumped ? t / 2 : 13 * t / 35 + 6 * r / (5 * L), b = lumped ? 0 : -11 * t * L / 210 - r / 10,
                   c = lumped ? r * L / 2 : t * L * L / 105 + 2 * L * r / 15;
      // Of det(K - q M) = 0 with K = k [12, -6 Le; -6 Le, 4 Le2] and M = [a, b; b, c].
      const double two = a * c - b * b, one = -k * (12 * c + 4 * Le * Le * a + 12 * Le * b),
                   zero = 12 * k * k * Le * Le;
      const double square = 2 * zero / (-one + std::sqrt(one * one - 4 * two * zero));
      CHECK(result.modes[m].angular_frequency == Approx(std::sqrt(square)).epsilon(1e-9));
    }
  }
}

TEST_CASE("between radii geometric stiffness and end moments of the weight are those of the whole distance") {
  // As Frame3DD has it: stiff over what the radii leave, the axial force and the weight over the whole length.
  constexpr double L = 3000, Le = L - 200 - 300, E = 200000, area = 100, density = 7.85e-9;
  const auto element = [](const std::string& second_support, const std::string& geometric, const std::string& load) {
    return analyse(parse_frame3dd("A stub\n2\n1 0 0 0 200\n2 3000 0 0 300\n" + second_support +
                                      "1\n1 1 2  100 50 60 10 20000 50000 200000 80000 0 7.85e-9\n0\n" + geometric +
                                      "\n1 1 -1\n1\n" + load + "0\n",
                                  "stub.3dd"),
                   [&] {
                     AnalysisRequest request;
                     if (geometric == "1") request.second_order = topple::solver::SecondOrder::frame3dd;
                     return request;
                   }())
        .combinations.front();
  };
  constexpr double push = 3, pressed = 1000;
  const CombinationResult leaning = element("1\n1 1 1 1 1 1 1\n", "1", "0 0 0\n1\n2 -1000 3 0 0 0 0\n0\n0\n0\n0\n0\n");
  const double EI = E * 50000, T = -pressed;
  const double a = 12 * EI / (Le * Le * Le) + 1.2 * T / L, b = -(6 * EI / (Le * Le) + T / 10),
               c = 4 * EI / Le + T * L * 2 / 15;
  CHECK(leaning.displacements[1].y() == Approx(push * c / (a * c - b * b)).epsilon(1e-9));
  CHECK(leaning.displacements[1](5) == Approx(-push * b / (a * c - b * b)).epsilon(1e-9));

  const CombinationResult held = element("2\n1 1 1 1 1 1 1\n2 1 1 1 1 1 1\n", "0", "0 0 -9806\n0\n0\n0\n0\n0\n0\n");
  const double q = density * area * 9806;
  CHECK(std::abs(held.members[0].end_forces(4)) == Approx(q * L * L / 12).epsilon(1e-9));
  CHECK(std::abs(held.members[0].end_forces(10)) == Approx(q * L * L / 12).epsilon(1e-9));
  CHECK(held.members[0].end_forces(2) == Approx(q * L / 2).epsilon(1e-9));
  CHECK(std::abs(held.reactions[0](4)) == Approx(q * L * L / 12).epsilon(1e-9));
}
