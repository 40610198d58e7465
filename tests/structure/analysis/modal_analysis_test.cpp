// Natural modes of whole models: OpenSees' frequencies, where masses come from, results.json.
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "support/shared_data.h"
#include "topple/structure/analysis.h"
#include "topple/structure/divide_member.h"
#include "topple/structure/error.h"
#include "topple/structure/formats/files.h"

using namespace topple::structure;
using Json = nlohmann::json;
namespace solver = topple::solver;

namespace {

/// A light post of 3 m with a mast arm of 2 m along x at its head, and what the masses say.
Building mast(const std::string& rest, const std::string& units = R"("consistent")", double gravity = 10) {
  return parse_model(R"({"topple": 1, "units": )" + units + R"(, "gravity": )" + std::to_string(gravity) + R"(,
    "materials": {"light": {"youngs_modulus": 2e11, "shear_modulus": 8e10}},
    "sections": {"s": {"area": 0.01, "Iy": 1e-4, "Iz": 2e-5, "J": 1e-5}},
    "nodes": {"A": [0, 0, 0], "B": [0, 0, 3], "C": [2, 0, 3]},
    "members": {"P": {"kind": "post", "nodes": ["A", "B"], "section": "s", "material": "light"},
                "M": {"nodes": ["B", "C"], "section": "s", "material": "light"}},
    "supports": {"A": "fixed"})" +
                         rest + "}",
                     "mast.json");
}

AnalysisResult modes(const Building& building, int count) {
  AnalysisRequest request;
  request.modes = count;
  return analyse(building, request);
}

}  // namespace

TEST_CASE("OpenSees' frames have its natural frequencies") {
  for (const std::string name : {"A1_def_L6", "D3_def_L6"}) {
    const std::string base = "reference/opensees/" + name;
    if (!topple::test::have_shared(base + ".expected.json")) return;
    std::ifstream file(topple::test::shared_path(base + ".expected.json"));
    const Json expected = Json::parse(file);
    AnalysisRequest request;
    request.modes = 3;
    request.torsional_mass = solver::TorsionalMass::torsion_constant;
    const AnalysisResult result = analyse(read_model(topple::test::shared_path(base + ".json")), request);
    REQUIRE(result.modes.size() == 3);
    for (std::size_t m = 0; m < 3; ++m)
      CHECK(result.modes[m].angular_frequency ==
            Approx(expected["modes"][m]["angular_frequency"].get<double>()).epsilon(1e-8));
  }
}

TEST_CASE("mass comes from nodes, from members by halves, and from vertical loads over gravity") {
  const auto moving = [](const Building& building) { return modes(building, 1).moving_mass.z(); };
  CHECK(moving(mast(R"(, "masses": {"nodes": {"C": 50}})")) == Approx(50).epsilon(1e-12));
  CHECK(moving(mast(R"(, "masses": {"members": {"P": 30}})")) == Approx(15).epsilon(1e-12));
  // 100 over the second half of the arm and a point load of 60 at a quarter, both downwards; half of it counts.
  const std::string loads = R"(, "loads": {"live": {"self_weight": 1, "members": {"M": [
    {"uniform": {"z": -100, "x": 7}, "from": 1, "to": 2}, {"point": {"z": -60}, "at": 0.5}]}, "nodes": {"C": {"z": -40}}}},
    "masses": {"loads": {"live": 0.5}})";
  CHECK(moving(mast(loads)) == Approx(0.5 * 200 / 10).epsilon(1e-12));
  CHECK_THROWS_WITH(mast(R"(, "masses": {"loads": {"live": -1}})"), Catch::Contains("masses"));
  CHECK_THROWS_WITH(
      modes(mast(R"(, "loads": {"lift": {"nodes": {"C": {"z": 40}}}}, "masses": {"loads": {"lift": 1}})"), 1),
      Catch::Contains("node C upwards"));
  CHECK_THROWS_WITH(modes(mast(""), 1), Catch::Contains("mass"));
}

