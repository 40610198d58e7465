#include "design/en1993_class.h"

#include <algorithm>

namespace topple::structure {

namespace {

/// A plate's slenderness c/t and its limits for the classes 1 to 3, epsilon left out.
struct Plate {
  double slenderness = 0;
  std::array<double, 3> limit{};
};

/// Table 5.2, sheet 1: an internal part in bending and compression, `compression` acting on it alone beside bending.
Plate internal_part(double length, double thickness, double compression, double area_stress, double fy) {
  const double alpha = std::clamp(0.5 * (1 + compression / (fy * thickness * length)), 0.5, 1.0);
  const double psi = std::clamp(2 * area_stress / fy - 1, -1.0, 1.0);
  return {length / thickness,
          {396 / (13 * alpha - 1), 456 / (13 * alpha - 1), psi > -1 ? 42 / (0.67 + 0.33 * psi) : 124.0}};
}

/// The same under uniform compression.
Plate pressed_part(double slenderness) { return {slenderness, {33, 38, 42}}; }

int class_of(const Plate& plate, double epsilon) {
  for (int k = 0; k < 3; ++k)
    if (plate.slenderness <= plate.limit[static_cast<std::size_t>(k)] * epsilon) return k + 1;
  return 4;
}

}  // namespace

SectionClass classify_en1993(const SteelSection& steel, double compression) {
  const EffectiveSection whole{steel.area, steel.elastic_y, steel.elastic_z};
  if (steel.kind == SteelSection::Kind::solid) return {1, 1, steel.fy, whole, steel.area};
  if (steel.kind == SteelSection::Kind::other)  // elastic: its parts are not known
    return {3, 3, steel.fy, whole, steel.area};
  const double epsilon = std::sqrt(235e6 / steel.fy);
  if (steel.kind == SteelSection::Kind::pipe) {  // table 5.2, sheet 3: limits in epsilon squared
    const double slenderness = steel.depth / steel.web;
    const double e2 = epsilon * epsilon;
    for (int k = 0; k < 3; ++k)
      if (slenderness <= (50 + 20 * k) * e2) return {k + 1, k + 1, steel.fy, whole, steel.area};
    return {4, 4, 235e6 * 90 / slenderness, whole, steel.area};
  }
  const bool box = steel.kind == SteelSection::Kind::box;
  // Clear widths: between fillets (I), between the corners (box).
  const double web_length = box ? steel.depth - steel.corners : steel.depth - 2 * steel.flange - 2 * steel.fillet;
  const double mean_stress = compression / steel.area;
  const Plate web = internal_part(web_length, steel.web, compression / (box ? 2 : 1), mean_stress, steel.fy);
  const Plate flange = box ? pressed_part((steel.width - steel.corners) / steel.web)
                           : Plate{((steel.width - steel.web) / 2 - steel.fillet) / steel.flange, {9, 10, 14}};
  const Plate pressed_web = pressed_part(web_length / steel.web);
  const EffectiveSection effective = effective_section(steel);
  SectionClass cls;
  cls.fy = steel.fy;
  cls.number = std::max(class_of(web, epsilon), class_of(flange, epsilon));
  cls.about_z = cls.number;
  if (box)
    cls.about_z =
        std::max(class_of(pressed_web, epsilon),
                 class_of(internal_part(steel.width - steel.corners, steel.web, compression / 2, mean_stress, steel.fy),
                          epsilon));
  cls.counts = cls.number < 4 ? whole : effective;
  cls.counts.modulus_z = cls.about_z < 4 ? whole.modulus_z : effective.modulus_z;
  const bool class_4 = std::max(class_of(pressed_web, epsilon), class_of(flange, epsilon)) == 4;
  cls.pressed_area = class_4 ? effective.area : steel.area;
  return cls;
}

}  // namespace topple::structure
