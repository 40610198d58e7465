#include "elements/second_order_beam.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "elements/beam_internal_forces.h"

namespace topple::solver {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

ColumnPlane plane_of(const Beam& beam, double factor, const InternalForces& forces, bool xz) {
  ColumnPlane plane;
  plane.bending_stiffness = factor * beam.youngs_modulus * (xz ? beam.Iy : beam.Iz);
  plane.shear_compliance = inverse_or_zero(factor * beam.shear_modulus * (xz ? beam.shear_area_z : beam.shear_area_y));
  plane.free_curvature = xz ? -forces.free_curvature_y : forces.free_curvature_z;
  return plane;
}

/// How long a piece is, measured by the longest segment on which transfer matrices are well conditioned.
double segments_long(const BeamPiece& piece, double bending_stiffness) {
  const std::array<double, 4>& axial = piece.force[0];
  double most_axial = std::max(std::abs(axial[0]), std::abs(polynomial(axial, piece.length)));
  if (const double turn = -axial[1] / (2 * axial[2]); turn > 0 && turn < piece.length)
    most_axial = std::max(most_axial, std::abs(polynomial(axial, turn)));
  constexpr double longest = 1.5;  // of L sqrt(N/EI): far below 2 pi, where a held segment would buckle
  return piece.length * std::sqrt(most_axial / bending_stiffness) / longest;
}

/// Where a beam is cut into segments: all as long as each other in that measure, so that none is a small rest.
class SegmentCuts {
 public:
  SegmentCuts(const std::vector<BeamPiece>& pieces, double bending_stiffness) {
    for (const BeamPiece& piece : pieces) whole_ += segments_long(piece, bending_stiffness);
    constexpr double most = 4096;
    count_ = static_cast<int>(std::clamp(std::ceil(whole_), 1.0, most));
  }
  /// The next cut within a piece so long, as a share of it; nothing when the piece ends first. One at its end is left
  /// to the piece behind.
  std::optional<double> next(double piece) {
    constexpr double end = 1 - 1e-9;
    const double share = (whole_ * cuts_ / count_ - passed_) / piece;
    if (cuts_ >= count_ || !(share < end)) return std::nullopt;
    ++cuts_;
    return std::max(share, 0.0);
  }
  void pass(double piece) { passed_ += piece; }