TEST_CASE("results.json has frequencies in Hz and rad/s, mass shares and shapes, and asks for no more than there are") {
  const Building building = mast(R"(, "masses": {"nodes": {"C": 50}})");
  AnalysisRequest request;
  request.modes = 5;
  const AnalysisResult result = analyse(building, request);
  const Json json = Json::parse(results_json(building, request, result, {}));
  REQUIRE(json["modes"].size() == 3);
  CHECK_THAT(result.warnings.at(result.warnings.size() - 1), Catch::Contains("3 modes, 5 were asked for"));
  double shares = 0;
  for (const Json& mode : json["modes"]) {
    CHECK(mode["frequency"].get<double>() * 2 * 3.14159265358979323846 ==
          Approx(mode["angular_frequency"].get<double>()).epsilon(1e-14));
    shares += mode["mass_share"][1].get<double>();
    CHECK(mode["shape"].size() == 3);
  }
  CHECK(shares == Approx(1).epsilon(1e-10));
  // Sideways the post bends and twists, the arm bends: flexibilities add up at the mass.
  const double E = 2e11, G = 8e10, L = 3, a = 2;
  const double flexibility = L * L * L / (3 * E * 2e-5) + a * a * L / (G * 1e-5) + a * a * a / (3 * E * 2e-5);
  CHECK(json["modes"][0]["angular_frequency"].get<double>() == Approx(1 / std::sqrt(50 * flexibility)).epsilon(1e-9));
}

namespace {

/// A bar of 4 m without supports, in eight parts; `shift` as the file gives it.
std::string floating_bar(const std::string& analyses) {
  std::string nodes, members;
  for (int i = 0; i <= 8; ++i)
    nodes += (i > 0 ? ", " : "") + ("\"n" + std::to_string(i) + "\": [" + std::to_string(0.5 * i) + ", 0, 0]");
  for (int i = 0; i < 8; ++i)
    members +=
        (i > 0 ? ", " : "") + ("\"m" + std::to_string(i) + "\": {\"nodes\": [\"n" + std::to_string(i) + "\", \"n" +
                               std::to_string(i + 1) + "\"], \"section\": \"s\", \"material\": \"steel\"}");
  return R"({"topple": 1, "materials": {"steel": {"youngs_modulus": 2e11, "shear_modulus": 8e10, "density": 7800}},
    "sections": {"s": {"area": 0.01, "Iy": 1e-4, "Iz": 2e-5, "J": 1e-5}}, "nodes": {)" +
         nodes + R"(}, "members": {)" + members + R"(}, "analyses": )" + analyses + "}";
}

}  // namespace

TEST_CASE("a structure that floats has modes where its file gives a shift, and bears no loads") {
  const Building bar = parse_model(floating_bar(R"({"modes": 8, "shift": 1000})"), "bar.json");
  AnalysisRequest request;
  request.modes = bar.requested.modes;
  const AnalysisResult result = analyse(bar, request);
  CHECK(result.combinations.empty());
  CHECK_THAT(result.warnings.back(), Catch::Contains("no combination is solved") && Catch::Contains("unstable"));
  REQUIRE(result.modes.size() == 8);
  for (std::size_t m = 0; m < 6; ++m) CHECK(result.modes[m].angular_frequency == 0);
  // 4.730^2/L^2 sqrt(E Iz/(density A)) with free ends; eight parts leave (4.73/8)^4/720 of an error.
  const double first = 4.730040744862704 * 4.730040744862704 / 16 * std::sqrt(2e11 * 2e-5 / (7800 * 0.01));
  CHECK(result.modes[6].angular_frequency == Approx(first).epsilon(2e-4));
  const Json file = Json::parse(results_json(bar, request, result, {}));
  CHECK(file["combinations"].empty());
  CHECK(file["envelope"]["members"].empty());
  CHECK(file["modes"].size() == 8);
}

