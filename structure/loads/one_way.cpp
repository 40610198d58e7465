#include <cmath>

#include "chords.h"
#include "panel_plane.h"

namespace topple::structure {

namespace {

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

/// The panel as strips: x(s, t) = (1 - t) a(s) + t b(s), s along edge A from its first node, t across to edge B.
struct Strips {
  Vec2 a0, a1, b0, b1;  ///< ends of A and of B at s = 0 and 1

  [[nodiscard]] Vec2 along_a() const { return a1 - a0; }
  [[nodiscard]] Vec2 along_b() const { return b1 - b0; }
  [[nodiscard]] Vec2 across(double s) const { return (b0 - a0) + s * (along_b() - along_a()); }
  /// Area per ds dt at t = 0 and t = 1; linear between.
  [[nodiscard]] double area_at_a(double s) const { return cross(along_a(), across(s)); }
  [[nodiscard]] double area_at_b(double s) const { return cross(along_b(), across(s)); }
  [[nodiscard]] bool affine() const {
    return (along_a() - along_b()).norm() <= 1e-12 * (along_a().norm() + along_b().norm());
  }
};

/// Linear distribution over [start, end] with a given total and first moment about its middle.
struct Linear {
  double first, last;
};
Linear matched(double total, double moment, double width) {
  return {total / width - 6 * moment / (width * width), total / width + 6 * moment / (width * width)};
}

class OneWay {
 public:
  OneWay(const PanelPlane& plane, int first_edge, const Vec3& traction, EdgeForces& out)
      : plane_(plane), edge_a_(first_edge), edge_b_(first_edge + 2), traction_(traction), out_(out) {
    const auto e = static_cast<std::size_t>(first_edge);
    strips_ = {plane.corner[e], plane.corner[e + 1], plane.corner[(e + 3) % 4], plane.corner[e + 2]};
    length_a_ = strips_.along_a().norm();
    length_b_ = strips_.along_b().norm();
  }

  void distribute() {
    if (plane_.openings.empty() || !strips_.affine()) {
      whole();
      for (const auto& opening : plane_.openings) take_out(opening);
    } else {
      between_vertices();
    }
  }

 private:
  /// Shares per ds are linear in s: the integrals of (1 - t) and t over an area that is linear in t.
  void whole() {
    const auto share_a = [&](double s) { return strips_.area_at_a(s) / 3 + strips_.area_at_b(s) / 6; };
    const auto share_b = [&](double s) { return strips_.area_at_a(s) / 6 + strips_.area_at_b(s) / 3; };
    add(edge_a_, 0, 1, {share_a(0), share_a(1)});
    add(edge_b_, 0, 1, {share_b(0), share_b(1)});
  }

  /// A parallelogram with openings: between the openings' vertices the shares are quadratic in s at most; the linear
  /// distribution with the same force and moment stands for each stretch.
  void between_vertices() {
    std::vector<std::vector<Vec2>> openings;
    for (const auto& opening : plane_.openings) {
      openings.emplace_back();
      for (const Vec2& vertex : opening) openings.back().push_back(share_of(vertex));
    }
    const double area = strips_.area_at_a(0);
    const std::vector<double> at = abscissae(openings, 0, 1, 1e-12);
    for (std::size_t k = 0; k + 1 < at.size(); ++k) {
      const double width = at[k + 1] - at[k];
      double total_a = 0, moment_a = 0, total_b = 0, moment_b = 0;
      for (const double gauss : {-1 / std::sqrt(3.0), 1 / std::sqrt(3.0)}) {  // exact for cubics
        const double place = (1 + gauss) / 2;
        double open_a = 0, open_b = 0;
        for (const auto& opening : openings) {
          const std::vector<Crossing> c = crossings(opening, at[k], at[k + 1]);
          for (std::size_t i = 0; i + 1 < c.size(); i += 2) {
            const double low = c[i].at_start + place * (c[i].at_end - c[i].at_start);
            const double high = c[i + 1].at_start + place * (c[i + 1].at_end - c[i + 1].at_start);
            open_a += (high - low) - (high * high - low * low) / 2;
            open_b += (high * high - low * low) / 2;
          }
        }
        const double weight = width / 2, arm = width * gauss / 2;
        total_a += weight * area * (0.5 - open_a);
        total_b += weight * area * (0.5 - open_b);
        moment_a += weight * area * (0.5 - open_a) * arm;
        moment_b += weight * area * (0.5 - open_b) * arm;
      }
      add(edge_a_, at[k], at[k + 1], matched(total_a, moment_a, width));
      add(edge_b_, at[k], at[k + 1], matched(total_b, moment_b, width));
    }
  }

  /// Another quadrilateral: the missing part's resultant is taken off by the lever rule on the strip through its
  /// centroid.
  void take_out(const std::vector<Vec2>& opening) {
    double area = 0;
    Vec2 first = Vec2::Zero();
    for (std::size_t i = 0; i < opening.size(); ++i) {
      const Vec2 &p = opening[i], &q = opening[(i + 1) % opening.size()];
      area += cross(p, q) / 2;
      first += cross(p, q) * (p + q) / 6;
    }
    if (area == 0) return;
    const Vec2 share = share_of(first / area);
    const Vec3 force = -std::abs(area) * traction_;
    point(edge_a_, share.x(), (1 - share.y()) * force);
    point(edge_b_, share.x(), share.y() * force);
  }

  /// (s, t) of a point: Newton's method, one step where the panel is a parallelogram.
  [[nodiscard]] Vec2 share_of(const Vec2& point) const {
    Vec2 share(0.5, 0.5);
    for (int k = 0; k < 50; ++k) {
      const Vec2 a = strips_.a0 + share.x() * strips_.along_a(), across = strips_.across(share.x());
      const Vec2 away = point - (a + share.y() * across);
      const Vec2 along = (1 - share.y()) * strips_.along_a() + share.y() * strips_.along_b();
      const double det = cross(along, across);
      const Vec2 step(cross(away, across) / det, cross(along, away) / det);
      share += step;
      if (step.norm() < 1e-15) break;
    }
    return share;
  }

  /// Shares are counted along A; edge B runs the other way round.
  void add(int edge, double start, double end, const Linear& per_share) {
    const bool b = edge == edge_b_;
    const double length = b ? length_b_ : length_a_;
    EdgeForce force;
    force.edge = edge;
    force.from = (b ? 1 - end : start) * length;
    force.to = (b ? 1 - start : end) * length;
    force.first = traction_ * ((b ? per_share.last : per_share.first) / length);
    force.last = traction_ * ((b ? per_share.first : per_share.last) / length);
    out_.push_back(force);
  }
  void point(int edge, double share, const Vec3& value) {
    const bool b = edge == edge_b_;
    const double at = (b ? 1 - share : share) * (b ? length_b_ : length_a_);
    out_.push_back({edge, at, at, value, value});
  }

  const PanelPlane& plane_;
  int edge_a_, edge_b_;
  Vec3 traction_;
  EdgeForces& out_;
  Strips strips_;
  double length_a_ = 0, length_b_ = 0;
};

}  // namespace

void one_way(const PanelPlane& plane, int first_edge, const Vec3& traction, EdgeForces& out) {
  OneWay(plane, first_edge, traction, out).distribute();
}

}  // namespace topple::structure