 private:
  double whole_ = 0, passed_ = 0;
  int count_ = 1, cuts_ = 1;
};

/// The axial force, of degree 2 at most, in powers of the distance from a place further on.
std::array<double, 3> from_place(const std::array<double, 4>& axial, double at) {
  return {polynomial(axial, at), axial[1] + 2 * at * axial[2], axial[2]};
}

/// Point forces and moments at a place, in one plane.
Eigen::Vector2d point_loads_at(double place, const Beam& beam, std::span<const BeamLoad> loads, bool xz) {
  Eigen::Vector2d sum(0, 0);
  for (const BeamLoad& load : loads)
    if (load.kind == BeamLoad::Kind::point && std::clamp(load.from, 0.0, beam.length) == place)
      sum += Eigen::Vector2d(load.first(xz ? 2 : 1), xz ? -load.first(4) : load.first(5));
  return sum;
}

/// From `from` to `to` of a piece, as shares of its length.
ColumnStretch stretch_of(const BeamPiece& piece, double from, double to, const Beam& beam,
                         std::span<const BeamLoad> loads, bool xz) {
  const int v = xz ? 2 : 1, r = xz ? 4 : 5;
  const double sign = xz ? -1 : 1;
  ColumnStretch s;
  s.start = piece.start + piece.length * from;
  s.length = piece.length * (to - from);
  s.axial = from_place(piece.force[0], piece.length * from);
  if (from == 0) {
    const Eigen::Vector2d point = point_loads_at(piece.start, beam, loads, xz);
    s.point_force = point(0);
    s.point_moment = point(1);
  }
  for (const BeamLoad& load : loads) {
    if (load.kind != BeamLoad::Kind::distributed) continue;
    const double begin = std::clamp(load.from, 0.0, beam.length), end = std::clamp(load.to, 0.0, beam.length);
    if (const double middle = piece.start + piece.length / 2; !(begin < middle && end > middle)) continue;
    const Vec6 slope = (load.last - load.first) / (end - begin), here = load.first + slope * (s.start - begin);
    s.force += here(v);
    s.force_slope += slope(v);
    s.moment += sign * here(r);
    s.moment_slope += sign * slope(r);
  }
  return s;
}

std::vector<ColumnStretch> stretches_of(const Beam& beam, double factor, const InternalForces& forces,
                                        std::span<const BeamLoad> loads, bool xz) {
  const double EI = factor * beam.youngs_modulus * (xz ? beam.Iy : beam.Iz);
  std::vector<ColumnStretch> stretches;
  SegmentCuts cuts(forces.pieces, EI);
  bool cut = false;
  for (const BeamPiece& piece : forces.pieces) {
    const double length = segments_long(piece, EI);
    double from = 0;
    const auto add_up_to = [&](double to) {
      stretches.push_back(stretch_of(piece, from, to, beam, loads, xz));
      stretches.back().begins_segment = std::exchange(cut, false);
      from = to;
    };
    while (const std::optional<double> at = cuts.next(length)) {
      if (*at > from) add_up_to(*at);
      cut = true;
    }
    add_up_to(1);
    cuts.pass(length);
  }
  return stretches;
}

std::array<double, 4> springs_of(const Beam& beam, bool xz) {
  std::array<double, 4> result{};
  for (std::size_t k = 0; k < 4; ++k) {
    const int f = (xz ? xz_plane : xy_plane)[k];
    result[k] = beam.end_stiffness[static_cast<std::size_t>(f / 6)](f % 6);
  }
  return result;
}

BeamColumn make_column(const Beam& beam, double factor, const InternalForces& forces, std::span<const BeamLoad> loads,
                       bool xz) {
  return {plane_of(beam, factor, forces, xz), stretches_of(beam, factor, forces, loads, xz), springs_of(beam, xz),
          point_loads_at(beam.length, beam, loads, xz)};
}

/// A cubic beam takes its loads by the first-order formulas: its column carries neither load nor axial force.
InternalForces bare(const Beam& beam) { return internal_forces(beam.length, Vec6::Zero(), {}); }

InternalForces profile(const Beam& beam, SecondOrder mode, double first_axial, std::span<const BeamLoad> loads) {
  if (mode != SecondOrder::exact) return bare(beam);
  Vec6 first = Vec6::Zero();
  first(0) = -first_axial;
  return internal_forces(beam.length, first, loads);
}

/// Consistent geometric stiffness of the Timoshenko beam's cubic shapes for a unit axial force; freedoms v1, r1, v2,
/// r2. Przemieniecki, ch. 15, with the shear parameter phi = 12 EI/(G As L2).
Eigen::Matrix4d cubic_geometric_stiffness(double L, double phi) {
  const double d = (1 + phi) * (1 + phi);
  const double a = (1.2 + 2 * phi + phi * phi) / d / L, b = 0.1 / d;
  const double c = L * (2.0 / 15 + phi / 6 + phi * phi / 12) / d, e = -L * (1.0 / 30 + phi / 6 + phi * phi / 12) / d;
  Eigen::Matrix4d K;
  K << a, b, -a, b, b, c, -b, e, -a, -b, a, -b, b, e, -b, c;
  return K;
}

/// Springs at the ends of a plane's stiffness and fixed-end forces, condensed.
void condense_springs(const std::array<double, 4>& springs, Eigen::Matrix4d& K, Eigen::Vector4d& fixed) {
  const Eigen::Vector4d diagonal = K.diagonal().cwiseAbs();
  for (int f = 0; f < 4; ++f) {
    const double k = springs[static_cast<std::size_t>(f)];
    if (std::isinf(k)) continue;
    constexpr double rounding = 1e-13;
    const double pivot = K(f, f) + k, inverse = std::abs(pivot) <= rounding * diagonal(f) ? 0 : 1 / pivot;
    const Eigen::Vector4d row = K.row(f).transpose();
    const double own = fixed(f);
    K -= row * row.transpose() * inverse;
    fixed -= row * (own * inverse);
    Eigen::Vector4d through = row * (k * inverse);
    through(f) = k - k * k * inverse;
    K.row(f) = through.transpose();
    K.col(f) = through;
    fixed(f) = k * inverse * own;
  }
}

}  // namespace

Eigen::Vector4d plane_part(const Vec12& all, bool xz) {
  Eigen::Vector4d part;
  for (std::size_t k = 0; k < 4; ++k) part(static_cast<Eigen::Index>(k)) = all((xz ? xz_plane : xy_plane)[k]);
  if (xz) {
    part(1) = -part(1);
    part(3) = -part(3);
  }
  return part;
}

