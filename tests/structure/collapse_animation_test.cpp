// The animation, read back by another program's reader and held against the simulation frame by frame.
#include <catch2/catch.hpp>
#include <cmath>
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
#include "topple/structure/files.h"

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
};

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
  tinygltf::TinyGLTF reader;
  tinygltf::Model model;
  std::string error, warning;
  const bool read =
      reader.LoadBinaryFromMemory(&model, &error, &warning, reinterpret_cast<const unsigned char*>(bytes.data()),
                                  static_cast<unsigned int>(bytes.size()));
  CAPTURE(error, warning);
  REQUIRE(read);
  CHECK(error.empty());
  CHECK(warning.empty());

  std::map<std::string, int> nodes;
  for (std::size_t n = 0; n < model.nodes.size(); ++n) nodes[model.nodes[n].name] = static_cast<int>(n);
  CHECK(nodes.size() == model.nodes.size());
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
