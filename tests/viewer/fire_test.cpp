// Fire, smoke and the ball of an explosion: where they are seen, for how long, and that what is brighter than white
// spreads.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "app/open_scene.h"
#include "app/session.h"
#include "renderer/picture_renderer.h"
#include "renderer/shapes/dust.h"

namespace {

using namespace topple::viewer;
using Kind = DustPuff::Kind;

std::size_t count(const Snapshot& moment, Kind kind) {
  if (!moment.dust) return 0;
  return static_cast<std::size_t>(
      std::count_if(moment.dust->begin(), moment.dust->end(), [=](const DustPuff& puff) { return puff.kind == kind; }));
}

/// A fire around the foot of a corner post, for a second and a half.
struct Fire {
  Scene scene = open_scene("seed_building");
  Session session{scene.building, scene.scenario};
  std::shared_ptr<const Snapshot> last = session.snapshot();
  topple::structure::MemberId post = *topple::structure::NameIndex(*scene.building).member("P-1-1-1");
  Fire() {
    topple::structure::WeakenTool fire;
    fire.members = {post};
    fire.strength = fire.stiffness = 0.9;
    fire.over = 1.5;
    fire.stages = 3;
    session.apply(fire);
  }
  void go(int steps) {
    for (int i = 0; i < steps; ++i) {
      session.step();
      last = session.snapshot();
    }
  }
};

}  // namespace

TEST_CASE("a fire is seen where it burns, as long as it burns, and its smoke for a while after") {
  Fire fire;
  fire.go(60);
  REQUIRE(count(*fire.last, Kind::fire) > 3);
  const auto& member = (*fire.scene.building)[fire.post];
  const Eigen::Vector3d middle =
      ((*fire.scene.building)[member.nodes[0]].position + (*fire.scene.building)[member.nodes[1]].position) / 2;
  for (const DustPuff& puff : *fire.last->dust) CHECK((puff.position - middle).norm() < 1e-9);
  fire.go(60);
  double latest = 0;
  for (const DustPuff& puff : *fire.last->dust) latest = std::max(latest, puff.time);
  CHECK(latest <= 1.5 + 1.0 / 60 + 1e-9);
  CHECK(latest > 1.2);
  fire.go(static_cast<int>(60 * dust_life));
  CHECK(count(*fire.last, Kind::fire) == 0);
  // A run made again burns at the same times.
  const auto then = fire.session.recording()->at(1.0);
  fire.session.return_to(60);
  const auto again = fire.session.snapshot();
  CHECK(count(then, Kind::fire) > 0);
  CHECK(count(*again, Kind::fire) > 0);
}

TEST_CASE("flames rise and go out, and smoke is carried by the wind") {
  const std::vector<DustPuff> licks{{3, 1.0, {0, 0, 2}, 0.8F, Kind::fire}};
  std::vector<DustInstance> young, old;
  append_dust(licks, 1.3, glm::dvec3(0), young);
  append_dust(licks, 4.0, glm::dvec3(0), old);
  REQUIRE(young.size() > 1);
  REQUIRE(old.size() == 1);  // smoke alone
  CHECK(young[0].colour >> 24U == 255);
  CHECK(old[0].colour >> 24U == 0);
  CHECK(old[0].position.z > 4);
  CHECK(glm::dot(glm::vec2(old[0].position), glm::vec2(wind[0], wind[1])) > 2);
}

TEST_CASE("a charge that goes off shows a ball that glows, by the cube root of the charge, and ends as soot") {
  Scene scene = open_scene("town_house");
  Session session(scene.building, scene.scenario);
  session.step();
  session.explode({{11, -0.5, 4.2}, 8});
  const auto one = session.snapshot();
  REQUIRE(count(*one, Kind::blast) == 1);
  session.step();
  session.explode({{11, -0.5, 4.2}, 64});
  const auto both = session.snapshot();
  std::vector<float> sizes;
  for (const DustPuff& puff : *both->dust)
    if (puff.kind == Kind::blast) sizes.push_back(puff.size);
  REQUIRE(sizes.size() == 2);
  CHECK(sizes[1] == Approx(2 * sizes[0]));
  const auto glow = [](double age) {
    std::vector<DustInstance> discs;
    append_dust({{0, 0.0, {0, 0, 2}, 2.0F, Kind::blast}}, age, glm::dvec3(0), discs);
    return discs.at(0).colour >> 24U;
  };
  CHECK(glow(0.01) > 200);
  CHECK(glow(0.2) < glow(0.1));
  CHECK(glow(1.0) == 0);
}

TEST_CASE("what glows spreads beyond its rim, dust does not") {
  const Scene scene = open_scene("seed_building");
  PictureRenderer renderer(*scene.building, 0, 320, 240);
  const Camera camera = renderer.default_camera();
  Snapshot snapshot = undeformed(*scene.building);
  snapshot.time = 0.04;
  const glm::dvec3 place = camera.eye + 0.4 * (renderer.scene().origin() - camera.eye);
  const auto picture = [&](Kind kind) {
    snapshot.dust = std::make_shared<const std::vector<DustPuff>>(
        std::vector<DustPuff>{{0, 0.0, {place.x, place.y, place.z}, 1.0F, kind}});
    return renderer.draw(snapshot, camera, {});
  };
  const Image clear = renderer.draw(undeformed(*scene.building), camera, {});
  // Pixels that are redder than without it: those of the ball and those around that its light spreads to.
  const auto brighter = [&](const Image& image) {
    std::size_t pixels = 0;
    for (std::size_t i = 0; i < image.pixels.size(); i += 4)
      pixels += image.pixels[i] > clear.pixels[i] + 4 &&
                        image.pixels[i] - clear.pixels[i] > image.pixels[i + 2] - clear.pixels[i + 2]
                    ? 1
                    : 0;
    return pixels;
  };
  CHECK(brighter(picture(Kind::blast)) > 4 * std::max<std::size_t>(brighter(picture(Kind::dust)), 20));
}
