// An animated scene as binary glTF 2.0 (Khronos Group, glTF 2.0 Specification, 2021): one buffer, 32-bit floats.
#include <algorithm>
#include <bit>
#include <cstring>
#include <map>

#include "topple/structure/animated_scene.h"
#include "topple/structure/bent_part.h"
#include "topple/structure/formats/json_tree.h"

namespace topple::structure {

namespace {

using Json = JsonTree;

static_assert(std::endian::native == std::endian::little, "glTF is written in the byte order of this machine");

constexpr int float_type = 5126, index_type = 5125, vertex_target = 34962, index_target = 34963;

/// z up to y up: a quarter turn about x.
std::array<float, 3> y_up(const Vec3& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.z()), static_cast<float>(-v.y())};
}
std::array<float, 4> y_up(const Eigen::Quaterniond& q) {
  return {static_cast<float>(q.x()), static_cast<float>(q.z()), static_cast<float>(-q.y()), static_cast<float>(q.w())};
}

class GlbWriter {
 public:
  explicit GlbWriter(const AnimatedScene& scene) : scene_(scene) {}

  std::string write() {
    root_["asset"] = {{"version", "2.0"}, {"generator", "Topple " TOPPLE_VERSION}};
    root_["scene"] = 0;
    add_materials();
    count_bends();
    for (std::size_t i = 0; i < scene_.meshes.size(); ++i) add_mesh(scene_.meshes[i], bends_[i]);
    Json children = Json::array();
    for (std::size_t i = 0; i < scene_.nodes.size(); ++i) {
      add_node(scene_.nodes[i], static_cast<int>(i));
      children.push_back(i);
    }
    root_["scenes"] = Json::array({{{"nodes", std::move(children)}}});
    if (!channels_.empty())
      root_["animations"] = Json::array({{{"name", "collapse"}, {"channels", channels_}, {"samplers", samplers_}}});
    root_["accessors"] = std::move(accessors_);
    root_["bufferViews"] = std::move(views_);
    root_["buffers"] = Json::array({{{"byteLength", buffer_.size()}}});
    return file();
  }

 private:
  template <class T>
  int add_view(const std::vector<T>& values, int target) {
    Json view = {{"buffer", 0}, {"byteOffset", buffer_.size()}, {"byteLength", values.size() * sizeof(T)}};
    if (target != 0) view["target"] = target;
    const std::size_t at = buffer_.size();
    buffer_.resize(at + values.size() * sizeof(T));
    std::memcpy(buffer_.data() + at, values.data(), values.size() * sizeof(T));
    views_.push_back(std::move(view));
    return static_cast<int>(views_.size()) - 1;
  }

  template <class T>
  int add_accessor(const std::vector<T>& values, int component, const char* type, int target) {
    accessors_.push_back({{"bufferView", add_view(values, target)},
                          {"componentType", component},
                          {"count", values.size()},
                          {"type", type}});
    return static_cast<int>(accessors_.size()) - 1;
  }

  /// Readers need the bounds of positions and of key times.
  template <std::size_t n>
  void add_bounds(int accessor, const std::vector<std::array<float, n>>& values) {
    std::array<float, n> low = values.front(), high = values.front();
    for (const auto& value : values)
      for (std::size_t i = 0; i < n; ++i) {
        low[i] = std::min(low[i], value[i]);
        high[i] = std::max(high[i], value[i]);
      }
    accessors_[static_cast<std::size_t>(accessor)]["min"] = low;
    accessors_[static_cast<std::size_t>(accessor)]["max"] = high;
  }

  void add_materials() {
    Json materials = Json::array();
    for (const auto& [name, colour] : scene_.materials)
      materials.push_back({{"name", name},
                           {"pbrMetallicRoughness",
                            {{"baseColorFactor", {colour[0], colour[1], colour[2], 1.0f}},
                             {"metallicFactor", 0.1f},
                             {"roughnessFactor", 0.8f}}}});
    root_["materials"] = std::move(materials);
    root_["meshes"] = Json::array();
  }

