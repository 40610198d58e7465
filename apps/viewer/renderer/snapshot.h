#pragma once
// All that drawing needs to know of a simulation at one instant, copied out of it so that the two may run on different
// threads. What changes only when the structure's answer changes, or when something breaks off, is shared between
// snapshots, so a snapshot of a resting scene costs nearly nothing.
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "topple/structure/simulation.h"

namespace topple::viewer {

/// The answer of the statics: shared by all snapshots until it changes.
struct FrameAnswer {
  std::vector<Eigen::Matrix<float, 6, 1>> displacements;  ///< per node, global; zero where the node does not stand
  struct Joint {
    std::array<float, 6> demand{};  ///< joint axes, N and N m (panels: per length)
    float utilisation = 0;
    float force_share = 0, torque_share = 0;  ///< largest ratio of demand to capacity among forces, among moments
    structure::Sense sense = structure::Sense::tension;
    bool intact = true, standing = true;
  };
  std::vector<Joint> joints;                  ///< per Building::joints
  std::vector<structure::JointId> most_used;  ///< standing joints that have a capacity, most used first (at most 20)
};

/// Which part is where: index into Snapshot::bodies, or one of these.
inline constexpr int part_stands = -1, part_gone = -2;
struct Membership {
  std::vector<int> member, panel;
  int members_standing = 0, panels_standing = 0;
};

struct BodyPose {
  std::int64_t id = -1;
  Eigen::Vector3d position = Eigen::Vector3d::Zero(), rest_centre = Eigen::Vector3d::Zero();
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  double radius = 0;  ///< above zero: a projectile
  bool asleep = false;
  std::shared_ptr<const fracture::Mesh> chunk;  ///< of a broken panel: about its centre of mass
  structure::PanelKind chunk_of = structure::PanelKind::slab;
};

struct Snapshot {
  double time = 0;
  std::int64_t step = 0;
  bool at_rest = false, finished = false;
  std::shared_ptr<const FrameAnswer> answer;
  std::shared_ptr<const Membership> membership;
  std::vector<BodyPose> bodies;  ///< in order of id
  structure::SimulationCounters counters;
  std::array<double, 6> stage_seconds{};
  double collision_engine_seconds = 0;
};

/// A building in its undeformed state, nothing loaded.
[[nodiscard]] Snapshot undeformed(const structure::Building& building);

/// Between two snapshots of one run (bodies by the shortest turn; the answer is that of `later`); `share` from 0 to 1.
[[nodiscard]] Snapshot interpolate(const Snapshot& earlier, const Snapshot& later, double share);

}  // namespace topple::viewer
