// What leaves the viewer: USD, the replay page, videos; and the panels without a window.
#include <sys/stat.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "app/headless.h"
#include "app/output/gltf_scene.h"
#include "app/output/html_replay.h"
#include "app/output/usd_scene.h"
#include "app/output/video.h"
#include "app/part_motion.h"
#include "app/session.h"
#include "renderer/instances/scene_instances.h"
#include "support/scratch_folder.h"

namespace {

using namespace topple::viewer;
using topple::test::ScratchFolder;

std::string text_of(const std::string& file) {
  std::ifstream stream(file);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}
std::size_t count(const std::string& text, const std::string& what) {
  std::size_t found = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++found;
  return found;
}

/// Two posts of the seed building are taken away; a second and a half of it.
struct Fall {
  Scene scene = open_scene("seed_building");
  Session session{scene.building, scene.scenario};
  Fall() {
    const topple::structure::NameIndex names(*scene.building);
    (void)session.snapshot();
    session.apply(topple::structure::RemoveTool{{*names.member("P-1-1-1"), *names.member("P-1-1-2")}, {}, {}});
    for (int i = 0; i < 90; ++i) {
      session.step();
      (void)session.snapshot();
    }
  }
};

}  // namespace

TEST_CASE("USD holds each part once, its motion as samples, and balanced braces") {
  const ScratchFolder folder;
  const Fall fall;
  const std::string file = (folder / "fall.usda").string();
  write_usd(*fall.scene.building, *fall.session.recording(), file);
  const std::string usd = text_of(file);
  CHECK(usd.rfind("#usda 1.0\n", 0) == 0);
  CHECK(count(usd, "def Mesh \"") >= fall.scene.building->members.size() + fall.scene.building->panels.size());
  CHECK(count(usd, "{") == count(usd, "}"));
  CHECK(count(usd, "[") == count(usd, "]"));
  CHECK(usd.find("upAxis = \"Z\"") != std::string::npos);
  CHECK(usd.find("endTimeCode = 45") != std::string::npos);  // 1.5 s at 30 a second
  CHECK(usd.find("def Mesh \"P_1_1_1\"") != std::string::npos);
  CHECK(count(usd, "\"invisible\"") >= 2);  // what was removed
  CHECK(count(usd, "xformOp:translate.timeSamples") > 0);
}

TEST_CASE("glTF holds a node for each part by its name, moved as its body moves") {
  const ScratchFolder folder;
  const Fall fall;
  const std::string file = (folder / "fall.glb").string();
  write_gltf(*fall.scene.building, *fall.session.recording(), file);
  const std::string bytes = text_of(file);
  REQUIRE(bytes.size() > 20);
  CHECK(bytes.substr(0, 4) == "glTF");
  std::uint32_t whole = 0, chunk = 0;
  std::memcpy(&whole, bytes.data() + 8, 4);
  std::memcpy(&chunk, bytes.data() + 12, 4);
  CHECK(whole == bytes.size());
  const auto gltf = nlohmann::json::parse(bytes.substr(20, chunk));
  std::map<std::string, int> nodes;
  for (const auto& node : gltf["nodes"])
    if (node.contains("name")) ++nodes[node["name"].get<std::string>()];
  for (const auto& member : fall.scene.building->members) CHECK(nodes[member.name] == 1);
  for (const auto& panel : fall.scene.building->panels) CHECK(nodes[panel.name] == 1);
  // As many shapes as members of different section, kind and length, and one for each panel.
  CHECK(gltf["meshes"].size() < fall.scene.building->members.size() + fall.scene.building->panels.size());
  // What moves has a channel of places, with a body or as it stands; what stands still has none.
  int moving = 0;
  const auto& recording = *fall.session.recording();
  const auto all = part_places(*fall.scene.building, recording);
  for (std::size_t part = 0; part < all.size(); ++part) {
    const auto shapes = part_shapes(*fall.scene.building, recording, part);
    const bool falls =
        std::any_of(all[part].begin(), all[part].end(), [](const PlaceChange& p) { return p.track >= 0; });
    const bool sways = std::any_of(shapes.begin(), shapes.end(), [&](const ShapeChange& one) {
      return !(one.shape.pose == shapes.front().shape.pose);
    });
    moving += falls || sways ? 1 : 0;
  }
  CHECK(static_cast<std::size_t>(moving) < all.size());
  int moved = 0;
  for (const auto& channel : gltf["animations"][0]["channels"])
    moved += channel["target"]["path"] == "translation" ? 1 : 0;
  CHECK(moving > 0);
  CHECK(moved == moving);
}

