#pragma once
// One bending plane of a beam-column under its axial force, exactly: v' = (rotation + T/GA)/(1 + N/GA) (Engesser),
// rotation' = M/EI + free curvature, M' = -T + N v' - m, T' = -q, with T the force across the undeformed axis. The beam
// is cut into stretches on which N is a polynomial and the solution smooth; each stretch's transfer matrix is a power
// series summed to rounding. Segments of several stretches multiply theirs, however short some of them are (a load
// hardly off an end); the stiffness of each follows, and the joints between segments are condensed. Timoshenko and
// Gere, Theory of Elastic Stability, ch. 1-2.
#include <Eigen/Core>
#include <Eigen/LU>
#include <array>
#include <span>
#include <vector>

namespace topple::solver {

/// What acts on one stretch of the beam.
struct ColumnStretch {
  double start = 0, length = 0;
  std::array<double, 3> axial{};             ///< tension, in powers of the distance from the start
  double force = 0, force_slope = 0;         ///< across, per length
  double moment = 0, moment_slope = 0;       ///< per length
  double point_force = 0, point_moment = 0;  ///< at the start of the stretch
  bool begins_segment = false;               ///< as the first one does anyway
};

struct ColumnPlane {
  double bending_stiffness = 0;
  double shear_compliance = 0;  ///< 1/(G As), or 0
  double free_curvature = 0;
};

class BeamColumn {
 public:
  /// `end_stiffness`: springs of v1, r1, v2, r2 (infinite: rigid, 0: released). `at_second_end`: point force and
  /// moment there. A segment should be far shorter than 2 pi sqrt(EI/N), at which it would buckle between held ends.
  BeamColumn(const ColumnPlane& plane, std::span<const ColumnStretch> stretches,
             const std::array<double, 4>& end_stiffness,
             const Eigen::Vector2d& at_second_end = Eigen::Vector2d::Zero());

  /// In the freedoms v1, r1, v2, r2 of the rigid ends.
  [[nodiscard]] const Eigen::Matrix4d& stiffness() const { return stiffness_; }
  [[nodiscard]] const Eigen::Vector4d& fixed_end_forces() const { return fixed_; }
  /// Modes of the beam between its rigid ends, held, whose critical load is below its axial force (Wittrick and
  /// Williams' J0). Above 0 the beam is not stable whatever its nodes do.
  [[nodiscard]] int buckled_modes() const { return buckled_; }

  /// v, rotation, M, T at points along the beam, given the rigid ends' displacements.
  class Curve {
   public:
    [[nodiscard]] Eigen::Vector4d at(double distance) const;
    /// One of the four; where it jumps, the one just before, or just `beyond`.
    [[nodiscard]] double value(int component, double distance, bool beyond = false) const;

   private:
    friend class BeamColumn;
    struct Part {
      double start = 0, length = 0;
      std::vector<Eigen::Vector4d> series;  ///< in powers of the distance from its start over its length
    };
    std::vector<Part> parts_;
  };
  [[nodiscard]] Curve curve(const Eigen::Vector4d& rigid_ends) const;

 private:
  struct Segment {
    std::size_t first = 0, count = 0;  ///< of stretches_
    double length = 0;
    Eigen::Matrix4d stiffness = Eigen::Matrix4d::Zero();
    Eigen::Vector4d fixed = Eigen::Vector4d::Zero();
  };
  /// The joint before a segment: its displacements follow from those of the first end and of the next joint.
  struct Joint {
    Eigen::Matrix2d inverse, to_first, to_next;
    Eigen::Vector2d load;
  };
  static Curve::Part along(const ColumnPlane& plane, const ColumnStretch& stretch, const Eigen::Vector4d& start);
  [[nodiscard]] std::span<const ColumnStretch> stretches(const Segment& segment) const {
    return std::span(stretches_).subspan(segment.first, segment.count);
  }
  void find_stiffness(Segment& segment) const;
  void chain();
  void add_springs(const std::array<double, 4>& end_stiffness);

  ColumnPlane plane_;
  std::vector<ColumnStretch> stretches_;
  std::vector<Segment> segments_;
  std::vector<Joint> joints_;  ///< before segments 1, 2, ...
  struct Spring {
    int freedom = 0;
    double stiffness = 0, pivot = 0, fixed = 0;
    Eigen::Vector4d row;
  };
  std::vector<Spring> springs_;
  Eigen::Matrix4d stiffness_ = Eigen::Matrix4d::Zero();
  Eigen::Vector4d fixed_ = Eigen::Vector4d::Zero();
  int buckled_ = 0;
};

}  // namespace topple::solver
