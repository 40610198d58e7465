// What falls keeps the shape that it let go with.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>

#include "app/open_scene.h"
#include "app/session.h"

using namespace topple::viewer;

TEST_CASE("a member that lets go keeps its bend, also when it is looked back at; one that stands has none of its own") {
  const Scene scene = open_scene("seed_building");
  Session session(scene.building, scene.scenario);
  const topple::structure::NameIndex names(*scene.building);
  session.step();
  const auto standing = session.snapshot();
  session.apply(topple::structure::RemoveTool{{*names.member("P-1-1-1"), *names.member("P-1-1-2")}, {}, {}});
  std::shared_ptr<const Snapshot> last = standing;
  std::vector<Eigen::Vector3f> expected(scene.building->members.size(), Eigen::Vector3f::Zero());
  std::vector<bool> let_go(scene.building->members.size(), false);
  for (int i = 0; i < 120; ++i) {
    session.step();
    const auto now = session.snapshot();
    for (std::size_t m = 0; m < let_go.size(); ++m) {
      if (now->membership->member[m] < 0 || last->membership->member[m] != part_stands) continue;
      let_go[m] = true;
      // By hand: the turn of the first end, beside that of the line between the ends, by the answer before.
      const auto& member = scene.building->members[m];
      const auto& d1 = last->answer->displacements[static_cast<std::size_t>(member.nodes[0].index)];
      const auto& d2 = last->answer->displacements[static_cast<std::size_t>(member.nodes[1].index)];
      const Eigen::Vector3f axis = member.axes.row(0).transpose().cast<float>();
      const Eigen::Vector3f way = d2.head<3>() - d1.head<3>();
      expected[m] = d1.tail<3>() - axis.cross(way) / static_cast<float>(member.length);
      expected[m] -= expected[m].dot(axis) * axis;
    }
    last = now;
  }
  std::size_t count = 0;
  double largest = 0;
  REQUIRE(last->membership->bend.size() == let_go.size());
  const Snapshot back = session.recording()->at(last->time);
  for (std::size_t m = 0; m < let_go.size(); ++m) {
    const auto& member = scene.building->members[m];
    const Eigen::Vector3f& bend = last->membership->bend[m][0];
    if (!let_go[m]) {
      if (last->membership->member[m] == part_stands) CHECK(bend.isZero(0));
      continue;
    }
    ++count;
    CHECK(back.membership->bend[m][0] == bend);
    if (!member.offsets[0].isZero(0) || !member.offsets[1].isZero(0)) continue;
    const Eigen::Vector3f axis = member.axes.row(0).transpose().cast<float>();
    CHECK((bend - bend.dot(axis) * axis - expected[m]).norm() < 1e-5F);  // single precision
    largest = std::max(largest, static_cast<double>(bend.norm()));
  }
  REQUIRE(count > 3);
  CHECK(largest > 1e-4);
}