TEST_CASE("what remains of a panel that breaks where it stands is in every export, from the frame on where it broke") {
  const ScratchFolder folder;
  const Scene scene = open_scene("seed_hit_fracture");
  Session session(scene.building, scene.scenario);
  // A ball flies at the middle of a wall.
  session.apply(topple::structure::Projectile{{-3, 3, 2}, {40, 0, 0}, 300, 0.3});
  (void)session.snapshot();
  const auto broken = [&] {
    for (const auto& states : panel_states(*scene.building, *session.recording()))
      if (states.size() > 1 && states.back().remains) return true;
    return false;
  };
  for (int i = 0; i < 60 && !broken(); ++i) {
    session.step();
    (void)session.snapshot();
  }
  const auto all = panel_states(*scene.building, *session.recording());
  std::size_t states = 0;
  for (std::size_t p = 0; p < all.size(); ++p) {
    REQUIRE_FALSE(all[p].empty());
    CHECK(all[p][0].frame == 0);
    CHECK_FALSE(all[p][0].remains);
    states += all[p].size();
    for (std::size_t k = 1; k < all[p].size(); ++k) {
      CHECK(all[p][k].frame > all[p][k - 1].frame);
      const Mesh mesh = placed_panel_mesh(*scene.building, scene.building->panels[p], all[p][k], {1, 2, 3});
      if (!all[p][k].remains) continue;
      REQUIRE(mesh.vertices.size() == all[p][k].remains->positions.size());
      CHECK(mesh.vertices[0].position.x == Approx(all[p][k].remains->positions[0].x() - 1));
    }
  }
  REQUIRE(states > all.size());
  const std::string usd = (folder / "broken.usda").string();
  write_usd(*scene.building, *session.recording(), usd);
  CHECK(count(text_of(usd), "_rest") >= states - all.size());
  if (!can_write_replay()) return;
  const std::string page = (folder / "broken.html").string();
  write_html_replay(*scene.building, *session.recording(), page);
  CHECK(count(text_of(page), "\"frame\":") == states);
}

TEST_CASE("a model drawn around the building is in every export, its pieces from the cut that makes them on") {
  const ScratchFolder folder;
  const Scene scene = open_scene("seed_house_hit");
  REQUIRE(scene.drawn);
  Session session(scene.building, scene.scenario, scene.drawn);
  while (session.simulation().time() < 2) {
    session.step();
    (void)session.snapshot();
  }
  const Recording& recording = *session.recording();
  const std::vector<DrawnTrack> pieces = drawn_tracks(*scene.building, recording);
  REQUIRE(pieces.size() > scene.drawn->size());
  std::size_t at_first = 0, at_last = 0;
  int moving = 0;
  for (const DrawnTrack& piece : pieces) {
    REQUIRE_FALSE(piece.places.empty());
    CHECK(piece.places.front().frame == 0);
    for (std::size_t k = 1; k < piece.places.size(); ++k) {
      CHECK(piece.places[k].frame > piece.places[k - 1].frame);
      CHECK(piece.places[k].track != piece.places[k - 1].track);
    }
    at_first += piece.places.front().track != part_gone;
    at_last += piece.places.back().track != part_gone;
    moving += piece.places.back().track >= 0;
  }
  CHECK(at_first == scene.drawn->size());
  CHECK(at_last == recording.frames().back().drawn->size());
  CHECK(moving > 0);
  const Mesh placed = placed_mesh(*pieces[0].mesh, {1, 2, 3});
  CHECK(placed.vertices[0].position.y == Approx(pieces[0].mesh->positions[0].y() - 2));

  const std::string usd = (folder / "house.usda").string();
  write_usd(*scene.building, recording, usd);
  const std::string usd_text = text_of(usd);
  CHECK(count(usd_text, "def Mesh \"drawn_") == pieces.size());
  CHECK(count(usd_text, "{") == count(usd_text, "}"));
  const std::string glb = (folder / "house.glb").string();
  write_gltf(*scene.building, recording, glb, 60);  // as often as was recorded: none falls between two frames
  CHECK(count(text_of(glb), "\"name\":\"drawn ") == pieces.size());
  if (!can_write_replay()) return;
  const std::string page = (folder / "house.html").string();
  write_html_replay(*scene.building, recording, page);
  const std::string html = text_of(page);
  const std::size_t list = html.find("\"drawn\":[");
  REQUIRE(list != std::string::npos);
  CHECK(count(html.substr(list, html.find("\"failed\":", list) - list), "\"mesh\":") == pieces.size());
}

