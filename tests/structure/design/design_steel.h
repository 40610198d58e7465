#pragma once
// Units, steel and girders of the codes' worked examples, and what a check says of one clause.
#include <algorithm>
#include <catch2/catch.hpp>
#include <string>

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

/// A doubly symmetric I of plates, in metres, its properties by rectangles.
[[nodiscard]] inline structure::Section welded(double h, double b, double tw, double tf) {
  structure::Section s;
  s.name = "girder";
  s.shape = structure::Section::Shape::I;
  s.depth = h;
  s.width = b;
  s.web = tw;
  s.flange = tf;
  const double hw = h - 2 * tf;
  s.area = 2 * b * tf + hw * tw;
  s.Iy = (b * h * h * h - (b - tw) * hw * hw * hw) / 12;
  s.Iz = (2 * tf * b * b * b + hw * tw * tw * tw) / 12;
  s.J = (2 * b * tf * tf * tf + hw * tw * tw * tw) / 3;
  s.plastic_modulus_y = b * tf * (h - tf) + tw * hw * hw / 4;
  s.plastic_modulus_z = tf * b * b / 2 + hw * tw * tw / 4;
  s.plastic_shear_area_z = hw * tw;
  s.plastic_shear_area_y = 2 * b * tf;
  s.torsion_modulus = s.J / std::max(tw, tf);
  return s;
}

/// Utilisation of the clause of this name; the test fails where it was not checked.
[[nodiscard]] inline double clause(const structure::DesignResult& result, const std::string& name) {
  for (const structure::DesignClause& c : result.clauses)
    if (c.clause == name) return c.utilisation;
  FAIL("no clause " << name);
  return 0;
}

}  // namespace topple::test
