// States of saved runs, kept in a folder: found by their snapshots alone, bounded, the oldest gone first.
#include "topple/structure/state_store.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <thread>
#include <vector>

#include "support/scratch_folder.h"
#include "topple/collision/sequential_impulse.h"
#include "topple/structure/formats/files.h"
#include "topple/structure/simulation.h"

using namespace topple::structure;
namespace fs = std::filesystem;

namespace {

/// A ball flies at the corner of the seed building.
Simulation seed_hit(std::unique_ptr<topple::collision::World> (*make_world)() = nullptr) {
  auto [building, scenario] = read_scenario(find_scenario("seed_hit"));
  scenario.duration = 3;
  SimulationOptions options;
  if (make_world != nullptr) options.make_world = make_world;
  return Simulation(std::move(building), std::move(scenario), options);
}

void run_to(Simulation& simulation, double time) {
  while (simulation.time() < time - 1e-9) simulation.step();
}

std::vector<fs::path> files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

TEST_CASE("a simulation that loads a kept state ends like the one that it was kept of, with its events and accounts") {
  const topple::test::ScratchFolder folder;
  const StateStore states(folder / "states");
  Simulation through = seed_hit();
  run_to(through, 1.7);
  REQUIRE(!through.bodies().empty());
  const Snapshot snapshot = through.save();
  REQUIRE(states.keep(through));
  run_to(through, 3);

  Simulation resumed = seed_hit();
  REQUIRE(states.load(snapshot, resumed));
  CHECK(resumed.hash() == snapshot.hash);
  CHECK(resumed.steps() == snapshot.step);
  run_to(resumed, 3);
  CHECK(resumed.hash() == through.hash());
  CHECK(resumed.events().size() == through.events().size());
  CHECK(resumed.ledger().residual() == through.ledger().residual());
}

TEST_CASE("a snapshot of another moment, or of what was done otherwise, finds no state, and nothing changes") {
  const topple::test::ScratchFolder folder;
  const StateStore states(folder / "states");
  Simulation one = seed_hit();
  run_to(one, 0.2);
  CHECK_FALSE(states.load(one.save(), one));  // the folder is not there
  REQUIRE(states.keep(one));
  one.step();
  const std::uint64_t hash = one.hash();
  CHECK_FALSE(states.load(one.save(), one));
  CHECK(one.hash() == hash);
}

TEST_CASE("a state above the limit is not kept, and old ones make room for new ones") {
  const topple::test::ScratchFolder folder;
  Simulation one = seed_hit();
  run_to(one, 0.1);
  REQUIRE(StateStore(folder / "all").keep(one));
  const std::uintmax_t size = fs::file_size(files_in(folder / "all").at(0));
  CHECK_FALSE(StateStore(folder / "small", {size / 2, size}).keep(one));
  CHECK_FALSE(fs::exists(folder / "small"));

  const StateStore two(folder / "two", {2 * size, 5 * size / 2});
  std::vector<Snapshot> snapshots;
  for (int i = 0; i < 3; ++i) {
    REQUIRE(two.keep(one));
    snapshots.push_back(one.save());
    one.step();
    std::this_thread::sleep_for(std::chrono::milliseconds(20));  // times of files tell the order
  }
  CHECK(files_in(folder / "two").size() == 2);
  Simulation other = seed_hit();
  CHECK_FALSE(two.load(snapshots[0], other));
  CHECK(two.load(snapshots[1], other));
  CHECK(two.load(snapshots[2], other));
}

TEST_CASE("no state is kept where the folder cannot be made, or the collision engine has none to give") {
  const topple::test::ScratchFolder folder;
  Simulation one = seed_hit();
  run_to(one, 0.1);
  CHECK_FALSE(StateStore("/proc/none/states").keep(one));
  Simulation bullet = seed_hit(&topple::collision::make_sequential_impulse_world);
  run_to(bullet, 0.1);
  CHECK_FALSE(StateStore(folder / "states").keep(bullet));
}
