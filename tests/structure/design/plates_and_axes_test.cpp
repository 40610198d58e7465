// Sections whose strong axis is local z, webs that bending about z or compression alone makes slender, and the plates
// of built-up I sections. Hand calculations: their steps stand beside them in numbers and share no code with the check.
#include <catch2/catch.hpp>
#include <cmath>

#include "structure/design/design_steel.h"
#include "topple/structure/analysis.h"
#include "topple/structure/design_check.h"
#include "topple/structure/formats/files.h"
#include "topple/structure/member_checks.h"

using namespace topple::structure;
using namespace topple::test;

namespace {

const Material s355 = steel(355 * MPa, 210e9, 81e9), gr50 = steel(345 * MPa, 200e9, 77.2e9);

double clause(DesignCode code, const DesignMember& member, const SectionForces& at, const std::string& name) {
  const SectionForces stations[] = {at};
  return topple::test::clause(check_member(code, member, stations), name);
}

Section bar(double depth, double width) {
  Section s;
  s.name = "bar";
  s.shape = Section::Shape::rectangle;
  s.depth = depth;
  s.width = width;
  s.area = depth * width;
  s.Iy = width * depth * depth * depth / 12;
  s.Iz = depth * width * width * width / 12;
  s.J = 0.110845e-6;  // of 200 x 12 mm: 200 x 12^3/3 (1 - 0.63 x 12/200)
  s.plastic_modulus_y = width * depth * depth / 4;
  s.plastic_modulus_z = depth * width * width / 4;
  return s;
}

/// The largest use of a bar of 4 m under 100 N/m (times 1.5) that bends about its strong axis, held at the middle
/// against moving across.
double use_in_model(const std::string& section, const std::string& load, const std::string& held, const char* code) {
  const Building building = parse_model(
      R"({"topple": 1, "materials": {"s": {"youngs_modulus": 210e9, "shear_modulus": 81e9, "yield_strength": 355e6}},
    "sections": {"bar": {"shape": "rectangle", )" +
          section + R"(}}, "nodes": {"A": [0, 0, 0], "B": [2, 0, 0], "C": [4, 0, 0]},
    "members": {"AB": {"nodes": ["A", "B"], "section": "bar", "material": "s"},
                "BC": {"nodes": ["B", "C"], "section": "bar", "material": "s"}},
    "supports": {"A": {"x": true, "y": true, "z": true, "rx": true}, "B": {")" +
          held + R"(": true}, "C": {"y": true, "z": true}},
    "loads": {"q": {"members": {"AB": [{"uniform": {")" +
          load + R"(": -100}}], "BC": [{"uniform": {")" + load + R"(": -100}}]}}},
    "combinations": {"u": {"q": 1.5}}})",
      "bar.json");
  AnalysisRequest request;
  request.stations = design_stations;
  request.critical_sections = true;
  AnalysisResult result = analyse(building, request);
  check_design(building, std::string(code) == "en1993" ? DesignCode::en1993 : DesignCode::aisc360, usual_drift_limit,
               result, {});
  return std::max(result.combinations[0].designs[0].utilisation, result.combinations[0].designs[1].utilisation);
}

}  // namespace

// Hand calculation: bar 200 x 12 mm, L = 4 m, uniform moment 5 kNm, S355. M_cr = pi/4000 sqrt(210000 x 28800 x 81000 x
// 110845) = 5.788 kNm; W_pl f_y = 42.6 kNm; lambda = 2.713; curve d: chi = 0.1053; 5/(0.1053 x 42.6) = 1.1145.
// AISC 360 (E = 210 GPa): L d/t^2 = 5556 above 1.9 E/F_y: F_cr = 1.9 x 210000/5556 = 71.82 MPa, M_n = 5.746 kNm: 5/(0.9
// x 5.746) = 0.9669. Whichever of its sides is called depth, it is the same bar.
TEST_CASE("a bar on edge buckles sideways whichever local axis is its strong one") {
  const Section upright = bar(0.2, 0.012), turned = bar(0.012, 0.2);
  const SectionForces about_y{0, 0, 0, 0, 5 * kNm, 0}, about_z{0, 0, 0, 0, 0, 5 * kNm};
  for (const auto& [section, at] : {std::pair(&upright, about_y), std::pair(&turned, about_z)}) {
    const DesignMember member{.section = section, .material = &s355, .lengths = {0, 0, 0, 4}};
    CHECK(clause(DesignCode::en1993, member, at, "EN 1993-1-1 6.3.2 (6.54)") == Approx(1.1145).epsilon(5e-4));
    CHECK(clause(DesignCode::aisc360, member, at, "AISC 360 F1") == Approx(0.9669).epsilon(5e-4));
  }
  // What holds its compressed edge holds it across: along z, where z is its strong axis.
  for (const char* code : {"en1993", "aisc360"}) {
    const double use = use_in_model(R"("depth": 0.2, "width": 0.012)", "z", "y", code);
    CHECK(use > 0.01);
    CHECK(use_in_model(R"("depth": 0.012, "width": 0.2)", "y", "z", code) == Approx(use).epsilon(1e-9));
    CHECK(use_in_model(R"("depth": 0.012, "width": 0.2)", "y", "y", code) != Approx(use).epsilon(0.1));
  }
}

