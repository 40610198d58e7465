#pragma once
// Chords of polygons: where lines of one direction cross them, as linear functions between the lines through vertices.
#include <vector>

#include "topple/structure/building.h"

namespace topple::structure {

/// One crossing of a polygon's border over an interval: its place at the interval's two ends.
struct Crossing {
  double at_start = 0, at_end = 0;
};

/// Crossings of the polygon by the lines x = const over the interval [start, end], which holds no vertex inside, in
/// ascending order: the first and second bound a chord, the third and fourth the next one.
[[nodiscard]] std::vector<Crossing> crossings(const std::vector<Vec2>& polygon, double start, double end);

/// The distinct abscissae of all vertices within [low, high], both of which are included, in ascending order. Closer
/// ones than `tolerance` count as one.
[[nodiscard]] std::vector<double> abscissae(const std::vector<std::vector<Vec2>>& polygons, double low, double high,
                                            double tolerance);

}  // namespace topple::structure
