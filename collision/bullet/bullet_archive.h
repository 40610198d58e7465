#pragma once
// Archives of Bullet's types (state_archive.h).
#include <BulletCollision/CollisionShapes/btConvexPolyhedron.h>
#include <LinearMath/btTransform.h>

#include <cstdint>

/// Three numbers: the fourth is always zero.
template <class Archive>
void save(Archive& archive, const btVector3& vector) {
  archive(vector.x(), vector.y(), vector.z());
}
template <class Archive>
void load(Archive& archive, btVector3& vector) {
  btScalar x = 0, y = 0, z = 0;
  archive(x, y, z);
  vector.setValue(x, y, z);
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
  archive(face.m_indices, face.m_plane[0], face.m_plane[1], face.m_plane[2], face.m_plane[3]);
}
/// What is read of it: the rest serves a search along separating axes, which is off.
template <class Archive>
void serialize(Archive& archive, btConvexPolyhedron& of) {
  archive(of.m_vertices, of.m_faces);
}
