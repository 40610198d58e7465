#include "app/output/gltf_scene.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "app/part_motion.h"
#include "renderer/shapes/palette.h"
#include "topple/structure/animated_scene.h"
#include "topple/structure/formats/output_files.h"
#include "topple/structure/formats/plain_text.h"

namespace topple::viewer {
namespace {

using structure::AnimatedNode;
using structure::AnimatedPose;
using structure::SceneMesh;

constexpr int ball_rings = 12;

structure::Vec3 vec3(const glm::vec3& v) { return {v.x, v.y, v.z}; }

class GltfWriter {
 public:
  GltfWriter(const structure::Building& building, const Recording& recording, double rate)
      : building_(building), recording_(recording), samples_(export_samples(recording, rate)) {
    scene_.rate = rate;
  }

  [[nodiscard]] std::string bytes() {
    const auto places = part_places(building_, recording_);
    for (std::size_t m = 0; m < building_.members.size(); ++m) member(structure::MemberId(m), places[m]);
    const auto states = panel_states(building_, recording_);
    for (std::size_t p = 0; p < building_.panels.size(); ++p)
      panel(structure::PanelId(p), states[p], places[building_.members.size() + p]);
    for (const BodyTrack& track : recording_.tracks()) body(track);
    drawn();
    return structure::glb_of(scene_);
  }

 private:
  static constexpr std::int32_t never = std::numeric_limits<std::int32_t>::max();

  int material(Rgba colour) {
    const auto [known, made] = materials_.try_emplace(colour, static_cast<int>(scene_.materials.size()));
    if (made) {
      // glTF's factors are linear.
      const auto linear = [](float x) { return std::pow(x, 2.2F); };
      const glm::vec4 c = unpack(colour);
      scene_.materials.push_back(
          {"material " + std::to_string(known->second), {linear(c.r), linear(c.g), linear(c.b)}});
    }
    return known->second;
  }

  int add(PartMesh part, Rgba colour) {
    const int number = add(part.mesh, colour);
    SceneMesh& added = scene_.meshes.back();
    added.bends = std::move(part.bends);
    added.bend_normals = std::move(part.bend_normals);
    return number;
  }

  int add(const Mesh& mesh, Rgba colour) {
    SceneMesh added;
    added.material = material(colour);
    for (const Vertex& v : mesh.vertices) {
      added.positions.push_back(vec3(v.position));
      added.normals.push_back(vec3(v.normal));
    }
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3)
      added.triangles.push_back({static_cast<int>(mesh.indices[i]), static_cast<int>(mesh.indices[i + 1]),
                                 static_cast<int>(mesh.indices[i + 2])});
    scene_.meshes.push_back(std::move(added));
    return static_cast<int>(scene_.meshes.size()) - 1;
  }

  /// A part in its place and shape, along the run; `lasts`: frames of the recording in which it is there at all.
  void part(const std::string& name, int mesh, const std::vector<ShapeChange>& shapes,
            const std::vector<PlaceChange>& places, std::pair<std::int32_t, std::int32_t> lasts = {0, never}) {
    AnimatedNode node;
    node.name = name;
    node.mesh = mesh;
    std::size_t next = 0;
    for (const ExportSample& sample : samples_) {
      while (next + 1 < places.size() && places[next + 1].frame <= sample.frame) ++next;
      const bool there = lasts.first <= sample.frame && sample.frame < lasts.second;
      const int track = there ? places[next].track : part_gone;
      node.show(sample.code, track != part_gone);
      if (track == part_gone) continue;
      const structure::BentPart& shape = shape_at(shapes, sample.frame);
      AnimatedPose now = shape.pose;
      if (track >= 0) {
        const PartMotion motion =
            motion_of(recording_.tracks()[static_cast<std::size_t>(track)], sample.frame, Eigen::Vector3d::Zero());
        now = {motion.turn * now.position + motion.shift, motion.turn * now.orientation};
      }
      node.pose(sample.code, now);
      node.bend(sample.code, shape.bend);
    }
    if (!node.poses.empty()) scene_.nodes.push_back(std::move(node));  // else it came and went between two frames
  }

  void member(structure::MemberId id, const std::vector<PlaceChange>& places) {
    const structure::Member& member = building_[id];
    const auto shapes = part_shapes(building_, recording_, static_cast<std::size_t>(id.index));
    const auto [known, made] =
        meshes_.try_emplace({member.section.index, member.kind, member.length, ways_of_bending(shapes) > 0}, 0);
    if (made) known->second = add(member_mesh(building_, id, ways_of_bending(shapes) > 0), member_colour(member.kind));
    part(member.name, known->second, shapes, places);
  }

  void panel(structure::PanelId id, const std::vector<PanelState>& states, const std::vector<PlaceChange>& places) {
    const structure::Panel& panel = building_[id];
    const auto shapes =
        part_shapes(building_, recording_, building_.members.size() + static_cast<std::size_t>(id.index));
    for (std::size_t k = 0; k < states.size(); ++k) {
      // What remains after each break is a node of its own, seen while it lasts.
      const std::string name = k == 0 ? panel.name : panel.name + " rest " + std::to_string(k);
      const std::int32_t end = k + 1 < states.size() ? states[k + 1].frame : never;
      part(name, add(panel_part_mesh(building_, id, states[k], ways_of_bending(shapes)), panel_colour(panel.kind)),
           shapes, places, {states[k].frame, end});
    }
  }

  void body(const BodyTrack& track) {
    if (!track.chunk && !(track.radius > 0)) return;
    AnimatedNode node;
    node.name = (track.chunk ? "chunk " : "projectile ") + std::to_string(track.id);
    for (const ExportSample& sample : samples_) {
      const bool here = track.first <= sample.frame && (track.end < 0 || sample.frame < track.end);
      node.show(sample.code, here);
      if (!here) continue;
      const BodyPose pose = track.pose(sample.frame);
      node.pose(sample.code, {pose.position, pose.orientation});
    }
    if (node.poses.empty()) return;  // it came and went between two frames of the file
    Mesh mesh = track.chunk ? chunk_mesh(*track.chunk) : sphere_mesh(ball_rings);
    if (!track.chunk)
      for (Vertex& v : mesh.vertices) v.position *= static_cast<float>(track.radius);
    node.mesh = add(mesh, track.chunk ? piece_colour(track.chunk_of) : projectile_colour);
    scene_.nodes.push_back(std::move(node));
  }

  /// Pieces of a model around the building, each while it is one; those that stand as they were drawn.
  void drawn() {
    int number = 0;
    for (const DrawnTrack& piece : drawn_tracks(building_, recording_))
      part("drawn " + std::to_string(++number), add(chunk_mesh(*piece.mesh), drawn_colour), {ShapeChange()},
           piece.places);
  }

  const structure::Building& building_;
  const Recording& recording_;
  std::vector<ExportSample> samples_;
  structure::AnimatedScene scene_;
  std::map<Rgba, int> materials_;
  std::map<std::tuple<std::int64_t, structure::MemberKind, double, bool>, int> meshes_;  ///< of members
};

}  // namespace

void write_gltf(const structure::Building& building, const Recording& recording, const std::string& file, double rate) {
  structure::write_file(file, GltfWriter(building, recording, rate).bytes());
  std::printf("%s: animation\n", structure::one_line(file).c_str());
}

}  // namespace topple::viewer
