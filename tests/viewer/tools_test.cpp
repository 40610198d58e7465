// What a person does with the building through the controller: tools, tuning, looking back, search.
#include <catch2/catch.hpp>
#include <fstream>

#include "app/controller.h"
#include "app/panels/tuning_panel.h"
#include "standing_still.h"
#include "support/scratch_folder.h"
#include "topple/structure/error.h"
#include "topple/structure/formats/files.h"

namespace {

using namespace topple::viewer;
using topple::structure::JointId;
using topple::structure::MemberId;

constexpr glm::dvec2 size{800, 600};

struct Person {
  Scene scene = standing_still(open_scene("seed_building"));
  Session session{scene.building, scene.scenario};
  DirectDriver driver{session};
  Controller controller{driver, scene, 0, size};
  Person() {
    // Only the frame, seen from a corner: a click meets the member that is meant.
    controller.options.shown.slabs = controller.options.shown.walls = false;
  }
  [[nodiscard]] MemberId member(const std::string& name) const { return *controller.names().member(name); }
  [[nodiscard]] JointId joint(const std::string& name) const { return *controller.names().joint(name); }
  /// Looks at a place of a member straight from outside and clicks on it.
  void click_on(const std::string& name, double share) {
    const auto& one = (*scene.building)[member(name)];
    const auto& a = (*scene.building)[one.nodes[0]].position;
    const topple::structure::Vec3 p = a + share * ((*scene.building)[one.nodes[1]].position - a);
    controller.camera.target = {p.x(), p.y(), p.z()};
    controller.camera.eye = controller.camera.target + glm::dvec3(-6, -6, 1);
    controller.click(size / 2.0);
  }
  void go(int steps) {
    for (int i = 0; i < steps; ++i) driver.advance();
  }
  [[nodiscard]] const Snapshot& now() const { return *driver.moment().later; }
  [[nodiscard]] float use(const std::string& name) const {
    return now().answer->joints[static_cast<std::size_t>(joint(name).index)].utilisation;
  }
};

}  // namespace

TEST_CASE("the cutting tool breaks the joint nearest to the click") {
  Person person;
  person.controller.key("j");
  person.click_on("P-1-1-1", 0.2);
  person.go(2);
  CHECK_FALSE(person.session.simulation().frame().intact(person.joint("P-1-1-1:1")));
  CHECK(person.controller.message == "cut P-1-1-1:1");
}

TEST_CASE("removing a part takes it away, and undo brings it back") {
  Person person;
  person.controller.key("m");
  person.click_on("P-1-1-2", 0.5);
  person.go(1);
  CHECK(person.now().membership->member[static_cast<std::size_t>(person.member("P-1-1-2").index)] == part_gone);
  person.controller.key("u");
  CHECK(person.now().membership->member[static_cast<std::size_t>(person.member("P-1-1-2").index)] == part_stands);
}

TEST_CASE("what is pointed at is marked while it stands, and no more when it has come off") {
  Person person;
  person.controller.key("m");
  const MemberId post = person.member("P-1-1-2");
  person.click_on("P-1-1-2", 0.5);  // looks at it; taken away with the next step
  person.controller.hover(size / 2.0);
  (void)person.controller.shown(false);
  CHECK(person.controller.options.hovered_member == post);
  person.go(1);
  (void)person.controller.shown(false);
  CHECK_FALSE(person.controller.options.hovered_member.valid());
  CHECK_FALSE(person.controller.hovered());
}

TEST_CASE("a support goes with a click on what stands on it, and nothing with a click elsewhere") {
  Person person;
  person.controller.key("t");
  person.click_on("P-1-1-3", 0.5);
  CHECK(person.controller.message == "remove support: P-1-1-3 stands on none");
  CHECK(person.session.actions() == 0);
  person.click_on("P-1-1-1", 0.3);
  CHECK(person.controller.message == "removed the support of N-1-1-0");
  const auto press = [&] { return -person.session.simulation().frame().demand(person.joint("P-1-1-1:1"))(0); };
  CHECK(press() > 1e5);
  person.go(1);
  // Without its support the corner post bears nothing from above; what hangs on its foot pulls.
  CHECK(press() < 1e3);
}

TEST_CASE("a charge weakens the joints around it") {
  Person person;
  person.controller.key("k");
  const float before = person.use("P-2-1-1:1");
  person.controller.hand.charge_radius = 1;
  person.click_on("P-2-1-1", 0.12);
  person.go(1);
  CHECK(person.session.simulation().frame().utilisation(person.joint("P-2-1-1:1")).value >
        1.1 * static_cast<double>(before));
}

