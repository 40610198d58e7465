#pragma once
// Units and steel of the codes' worked examples.
#include "topple/structure/design_check.h"

namespace topple::test {

inline constexpr double inch = 0.0254, kip = 4448.2216152605, ksi = kip / (inch * inch), foot = 12 * inch;
inline constexpr double mm = 1e-3, cm = 1e-2, kN = 1e3, kNm = 1e3, MPa = 1e6;

/// Pa; by default the moduli of AISC 360.
[[nodiscard]] inline structure::Material steel(double fy, double e = 29000 * ksi, double g = 11200 * ksi) {
  structure::Material m;
  m.name = "steel";
  m.youngs_modulus = e;
  m.shear_modulus = g;
  m.yield_strength = fy;
  return m;
}

}  // namespace topple::test
