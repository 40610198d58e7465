#pragma once
// From a recording: how each part of the building moved, for files that other programs play.
#include <glm/vec3.hpp>
#include <vector>

#include "renderer/recording.h"
#include "renderer/shapes/mesh.h"

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

/// A piece of a model that is drawn around the building, from the cut that made it to the one that ends it.
struct DrawnTrack {
  std::shared_ptr<const fracture::Mesh> mesh;  ///< where it was in the undeformed building
  std::vector<PlaceChange> places;             ///< in order of frame; the first is that of frame 0
};
/// In the order in which they come, those of one frame as the snapshot has them.
[[nodiscard]] std::vector<DrawnTrack> drawn_tracks(const Recording& recording);

/// Meshes in the undeformed building, global axes, double precision where it matters: positions relative to `origin`.
[[nodiscard]] Mesh placed_member_mesh(const structure::Building& building, const structure::Member& member,
                                      const Eigen::Vector3d& origin);
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

}  // namespace topple::viewer