TEST_CASE("a facade around a frame that hangs is exported as it is drawn, bent with the frame, to a centimetre") {
  const ScratchFolder folder;
  Scene scene = open_scene("steel_frame_hinges");
  const auto& building = *scene.building;
  // A box around the post that loses its foot, a hand wider: it sinks by half a metre with it.
  const topple::structure::NameIndex names(building);
  const topple::structure::Vec3 foot = building[*names.node("N-2-1-1")].position;
  topple::structure::DrawnMesh box;
  box.name = "box";
  const auto corner = [&](int i) -> topple::structure::Vec3 {
    return foot + topple::structure::Vec3((i & 1) != 0 ? 0.4 : -0.4, (i & 2) != 0 ? 0.4 : -0.4, (i & 4) != 0 ? 3 : 0.3);
  };
  for (const auto& face : {std::array{0, 2, 3, 1}, std::array{4, 5, 7, 6}, std::array{0, 1, 5, 4},
                           std::array{2, 6, 7, 3}, std::array{0, 4, 6, 2}, std::array{1, 3, 7, 5}}) {
    const auto first = static_cast<int>(box.mesh.positions.size());
    const auto across = (corner(face[1]) - corner(face[0])).cross(corner(face[2]) - corner(face[0])).normalized();
    for (const int i : face) {
      box.mesh.positions.push_back(corner(i));
      box.mesh.normals.emplace_back(across);
    }
    box.mesh.triangles.push_back({first, first + 1, first + 2});
    box.mesh.triangles.push_back({first, first + 2, first + 3});
  }
  scene.drawn = std::make_shared<const std::vector<topple::structure::DrawnMesh>>(std::vector{box});
  Session session(scene.building, scene.scenario, scene.drawn);
  (void)session.snapshot();
  while (session.simulation().time() < 3.5) {
    session.step();
    (void)session.snapshot();
  }
  const Recording& recording = *session.recording();
  const std::vector<DrawnTrack> pieces = drawn_tracks(building, recording);
  // At every moment one of them is there, and lies where pictures draw it.
  SceneInstances instances(building);
  double most = 0;
  for (std::size_t f = 0; f < recording.frames().size(); f += 5) {
    const Snapshot moment = recording.at(recording.frames()[f].time);
    instances.update(moment, ViewOptions());
    const DrawnTrack* there = nullptr;
    for (const DrawnTrack& piece : pieces) {
      int track = part_gone;
      for (const PlaceChange& change : piece.places)
        if (change.frame <= static_cast<std::int32_t>(f)) track = change.track;
      if (track == part_gone) continue;
      CHECK(there == nullptr);
      there = &piece;
    }
    REQUIRE(there != nullptr);
    REQUIRE(instances.drawn().size() == 1);
    const Mesh& drawn = instances.drawn()[0].mesh;
    REQUIRE(drawn.vertices.size() == there->mesh->positions.size());
    for (std::size_t v = 0; v < drawn.vertices.size(); ++v) {
      const glm::vec3 p = drawn.vertices[v].position;
      CHECK((topple::structure::Vec3(p.x, p.y, p.z) - there->mesh->positions[v]).norm() < 0.01 + 1e-5);
      most = std::max(most, (there->mesh->positions[v] - pieces[0].mesh->positions[v]).norm());
    }
  }
  CHECK(most > 0.4);  // what it would be off by if it were drawn where it stood at first
  const std::string usd = (folder / "box.usda").string();
  write_usd(building, recording, usd);
  CHECK(count(text_of(usd), "def Mesh \"drawn_") > 10);
}

