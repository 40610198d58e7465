// What a structure is to become, and what of it is a change.
#include "reanalysis/requested_changes.h"

#include <catch2/catch.hpp>

#include "frames.h"

using namespace topple::test;

namespace {

std::vector<int> listed(std::span<const int> numbers) { return {numbers.begin(), numbers.end()}; }

}  // namespace

TEST_CASE("what is asked for twice, or is so already, is one change or none") {
  const FrameModel model = tower(3, 2);
  RequestedChanges changes(model);
  CHECK(changes.none());
  changes.set_end_stiffness(3, 0, model.beams[3].end_stiffness[0]);
  changes.set_beam_removed(3, false);
  changes.set_beam_factor(3, 1);
  changes.set_beam_density(3, model.beams[3].density);
  changes.set_beam_loads(3, {});
  CHECK(changes.none());

  changes.set_beam_removed(5, true);
  changes.set_end_stiffness(3, 1, Vec6::Zero());
  changes.set_beam_factor(3, 0.5);
  changes.set_beam_factor(3, 0.5);
  CHECK_FALSE(changes.none());
  CHECK(listed(changes.beams()) == std::vector<int>{5, 3, 3});
  CHECK(listed(changes.sorted_beams()) == std::vector<int>{3, 5});

  changes.clear();
  CHECK(changes.none());
  CHECK(changes.beam(5).removed);
  CHECK(changes.beam(3).end_stiffness[1].isZero(0));
  CHECK(changes.beam(3).factor == 0.5);
}

TEST_CASE("loads are told apart by their values, not by the beam that they name") {
  RequestedChanges changes(tower(3, 2));
  const double length = 3;
  changes.set_beam_loads(4, {uniform_load(0, length, unit(2, -4000))});
  CHECK(changes.beam(4).loads.at(0).beam == 4);
  changes.clear();
  changes.set_beam_loads(4, {uniform_load(7, length, unit(2, -4000))});
  CHECK(changes.none());
  changes.set_beam_loads(4, {uniform_load(4, length, unit(2, -4001))});
  CHECK(listed(changes.beams()) == std::vector<int>{4});
}

TEST_CASE("a stiffness is the one that was given, then the model's, then the element's own") {
  FrameModel model = tower(3, 2);
  model.shells = {{{0, 1, 10, 9}, 30e9, 0.2, 0.2, 2400, false}, {{1, 2, 11, 10}, 30e9, 0.2, 0.2, 2400, false}};
  model.shell_stiffness[1] = Eigen::Matrix<double, 24, 24>::Identity();
  RequestedChanges changes(model);
  CHECK(changes.stiffness_of_shell(model, 0) == nullptr);
  CHECK(changes.stiffness_of_shell(model, 1) == &model.shell_stiffness[1]);
  changes.set_shell_stiffness(1, 2 * model.shell_stiffness[1]);
  REQUIRE(changes.stiffness_of_shell(model, 1) != nullptr);
  CHECK((*changes.stiffness_of_shell(model, 1))(3, 3) == 2);
}