TEST_CASE("a structure that floats is unstable where its file gives no shift") {
  AnalysisRequest request;
  request.modes = 8;
  CHECK_THROWS_AS(analyse(parse_model(floating_bar(R"({"modes": 8})"), "bar.json"), request), UnstableModel);
  request.modes = 0;
  CHECK_THROWS_AS(analyse(parse_model(floating_bar(R"({"modes": 8, "shift": 1000})"), "bar.json"), request),
                  UnstableModel);
}

TEST_CASE("modes that are lost in rounding are refused with the nodes that lie too far apart") {
  AnalysisRequest request;
  request.modes = 8;
  for (const char* number : {"2e11", "8e10", "7800", "0.01", "1e-4", "2e-5", "1e-5", "1000"})
    for (const char* other : {"1e-100", "1e-60", "1e-30", "1e-20", "1e-10", "1e10", "1e20", "1e30", "1e60", "1e100"}) {
      std::string text = floating_bar(R"({"modes": 8, "shift": 1000})");
      for (std::size_t at; (at = text.find(std::string(" ") + number)) != std::string::npos;)
        text.replace(at + 1, std::string(number).size(), other);
      INFO(number << " is " << other);
      try {  // an answer, or a refusal: never a failure of what has computed
        for (const solver::VibrationMode& mode : analyse(parse_model(text, "bar.json"), request).modes)
          CHECK(std::isfinite(mode.angular_frequency));
      } catch (const InputError& error) {
        CHECK_THAT(error.what(), Catch::Contains("bar.json"));
      } catch (const UnstableModel&) {
      }
    }
  const Building soft = parse_model(floating_bar(R"({"modes": 8, "shift": 1e30})"), "bar.json");
  try {
    CHECK(analyse(soft, request).modes.size() == 8);
  } catch (const InputError& error) {
    CHECK_THAT(error.what(), Catch::Contains("bar.json, natural modes") && Catch::Contains("at node n") &&
                                 Catch::Contains("with a shift of 1e+30"));
  }
}

TEST_CASE("divided members swing by themselves, with what lies on them") {
  // omega = k^2/L^2 sqrt(E I/m): k = pi between hinges, 4.73004 between held ends (Timoshenko, Vibration Problems in
  // Engineering). Nothing but 100 kg/m of load is mass.
  const auto beam = [](const std::string& ends, const std::string& mass) {
    return parse_model(R"({"topple": 1, "gravity": 10,
      "materials": {"s": {"youngs_modulus": 2e11, "poisson_ratio": 0.3, "density": 0}},
      "sections": {"b": {"area": 0.01, "Iy": 1e-4, "Iz": 4e-4, "J": 1e-4}},
      "nodes": {"A": [0, 0, 0], "B": [6, 0, 0]},
      "members": {"AB": {"nodes": ["A", "B"], "section": "b", "material": "s"}},
      "supports": {"A": )" +
                           ends + R"(, "B": )" + ends + R"(}, )" + mass + "}",
                       "beam.json");
  };
  const std::string hinges = R"({"x": true, "y": true, "z": true, "rx": true, "rz": true})", held = R"("fixed")";
  const std::string along =
      R"("masses": {"loads": {"q": 1}}, "loads": {"q": {"members": {"AB": [{"uniform": {"z": -1000}}]}}})";
  const double unit = std::sqrt(2e11 * 1e-4 / 100) / 36;
  for (const auto& [ends, k] : {std::pair(hinges, 3.14159265358979), std::pair(held, 4.73004)}) {
    Building building = beam(ends, along);
    divide_all_members(building, 8);
    REQUIRE(building.members.size() == 8);
    // Load is mass at nodes: of eight elements that costs less than 0.1 % (hinges), 1 % (held).
    CHECK(modes(building, 1).modes[0].angular_frequency == Approx(k * k * unit).epsilon(k < 4 ? 1e-3 : 1e-2));
  }
  Building alone = beam(held, along);
  CHECK(modes(alone, 1).modes.empty());  // all mass lies on nodes that do not move
}

