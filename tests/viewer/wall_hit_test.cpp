// A click on the wall fires, and the wall breaks where the ball touches it, whatever it breaks into.
#include <catch2/catch.hpp>
#include <cmath>

#include "app/controller.h"
#include "app/open_scene.h"

namespace {

using namespace topple::viewer;
using topple::structure::PanelId;
using topple::structure::SimulationEvent;
using topple::structure::Vec3;

constexpr glm::dvec2 size{800, 600};

/// The wall as a person finds it when the scenario's own ball is left out.
struct Person {
  explicit Person(const std::string& name) : scene(open_scene(name)) {
    scene.scenario.events.clear();
    scene.scenario.until_rest = false;
    session.emplace(scene.building, scene.scenario);
    driver.emplace(*session);
    controller.emplace(*driver, scene, 0, size);
    controller->camera.target = {3.6, 0, 1.7};
    controller->camera.eye = {1.5, -9, 3.5};
  }
  Scene scene;
  std::optional<Session> session;
  std::optional<DirectDriver> driver;
  std::optional<Controller> controller;
};

const SimulationEvent* fractured(const topple::structure::Simulation& simulation) {
  for (const SimulationEvent& event : simulation.events())
    if (event.kind == SimulationEvent::Kind::panel_fractured) return &event;
  return nullptr;
}

}  // namespace

TEST_CASE("a click on the wall breaks it where the ray meets it, with each method") {
  for (const std::string name : {"wall_hit", "wall_hit_quadrilateral", "wall_hit_local"}) {
    CAPTURE(name);
    Person person(name);
    person.driver->advance();
    person.controller->hand.shot.speed = 120;
    person.controller->hand.shot.mass = 200;
    person.controller->hand.shot.radius = 0.15;
    const glm::dvec2 pixel = size / 2.0 + glm::dvec2(40, -25);
    const Ray ray = person.controller->camera.ray(pixel, size);
    const auto along = [](const glm::dvec3& v) { return Vec3(v.x, v.y, v.z); };
    const auto met = person.session->simulation().ray_cast(along(ray.origin), along(ray.direction));
    REQUIRE(met);
    REQUIRE(met->panel == PanelId(0u));
    person.controller->click(pixel);
    for (int i = 0; i < 20 && !fractured(person.session->simulation()); ++i) person.driver->advance();
    const SimulationEvent* broke = fractured(person.session->simulation());
    REQUIRE(broke);
    CHECK(broke->name == "W");
    // The ball's centre flies to the point that the ray meets, a little above the ray on its way; its surface touches
    // the face straight in front of the centre, r away from it: so much short of the point along the wall as the centre
    // is then away from the face.
    const double r = person.controller->hand.shot.radius, cosine = std::abs(ray.direction.y);
    const double short_of = r * std::tan(std::acos(cosine));
    CHECK((broke->position - met->point).norm() < short_of + 0.02);
    CHECK(std::abs(broke->position.y() + 0.1) < 1e-3);  // on the face
    CHECK((broke->position - met->point).norm() > short_of - 0.02);
    // What is drawn has the hole, and what was there flies.
    CHECK_FALSE(person.session->simulation().bodies().empty());
    const auto through = person.session->simulation().ray_cast(along(ray.origin), along(ray.direction));
    CHECK((!through || through->panel != PanelId(0u)));
  }
}
