#include "shapes/touching_solid.h"

#include <BulletCollision/CollisionShapes/btConvexPolyhedron.h>
#include <BulletCollision/CollisionShapes/btPolyhedralConvexShape.h>

namespace topple::collision {

namespace {

Pose pose_of(const btTransform& transform) {
  return {from_bullet(transform.getOrigin()), from_bullet(transform.getRotation())};
}

PartShape touching_shape(const SolidPart& made) {
  const ConvexPart& part = *made.made_from;
  PartShape shape;
  if (part.kind == ConvexPart::Kind::sphere) {
    shape.centre = from_bullet(made.local.getOrigin());
    shape.radius = part.half_extents.x();
    shape.half.setConstant(shape.radius);
    return shape;
  }
  const btConvexPolyhedron* features = static_cast<const btPolyhedralConvexShape&>(*made.shape).getConvexPolyhedron();
  if (part.kind == ConvexPart::Kind::box || features == nullptr) {
    shape.polyhedron = make_box(part.half_extents, pose_of(made.local));
  } else {
    std::vector<Vec3> vertices;
    for (int i = 0; i < features->m_vertices.size(); ++i)
      vertices.push_back(from_bullet(made.local * features->m_vertices[i]));
    std::vector<std::vector<int>> faces;
    for (int f = 0; f < features->m_faces.size(); ++f) {
      const btAlignedObjectArray<int>& loop = features->m_faces[f].m_indices;
      std::vector<int>& face = faces.emplace_back();
      for (int i = 0; i < loop.size(); ++i) face.push_back(loop[i]);
    }
    shape.polyhedron = make_polyhedron(std::move(vertices), std::move(faces));
  }
  Vec3 low = shape.polyhedron->vertices.front(), high = low;
  for (const Vec3& vertex : shape.polyhedron->vertices) {
    low = low.cwiseMin(vertex);
    high = high.cwiseMax(vertex);
  }
  shape.centre = (low + high) / 2;
  shape.half = (high - low) / 2;
  return shape;
}

}  // namespace

void make_shapes(TouchingSolid& solid) {
  for (const SolidPart& part : solid.parts) solid.shapes.push_back(touching_shape(part));
}

}  // namespace topple::collision
