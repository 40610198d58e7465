#pragma once
// Small frames for the tests of this folder. Every section has Iy, Iz, J and both shear areas different, so that a
// swapped axis cannot hide.
#include <Eigen/Geometry>
#include <cmath>

#include "topple/solver/static_analysis.h"

namespace topple::test {

using namespace topple::solver;

inline constexpr double pi = 3.14159265358979323846;

/// A beam between two nodes of the model with the default axes of the format: up is z, or x for vertical members.
inline Beam make_beam(const FrameModel& model, int first, int second) {
  Beam beam;
  beam.node = {first, second};
  const Vec3 along = model.nodes[static_cast<std::size_t>(second)] - model.nodes[static_cast<std::size_t>(first)];
  beam.length = along.norm();
  const Vec3 x = along / beam.length;
  const Vec3 up = std::hypot(x.x(), x.y()) < 1e-6 ? Vec3(Vec3::UnitX()) : Vec3(Vec3::UnitZ());
  const Vec3 y = up.cross(x).normalized();
  beam.axes << x.transpose(), y.transpose(), x.cross(y).transpose();
  beam.youngs_modulus = 210e9;
  beam.shear_modulus = 80e9;
  beam.area = 8.5e-3;
  beam.Iy = 1.6e-4;
  beam.Iz = 1.2e-5;
  beam.J = 4e-7;
  beam.shear_area_y = 5.1e-3;
  beam.shear_area_z = 2.9e-3;
  return beam;
}

inline void add_beam(FrameModel& model, int first, int second) {
  model.beams.push_back(make_beam(model, first, second));
}

inline Vec6 fixed() { return Vec6::Constant(rigid); }
inline Vec6 components(double x, double y, double z, double rx, double ry, double rz) {
  Vec6 v;
  v << x, y, z, rx, ry, rz;
  return v;
}
inline Vec6 unit(int component, double value = 1) {
  Vec6 v = Vec6::Zero();
  v(component) = value;
  return v;
}

/// One beam along global x between two nodes, local axes those of the globe: y = y, z = z.
inline FrameModel single_beam(double length, const Vec6& first_support, const Vec6& second_support) {
  FrameModel model;
  model.nodes = {Vec3(0, 0, 0), Vec3(length, 0, 0)};
  add_beam(model, 0, 1);
  model.supports = {{0, first_support}, {1, second_support}};
  return model;
}

inline StaticSolution solve_one(const FrameModel& model, const LoadSet& loads) {
  StaticAnalysis analysis(model);
  return analysis.solve(std::span(&loads, 1)).front();
}

inline BeamLoad uniform_load(int beam, double length, const Vec6& intensity) {
  BeamLoad load;
  load.beam = beam;
  load.to = length;
  load.first = load.last = intensity;
  return load;
}

inline BeamLoad point_load(int beam, double at, const Vec6& value) {
  BeamLoad load;
  load.beam = beam;
  load.kind = BeamLoad::Kind::point;
  load.from = at;
  load.first = value;
  return load;
}

/// The model turned as a whole; supports and loads must be turned by the caller's own means (fixed ones need not).
inline FrameModel rotated(FrameModel model, const Mat3& R) {
  for (Vec3& node : model.nodes) node = R * node;
  for (Beam& beam : model.beams) {
    beam.axes = beam.axes * R.transpose();
    for (Vec3& offset : beam.offset) offset = R * offset;
  }
  return model;
}
inline Vec6 rotated(const Vec6& v, const Mat3& R) {
  Vec6 result;
  result << R * v.head<3>(), R * v.tail<3>();
  return result;
}

/// A frame of several storeys with fixed feet: `posts` x `posts` in plan, rigid joints.
inline FrameModel tower(int posts, int storeys, double bay = 6, double height = 3.5) {
  FrameModel model;
  const auto node = [&](int i, int j, int k) { return (k * posts + j) * posts + i; };
  for (int k = 0; k <= storeys; ++k) {
    for (int j = 0; j < posts; ++j) {
      for (int i = 0; i < posts; ++i) model.nodes.emplace_back(bay * i, bay * j, height * k);
    }
  }
  for (int k = 0; k < storeys; ++k) {
    for (int j = 0; j < posts; ++j) {
      for (int i = 0; i < posts; ++i) {
        add_beam(model, node(i, j, k), node(i, j, k + 1));
        if (i + 1 < posts) add_beam(model, node(i, j, k + 1), node(i + 1, j, k + 1));
        if (j + 1 < posts) add_beam(model, node(i, j, k + 1), node(i, j + 1, k + 1));
      }
    }
  }
  for (int n = 0; n < posts * posts; ++n) model.supports.push_back({n, fixed()});
  return model;
}

/// Sum of the loads and reactions about the origin over the sum of their sizes.
struct Balance {
  Vec6 sum = Vec6::Zero();
  double force = 0, moment = 0;
  void add(const Vec3& place, const Vec6& action) {
    const Vec3 moment_here = action.tail<3>() + place.cross(action.head<3>());
    sum.head<3>() += action.head<3>();
    sum.tail<3>() += moment_here;
    force += action.head<3>().cwiseAbs().sum();
    moment += moment_here.cwiseAbs().sum();
  }
  [[nodiscard]] double error() const {
    return std::max(sum.head<3>().cwiseAbs().maxCoeff() / force, sum.tail<3>().cwiseAbs().maxCoeff() / moment);
  }
};

}  // namespace topple::test
