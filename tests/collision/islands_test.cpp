// Which bodies are solved together, alone: bounds in a row, of which neighbours touch.
#include <array>
#include <catch2/catch.hpp>

#include "debris/islands.h"

using namespace topple::collision;

namespace {

/// Six places in a row; what is at a place touches what is at the next.
struct Row {
  NearPairs pairs;
  std::array<DebrisBody, 6> bodies;
  DebrisObstacle obstacle;
  std::vector<std::uint32_t> touching;
  std::vector<IslandParts::Hung> hinges;
  std::vector<IslandParts::Tied> cables;

  Row() {
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      bodies[i].kind = Touched::Kind::body;
      bodies[i].id = static_cast<std::int64_t>(i);
    }
    obstacle.kind = Touched::Kind::obstacle;
  }
  void put(Solid& solid, std::uint64_t order, int from, int to) {
    Box3 box{Vec3(from, 0, 0), Vec3(to, 1, 1)};
    pairs.move(pairs.add(&solid, 0, order, box), box, 0.1);
  }
  std::vector<Island> find() {
    pairs.find();
    touching = pairs.order();
    std::vector<DebrisBody*> awake;
    for (DebrisBody& one : bodies)
      if (!one.asleep) awake.push_back(&one);
    return find_islands({pairs, touching, awake, hinges, cables, 0.01});
  }
  [[nodiscard]] static std::vector<std::int64_t> ids(const Island& island) {
    std::vector<std::int64_t> found;
    for (const DebrisBody* one : island.bodies) found.push_back(one->id);
    return found;
  }
};

using Ids = std::vector<std::int64_t>;

}  // namespace

TEST_CASE("islands: bodies that touch or hang together are solved together, and what sleeps joins none") {
  Row row;
  for (int i = 0; i < 6; ++i)
    row.put(row.bodies[static_cast<std::size_t>(i)], static_cast<std::uint64_t>(i), 10 * i, 10 * i + (i == 2 ? 5 : 10));
  row.bodies[4].asleep = true;  // between 3 and 5; and 2 does not reach 3
  row.bodies[0].load = 3;
  row.bodies[1].load = 7;
  row.bodies[1].substep_rate = 480;
  std::vector<Island> islands = row.find();
  REQUIRE(islands.size() == 3);
  CHECK(Row::ids(islands[0]) == Ids{0, 1, 2});
  CHECK(Row::ids(islands[1]) == Ids{3});
  CHECK(Row::ids(islands[2]) == Ids{5});
  CHECK(islands[0].pairs.size() == 2);
  CHECK(islands[1].pairs.size() == 1);  // what sleeps bears it
  CHECK(islands[2].pairs.size() == 1);
  CHECK(islands[0].load == 7);
  CHECK(islands[0].substep_rate == 480);
  for (const Island& island : islands)
    for (const DebrisBody* one : island.bodies) CHECK(&islands[static_cast<std::size_t>(one->island)] == &island);

  // A hinge joins the last two; a cable goes with its body.
  DebrisHinge hinge;
  DebrisCable cable;
  row.hinges = {{&hinge, &row.bodies[5], &row.bodies[3], nullptr}};
  row.cables = {{&cable, &row.bodies[3]}};
  islands = row.find();
  REQUIRE(islands.size() == 2);
  CHECK(Row::ids(islands[1]) == Ids{3, 5});
  CHECK(islands[1].hinges == std::vector<DebrisHinge*>{&hinge});
  CHECK(islands[1].cables == std::vector<DebrisCable*>{&cable});
  CHECK(islands[0].hinges.empty());
}

TEST_CASE("islands: an obstacle joins what lies on it while it moves, and carries it when it is fast") {
  Row row;
  for (DebrisBody& one : row.bodies) one.asleep = true;
  row.bodies[0].asleep = row.bodies[1].asleep = false;
  row.put(row.bodies[0], 0, 0, 10);
  row.put(row.bodies[1], 1, 20, 30);
  row.put(row.obstacle, 100, 5, 25);  // below both, which do not touch each other
  CHECK(row.find().size() == 2);
  row.obstacle.moves = true;
  row.obstacle.island = -1;
  row.obstacle.motion.velocity = Vec3(0.005, 0, 0);
  std::vector<Island> islands = row.find();
  REQUIRE(islands.size() == 1);
  CHECK(Row::ids(islands[0]) == Ids{0, 1});
  CHECK(islands[0].pairs.size() == 2);
  CHECK_FALSE(islands[0].carried);
  row.obstacle.island = -1;
  row.obstacle.motion.velocity = Vec3(0.02, 0, 0);
  islands = row.find();
  REQUIRE(islands.size() == 1);
  CHECK(islands[0].carried);
}