TEST_CASE("the load path of a force on a post's head goes down through the post") {
  Person person;
  person.controller.key("l");
  person.click_on("P-1-1-6", 0.97);
  REQUIRE(person.now().path);
  const auto share = [&](const std::string& name) {
    return static_cast<double>((*person.now().path)[static_cast<std::size_t>(person.joint(name).index)]);
  };
  CHECK(share("P-1-1-6:1") > 0.5);
  CHECK(share("P-1-1-6:1") <= 1.05);
  CHECK(share("P-4-5-1:1") < 0.05);  // the far corner hears little of it
  CHECK(person.controller.options.colouring == Colouring::path);
}

TEST_CASE("the effect of a changed capacity is seen at once while paused, and undone") {
  Person person;
  person.go(1);
  person.driver.set_paused(true);
  const float before = person.use("BX-1-1-1:1");
  topple::structure::JointChange stronger;
  stronger.joints = "beams";
  stronger.strength = 2.0;
  const auto solves = person.now().counters.solves;
  person.controller.tune(stronger);
  CHECK(person.use("BX-1-1-1:1") == Approx(before / 2));
  CHECK(person.now().counters.solves == solves);
  CHECK(joint_capacity(*person.scene.building, person.now(), person.joint("BX-1-1-1:1")).value[5] == 2 * 2.4e5);
  person.controller.key("u");
  CHECK(person.use("BX-1-1-1:1") == before);
  CHECK_FALSE(person.now().tuned);
  topple::structure::JointChange wrong;
  wrong.joints = "columns";
  wrong.strength = 2.0;
  CHECK_THROWS_AS(person.controller.tune(wrong), topple::structure::InputError);
}

TEST_CASE("capacities in all seven senses are tuned for all joints, a group, or one") {
  Person person;
  const auto& building = *person.scene.building;
  const JointId one = person.joint("P-2-2-1:1"), post = person.joint("P-3-3-2:1"), beam = person.joint("BX-1-1-1:1");
  const auto value = [&](JointId joint, std::size_t sense) {
    return joint_capacity(building, person.now(), joint).value[sense];
  };
  for (std::size_t sense = 0; sense < 7; ++sense) {
    CAPTURE(topple::structure::sense_names[sense]);
    const double before[] = {value(one, sense), value(post, sense), value(beam, sense)};
    const auto set = [&](const char* joints, double to) {
      topple::structure::JointChange change;
      change.joints = joints;
      change.capacity[sense] = to;
      person.controller.tune(change);
    };
    set("P-2-2-1:1", 1e5);
    CHECK(value(one, sense) == 1e5);
    CHECK(value(post, sense) == before[1]);
    set("posts", 2e5);
    CHECK(value(one, sense) == 2e5);
    CHECK(value(post, sense) == 2e5);
    CHECK(value(beam, sense) == before[2]);
    set("*", 3e5);
    CHECK(value(beam, sense) == 3e5);
  }
}

TEST_CASE("a tuned model is written and reads back as it was tuned") {
  const topple::test::ScratchFolder folder;
  Person person;
  topple::structure::JointChange change;
  change.joints = "posts";
  change.strength = 1.5;
  person.controller.tune(change);
  const std::string file = (folder / "tuned.json").string();
  write_tuned_model(person.scene, person.now(), file);
  const auto again = topple::structure::read_model(file);
  const auto post = static_cast<std::size_t>(person.joint("P-1-1-1:1").index);
  CHECK(again.joints[post].capacity.value == person.now().tuned->capacity[post].value);
}

TEST_CASE("scrubbing pauses, shows the past, and the present comes back") {
  Person person;
  person.controller.key("m");
  person.go(10);
  person.click_on("P-1-1-1", 0.5);
  person.go(60);
  const double end = person.now().time;
  person.controller.playback().seek(5 * person.scene.scenario.step);
  CHECK(person.driver.paused());
  CHECK(person.controller.shown(true).time == Approx(5 * person.scene.scenario.step));
  CHECK(person.controller.shown(true).membership->members_standing ==
        static_cast<int>(person.scene.building->members.size()));
  person.controller.key("space");  // plays again
  person.controller.update(0.1);
  CHECK(person.controller.shown(true).time == Approx(5 * person.scene.scenario.step + 0.1).epsilon(0.2));
  person.controller.key("y");
  CHECK(person.controller.shown(true).time == end);
  person.controller.playback().seek(5 * person.scene.scenario.step);
  person.controller.playback().go_on_from_here();
  CHECK(person.session.simulation().steps() == 5);
  CHECK(person.session.actions() == 0);
}