  /// As many of each mesh as any node uses.
  void count_bends() {
    bends_.assign(scene_.meshes.size(), 0);
    for (const AnimatedNode& node : scene_.nodes)
      for (const auto& [frame, bend] : node.bends)
        for (std::size_t k = 0; k < bend.size(); ++k)
          if (bend[k] != 0) bends_[static_cast<std::size_t>(node.mesh)] = std::max(bends_of(node), k + 1);
    // Where no normal is seen to turn, files are smaller without, and no program has to bear more than it must.
    normals_turn_.assign(scene_.meshes.size(), false);
    for (const AnimatedNode& node : scene_.nodes) {
      if (node.mesh < 0) continue;
      const SceneMesh& mesh = scene_.meshes[static_cast<std::size_t>(node.mesh)];
      for (const auto& [frame, bend] : node.bends) {
        if (normals_turn_[static_cast<std::size_t>(node.mesh)]) break;
        normals_turn_[static_cast<std::size_t>(node.mesh)] = normals_turn(mesh.normals, mesh.bend_normals, {}, bend);
      }
    }
  }
  [[nodiscard]] std::size_t bends_of(const AnimatedNode& node) const {
    return bends_[static_cast<std::size_t>(node.mesh)];
  }

  void add_mesh(const SceneMesh& mesh, std::size_t bends) {
    std::vector<std::array<float, 3>> positions, normals;
    std::vector<std::uint32_t> indices;
    for (const Vec3& position : mesh.positions) positions.push_back(y_up(position));
    for (const Vec3& normal : mesh.normals) normals.push_back(y_up(normal));
    for (const auto& triangle : mesh.triangles)
      for (const int vertex : triangle) indices.push_back(static_cast<std::uint32_t>(vertex));
    const int position = add_accessor(positions, float_type, "VEC3", vertex_target);
    add_bounds(position, positions);
    const int normal = add_accessor(normals, float_type, "VEC3", vertex_target);
    Json attributes = {{"POSITION", position}, {"NORMAL", normal}};
    if (!mesh.texture.empty()) {
      std::vector<std::array<float, 2>> texture;
      for (const Vec2& at : mesh.texture) texture.push_back({static_cast<float>(at.x()), static_cast<float>(at.y())});
      attributes["TEXCOORD_0"] = add_accessor(texture, float_type, "VEC2", vertex_target);
    }
    const int index = add_accessor(indices, index_type, "SCALAR", index_target);
    Json primitive = {{"attributes", std::move(attributes)}, {"indices", index}, {"material", mesh.material}};
    if (bends > 0) primitive["targets"] = targets(mesh, bends, normals_turn_[root_["meshes"].size()]);
    Json entry = {{"primitives", Json::array({std::move(primitive)})}};
    if (bends > 0) entry["weights"] = std::vector<float>(bends, 0.0F);
    root_["meshes"].push_back(std::move(entry));
  }

  /// With normals a target is two attributes, and every program bears eight: one that bears no more takes the targets
  /// that weigh most.
  Json targets(const SceneMesh& mesh, std::size_t bends, bool with_normals) {
    Json list = Json::array();
    for (std::size_t k = 0; k < bends; ++k) {
      std::vector<std::array<float, 3>> ways;
      for (const Vec3& way : mesh.bends[k]) ways.push_back(y_up(way));
      const int accessor = add_accessor(ways, float_type, "VEC3", vertex_target);
      add_bounds(accessor, ways);
      Json target = {{"POSITION", accessor}};
      if (with_normals) {
        std::vector<std::array<float, 3>> turns;
        for (const Vec3& turn : mesh.bend_normals[k]) turns.push_back(y_up(turn));
        target["NORMAL"] = add_accessor(turns, float_type, "VEC3", vertex_target);
      }
      list.push_back(std::move(target));
    }
    return list;
  }

  /// Key times are shared by all nodes with the same frames.
  int times_of(const std::vector<int>& frames) {
    const auto known = times_.find(frames);
    if (known != times_.end()) return known->second;
    std::vector<std::array<float, 1>> times;
    for (const int frame : frames) times.push_back({static_cast<float>(frame / scene_.rate)});
    const int accessor = add_accessor(times, float_type, "SCALAR", 0);
    add_bounds(accessor, times);
    return times_.emplace(frames, accessor).first->second;
  }

