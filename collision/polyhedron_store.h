#pragma once
// Faces and edges of boxes and hulls, which Bullet finds by a search of two thousand steps for every shape: a part that
// stands, comes loose and breaks further has them found once.
#include <BulletCollision/CollisionShapes/btConvexPolyhedron.h>
#include <BulletCollision/CollisionShapes/btPolyhedralConvexShape.h>

#include <map>
#include <vector>

namespace topple::collision {

class PolyhedronStore {
 public:
  /// Gives the shape the faces and edges of all shapes that are made from these numbers.
  void give_features(btPolyhedralConvexShape& shape, const std::vector<double>& made_from);

 private:
  std::map<std::vector<double>, btConvexPolyhedron> known_;
};

}  // namespace topple::collision
