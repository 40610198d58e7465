// The right-hand side of a structure that changes, against one that is summed up from nothing.
#include "reanalysis/changing_load.h"

#include <catch2/catch.hpp>

#include "frames.h"

using namespace topple::test;

namespace {

FixedEndForces under(const FrameSystem& system, int beam, double value) {
  const BeamLoad load = uniform_load(beam, system.model.beams[static_cast<std::size_t>(beam)].length,
                                     components(0.3 * value, value, -1.7 * value, 0, 0, 0));
  return system.fixed_end_forces(beam, {&load, 1});
}

void load_beam(ChangingLoad& load, const FrameSystem& system, int beam, double value) {
  load.set_beam(beam, system.model.beams[static_cast<std::size_t>(beam)], under(system, beam, value));
}

/// As both beams and nodes are loaded in the end.
ChangingLoad from_nothing(const FrameSystem& system, const std::vector<double>& on_beams,
                          const std::vector<Vec6>& on_nodes) {
  ChangingLoad load(system.model);
  for (std::size_t i = 0; i < on_beams.size(); ++i) load_beam(load, system, static_cast<int>(i), on_beams[i]);
  for (std::size_t n = 0; n < on_nodes.size(); ++n) load.set_node(static_cast<int>(n), on_nodes[n]);
  load.update(system);
  return load;
}

}  // namespace

TEST_CASE("a load brought up to date node by node has the bits of one summed up from nothing") {
  FrameModel model = tower(3, 3);
  const bool with_diaphragm = GENERATE(false, true);
  if (with_diaphragm) model.diaphragms = {{{9, 10, 11, 12}}};
  FrameSystem system(model);
  std::vector<double> on_beams(model.beams.size());
  std::vector<Vec6> on_nodes(model.nodes.size());
  for (std::size_t i = 0; i < on_beams.size(); ++i) on_beams[i] = 1000.0 / (3 + static_cast<double>(i));
  for (std::size_t n = 0; n < on_nodes.size(); ++n)
    on_nodes[n] = unit(static_cast<int>(n % 6), 100.0 / (7 + static_cast<double>(n)));
  ChangingLoad load = from_nothing(system, on_beams, on_nodes);
  REQUIRE(load.known());

  on_nodes[10] = components(1, 2, 3, 4, 5, 6);
  load.set_node(10, on_nodes[10]);
  CHECK_FALSE(load.known());
  on_beams[4] = -333;
  load_beam(load, system, 4, on_beams[4]);
  system.beam_stands[7] = 0;
  for (const int node : model.beams[7].node) load.touch(node);
  system.node_stands[20] = 0;
  load.touch(20);
  load.update(system);

  CHECK(load.known());
  const ChangingLoad fresh = from_nothing(system, on_beams, on_nodes);
  CHECK(load.vector().force == fresh.vector().force);
  CHECK(load.vector().force.lpNorm<Eigen::Infinity>() > 100);
  CHECK(load.fixed_end(4) == under(system, 4, on_beams[4]).force);
}

TEST_CASE("a load that is what it was leaves the right-hand side as it is") {
  const FrameSystem system(tower(3, 2));
  ChangingLoad load(system.model);
  load.update(system);
  load.set_node(5, Vec6::Zero());
  CHECK(load.known());
  load.set_node(5, unit(2));
  CHECK_FALSE(load.known());
}