TEST_CASE("an audit says that a section's axes are exchanged, and its lengths stay those of the member's own axes") {
  const Section turned = bar(0.012, 0.2);
  const DesignMember member{.section = &turned, .material = &s355, .lengths = {1, 2, 0, 4}};
  const SectionForces at[] = {{-1 * kN, 0, 0, 0, 0, 1 * kNm}};
  const DesignAudit audit = audit_member(DesignCode::en1993, member, at);
  CHECK(audit.steps.front().symbol == "y, z");
  CHECK(audit.result.lengths.y == 1);
  CHECK(audit.result.lengths.z == 2);
  for (const DesignStep& step : audit.steps)
    if (step.symbol == "L_cr,y") CHECK(step.value == 2);
}

TEST_CASE("an I that is stronger along its flanges is not said to pass once it bends about that axis") {
  const Section wide = welded(0.1, 0.6, 0.01, 0.02);
  const DesignMember member{.section = &wide, .material = &s355};
  const SectionForces strong[] = {{0, 0, 0, 0, 0, 1 * kNm}}, weak[] = {{0, 0, 0, 0, 1 * kNm, 0}};
  CHECK_FALSE(check_member(DesignCode::en1993, member, strong).passes());
  CHECK_FALSE(check_member(DesignCode::aisc360, member, strong).passes());
  CHECK(check_member(DesignCode::aisc360, member, weak).passes());
}

// Hand calculation: box 400 x 200 x 6, welded, S355, bent about its weak axis: walls of 388 mm are pressed all over:
// 64.67 above 42 epsilon = 34.2. lambda_p = 64.67/(28.4 x 0.8136 x 2) = 1.3993; rho = 0.60228; of the wall 925.9 mm2 do
// not count. I_z = 5182.2e4; the axis moves by 925.9 x 97/(7056 - 925.9) = 14.65 mm; I_eff = 5182.2e4 - 925.9 x (97^2 +
// 3) - 6130.1 x 14.65^2 = 4179.2e4; W_eff = 4179.2e4/114.65 = 364.5 cm3; 60 kNm/129.4 kNm = 0.4637. By the elastic
// modulus, which bending about the strong axis allows (flanges 188/6 = 31.3 of class 3), it would be 0.3261.
TEST_CASE("EN 1993-1-1 5.5: the webs of a box that bends about its weak axis are flanges under pressure") {
  Section s;
  s.name = "box";
  s.shape = Section::Shape::box;
  s.depth = 0.4;
  s.width = 0.2;
  s.thickness = 0.006;
  s.area = 7056e-6;
  s.Iy = (200 * std::pow(400, 3) - 188 * std::pow(388, 3)) / 12 * 1e-12;
  s.Iz = 5182.2e-8;
  s.J = 1e-4;
  s.plastic_modulus_y = (200 * 400.0 * 400 - 188 * 388.0 * 388) / 4 * 1e-9;
  s.plastic_modulus_z = 571.6e-6;
  const DesignMember member{.section = &s, .material = &s355};
  const SectionForces weak{0, 0, 0, 0, 0, 60 * kNm}, strong{0, 0, 0, 0, 60 * kNm, 0};
  CHECK(clause(DesignCode::en1993, member, weak, "EN 1993-1-1 6.2.1 (6.2)") == Approx(0.4637).epsilon(5e-4));
  // About y it stays elastic: W_el = 757.8 cm3: 60/269.0 = 0.2230.
  CHECK(clause(DesignCode::en1993, member, strong, "EN 1993-1-1 6.2.1 (6.2)") == Approx(0.2230).epsilon(5e-4));
}

// Hand calculation: IPE 500 in S355 under compression alone, L_z = 2 m: c/t = 426/10.2 = 41.76 above 42 epsilon
// = 34.17: class 4. lambda_p = 0.90374, rho = 0.83715; A_eff = 11550 - 0.16285 x 426 x 10.2 = 10842 mm2. lambda_z =
// sqrt(10842 x 355/N_cr) = 0.5889 with N_cr = pi^2 x 210000 x 2142e4/2000^2 = 11099 kN; curve b: chi = 0.8426; 1000
// kN/3243.2 kN = 0.3083. With the whole area, as under bending, it would be 0.2927.
TEST_CASE("EN 1993-1-1 6.3.1: a web of class 4 under compression alone counts in part, however small the force") {
  Section s = welded(0.5, 0.2, 0.0102, 0.016);
  s.catalogue = "IPE500";
  s.fillet = 0.021;
  s.area = 11550e-6;
  s.Iz = 2142e-8;
  const DesignMember member{.section = &s, .material = &s355, .lengths = {0, 2, 0, 0}};
  for (const double share : {0.1, 1.0})
    CHECK(clause(DesignCode::en1993, member, {-share * 1000 * kN, 0, 0, 0, 0, 0}, "EN 1993-1-1 6.3.1 (6.46)") ==
          Approx(0.3083 * share).epsilon(5e-4));
}

