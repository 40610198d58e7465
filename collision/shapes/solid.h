#pragma once
// What lies in the Bullet world: the convex parts of a body, an obstacle or the ground, as Bullet shapes.
#include <BulletCollision/CollisionShapes/btCompoundShape.h>
#include <BulletCollision/CollisionShapes/btConvexShape.h>
#include <array>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bullet/bullet_types.h"
#include "shapes/polyhedron_store.h"

class btCollisionObject;

namespace topple::collision {

/// Hulls touch through a skin of this thickness (m). Thick enough that resting contacts stay out of the costly search
/// for penetration depth, thin enough that nobody sees the gap: it lies outside.
inline constexpr double kSkin = 0.002;
/// A box's lies inside, and rounds its corners off by up to three quarters of this (m): what a sweep does not see
/// coming for that, contacts stop, with a force that is as large as a part of a step is short.
inline constexpr double kSkinOfBox = 1e-5;

/// One convex part in the frame of its solid's Bullet transform.
struct SolidPart {
  std::shared_ptr<const ConvexPart> made_from;  ///< a hull's points are in the solid's frame; shared as the shape is
  std::shared_ptr<btConvexShape> shape;         ///< never changed, so that copies of a solid share it
  btTransform local = btTransform::getIdentity();
  std::int64_t tag = -1;
  double reach = 0;      ///< no point of it is farther from the solid's origin, m
  double thickness = 0;  ///< least width across any of its faces, m

  template <class Archive>
  void save(Archive& archive) const {
    const auto& [from, made, in_solid, number, farthest, width] = *this;  // the shape is made again
    archive(*from, in_solid, number, farthest, width);
  }
  template <class Archive>
  void load(Archive& archive) {
    ConvexPart from;
    archive(from, local, tag, reach, thickness);
    made_from = std::make_shared<const ConvexPart>(std::move(from));
  }
};

struct Solid {
  Touched::Kind kind = Touched::Kind::ground;
  std::int64_t id = -1;
  std::vector<SolidPart> parts;
  std::shared_ptr<btCompoundShape> compound;       ///< none when one part fills the frame
  btTransform frame = btTransform::getIdentity();  ///< of Bullet's transform in the caller's (a rotation)
  bool turned = false;                             ///< the frame is not the identity
  btCollisionObject* object = nullptr;
  double reach = 0;

  [[nodiscard]] btCollisionShape* shape() const {
    return compound ? static_cast<btCollisionShape*>(compound.get()) : parts.front().shape.get();
  }
  /// The part of a Bullet child index, -1 being the only one.
  [[nodiscard]] const SolidPart& part(int index) const {
    return parts[index < 0 ? 0 : static_cast<std::size_t>(index)];
  }

  template <class Archive>
  void serialize(Archive& archive) {
    auto& [is, number, pieces, whole, axes, is_turned, bullet, farthest] = *this;
    archive(is, number, pieces, axes, is_turned, farthest);  // the compound is made again; `bullet` is another engine's
  }
};

/// Of the box around a part, in the solid's frame.
[[nodiscard]] std::array<btVector3, 8> corners_of_bounds(const SolidPart& part);

/// The frame of a description of one box that lies about the origin: in it the box is no compound, which pairs cost
/// several times as much. None for any other.
[[nodiscard]] std::optional<btTransform> frame_of_only_box(const std::vector<ConvexPart>& description);

/// Makes the parts of a solid whose frame is known. Throws std::invalid_argument naming
/// `owner` and the part's tag for a part of no volume or with a number that is not finite, and for no part at all.
void make_parts(const std::vector<ConvexPart>& description, const std::string& owner, PolyhedronStore& polyhedra,
                Solid& solid);

/// The shapes of parts of which all else is there: as they were made.
void make_shapes_again(PolyhedronStore& polyhedra, Solid& solid);
/// What a store keeps of the solid's shapes.
void take_features(const Solid& solid, const PolyhedronStore& from, PolyhedronStore& to);

/// The number of a child from a ray or contact of a solid with several parts; the part nearest to a global point.
[[nodiscard]] int nearest_part(const Solid& solid, const btTransform& pose, const btVector3& point);

}  // namespace topple::collision