TEST_CASE("a part in a recording moves with its body") {
  const Fall fall;
  const auto& recording = *fall.session.recording();
  const auto places = part_places(*fall.scene.building, recording);
  const auto last = static_cast<std::int32_t>(recording.frames().size()) - 1;
  int moving = 0;
  for (std::size_t m = 0; m < fall.scene.building->members.size(); ++m) {
    const int track = places[m].back().track;
    if (track < 0) continue;
    ++moving;
    const auto& member = fall.scene.building->members[m];
    const auto& body = recording.tracks()[static_cast<std::size_t>(track)];
    const Eigen::Vector3d p = (*fall.scene.building)[member.nodes[0]].position;
    const PartMotion motion = motion_of(body, last, Eigen::Vector3d(3, 4, 5));
    const Eigen::Vector3d moved =
        motion.turn * (p - Eigen::Vector3d(3, 4, 5)) + motion.shift + Eigen::Vector3d(3, 4, 5);
    const BodyPose pose = body.pose(last);
    CHECK((moved - (pose.position + pose.orientation * (p - pose.rest_centre))).norm() < 1e-9);
  }
  CHECK(moving > 0);
}

TEST_CASE("the replay page carries the run and asks for nothing else") {
  if (!can_write_replay()) {
    std::cout << "SKIPPED: built without the replay page\n";
    return;
  }
  const ScratchFolder folder;
  const Fall fall;
  const std::string file = (folder / "fall.html").string();
  write_html_replay(*fall.scene.building, *fall.session.recording(), file);
  const std::string html = text_of(file);
  CHECK(html.find("\"TOPPLE_DATA\"") == std::string::npos);
  CHECK(html.find("\"name\":\"P-1-1-1\"") != std::string::npos);
  CHECK(html.find("src=\"http") == std::string::npos);
}

TEST_CASE("a video gets every picture, and without ffmpeg one line says what to do instead") {
  const ScratchFolder folder;
  const std::string path = std::getenv("PATH");
  Image image;
  image.width = 8, image.height = 4;
  image.pixels.assign(8 * 4 * 4, 77);
  setenv("PATH", folder.path().c_str(), 1);
  CHECK_THROWS_WITH(VideoWriter((folder / "v.mp4").string(), {8, 4}, 30), Catch::Contains("--record"));
  // One that keeps what it is told and given.
  const std::string fake = (folder / "ffmpeg").string();
  std::ofstream(fake)
      << "#!/bin/sh\nfor word; do last=$word; done\necho \"$*\" > \"$last.words\"\n/bin/cat > \"$last\"\n";
  chmod(fake.c_str(), 0755);
  {
    VideoWriter video((folder / "v.mp4").string(), {8, 4}, 24);
    for (int i = 0; i < 3; ++i) video.add(image);
    video.finish();
  }
  setenv("PATH", path.c_str(), 1);
  CHECK(text_of((folder / "v.mp4").string()).size() == 3 * image.pixels.size());
  // It is told of a temporary file, which takes the name when it is whole.
  std::string words;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
    if (entry.path().extension() == ".words") words += text_of(entry.path().string());
  CHECK(words.find("-s 8x4 -r 24") != std::string::npos);
  CHECK(words.find(".part.mp4") != std::string::npos);
}