// Hand calculation: girder 1200 x 400, web 10, flanges 10 mm, built up, F_y = 345, E = 200 GPa: b/2t = 20; h/t_w = 118;
// k_c = 4/sqrt(118) = 0.36823; table B4.1b case 11: 0.95 sqrt(0.36823 x 200000/(0.7 x 345)) = 16.59: slender. I_x =
// (400 x 1200^3 - 390 x 1180^3)/12 = 4.2015e9, S_x = 7002.4e3 mm3. (F3-2): 0.9 x 200000 x 0.36823 x 7002.4e3/400 =
// 1160.3 kNm (a rolled one's line would give 0.9 S_x F_y and more). Web noncompact (90.5 to 137.2), F_y S_x = 2415.8.
// 500/(0.9 x 1160.3) = 0.4788.
TEST_CASE("AISC 360 F3: flanges of built-up sections are slender by their own limit") {
  const Section s = welded(1.2, 0.4, 0.01, 0.01);
  const DesignMember member{.section = &s, .material = &gr50};
  CHECK(clause(DesignCode::aisc360, member, {0, 0, 0, 0, 500 * kNm, 0}, "AISC 360 F1") == Approx(0.4788).epsilon(5e-4));
}

// Hand calculation: the same girder as a stub in compression, F_cr = F_y. Table B4.1a case 2: 0.64 sqrt(0.36823 x
// 200000/345) = 9.351 below 20: F_el = (1.49 x 9.351/20)^2 x 345 = 167.4; b_e = 400 (1 - 0.22 x 0.6966) 0.6966 = 235.9.
// Web: 1.49 x 24.077 = 35.87 below 118: F_el = (1.31 x 35.87/118)^2 x 345 = 54.71; h_e = 1180 (1 - 0.18 x 0.3982) x
// 0.3982 = 436.3. A_e = 2 x 2359 + 4363 = 9082 mm2; phi P_n = 0.9 x 345 x 9082 = 2820 kN; 1000/2820 = 0.3546.
TEST_CASE("AISC 360 E7: flanges of built-up sections count by their own limit") {
  const Section s = welded(1.2, 0.4, 0.01, 0.01);
  const DesignMember member{.section = &s, .material = &gr50};
  CHECK(clause(DesignCode::aisc360, member, {-1000 * kN, 0, 0, 0, 0, 0}, "AISC 360 E1") ==
        Approx(0.3546).epsilon(1e-3));
}

// Hand calculation: girder 1000 x 300, web 8, flanges 20 mm, F_y = 345, E = 200, G = 77.2 GPa, uniform moment, L_b = 4
// m. h/t_w = 120: noncompact. a_w = 960 x 8/(300 x 20) = 1.28; r_t = 300/sqrt(12 (1 + 1.28/6)) = 78.62 mm; L_p = 1.1 x
// 78.62 x 24.077 = 2082 mm; S_x = 6.9428e6 mm3 (I_x = 3.4714e9), J = 1.7638e6, J/(S_x h_o) = 2.5924e-4; L_r = 1.95 x
// 78.62 x 828.2 x sqrt(2.5924e-4 + sqrt(6.720e-8 + 6.76 x 1.458e-6)) = 7413 mm. M_n with R_pc = 1: 345 x 6.9428e6 (1 -
// 0.3 x (4000 - 2082)/(7413 - 2082)) = 2395.3 x 0.89207 = 2136.8 kNm; 1500/(0.9 x 2136.8) = 0.7800. With L_p of compact
// webs, 1.76 r_y sqrt(E/F_y), it would have been 0.7507.
TEST_CASE("AISC 360 F4.2: a noncompact web buckles sideways from 1.1 r_t sqrt(E/F_y) on") {
  const Section s = welded(1.0, 0.3, 0.008, 0.02);
  const DesignMember member{.section = &s, .material = &gr50, .lengths = {0, 0, 0, 4}};
  CHECK(clause(DesignCode::aisc360, member, {0, 0, 0, 0, 1500 * kNm, 0}, "AISC 360 F1") ==
        Approx(0.7800).epsilon(1e-3));
}

TEST_CASE("a material that is not the codes' steel is not said to pass") {
  const Section s = welded(0.3, 0.15, 0.007, 0.011);
  const SectionForces at[] = {{0, 0, 0, 0, 1 * kNm, 0}};
  const auto passes = [&](DesignCode code, const Material& material) {
    return check_member(code, {.section = &s, .material = &material}, at).passes();
  };
  const Material aluminium = steel(240 * MPa, 70e9, 26e9), s460 = steel(460 * MPa, 210e9, 81e9),
                 s690 = steel(690 * MPa, 210e9, 81e9);
  for (const DesignCode code : {DesignCode::en1993, DesignCode::aisc360}) {
    CHECK_FALSE(passes(code, aluminium));
    CHECK(passes(code, s460));
  }
  CHECK_FALSE(passes(DesignCode::en1993, s690));
  CHECK(passes(DesignCode::aisc360, s690));
}
