#pragma once
// Convex shapes of members and panels for the collision world, in global axes of the undeformed building. A member is
// the box around its section, a panel the plate between its edges. Both end where their neighbours begin, so that a
// part that breaks off does not start inside what it was joined to.
#include <map>
#include <optional>
#include <vector>

#include "simulation/debris/part.h"
#include "topple/collision/world.h"

namespace topple::structure {

struct Bounds {
  Vec3 low = Vec3::Constant(unlimited), high = Vec3::Constant(-unlimited);
  void add(const Vec3& point) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  void add(const Bounds& other) {
    low = low.cwiseMin(other.low);
    high = high.cwiseMax(other.high);
  }
  [[nodiscard]] bool holds(const Bounds& other) const {
    return (low.array() <= other.low.array()).all() && (other.high.array() <= high.array()).all();
  }
  [[nodiscard]] bool meets(const Bounds& other) const {
    return (low.array() <= other.high.array()).all() && (other.low.array() <= high.array()).all();
  }
};
template <class Archive>
void serialize(Archive& archive, Bounds& bounds) {
  auto& [low, high] = bounds;
  archive(low, high);
}

class PartShapes {
 public:
  explicit PartShapes(const Building& building);

  /// Relative to `origin`; the tag is the part's number.
  [[nodiscard]] collision::ConvexPart shape(Part part, const Vec3& origin) const;
  /// The same of what is left of it: several convex parts where it is broken.
  [[nodiscard]] std::vector<collision::ConvexPart> parts(Part part, const Vec3& origin) const;
  /// Corners of what of a member's shape lies between two distances from its first end, a little apart from what was
  /// cut off there; of a stretch that lies all but beyond the shape, of its inner part.
  [[nodiscard]] std::vector<Vec3> corners(const Building& building, MemberId member, double from, double to) const;
  /// From now on the panel has these shapes (corners of each).
  void set_broken(PanelId panel, std::vector<std::vector<Vec3>> hulls);
  /// The eight corners of a panel's whole shape: going round, on both sides in turn.
  [[nodiscard]] std::vector<Vec3> corners(PanelId panel) const;
  [[nodiscard]] const Bounds& bounds(Part part) const;
  /// Distance along a ray (unit direction) to the part where it stands undeformed.
  [[nodiscard]] std::optional<double> ray(Part part, const Vec3& from, const Vec3& direction) const;

  /// The rest is the building's.
  template <class Archive>
  void serialize(Archive& archive) {
    auto& [members, members_at_node, shapes, broken] = *this;
    archive(broken);
  }

 private:
  /// A member or a rectangular panel: box with rows of `axes` as its own. Another panel: eight corners.
  struct Shape {
    Mat3 axes = Mat3::Identity();
    Vec3 centre = Vec3::Zero(), half = Vec3::Zero();
    std::vector<Vec3> corners;
    Bounds bounds;
  };
  [[nodiscard]] const Shape& of(Part part) const;
  [[nodiscard]] Shape member_shape(const Building& building, MemberId id) const;
  [[nodiscard]] Shape panel_shape(const Building& building, PanelId id) const;
  static void make_box(Shape& shape);
  [[nodiscard]] double clearance(const Building& building, NodeId node, MemberId except, const Vec3& direction) const;
  [[nodiscard]] double edge_inset(const Building& building, const Panel& panel, int edge) const;

  std::size_t members_ = 0;
  std::vector<std::vector<MemberId>> members_at_node_;
  std::vector<Shape> shapes_;
  std::map<PanelId, std::vector<std::vector<Vec3>>> broken_;
};

/// Width along local y and depth along local z: as given, or those of the rectangle with the same area and inertia.
[[nodiscard]] Vec2 section_size(const Section& section);

}  // namespace topple::structure
