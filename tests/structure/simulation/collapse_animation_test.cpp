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

#include "topple/structure/bent_part.h"
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
    auto keys = values(model, found->second->output);
    if (path == "weights") {  // one number after the other, as many to a key as there are targets
      std::vector<std::vector<double>> sets(times.size());
      for (std::size_t i = 0; i < keys.size(); ++i) sets[i * times.size() / keys.size()].push_back(keys[i][0]);
      keys = std::move(sets);
    }
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
  ShapeWatcher shapes;
  shapes.watch(simulation);
  while (!simulation.finished()) {
    simulation.step();
    animation.add_due(simulation);
    shapes.watch(simulation);
    if (simulation.steps() % 2 != 0) continue;
    Seen seen{simulation.time(), {}, {}};
    for (const BodyView& body : simulation.bodies()) {
      for (const MemberId id : body.members) {
        const Member& member = simulation.building()[id];
        Vec3 middle =
            (simulation.building()[member.nodes[0]].position + simulation.building()[member.nodes[1]].position) / 2;
        // In the shape that it let go with.
        if (const auto& kept = shapes.parts()->member_shape[static_cast<std::size_t>(id.index)])
          middle += (kept->ends[0] + kept->ends[1]).head<3>().cast<double>() / 2;
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
      const double allowed = name.starts_with("projectile") ? 1e-4 /* floats */ : drawn_tolerance / 2 + 1e-4;
      CHECK((Vec3(shown[0], shown[1], shown[2]) - Vec3(place.x(), place.z(), -place.y())).norm() < allowed);
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

TEST_CASE("members of an animation are bent as they stand and as they let go") {
  auto [building, scenario] = read_scenario(find_scenario("steel_frame_hinges"));
  scenario.duration = 4.9;
  Simulation simulation(std::move(building), std::move(scenario));
  CollapseAnimation animation(simulation, 60);  // every step
  const Building& frame = simulation.building();
  /// The two ends and the middle of each member's axis, and their places once it is bent like this.
  const auto axis = [&](MemberId id, const MemberShape& shape) {
    const Member& member = frame[id];
    const Vec3 x = member.axes.row(0), first = frame[member.nodes[0]].position;
    std::array<Vec3, 2> moved, slope;
    for (std::size_t e = 0; e < 2; ++e) {
      moved[e] = shape.ends[e].head<3>().cast<double>();
      slope[e] = shape.ends[e].tail<3>().cast<double>().cross(x);
    }
    const Vec3 middle = first + member.length / 2 * x + (moved[0] + moved[1]) / 2 +
                        member.length / 8 * (slope[0] - slope[1] - (slope[0] - slope[1]).dot(x) * x) +
                        shape.bulge.cast<double>();
    return std::array<Vec3, 3>{first + moved[0], middle, first + member.length * x + moved[1]};
  };
  using Axes = std::map<std::string, std::array<Vec3, 3>>;
  Axes hang, stood;
  while (!simulation.finished()) {
    Axes now;
    std::vector<Displacement> displacements;
    for (std::size_t n = 0; n < frame.nodes.size(); ++n)
      displacements.push_back(simulation.frame().displacement(NodeId(n)).cast<float>());
    for (std::size_t m = 0; m < frame.members.size(); ++m)
      if (simulation.frame().stands(MemberId(m)))
        now[frame.members[m].name] =
            axis(MemberId(m), member_shape(simulation.frame(), frame, MemberId(m), displacements));
    if (std::abs(simulation.time() - 3.5) < 1e-6) hang = now;
    simulation.step();
    animation.add_due(simulation);
    for (const auto& [name, axis_now] : now) stood[name] = axis_now;  // as long as it does
  }
  REQUIRE(hang.size() == frame.members.size() - 1);  // a column was taken away
  const tinygltf::Model model = read_back(animation.glb());
  const std::map<std::string, int> nodes = node_names(model);
  const Played played(model);
  /// The same of the file: means of the corners of the box at both ends and in the middle.
  const auto shown = [&](const std::string& name, double time) {
    const auto& node = model.nodes[static_cast<std::size_t>(nodes.at(name))];
    const auto& mesh = model.meshes[static_cast<std::size_t>(node.mesh)];
    const auto rest = values(model, mesh.primitives[0].attributes.at("POSITION"));
    auto now = rest;
    const auto weights = played.at(nodes.at(name), "weights", time, node.weights);
    REQUIRE(weights.size() == mesh.primitives[0].targets.size());
    for (std::size_t k = 0; k < weights.size(); ++k) {
      const auto way = values(model, mesh.primitives[0].targets[k].at("POSITION"));
      for (std::size_t v = 0; v < now.size(); ++v)
        for (std::size_t c = 0; c < 3; ++c) now[v][c] += weights[k] * way[v][c];
    }
    const auto t = played.at(nodes.at(name), "translation", time, node.translation),
               r = played.at(nodes.at(name), "rotation", time, node.rotation);
    const Eigen::Quaterniond turn = Eigen::Quaterniond(r[3], r[0], r[1], r[2]).normalized();
    double half = 0;
    for (const auto& p : rest) half = std::max(half, p[0]);
    std::array<Vec3, 3> means;
    std::array<int, 3> count{};
    means.fill(Vec3::Zero());
    for (std::size_t v = 0; v < rest.size(); ++v)
      for (const int place : {0, 1, 2}) {
        if (std::abs(rest[v][0] - (place - 1) * half) > 1e-4) continue;
        const Vec3 p = turn * Vec3(now[v][0], now[v][1], now[v][2]) + Vec3(t[0], t[1], t[2]);
        means[static_cast<std::size_t>(place)] += Vec3(p.x(), -p.z(), p.y());
        ++count[static_cast<std::size_t>(place)];
      }
    for (std::size_t i = 0; i < 3; ++i) means[i] /= std::max(1, count[i]);
    if (count[1] == 0) means[1] = (means[0] + means[2]) / 2;  // one that is never bent
    return means;
  };
  double most = 0;
  for (const auto& [name, axis_then] : hang) {
    const auto is = shown(name, 3.5);
    for (std::size_t i = 0; i < 3; ++i) CHECK((is[i] - axis_then[i]).norm() < drawn_tolerance);
    most = std::max(most, (axis_then[1] - (axis_then[0] + axis_then[2]) / 2).norm());
  }
  CHECK(most > 2 * drawn_tolerance);
  // What let go is as deep in its middle as when it stood last.
  std::size_t fallen = 0;
  for (const auto& [name, axis_then] : stood) {
    const NameIndex names(frame);
    if (simulation.body_of(*names.member(name)).value < 0) continue;
    ++fallen;
    const auto is = shown(name, 4.9);
    const auto bow = [](const std::array<Vec3, 3>& a) { return (a[1] - (a[0] + a[2]) / 2).norm(); };
    CHECK(std::abs(bow(is) - bow(axis_then)) < 2 * drawn_tolerance);
  }
  CHECK(fallen > 3);
  // Those that bend share a mesh for each kind, section and length; those that do not keep the box of eight corners.
  std::set<int> bending;
  for (const Member& member : frame.members) {
    const auto& node = model.nodes[static_cast<std::size_t>(nodes.at(member.name))];
    const auto& mesh = model.meshes[static_cast<std::size_t>(node.mesh)];
    CHECK(node.weights.empty() == mesh.primitives[0].targets.empty());
    if (node.weights.empty())
      CHECK(values(model, mesh.primitives[0].attributes.at("POSITION")).size() == 24);
    else
      bending.insert(node.mesh);
  }
  CHECK_FALSE(bending.empty());
  CHECK(bending.size() <= 2);
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

TEST_CASE("an animation holds the visual mesh, each piece while it is one") {
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
