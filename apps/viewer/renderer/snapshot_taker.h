#pragma once
#include <map>
#include <memory>
#include <vector>

#include "renderer/shapes/dust.h"
#include "renderer/snapshot.h"
#include "topple/structure/visual_mesh.h"

namespace topple::viewer {

/// Takes snapshots of one simulation, sharing what did not change since the last one. Used on the simulation's thread.
class SnapshotTaker {
 public:
  /// The run begins: what it has moved by later is counted from how it stands now.
  void begin(const structure::Simulation& simulation);
  /// `drawn`: cut where its parts have come apart since, and seen.
  [[nodiscard]] Snapshot capture(const structure::Simulation& simulation, structure::VisualMesh* drawn = nullptr);
  /// From the next snapshot on.
  void set_wanted(Wanted wanted) { wanted_ = wanted; }
  /// Joints were given other capacities: the next snapshot reads their utilisations anew.
  void forget_answer() { answer_ = nullptr; }
  /// What is seen where a fire is laid (from the time given on) and where a charge goes off. Sparks: as thermite burns.
  void burn(const structure::WeakenTool& fire, double from, DustPuff::Kind kind = DustPuff::Kind::fire) {
    if (fire.over > 0) dust_.burn({fire.members, fire.joints, from, from + fire.over, kind});
  }
  /// Flames are seen at this time, s: each step has its own.
  [[nodiscard]] bool burns(double time) const { return dust_.burns(time); }
  /// Supports of these nodes are taken away at this time (s).
  void mark_removed_supports(const std::vector<structure::NodeId>& nodes, double at) {
    for (const structure::NodeId node : nodes) taken_supports_.emplace_back(node, at);
  }
  void blast(const Eigen::Vector3d& centre, double charge) { dust_.blast(centre, charge); }

 private:
  [[nodiscard]] structure::MaterialId material_of(const structure::Simulation& simulation,
                                                  const structure::BodyView& body);
  Wanted wanted_, read_;
  structure::ShapeWatcher shapes_;
  std::vector<std::pair<structure::NodeId, double>> taken_supports_;
  DustWatcher dust_;
  std::shared_ptr<const FrameAnswer> answer_;
  std::shared_ptr<const structure::StandingShapes> at_start_;
  structure::Ledger energies_;
  bool rested_ = false;  ///< when the energies were read
  std::shared_ptr<const Membership> membership_;
  std::shared_ptr<const std::vector<DrawnPiece>> drawn_;
  std::uint64_t drawn_revision_ = 0;
  std::unique_ptr<structure::NameIndex> names_;
  std::map<std::int64_t, structure::MaterialId> material_of_chunk_;
};

}  // namespace topple::viewer
