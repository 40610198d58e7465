#include "topple/solver/shell_resultants.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include "elements/shell.h"

namespace topple::solver {
namespace {

/// Components of a symmetric tensor (xx, yy, xy) in axes turned by an angle.
Vec3 turned(const Vec3& t, double cosine, double sine) {
  const double c2 = cosine * cosine, s2 = sine * sine, cs = cosine * sine;
  return {c2 * t(0) + s2 * t(1) + 2 * cs * t(2), s2 * t(0) + c2 * t(1) - 2 * cs * t(2),
          cs * (t(1) - t(0)) + (c2 - s2) * t(2)};
}

}  // namespace

ShellResultants shell_resultants(const FrameModel& model, int index, const std::vector<Vec6>& displacements,
                                 double strain, const Eigen::Vector2d& at) {
  if (index < 0 || static_cast<std::size_t>(index) >= model.shells.size()) {
    throw std::invalid_argument("shell " + std::to_string(index) + " does not exist");
  }
  const Shell& shell = model.shells[static_cast<std::size_t>(index)];
  const std::array<Vec3, 4> places = corner_places(shell, model.nodes);
  const ShellElement element(shell, places);
  Vec24 u;
  for (int n = 0; n < 4; ++n) {
    u.segment<6>(6 * n) = displacements[static_cast<std::size_t>(shell.node[static_cast<std::size_t>(n)])];
  }
  const Eigen::Matrix<double, 8, 1> r = element.resultants(u, strain, at);
  const Vec3 edge = element.axes() * (places[1] - places[0]);
  const double length = std::hypot(edge.x(), edge.y()), c = edge.x() / length, s = edge.y() / length;
  ShellResultants result;
  result.membrane = turned(r.head<3>(), c, s);
  result.moments = turned(r.segment<3>(3), c, s);
  result.shears << c * r(6) + s * r(7), c * r(7) - s * r(6);
  return result;
}

}  // namespace topple::solver
