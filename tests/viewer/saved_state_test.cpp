// A saved run whose state is kept is there at once, and is the run that doing it again would make.
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "app/controller.h"
#include "standing_still.h"
#include "support/scratch_folder.h"
#include "topple/structure/snapshot.h"
#include "topple/structure/state_store.h"

namespace {

using namespace topple::viewer;
namespace structure = topple::structure;

/// A post of the seed building goes after a few steps, tuned and shaken before, with states kept in a folder.
struct Run {
  explicit Run(const std::filesystem::path& states)
      : session(scene.building, scene.scenario, nullptr, std::make_shared<Recording>(),
                structure::StateStore(states / "states")) {}
  void act() {
    structure::JointChange weaker;
    weaker.joints = "posts";
    weaker.strength = 0.9;
    session.tune(weaker);
    go(5);
    structure::RemoveTool remove;
    remove.members.push_back(*structure::NameIndex(*scene.building).member("P-1-1-1"));
    session.apply(remove);
    go(40);
  }
  void go(int steps) {
    for (int i = 0; i < steps; ++i) driver.advance();
  }

  Scene scene = standing_still(open_scene("seed_building"));
  Session session;
  DirectDriver driver{session};
};

}  // namespace

TEST_CASE("a saved run whose state is kept is taken up without doing it again, with tuning, events and undo") {
  const topple::test::ScratchFolder folder;
  Run first(folder.path());
  first.act();
  const structure::Snapshot saved = structure::parse_snapshot(first.session.save(), "saved");
  const auto hash = first.session.simulation().hash();
  first.go(60);

  Run other(folder.path());
  other.driver.order_and_show([&](Session& session) { session.load(saved); });
  CHECK(other.session.simulation().hash() == hash);
  const double at = other.session.simulation().time();
  CHECK(at == Approx(45.0 / 60));
  CHECK(other.session.recording()->span()[0] == Approx(at));  // nothing was done again
  CHECK(other.session.recording()->events().size() > 3);
  CHECK(other.session.actions() == 2);
  REQUIRE(other.driver.moment().later->tuned);
  CHECK(other.driver.moment().later->tuned->capacity[0].value == first.driver.moment().later->tuned->capacity[0].value);
  other.go(60);
  CHECK(other.session.simulation().hash() == first.session.simulation().hash());

  other.driver.order_and_show([](Session& session) { session.record_past(); });
  CHECK(other.session.recording()->span()[0] == 0);
  CHECK(other.session.simulation().hash() == first.session.simulation().hash());
  CHECK(other.session.recording()->events().size() == first.session.recording()->events().size());
  CHECK(other.session.undo());
  CHECK(other.session.simulation().steps() == 5);
}

TEST_CASE("a state that is damaged, or another's to write, is not read: the saved run is done again") {
  const topple::test::ScratchFolder folder;
  Run first(folder.path());
  first.act();
  const structure::Snapshot saved = structure::parse_snapshot(first.session.save(), "saved");
  std::vector<std::filesystem::path> kept;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "states")) kept.push_back(entry.path());
  REQUIRE(kept.size() == 1);
  const auto load = [&] {
    Run other(folder.path());
    other.driver.order_and_show([&](Session& session) { session.load(saved); });
    CHECK(other.session.simulation().hash() == saved.hash);
    return other.session.recording()->span()[0];
  };
  CHECK(load() > 0.5);
  using std::filesystem::perms;
  std::filesystem::permissions(kept[0], perms::others_write, std::filesystem::perm_options::add);
  CHECK(load() == 0);
  std::filesystem::permissions(kept[0], perms::others_write, std::filesystem::perm_options::remove);
  CHECK(load() > 0.5);
  const auto size = std::filesystem::file_size(kept[0]);
  std::fstream file(kept[0], std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(static_cast<std::streamoff>(size / 2));
  file.put('x').put('y').put('z');
  file.close();
  CHECK(load() == 0);
  std::filesystem::resize_file(kept[0], size / 2);
  CHECK(load() == 0);
}