  template <class T>
  void add_channel(int node, const char* path, const char* type, const char* interpolation,
                   const std::vector<int>& frames, const std::vector<T>& values) {
    const int input = times_of(frames);
    const int output = add_accessor(values, float_type, type, 0);
    channels_.push_back({{"sampler", samplers_.size()}, {"target", {{"node", node}, {"path", path}}}});
    samplers_.push_back({{"input", input}, {"output", output}, {"interpolation", interpolation}});
  }

  void add_node(const AnimatedNode& node, int number) {
    std::vector<int> frames;
    std::vector<std::array<float, 3>> translations;
    std::vector<std::array<float, 4>> rotations;
    Eigen::Quaterniond last = node.poses.front().second.orientation;
    for (const auto& [frame, pose] : node.poses) {
      // A quaternion and its negative are one turn; between keys the short way is meant.
      Eigen::Quaterniond q = pose.orientation;
      if (q.dot(last) < 0) q.coeffs() = -q.coeffs();
      last = q;
      frames.push_back(frame);
      translations.push_back(y_up(pose.position));
      rotations.push_back(y_up(q));
    }
    Json entry = {{"name", node.name},
                  {"mesh", node.mesh},
                  {"translation", translations.front()},
                  {"rotation", rotations.front()}};
    if (!node.visible.front().second) entry["scale"] = {0, 0, 0};
    if (!node.bends.empty()) {
      const BendWeights& first = node.bends.front().second;
      entry["weights"] = std::vector<float>(first.begin(), first.begin() + static_cast<std::ptrdiff_t>(bends_of(node)));
    }
    root_["nodes"].push_back(std::move(entry));
    if (frames.size() > 1) {
      add_channel(number, "translation", "VEC3", "LINEAR", frames, translations);
      add_channel(number, "rotation", "VEC4", "LINEAR", frames, rotations);
    }
    add_bends(node, number);
    if (node.visible.size() < 2) return;
    std::vector<int> changes;
    std::vector<std::array<float, 3>> scales;
    for (const auto& [frame, visible] : node.visible) {
      changes.push_back(frame);
      scales.push_back(visible ? std::array<float, 3>{1, 1, 1} : std::array<float, 3>{0, 0, 0});
    }
    add_channel(number, "scale", "VEC3", "STEP", changes, scales);
  }

  void add_bends(const AnimatedNode& node, int number) {
    if (node.bends.empty()) return;
    std::vector<int> frames;
    std::vector<std::array<float, 1>> weights;
    for (const auto& [frame, bend] : node.bends) {
      frames.push_back(frame);
      for (std::size_t k = 0; k < bends_of(node); ++k) weights.push_back({bend[k]});
    }
    if (frames.size() > 1) add_channel(number, "weights", "SCALAR", "LINEAR", frames, weights);
  }

  std::string file() {
    std::string text = root_.dump();
    while (text.size() % 4 != 0) text += ' ';
    while (buffer_.size() % 4 != 0) buffer_ += '\0';
    std::string out;
    const auto word = [&](std::size_t value) {
      const auto bits = static_cast<std::uint32_t>(value);
      out.append(reinterpret_cast<const char*>(&bits), sizeof bits);
    };
    out += "glTF";
    word(2);
    word(12 + 8 + text.size() + 8 + buffer_.size());
    word(text.size());
    out += "JSON";
    out += text;
    word(buffer_.size());
    out.append("BIN\0", 4);
    out += buffer_;
    return out;
  }

  const AnimatedScene& scene_;
  Json root_, accessors_ = Json::array(), views_ = Json::array(), channels_ = Json::array(), samplers_ = Json::array();
  std::string buffer_;
  std::map<std::vector<int>, int> times_;
  std::vector<std::size_t> bends_;  ///< by mesh: ways in which it bends
  std::vector<bool> normals_turn_;  ///< by mesh: so that it is seen
};

}  // namespace

std::string glb_of(const AnimatedScene& scene) { return GlbWriter(scene).write(); }

}  // namespace topple::structure