TEST_CASE("parts are found by name, piece of a name, and pattern") {
  const Person person;
  CHECK(person.controller.search("", 10).empty());
  CHECK(person.controller.search("P-1-1-", 10).size() == 6);
  CHECK(person.controller.search("P-1-1-", 4).size() == 4);
  CHECK(person.controller.search("P-*-1-1", 10).size() == 4);
  const auto joints = person.controller.search("P-1-1-1:", 10);
  REQUIRE(joints.size() == 2);
  CHECK(joints[0] == person.joint("P-1-1-1:1"));
}

TEST_CASE(
    "a run starts again with other strengths of materials and another way of breaking, and the model is written so") {
  Person person;
  RunRules rules{person.scene.scenario.failure, topple::fracture::PanelSettings(), nullptr};
  rules.fracture->method = topple::fracture::Method::quadrilateral;
  const std::vector<topple::structure::MaterialChange> weaker{{"concrete", 0.5}};
  rules.building = building_with_strengths(person.scene, weaker);
  CHECK(*rules.building->materials[1].compressive_strength == 15e6);
  person.controller.restart(rules);
  CHECK(person.now().step == 0);
  CHECK(person.session.scenario().fracture->method == topple::fracture::Method::quadrilateral);
  CHECK(&person.session.building() == rules.building.get());
  // A ball at the middle of a wall now breaks it.
  person.driver.apply(topple::structure::Projectile{{-3, 3, 2}, {40, 0, 0}, 300, 0.3});
  person.go(40);
  bool broken = false;
  for (const auto& event : person.session.simulation().events())
    broken = broken || event.kind == topple::structure::SimulationEvent::Kind::panel_fractured;
  CHECK(broken);

  const topple::test::ScratchFolder folder;
  const std::string file = (folder / "weaker.json").string();
  write_tuned_model(person.scene, person.now(), file, weaker);
  const auto again = topple::structure::read_model(file);
  CHECK(*again.materials[1].compressive_strength == 15e6);
  CHECK(*again.materials[0].yield_strength == 355e6);
  CHECK_THROWS_WITH(building_with_strengths(person.scene, {{"wood", 2}}),
                    Catch::Contains("'wood'") && Catch::Contains("steel, concrete"));
  CHECK_THROWS_WITH(building_with_strengths(person.scene, {{"steel", 0}}), Catch::Contains("above 0"));
}

TEST_CASE("the wrecking ball swings on its cable into what is clicked on, and the cable is drawn and recorded") {
  Person person;
  person.controller.key("b");
  person.click_on("P-1-1-1", 0.6);
  CHECK(person.controller.message == "a ball swings at P-1-1-1:2");
  person.go(2);
  REQUIRE(person.now().bodies.size() == 1);
  const BodyPose ball = person.now().bodies[0];
  REQUIRE(ball.cable_anchor);
  CHECK((ball.position - *ball.cable_anchor).norm() == Approx(12).epsilon(1e-3));
  bool hit = false;
  for (int i = 0; i < 240 && !hit; ++i) {
    person.go(1);
    for (const auto& event : person.session.simulation().events())
      hit = hit || event.kind == topple::structure::SimulationEvent::Kind::impact;
  }
  CHECK(hit);
  const Snapshot then = person.driver.recording().at(0.1);
  REQUIRE(then.bodies.size() == 1);
  CHECK(then.bodies[0].cable_anchor);
}

TEST_CASE("a fire takes strength and stiffness from what is within its reach, stage by stage") {
  Person person;
  person.controller.key("z");
  person.controller.hand.burning.reach = 2;
  person.controller.hand.burning.over = 1;
  person.controller.hand.burning.strength = 0.5;
  const float before = person.use("P-1-1-1:1"), far = person.use("P-4-5-1:1");
  person.click_on("P-1-1-1", 0.1);
  person.go(90);
  // Half its strength doubles the utilisation, as far as the softer post does not hand its load on.
  CHECK(person.use("P-1-1-1:1") > 1.3F * before);
  CHECK(person.use("P-1-1-1:1") < 2.05F * before);
  CHECK(person.use("P-4-5-1:1") == Approx(far).epsilon(0.02));
}