TEST_CASE("the lowest of very many frequencies that lie close together are found") {
  // 150 beams between hinges, each a little longer than the one before: 4e-5 between neighbours' frequencies.
  std::string nodes, members, supports;
  const auto node = [&](const std::string& name, double x, double y) {
    nodes += (nodes.empty() ? "\"" : ", \"") + name + "\": [" + std::to_string(x) + ", " + std::to_string(y) + ", 0]";
    supports +=
        (supports.empty() ? "\"" : ", \"") + name + R"(": {"x": true, "y": true, "z": true, "rx": true, "rz": true})";
  };
  for (int i = 0; i < 150; ++i) {
    const std::string k = std::to_string(i);
    node("A" + k, 0, i);
    node("B" + k, 6 + 1.25e-4 * i, i);
    members += (i ? ", \"M" : "\"M") + k + R"(": {"nodes": ["A)" + k + R"(", "B)" + k +
               R"("], "section": "b", "material": "s"})";
  }
  Building building =
      parse_model(R"({"topple": 1, "materials": {"s": {"youngs_modulus": 2e11, "poisson_ratio": 0.3, "density": 7850}},
    "sections": {"b": {"area": 0.01, "Iy": 1e-4, "Iz": 4e-4, "J": 1e-4}}, "nodes": {)" +
                      nodes + R"(}, "members": {)" + members + R"(}, "supports": {)" + supports + "}}",
                  "beams.json");
  divide_all_members(building, 2);
  const AnalysisResult result = modes(building, 6);
  REQUIRE(result.modes.size() == 6);
  for (std::size_t m = 0; m < 6; ++m) {
    const double length = 6 + 1.25e-4 * (149 - static_cast<double>(m));
    const double omega = std::pow(3.14159265358979 / length, 2) * std::sqrt(2e11 * 1e-4 / 78.5);
    // Two elements are 0.39 % too quick (and shear makes the beam softer); neighbours are 4e-5 apart.
    const double ratio = result.modes[m].angular_frequency / omega;
    CHECK(ratio == Approx(result.modes[0].angular_frequency /
                          (std::pow(3.14159265358979 / (6 + 1.25e-4 * 149), 2) * std::sqrt(2e11 * 1e-4 / 78.5)))
                       .epsilon(1e-6));
    CHECK(ratio == Approx(1.0039).epsilon(2e-3));
  }
}

TEST_CASE("the filler beams of la3 swing by themselves once they are divided") {
  // 216 beams within a few per cent of each other, which six and their spares do not hold: the block has to widen.
  Building building = read_model(find_model("la3"));
  const AnalysisResult frame = modes(building, 4);
  divide_all_members(building, 2);
  const AnalysisResult result = modes(building, 6);
  REQUIRE(result.modes.size() == 6);
  // The frame's own three: more freedoms make them slower, by as much as the fillers give way.
  for (std::size_t m = 0; m < 3; ++m) {
    CHECK(result.modes[m].angular_frequency < frame.modes[m].angular_frequency * (1 + 1e-9));
    CHECK(result.modes[m].angular_frequency == Approx(frame.modes[m].angular_frequency).epsilon(0.03));
  }
  // Then W16x26 of 9.144 m: pi/2 sqrt(E I/(rho A))/L^2 = 2.691 Hz with its own mass alone; two elements are 0.39 % too
  // quick, and tabs hold its ends a little.
  const double own = 2 * 3.14159265358979 * 2.691;
  CHECK(frame.modes[3].angular_frequency > 1.5 * own);
  for (std::size_t m = 3; m < 6; ++m) CHECK(result.modes[m].angular_frequency == Approx(1.0039 * own).epsilon(5e-3));
}
