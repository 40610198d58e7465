#pragma once
// Where the parts of a building lie, for what is drawn around them: members as lines, panels as quadrilaterals.
#include <utility>
#include <vector>

#include "simulation/debris/part.h"
#include "topple/structure/standing_frame.h"

namespace topple::structure {

class PartPlaces {
 public:
  explicit PartPlaces(const Building& building);

  [[nodiscard]] const std::vector<Part>& all() const { return all_; }
  /// The part nearest to a point, the first of equals; `among` must not be empty.
  [[nodiscard]] Part nearest(const Vec3& point, const std::vector<Part>& among) const;
  /// Points of two parts that lie closest to each other (of panels: on their middle lines).
  [[nodiscard]] std::pair<Vec3, Vec3> closest(Part first, Part second) const;
  [[nodiscard]] Vec3 centre(Part part) const;
  [[nodiscard]] bool touches(Part part, NodeId node) const;

 private:
  using Line = std::array<Vec3, 2>;
  [[nodiscard]] Line line(Part part) const;
  [[nodiscard]] double distance(Part part, const Vec3& point) const;

  const Building& building_;
  std::vector<Part> all_;
  /// A sphere around each part, by its number: what is farther away than the nearest so far is not looked at.
  struct Sphere {
    Vec3 centre = Vec3::Zero();
    double radius = 0;
  };
  std::vector<Sphere> around_;
};

}  // namespace topple::structure