TEST_CASE("a saved run is taken up where it was, tuning and tools with it, and undo goes on from there") {
  const topple::test::ScratchFolder folder;
  Person person;
  topple::structure::JointChange weaker;
  weaker.joints = "posts";
  weaker.strength = 0.9;
  person.controller.tune(weaker);
  person.go(5);
  person.controller.key("m");
  person.click_on("P-1-1-1", 0.5);
  person.go(20);
  const std::string file = (folder / "run.topple").string();
  person.controller.files().save(file);
  const auto hash = person.session.simulation().hash();

  Person other;
  other.go(3);
  other.controller.files().load(file);
  CHECK(other.session.simulation().hash() == hash);
  CHECK(other.now().step == person.now().step);
  // The way there can be looked back at.
  const Recording& way = other.driver.recording();
  CHECK(way.span()[0] == 0);
  CHECK(way.at(3 * person.scene.scenario.step).membership->members_standing ==
        static_cast<int>(person.scene.building->members.size()));
  CHECK(way.events().size() == person.driver.recording().events().size());
  REQUIRE(other.now().tuned);
  const auto post = static_cast<std::size_t>(other.joint("P-2-2-1:1").index);
  CHECK(other.now().tuned->capacity[post].value == person.now().tuned->capacity[post].value);
  other.controller.key("u");  // the removal
  CHECK(other.session.simulation().frame().stands(other.member("P-1-1-1")));

  std::ofstream(file) << "no run";
  CHECK_THROWS_AS(other.controller.files().load(file), topple::structure::InputError);
  CHECK_THROWS_AS(other.controller.files().load((folder / "none").string()), topple::structure::InputError);
}

TEST_CASE(
    "a run that has rested for two days is taken up in seconds, what happened before and after the rest to the bit") {
  Person person;
  person.go(5);
  person.controller.key("m");
  person.click_on("P-1-1-1", 0.5);
  person.go(1);
  REQUIRE_FALSE(person.now().at_rest);
  while (!person.now().at_rest) person.go(1);
  // The same state, as rest changes nothing of it: nine million steps later, which one by one would take minutes.
  topple::structure::Snapshot saved = topple::structure::parse_snapshot(person.session.save(), "saved");
  const std::int64_t rested_from = saved.step;
  saved.step += 9'000'000;
  Person other;
  other.session.load(saved);
  CHECK(other.session.simulation().hash() == saved.hash);
  CHECK(other.session.simulation().steps() == saved.step);
  other.go(1);
  CHECK(other.now().step == saved.step + 1);
  // The whole of it can be looked back at: how it fell, and how it lay in between.
  const Recording& way = other.driver.recording();
  const double step = person.scene.scenario.step;
  CHECK(way.span()[0] == 0);
  CHECK(way.at(static_cast<double>(rested_from + 4'000'000) * step).membership->members_standing ==
        person.now().membership->members_standing);
  const std::int64_t falling = 25;
  const Snapshot there = way.at(static_cast<double>(falling) * step),
                 then = person.driver.recording().at(static_cast<double>(falling) * step);
  REQUIRE(there.bodies.size() == then.bodies.size());
  for (std::size_t i = 0; i < there.bodies.size(); ++i) CHECK(there.bodies[i].position == then.bodies[i].position);
  // And goes on: the same as without the rest.
  for (Person* one : {&person, &other}) {
    one->controller.key("m");
    one->click_on("P-4-5-1", 0.5);
    one->go(40);
  }
  CHECK(other.session.simulation().hash() == person.session.simulation().hash());
  // To any moment of it.
  other.session.return_to(rested_from + 5'000'000);
  CHECK(other.session.simulation().hash() == saved.hash);
}

TEST_CASE("keys look along the time line: a quarter of a second each, to its ends, and on from there") {
  Person person;
  person.go(60);
  person.controller.key("bracketleft");
  REQUIRE(person.controller.playback().looking_at());
  CHECK(*person.controller.playback().looking_at() == Approx(0.75));
  CHECK(person.driver.paused());
  for (int i = 0; i < 6; ++i) person.controller.key("bracketleft");
  CHECK(*person.controller.playback().looking_at() == 0);
  person.controller.key("bracketright");
  person.controller.key("bracketright");
  CHECK(*person.controller.playback().looking_at() == Approx(0.5));
  person.controller.key("backspace");
  CHECK_FALSE(person.controller.playback().looking_at());
  CHECK(person.session.simulation().steps() == 30);
  // Beyond its end is the present; there is nothing to go on from.
  person.controller.key("bracketleft");
  person.controller.key("bracketright");
  CHECK_FALSE(person.controller.playback().looking_at());
  person.controller.key("backspace");
  CHECK(person.session.simulation().steps() == 30);
}
