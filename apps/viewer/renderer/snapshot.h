#pragma once
// All that drawing needs to know of a simulation at one instant, copied out of it so that the two may run on different
// threads. What changes only when the structure's answer changes, or when something breaks off, is shared between
// snapshots, so a snapshot of a resting scene costs nearly nothing.
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "topple/structure/joint_tuning.h"
#include "topple/structure/shape_watcher.h"
#include "topple/structure/simulation.h"

namespace topple::viewer {

using structure::Displacement;
using structure::MemberShape;
using structure::MemberShapes;
using structure::part_gone;
using structure::part_stands;

/// What acts on the frame and how its members bear it; read out only when it is wanted.
struct FrameForces {
  static constexpr int intervals = 12;  ///< even parts of a member between the places at which its forces are told
  /// [member * (intervals + 1) + place]: axial, shear_y, shear_z, torsion, moment_y, moment_z in member axes (N, N m).
  /// Empty when not wanted.
  std::vector<std::array<float, 6>> internal;
  struct Arrow {
    Eigen::Vector3d at;
    Eigen::Vector3f force;  ///< global; N, spread loads N/m
  };
  std::vector<Arrow> spread, points, contacts, reactions;
};
/// What a drawing wants beside displacements and demands.
struct Wanted {
  bool internal_forces = false, arrows = false;
  bool operator==(const Wanted&) const = default;
};

/// The answer of the statics: shared by all snapshots until it changes.
struct FrameAnswer : structure::StandingShapes {
  /// The same when the run began, nothing lost; null: zero.
  std::shared_ptr<const std::vector<Displacement>> at_start;
  std::shared_ptr<const MemberShapes> shapes_at_start;
  struct Joint {
    std::array<float, 6> demand{};  ///< joint axes, N and N m (panels: per length)
    float utilisation = 0;
    float force_share = 0, torque_share = 0;  ///< largest ratio of demand to capacity among forces, among moments
    float strength = 1;  ///< what charges and fires have left of the capacity: multiplies each of its senses
    structure::Sense sense = structure::Sense::tension;
    bool intact = true, standing = true;
  };
  std::vector<Joint> joints;                                  ///< per Building::joints
  std::vector<structure::PlasticRotation> plastic_rotations;  ///< in order of joint and sense
  std::vector<structure::JointId> most_used;  ///< standing joints that have a capacity, most used first (at most 20)
  std::shared_ptr<const FrameForces> forces;  ///< null when not wanted
};

/// Capacities as a person has changed them, per joint.
struct TunedJoints {
  std::vector<structure::JointCapacity> capacity;
  std::vector<double> strength;  ///< multiplier, contained in the capacity
  std::vector<structure::JointChange> changes;
};

/// Which part is where (index into Snapshot::bodies), what it keeps of its shape, what remains of it.
struct Membership : structure::KeptShapes {
  std::vector<int> segment;  ///< per member: number of its standing segment, -1 when it does not stand
  /// Per panel: what remains of one that is broken in part, where it stood undeformed; null while it is whole.
  std::vector<std::shared_ptr<const fracture::Mesh>> broken;
  std::vector<bool> supports;  ///< per Building::supports: it has not been taken away
  int members_standing = 0, panels_standing = 0;
};

struct BodyPose {
  std::int64_t id = -1;
  Eigen::Vector3d position = Eigen::Vector3d::Zero(), rest_centre = Eigen::Vector3d::Zero();
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  double radius = 0;  ///< above zero: a projectile
  bool asleep = false;
  std::shared_ptr<const fracture::Mesh> chunk;  ///< of a broken panel or member: about its centre of mass
  structure::PieceKind chunk_of = structure::PieceKind::slab;
  structure::MaterialId material;               ///< of a chunk; none where that is not known
  std::optional<Eigen::Vector3d> cable_anchor;  ///< of a wrecking ball
};

/// A piece of a model that is drawn around the building.
struct DrawnPiece {
  std::shared_ptr<const fracture::Mesh> mesh;              ///< where it was in the undeformed building
  std::shared_ptr<const std::vector<std::int32_t>> bones;  ///< of one that stands: structure::VisualMesh::Piece::bones
  std::int64_t body = part_stands;                         ///< id of the body that it moves with; or part_stands
};

/// Dust, sparks, the ball of an explosion, or a lick of fire with its smoke, of an instant: see dust.h.
struct DustPuff {
  enum class Kind : std::uint8_t { dust, sparks, blast, fire };
  std::int64_t number = 0;  ///< tells puffs of one time apart
  double time = 0;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  float size = 0;  ///< radius of the cloud when it has spread, m
  Kind kind = Kind::dust;
  std::uint32_t colour = 0xffb2bec4;  ///< of dust: red in the lowest byte; that of concrete unless told
  std::uint8_t material = 1;          ///< of what broke or landed, as a number of looks.h: what is heard of it
  float mass = 500;                   ///< kg, of what broke or landed
  bool broke = false;                 ///< else something struck
};

struct Snapshot {
  double time = 0;
  std::int64_t step = 0;
  bool at_rest = false, finished = false;
  std::shared_ptr<const FrameAnswer> answer;
  std::shared_ptr<const Membership> membership;
  std::shared_ptr<const TunedJoints> tuned;              ///< null: as in the model
  std::shared_ptr<const std::vector<float>> path;        ///< per joint: share of a chosen force that goes through it
  std::vector<BodyPose> bodies;                          ///< in order of id
  std::shared_ptr<const std::vector<DustPuff>> dust;     ///< in order of time; null: none
  std::shared_ptr<const std::vector<DrawnPiece>> drawn;  ///< those that are there; null: nothing is drawn around it
  /// When there is one, what stands is drawn in this shape times the scale instead of its displacements (a mode).
  std::shared_ptr<const std::vector<Eigen::Matrix<float, 6, 1>>> shape;
  /// Per member: how far its middle moves, global, beside where the ends' displacements and turns bend it to; null:
  /// not.
  std::shared_ptr<const std::vector<Eigen::Vector3f>> shape_bulge;
  float shape_scale = 0;
  std::vector<std::array<Eigen::Vector3d, 2>> ropes;  ///< that a winch pulls, from end to end
  int actions = 0;                                    ///< what a person has done to the building
  structure::SimulationCounters counters;
  structure::Ledger energies;
  std::array<double, 6> stage_seconds{};
  double collision_engine_seconds = 0;
};

/// What a joint bears now.
[[nodiscard]] inline const structure::JointCapacity& joint_capacity(const structure::Building& building,
                                                                    const Snapshot& snapshot,
                                                                    structure::JointId joint) {
  return snapshot.tuned ? snapshot.tuned->capacity[static_cast<std::size_t>(joint.index)] : building[joint].capacity;
}

/// A building in its undeformed state, nothing loaded.
[[nodiscard]] Snapshot undeformed(const structure::Building& building);

/// Between two snapshots of one run (bodies by the shortest turn; the answer is that of `later`); `share` from 0 to 1.
[[nodiscard]] Snapshot interpolate(const Snapshot& earlier, const Snapshot& later, double share);

}  // namespace topple::viewer
