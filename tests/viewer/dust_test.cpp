// Dust where things break and land: what throws it up, how it ages, and that it is seen.
#include <catch2/catch.hpp>
#include <cmath>

#include "app/open_scene.h"
#include "app/session.h"
#include "renderer/picture_renderer.h"
#include "renderer/shapes/dust.h"

namespace {

using namespace topple::viewer;

/// A post of the seed building is taken away: joints break at once, and what they held lands later.
struct Fall {
  Scene scene = open_scene("seed_building");
  Session session{scene.building, scene.scenario};
  std::shared_ptr<const Snapshot> last;
  Fall() {
    const topple::structure::NameIndex names(*scene.building);
    last = session.snapshot();
    session.apply(topple::structure::RemoveTool{{*names.member("P-1-1-1"), *names.member("P-1-1-2")}, {}, {}});
  }
  void go(int steps) {
    for (int i = 0; i < steps; ++i) {
      session.step();
      last = session.snapshot();
    }
  }
};

}  // namespace

TEST_CASE("nothing throws up dust while nothing moves, breaks do where they are, landings where they touch") {
  Fall fall;
  CHECK_FALSE(fall.last->dust);
  fall.go(30);
  REQUIRE(fall.last->dust);
  for (const DustPuff& puff : *fall.last->dust) {
    CHECK(puff.time <= fall.last->time);
    double nearest = 1e9;
    for (const auto& event : fall.session.simulation().events())
      nearest = std::min(nearest, (event.position - puff.position).norm());
    CHECK(nearest < 1.0 + 1e-9);  // puffs closer than a metre are one
  }
  fall.go(240);
  bool landed = false;
  for (const DustPuff& puff : *fall.last->dust) landed = landed || (puff.position.z() < 1 && puff.size > 0.3F);
  CHECK(landed);
  // Looking back shows what was seen then.
  fall.go(60);
  const Snapshot then = fall.session.recording()->at(1.0);
  REQUIRE(then.dust);
  for (const DustPuff& puff : *then.dust) CHECK(puff.time <= 1.0 + 1e-9);
}

TEST_CASE("a puff spreads, thins out and is gone") {
  const std::vector<DustPuff> puffs{{7, 2.0, {1, 2, 3}, 1.5F}};
  const auto at = [&](double time) {
    std::vector<DustInstance> discs;
    append_dust(puffs, time, glm::dvec3(0), discs);
    return discs;
  };
  CHECK(at(1.9).empty());
  CHECK(at(2.0 + dust_life).empty());
  const auto young = at(2.2), old = at(4.5);
  REQUIRE(young.size() == old.size());
  REQUIRE_FALSE(young.empty());
  for (std::size_t i = 0; i < young.size(); ++i) {
    CHECK(old[i].radius > young[i].radius);
    CHECK(old[i].opacity < young[i].opacity);
    // As far as it was thrown, and the wind has carried it since.
    const double carried = 2.5 * std::hypot(wind[0], wind[1], 0.15 * 1.5);
    CHECK(glm::length(glm::dvec3(old[i].position) - glm::dvec3(1, 2, 3)) < 1.5 * std::sqrt(1 + 0.6 * 0.6) + carried);
  }
}

TEST_CASE("dust is seen, and not when it is switched off") {
  const Scene scene = open_scene("seed_building");
  PictureRenderer renderer(*scene.building, 0, 320, 240);
  const Camera camera = renderer.default_camera();
  Snapshot snapshot = undeformed(*scene.building);
  snapshot.time = 0.6;
  const auto difference = [](const Image& a, const Image& b) {
    std::size_t pixels = 0;
    for (std::size_t i = 0; i < a.pixels.size(); i += 4)
      pixels += std::abs(a.pixels[i] - b.pixels[i]) + std::abs(a.pixels[i + 2] - b.pixels[i + 2]) > 12 ? 1 : 0;
    return pixels;
  };
  const Image clear = renderer.draw(snapshot, camera, {});
  // A cloud before the near corner.
  const glm::dvec3 toward = camera.eye + 0.4 * (renderer.scene().origin() - camera.eye);
  snapshot.dust = std::make_shared<const std::vector<DustPuff>>(
      std::vector<DustPuff>{{0, 0.2, {toward.x, toward.y, toward.z}, 3.0F}});
  const Image dusty = renderer.draw(snapshot, camera, {});
  CHECK(difference(clear, dusty) > 300);
  ViewOptions off;
  off.dust = false;
  CHECK(difference(clear, renderer.draw(snapshot, camera, off)) == 0);
}
