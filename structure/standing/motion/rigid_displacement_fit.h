#pragma once
// By how much a body has moved and turned whose parts have moved each by itself.
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include "model/point_inertia.h"

namespace topple::structure {

/// The rigid displacement that has the first moments of that of the mass, as a body's motion has its momentum. Small
/// displacements.
class RigidDisplacementFit {
 public:
  /// A part with its inertia about its own centre, kg m2.
  void add(double mass, const Vec3& centre, const Mat3& inertia, const Vec3& moved, const Vec3& turned) {
    Vec6 moments;
    moments << mass * moved, inertia * turned + mass * centre.cross(moved);
    add_momentum(mass, centre, inertia, moments);
  }
  void add_point(double mass, const Vec3& place, const Vec3& moved) {
    add(mass, place, Mat3::Zero(), moved, Vec3::Zero());
  }
  /// A part by its momentum, linear (N s) and about the origin (N m s): of the motion, not of a displacement.
  void add_momentum(double mass, const Vec3& centre, const Mat3& inertia, const Vec6& momentum) {
    mass_ += mass;
    first_ += mass * centre;
    moved_ += momentum.head<3>();
    inertia_ += inertia + point_inertia(mass, centre);
    turning_ += momentum.tail<3>();
  }
  [[nodiscard]] Vec3 centre() const { return first_ / mass_; }
  /// m, of the mean of its mass; 0 without mass.
  [[nodiscard]] Vec3 moved() const { return mass_ > 0 ? Vec3(moved_ / mass_) : Vec3(Vec3::Zero()); }
  /// rad; `else_turned`: about what has no inertia.
  [[nodiscard]] Vec3 turned(const Vec3& else_turned = Vec3::Zero()) const {
    if (!(mass_ > 0)) return else_turned;
    const Vec3 centre = first_ / mass_, turning = turning_ - centre.cross(moved_);
    const Eigen::SelfAdjointEigenSolver<Mat3> axes(Mat3(inertia_ - point_inertia(mass_, centre)));
    Vec3 turned = else_turned;
    constexpr double none = 1e-9;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const Vec3 along = axes.eigenvectors().col(axis);
      if (axes.eigenvalues()(axis) > none * inertia_.trace())
        turned += (along.dot(turning) / axes.eigenvalues()(axis) - along.dot(else_turned)) * along;
    }
    return turned;
  }

 private:
  double mass_ = 0;
  Vec3 first_ = Vec3::Zero(), moved_ = Vec3::Zero(), turning_ = Vec3::Zero();
  Mat3 inertia_ = Mat3::Zero();
};

}  // namespace topple::structure
