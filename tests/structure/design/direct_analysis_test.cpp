// The direct analysis method against the beam-column's closed form.
#include "topple/structure/direct_analysis.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "topple/structure/error.h"
#include "topple/structure/formats/files.h"
#include "topple/structure/member_checks.h"

using namespace topple::structure;

namespace {

// A cantilever of 5 m, HEB300-like in numbers, under 800 kN at its head.
const char* const column = R"({"topple": 1,
  "materials": {"S": {"youngs_modulus": 200e9, "poisson_ratio": 0.3, "yield_strength": 345e6}},
  "sections": {"c": {"catalogue": "W12x65"}},
  "nodes": {"A": [0, 0, 0], "B": [0, 0, 5]},
  "members": {"C": {"kind": "post", "nodes": ["A", "B"], "section": "c", "material": "S"}},
  "supports": {"A": "fixed"},
  "loads": {"P": {"nodes": {"B": {"z": -800e3}}}, "H": {"nodes": {"B": {"x": 1e3}}}},
  "combinations": {"u": {"P": 1.2, "H": 0.5}, "v": {"P": 1}}})";

}  // namespace

TEST_CASE("a leaning cantilever of reduced stiffness has the foot moment of a beam-column with a load across") {
  const Building whole = parse_model(column, "c.json");
  const Building leaning = with_notional_loads(whole, {CombinationId(std::size_t{0})});
  REQUIRE(leaning.combinations.size() == 4);
  CHECK(leaning.combinations[0].name == "u +x");
  CHECK(leaning.combinations[3].name == "u -y");
  AnalysisRequest request;
  request.second_order = topple::solver::SecondOrder::exact;
  request.stations = design_stations;
  request.critical_sections = true;
  AnalysisResult result = analyse(with_reduced_stiffness(leaning), request);
  const Section& section = whole.sections[0];
  const double P = 1.2 * 800e3, L = 5, E = 0.8 * 200e9;
  for (std::size_t k = 0; k < 4; ++k) {
    const bool x = k < 2;
    const double H = (k % 2 == 0 ? 1 : -1) * 0.003 * P + (x ? 0.5e3 : 0);
    // Vertical, `up` is global x: local z is x, and the strong axis bends it along x.
    const double I = x ? section.Iy : section.Iz, area = x ? section.shear_area_z : section.shear_area_y;
    // Shear after Engesser: E I (1 - P/(G A_s)) v'' = P (d - v) + H (L - x), the foot's section upright.
    const double G = 0.8 * whole.materials[0].shear_modulus, soft = area > 0 ? 1 - P / (G * area) : 1;
    const double a = std::sqrt(P / (E * I * soft));
    const double moment = std::abs(H) * std::tan(a * L) / (a * soft);
    const auto& reaction = result.combinations[k].reactions[0];
    CHECK(std::abs(reaction(x ? 4 : 3)) == Approx(moment).epsilon(1e-9));  // asked of P-Delta: 1e-8 of axial forces
    CHECK(reaction(x ? 0 : 1) == Approx(-H).epsilon(1e-9));
  }
  DesignInput input;
  input.lengths = EffectiveLengths::unbraced;
  check_design(leaning, DesignCode::aisc360, usual_drift_limit, result, input);
  const DesignResult& used = result.combinations[0].designs[0];
  CHECK(used.lengths.y == L);  // K = 1, where a cantilever alone would have 2
  CHECK(used.lengths.z == L);
}

TEST_CASE("notional loads go with all that acts downwards") {
  const Building whole = parse_model(R"({"topple": 1,
    "materials": {"S": {"youngs_modulus": 200e9, "poisson_ratio": 0.3, "density": 7850}},
    "sections": {"s": {"area": 0.01, "Iy": 1e-4, "Iz": 1e-4, "J": 1e-4}},
    "nodes": {"A": [0, 0, 0], "B": [4, 0, 0], "C": [4, 3, 0], "D": [0, 3, 0], "E": [8, 0, 3]},
    "members": {"AB": {"nodes": ["A", "B"], "section": "s", "material": "S"},
      "BC": {"nodes": ["B", "C"], "section": "s", "material": "S"}, "CD": {"nodes": ["C", "D"], "section": "s", "material": "S"},
      "DA": {"nodes": ["D", "A"], "section": "s", "material": "S"}, "BE": {"nodes": ["B", "E"], "section": "s", "material": "S"}},
    "panels": {"S": {"nodes": ["A", "B", "C", "D"], "thickness": 0.1, "material": "S"}},
    "supports": {"A": "fixed", "B": "fixed", "C": "fixed", "D": "fixed"},
    "loads": {"q": {"self_weight": 1, "panels": {"S": {"pressure": 2000}}, "nodes": {"E": {"z": -5000, "x": 300}},
      "members": {"AB": [{"uniform": {"z": -1000, "y": 200}}], "BE": [{"uniform": {"z": -700}, "frame": "projected"},
        {"point": {"z": -900}, "at": 1, "frame": "local"}]}}}})",
                                     "m.json");
  const Building leaning = with_notional_loads(whole, {CombinationId(std::size_t{0})});
  const AnalysisResult first = analyse(leaning);
  Vec6 down = Vec6::Zero();
  const AnalysisResult plumb = analyse(whole);
  for (const Vec6& reaction : plumb.combinations[0].reactions) down += reaction;
  for (std::size_t k = 0; k < 4; ++k) {
    Vec6 sum = Vec6::Zero();
    for (const Vec6& reaction : first.combinations[k].reactions) sum += reaction;
    const Eigen::Index axis = k < 2 ? 0 : 1;
    const double sideways = (k % 2 == 0 ? -1 : 1) * 0.003 * down(2);
    CHECK(sum(axis) - down(axis) == Approx(sideways).epsilon(1e-9));
    CHECK(sum(2) == Approx(down(2)).epsilon(1e-12));
  }
}

