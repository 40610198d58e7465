// The animation, read back by another program's reader and held against the simulation frame by frame.
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#define TINYGLTF_IMPLEMENTATION
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#define TINYGLTF_NO_INCLUDE_JSON
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wall"
#pragma GCC diagnostic ignored "-Wextra"
#include <tiny_gltf.h>
#pragma GCC diagnostic pop

#include "topple/structure/collapse_animation.h"
#include "topple/structure/formats/files.h"
#include "topple/structure/visual_mesh.h"

using namespace topple::structure;

namespace {

std::vector<std::vector<double>> values(const tinygltf::Model& model, int index) {
  const tinygltf::Accessor& accessor = model.accessors[static_cast<std::size_t>(index)];
  const tinygltf::BufferView& view = model.bufferViews[static_cast<std::size_t>(accessor.bufferView)];
  const auto width =
      static_cast<std::size_t>(tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type)));
  const auto* data =
      reinterpret_cast<const float*>(model.buffers[0].data.data() + view.byteOffset + accessor.byteOffset);
  std::vector<std::vector<double>> result;
  for (std::size_t i = 0; i < accessor.count; ++i) result.emplace_back(data + i * width, data + (i + 1) * width);
  return result;
}

/// A node's own pose at an instant, as a viewer would show it.
struct Played {
  const tinygltf::Model& model;
  std::map<std::pair<int, std::string>, const tinygltf::AnimationSampler*> samplers;

  explicit Played(const tinygltf::Model& given) : model(given) {
    if (model.animations.empty()) return;
    for (const auto& channel : model.animations[0].channels)
      samplers[{channel.target_node, channel.target_path}] =
          &model.animations[0].samplers[static_cast<std::size_t>(channel.sampler)];
  }
  std::vector<double> at(int node, const std::string& path, double time, std::vector<double> still) const {
    const auto found = samplers.find({node, path});
    if (found == samplers.end()) return still;
    const auto times = values(model, found->second->input);
    const auto keys = values(model, found->second->output);
    REQUIRE(times.size() == keys.size());
    if (time <= times.front()[0]) return keys.front();
    for (std::size_t i = 1; i < times.size(); ++i) {
      CHECK(times[i][0] > times[i - 1][0]);
      if (time > times[i][0] + 1e-5) continue;
      if (found->second->interpolation == "STEP") return time > times[i][0] - 1e-5 ? keys[i] : keys[i - 1];
      const double share = (time - times[i - 1][0]) / (times[i][0] - times[i - 1][0]);
      std::vector<double> between = keys[i - 1];
      for (std::size_t c = 0; c < between.size(); ++c) between[c] += share * (keys[i][c] - keys[i - 1][c]);
      return between;
    }
    return keys.back();
  }
  bool shows(int node, double time) const {
    const auto& scale = model.nodes[static_cast<std::size_t>(node)].scale;
    return at(node, "scale", time, scale.empty() ? std::vector<double>{1, 1, 1} : scale)[0] == 1;
  }
};

tinygltf::Model read_back(const std::string& bytes) {
  tinygltf::TinyGLTF reader;
  tinygltf::Model model;
  std::string error, warning;
  REQUIRE(reader.LoadBinaryFromMemory(&model, &error, &warning, reinterpret_cast<const unsigned char*>(bytes.data()),
                                      static_cast<unsigned int>(bytes.size())));
  CHECK(error + warning == "");
  return model;
}

std::map<std::string, int> node_names(const tinygltf::Model& model) {
  std::map<std::string, int> nodes;
  for (std::size_t n = 0; n < model.nodes.size(); ++n) nodes[model.nodes[n].name] = static_cast<int>(n);
  CHECK(nodes.size() == model.nodes.size());
  return nodes;
}

}  // namespace

TEST_CASE("an animation has a node for each part and ball, with its pose at every frame") {
  auto [building, scenario] = read_scenario(find_scenario("seed_hit"));
  scenario.duration = 2.5;
  Simulation simulation(std::move(building), std::move(scenario));
  const double rate = 30;  // every second step
  CollapseAnimation animation(simulation, rate);
  struct Seen {
    double time;
    std::map<std::string, Vec3> members;  ///< middles of moving ones, and balls
    std::set<std::string> all;
  };
  std::vector<Seen> frames;
  while (!simulation.finished()) {
    simulation.step();
    animation.add_due(simulation);
    if (simulation.steps() % 2 != 0) continue;
    Seen seen{simulation.time(), {}, {}};
    for (const BodyView& body : simulation.bodies()) {
      for (const MemberId id : body.members) {
        const Member& member = simulation.building()[id];
        const Vec3 middle =
            (simulation.building()[member.nodes[0]].position + simulation.building()[member.nodes[1]].position) / 2;
        seen.members[member.name] = body.pose * (middle - body.rest_centre);
      }
      if (body.radius > 0) seen.members[std::string(body.name)] = body.pose.position;
    }
    frames.push_back(std::move(seen));
  }
  CHECK(animation.frames() == 76);  // 0 to 2.5 s

  const std::string bytes = animation.glb();
  const tinygltf::Model model = read_back(bytes);
  const std::map<std::string, int> nodes = node_names(model);
  for (const Member& member : simulation.building().members) CHECK(nodes.contains(member.name));
  for (const Panel& panel : simulation.building().panels) CHECK(nodes.contains(panel.name));
  REQUIRE(nodes.contains("projectile 1"));

  const Played played(model);
  std::size_t compared = 0;
  for (const Seen& frame : frames)
    for (const auto& [name, place] : frame.members) {
      const int node = nodes.at(name);
      const auto shown =
          played.at(node, "translation", frame.time, model.nodes[static_cast<std::size_t>(node)].translation);
      CHECK((Vec3(shown[0], shown[1], shown[2]) - Vec3(place.x(), place.z(), -place.y())).norm() < 1e-4);  // floats
      CHECK(played.at(node, "scale", frame.time, {1, 1, 1})[0] == 1);
      ++compared;
    }
  CHECK(compared > 100);

  // The ball is born at 1 s.
  const int ball = nodes.at("projectile 1");
  CHECK(played.at(ball, "scale", 0.9, {1, 1, 1})[0] == 0);
  CHECK(played.at(ball, "scale", 1.1, {1, 1, 1})[0] == 1);
  // A standing post far away: upright, where it stands, never moving much.
  const NameIndex names(simulation.building());
  const Member& post = simulation.building()[*names.member("P-4-5-1")];
  const auto& node = model.nodes[static_cast<std::size_t>(nodes.at(post.name))];
  const Vec3 foot = simulation.building()[post.nodes[0]].position;
  CHECK(node.translation[0] == Approx(foot.x()).margin(0.01));
  CHECK(node.translation[2] == Approx(-foot.y()).margin(0.01));
  const Eigen::Quaterniond turn(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2]);
  // The mesh lies along its x (the member's axis, kept by the turn to y up); the node turns that upright.
  CHECK((turn * Vec3::UnitX() - Vec3::UnitY()).norm() < 1e-3);
}