SecondOrderBeam::SecondOrderBeam(const Beam& beam, double factor, SecondOrder mode, double first_axial,
                                 std::span<const BeamLoad> loads, double ends_apart)
    : in_xy_(make_column(beam, factor, profile(beam, mode, first_axial, loads),
                         mode == SecondOrder::exact ? loads : std::span<const BeamLoad>{}, false)),
      in_xz_(make_column(beam, factor, profile(beam, mode, first_axial, loads),
                         mode == SecondOrder::exact ? loads : std::span<const BeamLoad>{}, true)) {
  const CondensedBeam linear(beam, factor);
  stiffness_ = linear.stiffness();
  fixed_ = linear.fixed_end_forces(loads);
  if (linear.absent()) return;
  if (mode == SecondOrder::frame3dd) {
    make_cubic(beam, factor, first_axial, ends_apart > 0 ? ends_apart : beam.length);
    return;
  }
  if (mode == SecondOrder::cubic) {
    Vec6 first = Vec6::Zero();
    first(0) = -first_axial;
    const BeamPiece last = internal_forces(beam.length, first, loads).pieces.back();
    make_cubic(beam, factor, 0.5 * (first_axial + polynomial(last.force[0], last.length)), beam.length);
    return;
  }
  for (const bool xz : {false, true}) {
    const BeamColumn& column = xz ? in_xz_ : in_xy_;
    const auto& freedoms = xz ? xz_plane : xy_plane;
    const Eigen::Vector4d sign(1, xz ? -1 : 1, 1, xz ? -1 : 1);
    for (std::size_t i = 0; i < 4; ++i) {
      const auto ii = static_cast<Eigen::Index>(i);
      fixed_.force(freedoms[i]) = sign(ii) * column.fixed_end_forces()(ii);
      for (std::size_t j = 0; j < 4; ++j) {
        const auto jj = static_cast<Eigen::Index>(j);
        stiffness_(freedoms[i], freedoms[j]) = sign(ii) * column.stiffness()(ii, jj) * sign(jj);
      }
    }
  }
}

bool far_from_buckling_inside(const Beam& beam, double axial, std::span<const BeamLoad> loads) {
  for (const Vec6& end : beam.end_stiffness)
    if (!(end.array() == rigid).all()) return false;
  double pressed = -axial;
  for (const BeamLoad& load : loads) {
    if (load.kind == BeamLoad::Kind::point) pressed += std::abs(load.first(0));
    if (load.kind == BeamLoad::Kind::distributed)
      pressed += std::max(std::abs(load.first(0)), std::abs(load.last(0))) * (load.to - load.from);
  }
  constexpr double pi = 3.14159265358979323846, far_below = 0.9;
  for (const auto& [I, area] : {std::pair(beam.Iy, beam.shear_area_z), std::pair(beam.Iz, beam.shear_area_y)}) {
    const double euler = 4 * pi * pi * beam.youngs_modulus * I / (beam.length * beam.length);
    const double critical = area > 0 ? euler / (1 + euler / (beam.shear_modulus * area)) : euler;
    if (pressed > far_below * critical) return false;
  }
  return true;
}

Vec12 frame3dd_end_forces(const Beam& beam, const Vec12& rigid_ends, const Vec12& fixed_end, double ends_apart) {
  const double strain = (rigid_ends(6) - rigid_ends(0)) / beam.length;
  const CondensedBeam linear(beam, 1);
  const SecondOrderBeam displaced(beam, 1, SecondOrder::frame3dd, beam.youngs_modulus * beam.area * strain, {},
                                  ends_apart);
  const Vec12 first_order = beam_end_forces(linear, beam.length, rigid_ends, fixed_end);
  Vec12 moved = rigid_ends;
  for (const int end : {0, 6}) moved.segment<3>(end) -= rigid_ends.head<3>();
  Vec12 geometric = (displaced.stiffness() - linear.stiffness()) * moved;
  geometric(3) = geometric(9) = 0;
  return first_order + geometric;
}

void SecondOrderBeam::make_cubic(const Beam& beam, double factor, double axial, double geometric_length) {
  Beam rigid_ends = beam;
  for (Vec6& end : rigid_ends.end_stiffness) end.setConstant(infinite);
  const Mat12 own = CondensedBeam(rigid_ends, factor).stiffness();
  for (const bool xz : {false, true}) {
    const auto& freedoms = xz ? xz_plane : xy_plane;
    const double EI = factor * beam.youngs_modulus * (xz ? beam.Iy : beam.Iz), L = beam.length;
    const double phi =
        12 * EI / (L * L) * inverse_or_zero(factor * beam.shear_modulus * (xz ? beam.shear_area_z : beam.shear_area_y));
    Eigen::Matrix4d K = axial * cubic_geometric_stiffness(geometric_length, phi);
    const double sign = xz ? -1 : 1;
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < 4; ++j) {
        const auto ii = static_cast<Eigen::Index>(i), jj = static_cast<Eigen::Index>(j);
        if (i % 2 != j % 2) K(ii, jj) *= sign;
        K(ii, jj) += own(freedoms[i], freedoms[j]);
      }
    Eigen::Vector4d no_load = Eigen::Vector4d::Zero();
    condense_springs(springs_of(beam, xz), K, no_load);
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < 4; ++j)
        stiffness_(freedoms[i], freedoms[j]) = K(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
  }
  const double G = factor * beam.shear_modulus + axial / beam.area * (beam.length / geometric_length);
  const AxialEnds torsion(beam.length / (G * beam.J), {beam.end_stiffness[0](3), beam.end_stiffness[1](3)});
  stiffness_(3, 3) = stiffness_(9, 9) = torsion.stiffness();
  stiffness_(3, 9) = stiffness_(9, 3) = -torsion.stiffness();
}

}  // namespace topple::solver
