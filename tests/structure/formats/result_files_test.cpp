// Tables and ParaView files: what a reader of them gets back.
#include <catch2/catch.hpp>
#include <map>
#include <sstream>

#include "topple/structure/analysis.h"
#include "topple/structure/formats/files.h"

using namespace topple::structure;

namespace {

/// A beam of 4000 mm between fixed ends under 6 N/mm, in mm and N; its name needs quoting in a table.
Building beam() {
  return parse_model(R"({"topple": 1, "units": {"length": "mm", "force": "N", "mass": "kg"},
    "materials": {"steel": {"youngs_modulus": 2e5, "shear_modulus": 8e4}},
    "sections": {"s": {"area": 10000, "Iy": 2e8, "Iz": 3e7, "J": 5e6}},
    "joints": {"j": {"capacity": {"moment_y": 1.6e7}}},
    "nodes": {"A": [0, 0, 0], "B": [4000, 0, 0]},
    "members": {"M, \"1\"": {"nodes": ["A", "B"], "section": "s", "material": "steel", "joints": ["j", "j"]}},
    "supports": {"A": "fixed", "B": "fixed"},
    "loads": {"snow/1": {"members": {"M, \"1\"": [{"uniform": {"z": -6}}]}}}})",
                     "beam.json");
}

std::string file(const NamedTexts& files, const std::string& name) {
  for (const auto& [own, text] : files)
    if (own == name) return text;
  FAIL("there is no file " + name);
  return {};
}

std::vector<std::string> lines(const std::string& text) {
  std::vector<std::string> result;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) result.push_back(line);
  return result;
}

/// The number in a column (from 0) of a row without quotes.
double number_in(const std::string& row, int column) {
  std::istringstream stream(row);
  std::string cell;
  for (int i = 0; i <= column; ++i) std::getline(stream, cell, ',');
  return std::stod(cell);
}

/// Numbers of the data array of that name.
std::vector<double> data_array(const std::string& vtu, const std::string& name) {
  const std::size_t at = vtu.find("Name=\"" + name + "\"");
  REQUIRE(at != std::string::npos);
  const std::size_t begin = vtu.find('>', at) + 1, end = vtu.find("</DataArray>", begin);
  std::istringstream stream(vtu.substr(begin, end - begin));
  std::vector<double> numbers;
  for (double number = 0; stream >> number;) numbers.push_back(number);
  return numbers;
}

}  // namespace

TEST_CASE("tables have units in their headers, quoted names, and the textbook's numbers") {
  const Building building = beam();
  const NamedTexts files = results_csv(building, analyse(building));
  const auto reactions = lines(file(files, "reactions.csv"));
  CHECK(reactions[0] == "combination,node,x (N),y (N),z (N),rx (N mm),ry (N mm),rz (N mm)");
  REQUIRE(reactions.size() == 3);
  CHECK(reactions[1].starts_with("snow/1,A,"));
  CHECK(number_in(reactions[1], 4) == Approx(12000).epsilon(1e-12));
  CHECK(number_in(reactions[1], 6) == Approx(-6.0 * 4000 * 4000 / 12).epsilon(1e-12));
  const auto members = lines(file(files, "members.csv"));
  REQUIRE(members.size() == 2);
  CHECK(members[1].starts_with("snow/1,\"M, \"\"1\"\"\",yes,"));
  const auto joints = lines(file(files, "joints.csv"));
  REQUIRE(joints.size() == 3);
  const double use = number_in(joints[1].substr(joints[1].find(":1\",") + 2), 1);
  CHECK(use == Approx(6.0 * 4000 * 4000 / 12 / 1.6e7).epsilon(1e-12));  // q L^2 / 12
  CHECK(joints[0].ends_with(",demand,capacity,unit"));
  CHECK(joints[1].ends_with(",N mm"));
  CHECK(lines(file(files, "displacements.csv")).size() == 3);
  CHECK(lines(file(files, "panels.csv")).size() == 1);
}

TEST_CASE("the table of reactions has those of supported edges, and they add up to the load") {
  const Building building = parse_model(R"({"topple": 1, "units": {"length": "m", "force": "kN", "mass": "t"},
    "materials": {"c": {"youngs_modulus": 3e7, "poisson_ratio": 0.2}},
    "nodes": {"A": [0, 0, 0], "B": [4, 0, 0], "C": [4, 3, 0], "D": [0, 3, 0]},
    "joints": {"e": {"capacity_per_length": {"shear_z": 50}}},
    "panels": {"S": {"nodes": ["A", "B", "C", "D"], "thickness": 0.2, "material": "c", "model": "shell", "mesh": 4, "joint": "e"}},
    "supports": {"S:1": "fixed", "S:3": {"z": true}}, "loads": {"a": {"panels": {"S": {"pressure": 5}}}}})",
                                        "slab.json");
  const NamedTexts files = results_csv(building, analyse(building));
  const auto reactions = lines(file(files, "reactions.csv"));
  REQUIRE(reactions.size() == 3);
  CHECK(reactions[1].starts_with("a,S:1,"));
  CHECK(reactions[2].starts_with("a,S:3,"));
  CHECK(number_in(reactions[1], 4) + number_in(reactions[2], 4) == Approx(60).epsilon(1e-9));
  CHECK(lines(file(files, "joints.csv")).at(1).ends_with(",kN/m"));
}

TEST_CASE("a drawing goes through the stations, displaced by the beam's own deflection") {
  const Building building = beam();
  AnalysisRequest request;
  request.stations = drawing_stations;
  const NamedTexts files = results_vtu(building, analyse(building, request));
  const std::string vtu = file(files, "snow_1.vtu");
  const auto points = data_array(vtu, "points"), displacement = data_array(vtu, "displacement");
  REQUIRE(points.size() == 3 * 11);
  CHECK(points[3 * 5] == 2000);
  CHECK(displacement[3 * 5 + 2] == Approx(-6.0 * std::pow(4000.0, 4) / (384 * 2e5 * 2e8)).epsilon(1e-10));
  CHECK(displacement[2] == 0);
  const auto moment = data_array(vtu, "moment_y");
  REQUIRE(moment.size() == 11);
  CHECK(std::abs(moment[5]) == Approx(6.0 * 4000 * 4000 / 24).epsilon(1e-10));
  CHECK(data_array(vtu, "offsets") == std::vector<double>{11});
  CHECK(data_array(vtu, "types") == std::vector<double>{4});
  CHECK(data_array(vtu, "utilisation")[0] == Approx(0.5).epsilon(1e-12));
  CHECK_THROWS_AS(results_vtu(building, analyse(building)), std::invalid_argument);
}