TEST_CASE("an animation shows what remains of a wall from its break on, and a picture on it stays where it was") {
  auto [building, scenario] = read_scenario(find_scenario("wall_hit"));
  Simulation simulation(std::move(building), std::move(scenario));
  CollapseAnimation animation(simulation, 30);
  double broke = 0;
  std::set<std::string> chunks;
  while (!simulation.finished()) {
    simulation.step();
    animation.add_due(simulation);
    for (const BodyView& body : simulation.bodies())
      if (body.chunk) chunks.emplace(body.name);
  }
  for (const SimulationEvent& event : simulation.events())
    if (event.kind == SimulationEvent::Kind::panel_fractured) broke = event.time;
  REQUIRE(broke > 0);
  const tinygltf::Model model = read_back(animation.glb());
  const std::map<std::string, int> nodes = node_names(model);
  REQUIRE(nodes.contains("W"));
  REQUIRE(nodes.contains("W rest 1"));
  const Played played(model);
  CHECK(played.shows(nodes.at("W"), broke - 0.1));
  CHECK_FALSE(played.shows(nodes.at("W rest 1"), broke - 0.1));
  CHECK_FALSE(played.shows(nodes.at("W"), broke + 0.1));
  CHECK(played.shows(nodes.at("W rest 1"), broke + 0.1));
  REQUIRE(chunks.size() > 3);

  // The wall stands in y = 0 from x = 0 and z = 0: on its faces, texture coordinates are x and z of where a vertex was.
  std::size_t compared = 0;
  const auto compare = [&](const std::string& name, const Vec3& moved) {
    const auto& node = model.nodes[static_cast<std::size_t>(nodes.at(name))];
    const auto& primitive = model.meshes[static_cast<std::size_t>(node.mesh)].primitives[0];
    REQUIRE(primitive.attributes.contains("TEXCOORD_0"));
    const auto positions = values(model, primitive.attributes.at("POSITION"));
    const auto normals = values(model, primitive.attributes.at("NORMAL"));
    const auto texture = values(model, primitive.attributes.at("TEXCOORD_0"));
    REQUIRE(texture.size() == positions.size());
    for (std::size_t v = 0; v < positions.size(); ++v) {
      if (std::abs(normals[v][2]) < 0.5) continue;  // a side
      CHECK(texture[v][0] == Approx(positions[v][0] + moved.x()).margin(1e-4));
      CHECK(texture[v][1] == Approx(positions[v][1] + moved.z()).margin(1e-4));
      ++compared;
    }
  };
  compare("W", Vec3(3, 0, 1.5));  // meshes lie about the middle of the wall
  compare("W rest 1", Vec3(3, 0, 1.5));
  for (const BodyView& body : simulation.bodies())
    if (body.chunk) compare(std::string(body.name), body.rest_centre);
  CHECK(compared > 100);
}

TEST_CASE("an animation holds the drawn model, each piece while it is one") {
  const std::filesystem::path file = find_model("seed_house");
  auto [building, scenario] = read_scenario(find_scenario("seed_house_hit"));
  scenario.duration = 3;
  Simulation simulation(std::move(building), std::move(scenario));
  VisualMesh drawn(simulation.building(), read_drawn_meshes(simulation.building(), file));
  drawn.update(simulation);
  const std::string whole = drawn.pieces().front().name;
  CollapseAnimation animation(simulation, 10, &drawn);
  while (!simulation.finished()) {
    simulation.step();
    drawn.update(simulation);
    animation.add_due(simulation);
  }
  const tinygltf::Model model = read_back(animation.glb());
  const std::map<std::string, int> nodes = node_names(model);
  const Played played(model);
  REQUIRE(nodes.contains(whole));
  CHECK(played.shows(nodes.at(whole), 0));
  // As many of its nodes are seen at the end as there are pieces that anything holds.
  std::size_t there = 0, seen = 0;
  std::set<std::string> meshes;
  for (const VisualMesh::Piece& piece : drawn.pieces()) {
    there += piece.body.value >= -1 ? 1 : 0;
    meshes.insert(piece.name.substr(0, piece.name.find('#')));
  }
  for (const auto& [name, node] : nodes)
    for (const std::string& mesh : meshes)
      if (name == mesh || name.starts_with(mesh + "#") || name.starts_with(mesh + " after cut"))
        seen += played.shows(node, simulation.time()) ? 1 : 0;
  CHECK(there > meshes.size());
  CHECK(seen == there);
}
