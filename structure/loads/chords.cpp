#include "chords.h"

#include <algorithm>

namespace topple::structure {

std::vector<Crossing> crossings(const std::vector<Vec2>& polygon, double start, double end) {
  const double middle = (start + end) / 2;
  std::vector<Crossing> found;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2& a = polygon[i];
    const Vec2& b = polygon[(i + 1) % polygon.size()];
    if ((a.x() <= middle) == (b.x() <= middle)) continue;
    const double slope = (b.y() - a.y()) / (b.x() - a.x());
    found.push_back({a.y() + slope * (start - a.x()), a.y() + slope * (end - a.x())});
  }
  std::sort(found.begin(), found.end(),
            [](const Crossing& p, const Crossing& q) { return p.at_start + p.at_end < q.at_start + q.at_end; });
  return found;
}

std::vector<double> abscissae(const std::vector<std::vector<Vec2>>& polygons, double low, double high,
                              double tolerance) {
  std::vector<double> all{low, high};
  for (const auto& polygon : polygons)
    for (const Vec2& vertex : polygon)
      if (vertex.x() > low && vertex.x() < high) all.push_back(vertex.x());
  std::sort(all.begin(), all.end());
  std::vector<double> distinct{low};
  for (const double x : all)
    if (x > distinct.back() + tolerance) distinct.push_back(x);
  if (distinct.back() > high - tolerance && distinct.size() > 1) distinct.pop_back();
  distinct.push_back(high);
  return distinct;
}

}  // namespace topple::structure
