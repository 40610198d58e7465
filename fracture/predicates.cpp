#include "predicates.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace topple::fracture {

namespace {

constexpr double kRoundoff = 0x1p-53;

/// A sum of doubles kept without any error, as components that do not overlap (Shewchuk's grow-expansion).
class ExactSum {
 public:
  void add(double value) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < size_; ++i) {
      const double sum = value + parts_[i], back = sum - value;
      const double error = (value - (sum - back)) + (parts_[i] - back);
      if (error != 0) parts_[kept++] = error;
      value = sum;
    }
    if (value != 0) parts_[kept++] = value;
    size_ = kept;
  }
  void add_product(double a, double b) {
    const double product = a * b;
    add(std::fma(a, b, -product));
    add(product);
  }
  /// The largest component, whose sign is that of the sum.
  [[nodiscard]] double leading() const { return size_ == 0 ? 0 : parts_[size_ - 1]; }

 private:
  std::array<double, 12> parts_{};
  std::size_t size_ = 0;
};

double exact_orientation(const Vec2& a, const Vec2& b, const Vec2& c) {
  ExactSum sum;
  sum.add_product(a.x(), b.y());
  sum.add_product(-a.x(), c.y());
  sum.add_product(-c.x(), b.y());
  sum.add_product(-a.y(), b.x());
  sum.add_product(a.y(), c.x());
  sum.add_product(c.y(), b.x());
  return sum.leading();
}

}  // namespace

double orientation(const Vec2& a, const Vec2& b, const Vec2& c) {
  const double left = (a.x() - c.x()) * (b.y() - c.y()), right = (a.y() - c.y()) * (b.x() - c.x());
  const double value = left - right;
  constexpr double bound = (3 + 16 * kRoundoff) * kRoundoff;
  if (std::abs(value) > bound * (std::abs(left) + std::abs(right))) return value;
  return exact_orientation(a, b, c);
}

bool certainly_in_circle(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  const Vec2 p = a - d, q = b - d, r = c - d;
  const double qr = q.x() * r.y(), rq = r.x() * q.y(), rp = r.x() * p.y(), pr = p.x() * r.y();
  const double pq = p.x() * q.y(), qp = q.x() * p.y();
  const double lift_p = p.squaredNorm(), lift_q = q.squaredNorm(), lift_r = r.squaredNorm();
  const double value = lift_p * (qr - rq) + lift_q * (rp - pr) + lift_r * (pq - qp);
  const double magnitude = lift_p * (std::abs(qr) + std::abs(rq)) + lift_q * (std::abs(rp) + std::abs(pr)) +
                           lift_r * (std::abs(pq) + std::abs(qp));
  constexpr double bound = (10 + 96 * kRoundoff) * kRoundoff;
  return value > bound * magnitude;
}

double distance_to_segment(const Vec2& point, const Vec2& a, const Vec2& b) {
  const Vec2 along = b - a;
  const double length2 = along.squaredNorm();
  const double share = length2 > 0 ? std::clamp((point - a).dot(along) / length2, 0.0, 1.0) : 0.0;
  return (point - a - share * along).norm();
}

}  // namespace topple::fracture
