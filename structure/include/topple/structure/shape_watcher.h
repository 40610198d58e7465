#pragma once
// The shapes of a building's parts along a run: of what stands, as the analysis has them now; of what has let go, as it
// stood at that moment.
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "topple/structure/member_shapes.h"

namespace topple::structure {

/// Which part is where: index into Simulation::bodies(), or one of these.
inline constexpr int part_stands = -1, part_gone = -2;

/// Of what stands, as the analysis has it.
struct StandingShapes {
  std::vector<Displacement> displacements;     ///< per node; zero where the node does not stand
  std::shared_ptr<const MemberShapes> shapes;  ///< null: nodes tell all
  /// Of a member, by its own shape where one is known, else by its nodes.
  [[nodiscard]] MemberShape of(const Building& building, std::size_t member) const;
};

/// Where parts are, and how what has let go was bent then, beside the rigid motion of its body that comes nearest (axes
/// of the undeformed building). It keeps that shape.
struct KeptShapes {
  std::vector<int> member;                                                         ///< where each is
  std::vector<int> panel;                                                          ///< where each is
  std::vector<std::shared_ptr<const MemberShape>> member_shape;                    ///< null: none, or it stands
  std::vector<std::shared_ptr<const std::array<Eigen::Vector3f, 4>>> panel_shape;  ///< of its corners, m; null as above
};

/// Reads both from a simulation, and only when they change.
class ShapeWatcher {
 public:
  /// Call after every step: what lets go keeps the shape that was read last.
  void watch(const Simulation& simulation);
  /// Of what stands, read now; watch() is not called for it.
  [[nodiscard]] std::shared_ptr<const StandingShapes> read(const Simulation& simulation);

  /// As watched last; null before.
  [[nodiscard]] const std::shared_ptr<const StandingShapes>& standing() const { return standing_; }
  [[nodiscard]] const std::shared_ptr<const KeptShapes>& parts() const { return parts_; }  ///< as above

 private:
  void read_yields(const Simulation& simulation);
  std::vector<bool> yielded_;       // per member: a joint of it ever yielded
  std::size_t yielded_events_ = 0;  // that were read for it
  FrameCounters seen_;
  std::size_t seen_events_ = 0;
  bool was_pending_ = false;
  std::vector<std::int64_t> seen_bodies_;
  std::shared_ptr<const StandingShapes> standing_;
  std::shared_ptr<const KeptShapes> parts_;
};

}  // namespace topple::structure
