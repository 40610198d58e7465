// What a person meets first: the opening scene, what its tools do to it, and what is told of it.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <optional>

#include "app/controller.h"
#include "app/open_scene.h"
#include "renderer/snapshot_taker.h"
#include "topple/structure/error.h"

namespace {

using namespace topple::viewer;
using topple::structure::JointId;

constexpr glm::dvec2 size{640, 360};

/// The opening scene as it is found, with its usual eye.
struct Person {
  Scene scene = open_scene("town_house");
  Session session{scene.building, scene.scenario};
  DirectDriver driver{session};
  Controller controller{driver, scene, 0, size};

  void run(double seconds) {
    for (const double until = session.simulation().time() + seconds; session.simulation().time() < until;) {
      driver.advance();
      controller.update(1.0 / 60);
    }
  }
  /// A click on the middle of a wall's upper part, or of a post.
  void click(const std::string& part) {
    const auto& building = controller.building();
    const auto& names = controller.names();
    topple::structure::Vec3 at;
    if (const auto member = names.member(part))
      at = (building[building[*member].nodes[0]].position + building[building[*member].nodes[1]].position) / 2;
    else
      at = 0.25 * building[building[*names.panel(part)].nodes[0]].position +
           0.75 * building[building[*names.panel(part)].nodes[2]].position;
    const glm::dvec3 pixel = controller.camera.project({at.x(), at.y(), at.z()}, size);
    controller.click({pixel.x, pixel.y});
  }
  [[nodiscard]] double fallen_mass() const {
    double mass = 0;
    for (const auto& body : session.simulation().bodies())
      if (body.radius == 0) mass += body.mass;
    return mass;
  }
};

std::string refused(const std::string& name) {
  try {
    (void)open_scene(name);
  } catch (const topple::structure::InputError& error) {
    return error.what();
  }
  return {};
}

}  // namespace

TEST_CASE("the opening scene stands by itself, and the usual shot, ball and charge each bring tonnes of it down") {
  // A quarter of a wall of one bay (4.8 m x 3.1 m x 0.24 m of brick at 1,800 kg/m3) is a tonne and a half.
  constexpr double visible = 1500;
  Person still;
  still.run(2);
  CHECK(still.fallen_mass() == 0);
  CHECK(still.session.simulation().at_rest());
  for (const ToolKind tool : {ToolKind::fire, ToolKind::swing, ToolKind::charge}) {
    CAPTURE(tool_names[static_cast<std::size_t>(tool)]);
    Person person;
    person.run(0.1);
    person.controller.hand.tool = tool;
    person.click(tool == ToolKind::charge ? "P-4-1-1" : "front-3-2");
    person.run(4);
    CHECK(person.fallen_mass() > visible);
  }
}

TEST_CASE("a joint that a charge has weakened is told with the capacity that it has left") {
  Person person;
  person.run(0.1);
  const auto& building = person.controller.building();
  const JointId joint = *person.controller.names().joint("P-2-2-1:1");
  const auto& at = building[building[building[joint].member].nodes[0]].position;
  topple::structure::ChargeTool charge;
  charge.centre = at + topple::structure::Vec3(0, 0, -1);
  charge.radius = 2.5;  // linear: 1 m away 0.4 is left
  person.driver.apply(charge);
  person.run(0.1);
  SnapshotTaker taker;
  const Snapshot moment = taker.capture(person.session.simulation(), nullptr);
  const FrameAnswer::Joint& told = moment.answer->joints[static_cast<std::size_t>(joint.index)];
  REQUIRE(told.intact);
  CHECK(told.strength == Approx(0.4).epsilon(1e-6));  // single precision
  // What is written beside it: demand over what is left in the sense that is used most is the utilisation.
  const auto sense = static_cast<std::size_t>(told.sense);
  const double left = static_cast<double>(told.strength) * building[joint].capacity.value[sense];
  CHECK(std::abs(static_cast<double>(told.demand[0])) / left ==
        Approx(static_cast<double>(told.utilisation)).epsilon(1e-5));
}

TEST_CASE("a name that is neither a scenario nor a model is refused with both lists") {
  const std::string said = refused("no_such_scene");
  CHECK(said.find("there is no such scenario or model") != std::string::npos);
  CHECK(said.find("seed_hit,") != std::string::npos);
  CHECK(said.find("seed_building,") != std::string::npos);
  CHECK(refused("town_hous").find("did you mean town_house?") != std::string::npos);
}
