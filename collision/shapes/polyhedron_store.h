#pragma once
// Faces and edges of boxes and hulls, which Bullet finds by a search of two thousand steps for every shape: a part that
// stands, comes loose and breaks further has them found once.
#include <BulletCollision/CollisionShapes/btConvexPolyhedron.h>
#include <BulletCollision/CollisionShapes/btPolyhedralConvexShape.h>

#include <Eigen/Geometry>
#include <map>
#include <vector>

namespace topple::collision {

class PolyhedronStore {
 public:
  /// Gives the shape the faces and edges of all shapes that are made from these numbers.
  void give_features(btPolyhedralConvexShape& shape, const std::vector<double>& made_from);
  /// The same where the points are seen to be those of a straight prism: each corner of the one end followed by its
  /// opposite at the other, round a convex end. Then nothing needs to be sought, nor kept: its vertices and faces are
  /// all that it is given (edges and inner boxes serve a search along separating axes, which is off in Bullet unless
  /// m_enableSatConvex asks for it). False where they are not.
  static bool give_prism(btPolyhedralConvexShape& shape, const std::vector<Eigen::Vector3d>& points);
  /// What is kept there of shapes that are made from these numbers, if anything is.
  void take(const PolyhedronStore& from, const std::vector<double>& made_from);

  /// Whatever is missing is sought anew when it is asked for, and is the same to the bit.
  template <class Archive>
  void serialize(Archive& archive) {
    auto& [known] = *this;
    archive(known);
  }

 private:
  std::map<std::vector<double>, btConvexPolyhedron> known_;
};

}  // namespace topple::collision
