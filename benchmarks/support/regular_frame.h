#pragma once
// The regular steel frame that other programs were measured on: bay 6 m, storey 3.5 m, fixed base, box columns 0.3 x
// 0.3 x 0.015 m, no shear deformation; self weight and 5 kN/m2 shared out as line loads on the beams.
#include <Eigen/Geometry>

#include "topple/solver/frame_model.h"

namespace topple::bench {

struct RegularFrame {
  solver::FrameModel model;
  solver::LoadSet loads;
  int posts_x = 0, posts_y = 0, storeys = 0;
};

namespace detail {

inline solver::Beam steel_member(const solver::FrameModel& model, int first, int second) {
  using solver::Vec3;
  solver::Beam beam;
  beam.node = {first, second};
  const Vec3 along = model.nodes[static_cast<std::size_t>(second)] - model.nodes[static_cast<std::size_t>(first)];
  beam.length = along.norm();
  const Vec3 x = along / beam.length;
  const bool upright = x.head<2>().norm() < 1e-9;
  const Vec3 y = (upright ? Vec3(Vec3::UnitX()) : Vec3(Vec3::UnitZ())).cross(x).normalized();
  beam.axes << x.transpose(), y.transpose(), x.cross(y).transpose();
  beam.youngs_modulus = 210e9;
  beam.shear_modulus = 210e9 / 2.6;
  beam.density = 7850;
  if (upright) {
    constexpr double outer = 0.3, wall = 0.015, inner = outer - 2 * wall, centre = outer - wall;
    beam.area = outer * outer - inner * inner;
    beam.Iy = beam.Iz = (outer * outer * outer * outer - inner * inner * inner * inner) / 12;
    beam.J = centre * centre * centre * wall;  // Bredt
  } else {
    beam.area = 8.5e-3;
    beam.Iy = 1.6e-4;
    beam.Iz = 1.2e-5;
    beam.J = 4e-7;
  }
  return beam;
}

inline void add_weight(RegularFrame& frame, int beam, double floor_load) {
  using solver::Vec3;
  const solver::Beam& b = frame.model.beams[static_cast<std::size_t>(beam)];
  const Vec3 down = b.axes * Vec3(0, 0, -(9.81 * b.density * b.area + floor_load));
  solver::BeamLoad load;
  load.beam = beam;
  load.to = b.length;
  load.first.head<3>() = load.last.head<3>() = down;
  frame.loads.beams.push_back(load);
}

}  // namespace detail

/// Node (i, j, k): i along x, j along y, k the storey, 0 the ground; beams of a storey in the order posts, x, y.
inline RegularFrame regular_frame(int posts_x, int posts_y, int storeys) {
  constexpr double bay = 6, height = 3.5, floor = 5000;
  RegularFrame frame;
  frame.posts_x = posts_x, frame.posts_y = posts_y, frame.storeys = storeys;
  solver::FrameModel& model = frame.model;
  const auto node = [&](int i, int j, int k) { return (k * posts_y + j) * posts_x + i; };
  for (int k = 0; k <= storeys; ++k)
    for (int j = 0; j < posts_y; ++j)
      for (int i = 0; i < posts_x; ++i) model.nodes.emplace_back(bay * i, bay * j, height * k);
  const auto add = [&](int a, int b, double floor_load) {
    model.beams.push_back(detail::steel_member(model, a, b));
    detail::add_weight(frame, static_cast<int>(model.beams.size()) - 1, floor_load);
  };
  // Half of each bay's load goes to the beams along x, half to those along y; an outer beam has one bay beside it.
  const auto share = [&](int line, int lines) {
    return floor * bay / 2 * (line == 0 || line == lines - 1 ? 0.5 : 1.0);
  };
  for (int k = 0; k < storeys; ++k) {
    for (int j = 0; j < posts_y; ++j)
      for (int i = 0; i < posts_x; ++i) add(node(i, j, k), node(i, j, k + 1), 0);
    for (int j = 0; j < posts_y; ++j)
      for (int i = 0; i + 1 < posts_x; ++i) add(node(i, j, k + 1), node(i + 1, j, k + 1), share(j, posts_y));
    for (int j = 0; j + 1 < posts_y; ++j)
      for (int i = 0; i < posts_x; ++i) add(node(i, j, k + 1), node(i, j + 1, k + 1), share(i, posts_x));
  }
  for (int n = 0; n < posts_x * posts_y; ++n) model.supports.push_back({n, solver::Vec6::Constant(solver::rigid)});
  return frame;
}

}  // namespace topple::bench
