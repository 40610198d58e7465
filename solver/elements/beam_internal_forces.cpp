#include "elements/beam_internal_forces.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace topple::solver {
namespace {

/// How far outside of the beam a load may lie and still be taken as rounding, relative to the length.
constexpr double placement_tolerance = 1e-9;

double position_on_beam(double distance, double length, const BeamLoad& load) {
  if (!(distance >= -placement_tolerance * length && distance <= (1 + placement_tolerance) * length)) {
    throw std::invalid_argument("load on beam " + std::to_string(load.beam) + ": distance " + std::to_string(distance) +
                                " is outside of 0 to " + std::to_string(length));
  }
  return std::clamp(distance, 0.0, length);
}

void find_breakpoints(double length, std::span<const BeamLoad> loads, std::vector<double>& places) {
  places.clear();
  places.push_back(0.0);
  const auto covers_all = [&](const BeamLoad& load) {
    return load.kind == BeamLoad::Kind::temperature ||
           (load.kind == BeamLoad::Kind::distributed && load.from == 0 && load.to == length);
  };
  if (std::all_of(loads.begin(), loads.end(), covers_all)) {
    places.push_back(length);
    return;
  }
  places.push_back(length);
  for (const BeamLoad& load : loads) {
    if (load.kind == BeamLoad::Kind::temperature) continue;
    places.push_back(position_on_beam(load.from, length, load));
    if (load.kind == BeamLoad::Kind::distributed) places.push_back(position_on_beam(load.to, length, load));
  }
  std::sort(places.begin(), places.end());
  places.erase(std::unique(places.begin(), places.end()), places.end());
}

/// Intensity and its slope at the start of a piece, summed over the distributed loads that cover it.
void intensity_on(double start, double end, double length, std::span<const BeamLoad> loads, Vec6& value, Vec6& slope) {
  value.setZero();
  slope.setZero();
  for (const BeamLoad& load : loads) {
    if (load.kind != BeamLoad::Kind::distributed) continue;
    const double from = std::clamp(load.from, 0.0, length), to = std::clamp(load.to, 0.0, length);
    if (!(from <= start && to >= end)) continue;
    value += load.first;
    if (load.first == load.last) continue;
    const Vec6 load_slope = (load.last - load.first) / (to - from);
    value += load_slope * (start - from);
    slope += load_slope;
  }
}

void add_point_loads(double place, double length, std::span<const BeamLoad> loads, Vec6& state) {
  for (const BeamLoad& load : loads) {
    if (load.kind == BeamLoad::Kind::point && std::clamp(load.from, 0.0, length) == place) state -= load.first;
  }
}

BeamPiece make_piece(double start, double length, const Vec6& state, const Vec6& a, const Vec6& b) {
  BeamPiece piece;
  piece.start = start;
  piece.length = length;
  for (int i = 0; i < 4; ++i) piece.force[static_cast<std::size_t>(i)] = {state(i), -a(i), -b(i) / 2, 0};
  piece.force[4] = {state(4), state(2) - a(4), -(a(2) + b(4)) / 2, -b(2) / 6};
  piece.force[5] = {state(5), -state(1) - a(5), (a(1) - b(5)) / 2, b(1) / 6};
  return piece;
}

}  // namespace

InternalForces internal_forces(double length, const Vec6& first_end, std::span<const BeamLoad> loads) {
  InternalForces result;
  find_internal_forces(length, first_end, loads, result);
  return result;
}

void find_internal_forces(double length, const Vec6& first_end, std::span<const BeamLoad> loads,
                          InternalForces& result) {
  result.pieces.clear();
  result.free_strain = result.free_curvature_y = result.free_curvature_z = 0;
  for (const BeamLoad& load : loads) {
    if (load.kind != BeamLoad::Kind::temperature) continue;
    result.free_strain += load.strain;
    // Hotter towards +y the section turns about -z; hotter towards +z about +y.
    result.free_curvature_z -= load.curvature_y;
    result.free_curvature_y += load.curvature_z;
  }
  std::vector<double>& places = result.places;
  find_breakpoints(length, loads, places);
  result.pieces.reserve(places.size() - 1);
  Vec6 state = -first_end, value, slope;
  add_point_loads(0.0, length, loads, state);
  for (std::size_t i = 0; i + 1 < places.size(); ++i) {
    intensity_on(places[i], places[i + 1], length, loads, value, slope);
    result.pieces.push_back(make_piece(places[i], places[i + 1] - places[i], state, value, slope));
    const BeamPiece& piece = result.pieces.back();
    for (std::size_t k = 0; k < 6; ++k) state(static_cast<Eigen::Index>(k)) = polynomial(piece.force[k], piece.length);
    add_point_loads(places[i + 1], length, loads, state);
  }
  result.second_end = state;
}

namespace {

/// Integral of a cubic over stiffness plus a constant, from `initial`.
std::array<double, 5> integrate(const std::array<double, 4>& force, double compliance, double constant,
                                double initial) {
  return {initial, force[0] * compliance + constant, force[1] * compliance / 2, force[2] * compliance / 3,
          force[3] * compliance / 4};
}

/// Integral of sign * rotation + shear * compliance.
std::array<double, 6> integrate_deflection(const std::array<double, 5>& rotation, double sign,
                                           const std::array<double, 4>& shear, double compliance, double initial) {
  std::array<double, 6> result{initial};
  for (std::size_t k = 0; k < 5; ++k) {
    const double slope = sign * rotation[k] + (k < 4 ? shear[k] * compliance : 0.0);
    result[k + 1] = slope / static_cast<double>(k + 1);
  }
  return result;
}

}  // namespace

Vec6 integrate_deformation(const Beam& beam, double factor, const InternalForces& forces,
                           std::vector<DeformedPiece>* pieces) {
  const double E = factor * beam.youngs_modulus, G = factor * beam.shear_modulus;
  const double EA = inverse_or_zero(E * beam.area), GJ = inverse_or_zero(G * beam.J);
  const double EIy = inverse_or_zero(E * beam.Iy), EIz = inverse_or_zero(E * beam.Iz);
  const double GAy = inverse_or_zero(G * beam.shear_area_y), GAz = inverse_or_zero(G * beam.shear_area_z);
  Vec6 end = Vec6::Zero();
  for (const BeamPiece& piece : forces.pieces) {
    DeformedPiece d;
    d.u = integrate(piece.force[0], EA, forces.free_strain, end(0));
    d.theta_x = integrate(piece.force[3], GJ, 0, end(3));
    d.theta_y = integrate(piece.force[4], EIy, forces.free_curvature_y, end(4));
    d.theta_z = integrate(piece.force[5], EIz, forces.free_curvature_z, end(5));
    d.v = integrate_deflection(d.theta_z, 1, piece.force[1], GAy, end(1));
    d.w = integrate_deflection(d.theta_y, -1, piece.force[2], GAz, end(2));
    const double t = piece.length;
    end << polynomial(d.u, t), polynomial(d.v, t), polynomial(d.w, t), polynomial(d.theta_x, t),
        polynomial(d.theta_y, t), polynomial(d.theta_z, t);
    if (pieces) pieces->push_back(d);
  }
  return end;
}

}  // namespace topple::solver
