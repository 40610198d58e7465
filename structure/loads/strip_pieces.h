#pragma once
// A panel without its openings cut into trapezoids by parallel lines through every corner.
#include <functional>
#include <vector>

#include "tributary_areas.h"

namespace topple::structure {

/// Coordinates along (u) and across (t) the strips.
struct StripAxes {
  Vec2 along, across;
  explicit StripAxes(const Vec2& direction) : along(direction.normalized()), across(along.y(), -along.x()) {}
  [[nodiscard]] double u(const Vec2& p) const { return along.dot(p); }
  [[nodiscard]] double t(const Vec2& p) const { return across.dot(p); }
};

/// One point of an integration rule that is exact for products of cubics in t and quadratics in u over each trapezoid.
struct AreaPoint {
  Vec2 point;
  double weight = 0;    ///< area; negative inside openings, which are taken off
  double fraction = 0;  ///< of the way across its slab, between the two cuts
};

/// The part of the panel between two neighbouring cuts.
struct Slab {
  double from = 0, to = 0;             ///< t
  std::array<std::size_t, 2> edges{};  ///< of the outline that bound it, lower u first
  std::vector<AreaPoint> points;
};

/// `cuts`: values of t where to cut beside the corners.
[[nodiscard]] std::vector<Slab> cut_into_slabs(const PanelOutline& outline, const StripAxes& axes,
                                               std::vector<double> cuts = {});

/// Gathers area points on one stretch of an edge into a linear share with the same total and first moment.
class ShareCollector {
 public:
  ShareCollector(double from, double to) : from_(from), length_(to - from) {}
  /// `fraction`: of the way from `from` to `to`.
  void add(double fraction, double area) {
    total_ += area;
    moment_ += area * fraction;
  }
  [[nodiscard]] TributaryStrip share() const {
    TributaryStrip result{from_, from_ + length_, 4 * total_ - 6 * moment_, 6 * moment_ - 2 * total_};
    result.first /= length_;
    result.last /= length_;
    if (length_ < 0) result = {result.to, result.from, -result.last, -result.first};
    return result;
  }
  [[nodiscard]] bool empty() const { return total_ == 0 && moment_ == 0; }

 private:
  double from_, length_, total_ = 0, moment_ = 0;
};

}  // namespace topple::structure
