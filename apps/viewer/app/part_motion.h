#pragma once
// From a recording: how each part of the building moved, for files that other programs play.
#include <glm/vec3.hpp>
#include <vector>

#include "renderer/recording.h"
#include "renderer/shapes/mesh.h"
#include "topple/structure/bent_part.h"

namespace topple::viewer {

/// A frame of an exported file and the frame of the recording that it shows.
struct ExportSample {
  int code;
  std::int32_t frame;
};
/// `rate`: frames of the file for each simulated second.
[[nodiscard]] std::vector<ExportSample> export_samples(const Recording& recording, double rate);

/// From a frame on, a member or panel belongs to this track; part_stands or part_gone otherwise.
struct PlaceChange {
  std::int32_t frame = 0;
  int track = part_stands;
};
/// Per part, members first, then panels: its places in order of frame. The first is that of frame 0.
[[nodiscard]] std::vector<std::vector<PlaceChange>> part_places(const structure::Building& building,
                                                                const Recording& recording);

/// From a frame on, this is what remains of a panel; null: all of it.
struct PanelState {
  std::int32_t frame = 0;
  std::shared_ptr<const fracture::Mesh> remains;
};
/// Per panel, in order of frame; the first is that of frame 0.
[[nodiscard]] std::vector<std::vector<PanelState>> panel_states(const structure::Building& building,
                                                                const Recording& recording);

/// A piece of a model that is drawn around the building, from the cut that made it to the one that ends it; one that
/// stands from where it is drawn bent to where it is farther from that than structure::drawn_tolerance.
struct DrawnTrack {
  std::shared_ptr<const fracture::Mesh> mesh;  ///< in the undeformed building's axes: where it was, or bent
  std::vector<PlaceChange> places;             ///< in order of frame; the first is that of frame 0
};
/// In the order in which they come, those of one frame as the snapshot has them.
[[nodiscard]] std::vector<DrawnTrack> drawn_tracks(const structure::Building& building, const Recording& recording);

/// From a frame on, a part stands like this, or did when it let go: undeformed axes, its body's motion comes on top.
struct ShapeChange {
  std::int32_t frame = 0;
  structure::BentPart shape;
};
/// Of one part, members counted first, then panels; in order of frame, the first that of frame 0. As the viewer draws
/// it, to structure::drawn_tolerance.
[[nodiscard]] std::vector<ShapeChange> part_shapes(const structure::Building& building, const Recording& recording,
                                                   std::size_t part);
/// How many of the ways of bending, the first ones, it takes to draw these.
[[nodiscard]] std::size_t ways_of_bending(const std::vector<ShapeChange>& shapes);
/// The last at or before this frame.
[[nodiscard]] const structure::BentPart& shape_at(const std::vector<ShapeChange>& shapes, std::int32_t frame);

/// What is drawn of a part, about the place and axes of its pose, and the ways in which it bends.
struct PartMesh {
  Mesh mesh;
  std::vector<std::vector<structure::Vec3>> bends;         ///< SceneMesh::bends; empty: it stays as it is
  std::vector<std::vector<structure::Vec3>> bend_normals;  ///< SceneMesh::bend_normals
  structure::AnimatedPose rest;                            ///< undeformed
};
/// Straight in one part, or in as many as bend.
[[nodiscard]] PartMesh member_mesh(const structure::Building& building, structure::MemberId member, bool bent);
/// Of a panel, or of what remains of it, with so many ways of bending.
[[nodiscard]] PartMesh panel_part_mesh(const structure::Building& building, structure::PanelId panel,
                                       const PanelState& state, std::size_t ways);
/// Some normal of it is seen to turn along the run.
[[nodiscard]] bool normals_turn(const PartMesh& part, const std::vector<ShapeChange>& shapes);
/// Where its vertices are at rest but for their bend; positions relative to `origin`.
[[nodiscard]] Mesh placed(const PartMesh& part, const structure::BendWeights& bend, const Eigen::Vector3d& origin);

/// Meshes in the undeformed building, global axes, double precision where it matters: positions relative to `origin`.
[[nodiscard]] Mesh placed_panel_mesh(const structure::Building& building, const structure::Panel& panel,
                                     const Eigen::Vector3d& origin);

[[nodiscard]] Mesh placed_panel_mesh(const structure::Building& building, const structure::Panel& panel,
                                     const PanelState& state, const Eigen::Vector3d& origin);

[[nodiscard]] Mesh placed_mesh(const fracture::Mesh& placed, const Eigen::Vector3d& origin);

/// Rigid motion p -> turn p + shift of points of the undeformed building (about the same origin) at a frame.
struct PartMotion {
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();
};
[[nodiscard]] PartMotion motion_of(const BodyTrack& track, std::int32_t frame, const Eigen::Vector3d& origin);
/// From where a part was undeformed to where its shape has it.
[[nodiscard]] PartMotion motion_of(const structure::AnimatedPose& rest, const structure::AnimatedPose& now,
                                   const Eigen::Vector3d& origin);
/// First `inner`, then `outer`.
[[nodiscard]] PartMotion operator*(const PartMotion& outer, const PartMotion& inner);

}  // namespace topple::viewer
