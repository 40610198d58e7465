#pragma once
// A run kept for looking back at it and for export: poses only where something moved, answers and memberships shared.
// Safe to read on one thread while another adds.
#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "renderer/snapshot.h"

namespace topple::viewer {

/// Where a body is from a frame on: the way of its centre of mass since the undeformed building, and its turn.
struct PoseKey {
  std::int32_t frame = 0;
  std::array<float, 3> offset{};
  std::array<float, 4> turn{0, 0, 0, 1};  ///< quaternion x, y, z, w
};

/// All that one body did.
struct BodyTrack {
  std::int64_t id = -1;
  Eigen::Vector3d rest_centre = Eigen::Vector3d::Zero();
  double radius = 0;
  std::shared_ptr<const fracture::Mesh> chunk;
  structure::PieceKind chunk_of = structure::PieceKind::slab;
  std::optional<Eigen::Vector3d> cable_anchor;
  std::int32_t first = 0, end = -1;  ///< frames first to end - 1; end -1: it is still there
  std::vector<PoseKey> keys;         ///< in order of frame; between two the pose runs straight from one to the other
  /// At a frame of its life.
  [[nodiscard]] BodyPose pose(std::int32_t frame) const;
};

class Recording {
 public:
  struct Event {
    double time = 0;
    structure::SimulationEvent::Kind kind{};
    std::string text;
  };
  struct Frame {
    double time = 0;
    std::int64_t step = 0;
    bool at_rest = false;
    std::shared_ptr<const FrameAnswer> answer;
    std::shared_ptr<const Membership> membership;
    std::shared_ptr<const TunedJoints> tuned;
    std::shared_ptr<const std::vector<DrawnPiece>> drawn;
    structure::SimulationCounters counters;
    structure::Ledger energies;
  };

  /// A step at or before the last one replaces all from there on (undo).
  void add(const Snapshot& snapshot);
  void add_event(Event event);
  void clear();

  [[nodiscard]] std::array<double, 2> span() const;  ///< times of the first and the last frame
  /// Held to span(); between two frames as interpolate() has it. Something must have been recorded.
  [[nodiscard]] Snapshot at(double time) const;
  [[nodiscard]] std::vector<Event> events() const;
  /// Utilisation of a joint over time, in at most `most` even intervals: the largest in each.
  [[nodiscard]] std::vector<std::array<float, 2>> history(structure::JointId joint, std::size_t most = 300) const;

  /// Energies over time, at most `most` even instants.
  struct Energies {
    double time = 0;
    structure::Ledger ledger;
  };
  [[nodiscard]] std::vector<Energies> energies(std::size_t most = 300) const;

  // For export, when nothing is added any more.
  [[nodiscard]] const std::vector<Frame>& frames() const { return frames_; }
  [[nodiscard]] const std::vector<BodyTrack>& tracks() const { return tracks_; }

 private:
  void cut_from(std::int64_t step);
  [[nodiscard]] std::shared_ptr<const std::vector<DustPuff>> dust_at(double time) const;
  [[nodiscard]] Snapshot frame_snapshot(std::size_t frame) const;
  [[nodiscard]] std::size_t frame_at(double time) const;

  mutable std::mutex mutex_;
  std::vector<Frame> frames_;
  std::vector<BodyTrack> tracks_;   ///< in order of id
  std::vector<std::size_t> alive_;  ///< tracks that have not ended, in order of id
  std::vector<Event> events_;
  std::vector<DustPuff> dust_;  ///< all there was, in order of time
  bool resting_ = false;        ///< the last frame brought nothing new
};

}  // namespace topple::viewer
