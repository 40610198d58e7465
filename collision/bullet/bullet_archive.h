#pragma once
// Archives of Bullet's types.
#include <BulletCollision/CollisionShapes/btConvexPolyhedron.h>
#include <LinearMath/btTransform.h>

#include <cstdint>

#include "state_archive.h"

/// Three numbers: the fourth is always zero.
template <class Archive>
void save(Archive& archive, const btVector3& vector) {
  archive(cereal::binary_data(vector.m_floats, 3 * sizeof(btScalar)));
}
template <class Archive>
void load(Archive& archive, btVector3& vector) {
  vector.setZero();
  archive(cereal::binary_data(vector.m_floats, 3 * sizeof(btScalar)));
}

template <class Archive>
void serialize(Archive& archive, btTransform& transform) {
  archive(transform.getBasis()[0], transform.getBasis()[1], transform.getBasis()[2], transform.getOrigin());
}

template <class Archive, class Item>
void save(Archive& archive, const btAlignedObjectArray<Item>& array) {
  archive(static_cast<std::int32_t>(array.size()));
  for (int i = 0; i < array.size(); ++i) archive(array[i]);
}
template <class Archive, class Item>
void load(Archive& archive, btAlignedObjectArray<Item>& array) {
  std::int32_t size = 0;
  archive(size);
  array.resize(size);
  for (int i = 0; i < size; ++i) archive(array[i]);
}

template <class Archive>
void serialize(Archive& archive, btFace& face) {
  archive(face.m_indices, cereal::binary_data(face.m_plane, sizeof(face.m_plane)));
}
/// What is read of it: the rest serves a search along separating axes, which is off.
template <class Archive>
void serialize(Archive& archive, btConvexPolyhedron& of) {
  archive(of.m_vertices, of.m_faces);
}
