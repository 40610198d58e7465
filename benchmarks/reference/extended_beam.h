#pragma once
// One beam of the reference solution: stiffness and load vector in local axes, springs at its ends condensed one
// freedom at a time.
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "topple/solver/frame_model.h"

namespace reference {

template <typename Real>
using Vector12 = std::array<Real, 12>;
template <typename Real>
using Matrix12 = std::array<Vector12<Real>, 12>;

inline void require(bool known, const char* what) {
  if (!known) throw std::runtime_error(std::string("reference solution: ") + what + " are not in it");
}

/// Bending in one plane: v along one axis, r the rotation with v' = sign r. Przemieniecki 1968, table 5.1, with
/// phi = 12 E I/(G As L2).
template <typename Real>
void add_bending(Matrix12<Real>& k, int v, int r, Real sign, Real EI, Real GAs, Real L) {
  const Real phi = GAs > 0 ? 12 * EI / (GAs * L * L) : Real(0);
  const Real c = EI / (L * L * L * (1 + phi));
  const std::array<int, 4> at{v, r, v + 6, r + 6};
  const Real s = sign * L;
  const Real entries[4][4] = {{12, 6 * s, -12, 6 * s},
                              {6 * s, (4 + phi) * L * L, -6 * s, (2 - phi) * L * L},
                              {-12, -6 * s, 12, -6 * s},
                              {6 * s, (2 - phi) * L * L, -6 * s, (4 + phi) * L * L}};
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) k[at[i]][at[j]] += c * entries[i][j];
  }
}

/// Nodal forces with the work of a transverse intensity q(x): integrals of Hermite's functions (exact for a beam
/// without shear deformation). They are polynomials of degree 4 at most: by Boole's rule, which is exact to degree 5
/// and has rational points and weights, so that it is exact in every precision.
template <typename Real>
void add_transverse(Vector12<Real>& f, int v, int r, Real sign, Real L, Real a, Real b, Real qa, Real qb) {
  static constexpr int weight[5] = {7, 32, 12, 32, 7};
  for (int i = 0; i < 5; ++i) {
    const Real s = Real(i) / 4, x = a + (b - a) * s, t = x / L;
    const Real q = (qa + (qb - qa) * s) * (b - a) * Real(weight[i]) / 90;
    f[v] += q * (1 - 3 * t * t + 2 * t * t * t);
    f[r] += sign * q * L * (t - 2 * t * t + t * t * t);
    f[v + 6] += q * (3 * t * t - 2 * t * t * t);
    f[r + 6] += sign * q * L * (-t * t + t * t * t);
  }
}

template <typename Real>
void add_along(Vector12<Real>& f, int c, Real L, Real a, Real b, Real qa, Real qb) {
  const Real total = (qa + qb) / 2 * (b - a);
  const Real moment = (b - a) * (a * (qa + qb) / 2 + (b - a) * (qa / 6 + qb / 3));  // integral of q x
  f[c] += total - moment / L;
  f[c + 6] += moment / L;
}

template <typename Real>
struct ElementEquations {
  Matrix12<Real> stiffness{};
  Vector12<Real> load{};
};

/// A spring s between freedom i of the beam and that of its node: the beam's own is eliminated.
template <typename Real>
void condense_spring(ElementEquations<Real>& e, std::size_t i, double spring) {
  const Real s = spring, pivot = e.stiffness[i][i] + s;
  if (pivot == 0) return;
  const Vector12<Real> row = e.stiffness[i];
  const Real load = e.load[i];
  for (std::size_t a = 0; a < 12; ++a) {
    for (std::size_t b = 0; b < 12; ++b) {
      if (a != i && b != i) e.stiffness[a][b] -= row[a] * row[b] / pivot;
    }
    if (a != i) {
      e.stiffness[a][i] = e.stiffness[i][a] = s * row[a] / pivot;
      e.load[a] -= row[a] * load / pivot;
    }
  }
  e.stiffness[i][i] = s * row[i] / pivot;
  e.load[i] = s * load / pivot;
}

/// `loads`: those on this beam.
template <typename Real>
ElementEquations<Real> element_equations(const topple::solver::Beam& beam,
                                         const std::vector<const topple::solver::BeamLoad*>& loads) {
  using topple::solver::BeamLoad;
  ElementEquations<Real> e;
  const Real L = beam.length, E = beam.youngs_modulus, G = beam.shear_modulus;
  const auto add_rod = [&](std::size_t c, Real stiffness) {
    e.stiffness[c][c] += stiffness;
    e.stiffness[c + 6][c + 6] += stiffness;
    e.stiffness[c][c + 6] -= stiffness;
    e.stiffness[c + 6][c] -= stiffness;
  };
  add_rod(0, E * Real(beam.area) / L);
  add_rod(3, G * Real(beam.J) / L);
  add_bending<Real>(e.stiffness, 1, 5, 1, E * Real(beam.Iz), G * Real(beam.shear_area_y), L);
  add_bending<Real>(e.stiffness, 2, 4, -1, E * Real(beam.Iy), G * Real(beam.shear_area_z), L);
  for (const BeamLoad* load : loads) {
    require(load->kind == BeamLoad::Kind::distributed, "loads that are not distributed");
    require(beam.shear_area_y == 0 && beam.shear_area_z == 0, "loaded beams with shear deformation");
    require(load->first.tail<3>().isZero() && load->last.tail<3>().isZero(), "distributed moments");
    const Real a = load->from, b = load->to;
    add_along<Real>(e.load, 0, L, a, b, load->first[0], load->last[0]);
    add_transverse<Real>(e.load, 1, 5, 1, L, a, b, load->first[1], load->last[1]);
    add_transverse<Real>(e.load, 2, 4, -1, L, a, b, load->first[2], load->last[2]);
  }
  for (int end = 0; end < 2; ++end) {
    require(beam.offset[end].isZero(), "offsets");
    for (int c = 0; c < 6; ++c) {
      const double spring = beam.end_stiffness[end][c];
      if (!std::isinf(spring)) condense_spring(e, static_cast<std::size_t>(6 * end + c), spring);
    }
  }
  return e;
}

/// Local components of 12 global ones (`forward`), or back.
template <typename Real>
Vector12<Real> turn(const topple::solver::Beam& beam, const Vector12<Real>& from, bool forward) {
  Vector12<Real> to{};
  for (std::size_t block = 0; block < 12; block += 3) {
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j)
        to[block + static_cast<std::size_t>(i)] +=
            Real(forward ? beam.axes(i, j) : beam.axes(j, i)) * from[block + static_cast<std::size_t>(j)];
    }
  }
  return to;
}

}  // namespace reference
