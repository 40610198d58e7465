// Frame3DD's published examples, read as they are, against what Frame3DD itself printed.
#include <catch2/catch.hpp>

#include "support/frame3dd_output.h"
#include "topple/structure/analysis.h"
#include "topple/structure/formats/files.h"

using namespace topple::structure;
using topple::test::Frame3ddCase;
using topple::test::Printed;
namespace solver = topple::solver;

namespace {

/// What the file itself asks for.
AnalysisRequest as_the_file_asks(const Building& building) {
  AnalysisRequest request;
  if (building.requested.cubic_p_delta) request.second_order = solver::SecondOrder::frame3dd;
  request.modes = building.requested.modes;
  if (building.requested.lumped_mass) request.mass = solver::MassDistribution::lumped;
  request.torsional_mass = solver::TorsionalMass::torsion_constant;
  request.rotary_inertia = true;
  return request;
}

/// Half of the last digit printed, and what Frame3DD itself loses: it holds loads in single precision (6e-8).
double tolerance(double printed_unit, double largest) { return 0.5 * printed_unit + 6e-8 * largest; }

template <class Values>
void compare(const std::string& what, const Printed& printed, const Values& computed, double unit,
             const std::array<double, 2>& largest) {
  for (std::size_t i = 0; i < 6; ++i) {
    INFO(what << " component " << i << " printed " << printed[i]);
    CHECK(std::abs(computed(static_cast<Eigen::Index>(i)) - printed[i]) <= tolerance(unit, largest[i / 3]));
  }
}

template <class Table>
std::array<double, 2> largest_of(const Table& table) {
  std::array<double, 2> largest{};
  for (const auto& [key, values] : table)
    for (std::size_t i = 0; i < 6; ++i) largest[i / 3] = std::max(largest[i / 3], std::abs(values[i]));
  return largest;
}

void compare(const Building& building, const CombinationResult& result, const Frame3ddCase& printed) {
  const NameIndex names(building);
  const auto moved = largest_of(printed.displacements), forces = largest_of(printed.end_forces);
  for (const auto& [node, values] : printed.displacements) {
    const auto n = static_cast<std::size_t>(names.node(std::to_string(node))->index);
    compare("displacement of node " + std::to_string(node), values, result.displacements[n], 1e-6, moved);
  }
  for (const auto& [place, values] : printed.end_forces) {
    const auto m = static_cast<std::size_t>(names.member(std::to_string(place.first))->index);
    const Vec6 end = result.members[m].end_forces.segment<6>(6 * place.second);
    compare("element " + std::to_string(place.first) + " end " + std::to_string(place.second), values, end, 1e-3,
            forces);
  }
  for (std::size_t s = 0; s < building.supports.size(); ++s) {
    const auto found = printed.reactions.find(std::stoi(building[building.supports[s].node].name));
    if (found != printed.reactions.end())
      compare("reaction of node " + std::to_string(found->first), found->second, result.reactions[s], 1e-3,
              largest_of(printed.reactions));
  }
}

}  // namespace

TEST_CASE("Frame3DD's examples have its displacements, end forces and reactions to the digits it printed") {
  for (const std::string name : {"exA", "exB", "exE", "exH"}) {
    if (!topple::test::have_shared("reference/frame3dd/" + name + ".out")) return;
    const Building building = read_model(topple::test::shared_path("reference/frame3dd/" + name + ".3dd"));
    const auto printed = topple::test::frame3dd_output(name);
    const AnalysisResult result = analyse(building, as_the_file_asks(building));
    REQUIRE(printed.cases.size() == result.combinations.size());
    for (std::size_t k = 0; k < printed.cases.size(); ++k) {
      INFO(name << " case " << k + 1);
      REQUIRE_FALSE(printed.cases[k].displacements.empty());
      REQUIRE_FALSE(printed.cases[k].end_forces.empty());
      compare(building, result.combinations[k], printed.cases[k]);
    }
  }
}

TEST_CASE("Frame3DD's examples have its natural frequencies, but for the masses it puts on supports") {
  for (const std::string name : {"exB", "exE", "exH"}) {
    if (!topple::test::have_shared("reference/frame3dd/" + name + ".out")) return;
    const Building building = read_model(topple::test::shared_path("reference/frame3dd/" + name + ".3dd"));
    const auto printed = topple::test::frame3dd_output(name);
    const AnalysisResult result = analyse(building, as_the_file_asks(building));
    REQUIRE_FALSE(printed.frequencies.empty());
    REQUIRE(result.modes.size() == printed.frequencies.size());
    for (std::size_t m = 0; m < printed.frequencies.size(); ++m) {
      INFO(name << " mode " << m + 1);
      // Frame3DD does not hold supports: it gives them 10,000 times the trace of the mass matrix. Where a member's
      // other end turns, that lowers a frequency by up to 1e-5 of itself; 1.2e-5 leaves room for its printed digits.
      CHECK(result.modes[m].angular_frequency / (2 * 3.14159265358979323846) ==
            Approx(printed.frequencies[m]).margin(1e-6).epsilon(1.2e-5));
    }
  }
}