TEST_CASE("tau_b of C2.3(b) is that of the axial force, found again with the stiffness that it leaves") {
  CHECK(tau_b(0.3) == 1);
  CHECK(tau_b(0.5) == 1);
  CHECK(tau_b(0.75) == Approx(0.75).epsilon(1e-15));  // 4 x 0.75 x 0.25
  // A W12x65 (A = 19.1 in2) whose elements are not slender bears P_ns = 345 MPa x 12,322.6 mm2 = 4,251.3 kN. Under
  // 3,000 kN: ratio 0.70567, tau_b = 4 x 0.70567 x 0.29433 = 0.83080.
  std::string text = column;
  text.replace(text.find("-800e3"), 6, "-3000e3");
  text.replace(text.find("[0, 0, 5]"), 9, "[0, 0, 2]");
  text.replace(text.find("\"P\": 1.2"), 8, "\"P\": 1.0");
  const Building whole = parse_model(text, "c.json");
  const Building leaning = with_notional_loads(whole, {CombinationId(std::size_t{0})}, out_of_plumb);
  AnalysisRequest request;
  request.second_order = topple::solver::SecondOrder::exact;
  request.stations = design_stations;
  request.critical_sections = true;
  DirectAnalysis found = analyse_directly(leaning, request);
  REQUIRE(found.yielded.size() == 1);
  CHECK(found.yielded[0].ratio == Approx(0.70567).epsilon(1e-4));  // the published area is rounded
  CHECK(found.yielded[0].tau_b == Approx(0.83080).epsilon(1e-4));
  CHECK(found.rounds == 2);  // the force of a cantilever does not hang on its stiffness
  // The foot's moment is that of a beam-column with 0.8 tau_b of the flexural stiffness, and 0.8 of that in shear.
  const Section& section = whole.sections[0];
  const double P = 3000e3, H = 0.5e3 + 0.002 * P, L = 2, tau = found.yielded[0].tau_b;
  const double soft = 1 - P / (0.8 * whole.materials[0].shear_modulus * section.shear_area_z);
  const double a = std::sqrt(P / (0.8 * tau * 200e9 * section.Iy * soft));
  CHECK(std::abs(found.result.combinations[0].reactions[0](4)) ==
        Approx(H * std::tan(a * L) / (a * soft)).epsilon(1e-9));
  // The check says what it took, and has the whole stiffness for its strengths.
  DesignInput input;
  input.lengths = EffectiveLengths::unbraced;
  input.yielded = found.yielded;
  check_design(leaning, DesignCode::aisc360, usual_drift_limit, found.result, input);
  CHECK(found.result.combinations[0].designs[0].yielded->tau_b == found.yielded[0].tau_b);
  CHECK_THAT(summary_text(leaning, found.result, {}),
             Catch::Contains("tau_b is below 1 for 1 members, least in C: 0.831"));
  const DesignMembers members(leaning, input);
  const DesignAudit audit =
      audit_design(members, DesignCode::aisc360, MemberId(std::size_t{0}), leaning, found.result.combinations[0]);
  const auto step =
      std::find_if(audit.steps.begin(), audit.steps.end(), [](const DesignStep& s) { return s.symbol == "tau_b"; });
  REQUIRE(step != audit.steps.end());
  CHECK(step->value == found.yielded[0].tau_b);
  // More than the section bears leaves nothing to stand on.
  text.replace(text.find("-3000e3"), 7, "-4300e3");
  const Building heavy =
      with_notional_loads(parse_model(text, "c.json"), {CombinationId(std::size_t{0})}, out_of_plumb);
  AnalysisRequest linear;
  CHECK_THROWS_WITH(analyse_directly(heavy, linear), Catch::Contains("members.C: its compression is 1.01"));
}
