#include "sections/shape_properties.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sections/torsion.h"

namespace topple::structure {

namespace {

using std::numbers::pi;

double cube(double x) { return x * x * x; }

/// One of the four fillets between web and flange: a square of side r less a quarter circle.
struct Fillet {
  double area, arm, inertia;  ///< arm: from its corner to its centroid; inertia about the centroid
  explicit Fillet(double r) {
    area = (1 - pi / 4) * r * r;
    const double from_centre = r > 0 ? r * r * r / 6 / area : 0;
    arm = r - from_centre;
    inertia = std::pow(r, 4) * (1.0 / 3 - pi / 16) - area * from_centre * from_centre;
  }
};

/// Shear area by the energy of the thin-walled shear flow, I^2 / integral of S^2/t (Timoshenko & Gere, Mechanics of
/// Materials; equal to Cowper, J. Applied Mechanics 33 (1966), with Poisson's ratio 0). `webs` walls of thickness `web`
/// and mid-line height `height` share the force; at each of their ends flange walls of thickness `flange` stand out
/// `overhang` to each of `sides` sides.
double shear_area_of_walls(int webs, double height, double web, int sides, double overhang, double flange) {
  const double end_moment = sides * overhang * flange * height / 2;  // first moment of flange walls at one web's end
  const double inertia = webs * (web * cube(height) / 12 + 2 * sides * overhang * flange * height * height / 4);
  const double flange_energy = webs * 2 * sides * flange * height * height / 4 * cube(overhang) / 3;
  const double web_energy = webs / web *
                            (end_moment * end_moment * height + end_moment * web * cube(height) / 6 +
                             web * web / 4 * std::pow(height, 5) / 30);
  return inertia * inertia / (flange_energy + web_energy);
}

/// Areas and moduli: rectangles and fillets added up (exact). J: see torsion.h.
void compute_I(Section& s) {
  const double h = s.depth - 2 * s.flange;  // clear web
  const Fillet fillet(s.fillet);
  const double up = h / 2 - fillet.arm, out = s.web / 2 + fillet.arm;
  s.area = 2 * s.width * s.flange + h * s.web + 4 * fillet.area;
  s.Iy = (s.width * cube(s.depth) - (s.width - s.web) * cube(h)) / 12 + 4 * (fillet.inertia + fillet.area * up * up);
  s.Iz = (2 * s.flange * cube(s.width) + h * cube(s.web)) / 12 + 4 * (fillet.inertia + fillet.area * out * out);
  s.J = I_torsion_constant(s.depth, s.width, s.web, s.flange, s.fillet);
  s.plastic_modulus_y = s.width * s.flange * (s.depth - s.flange) + s.web * h * h / 4 + 4 * fillet.area * up;
  s.plastic_modulus_z = s.flange * s.width * s.width / 2 + h * s.web * s.web / 4 + 4 * fillet.area * out;
  s.torsion_modulus = s.J / std::max(s.flange, s.web);
  s.shear_area_z = shear_area_of_walls(1, s.depth - s.flange, s.web, 2, s.width / 2, s.flange);
  s.shear_area_y = 5.0 / 6.0 * 2 * s.width * s.flange;  // two rectangles; the web adds nothing across
}

/// Square corners. J: Bredt's closed tube and the walls' own torsion, as EN 10210-2 annex A.
void compute_box(Section& s) {
  const double t = s.thickness, h = s.depth - 2 * t, b = s.width - 2 * t;
  const double height = s.depth - t, width = s.width - t;  // mid-lines
  s.area = s.depth * s.width - h * b;
  s.Iy = (s.width * cube(s.depth) - b * cube(h)) / 12;
  s.Iz = (s.depth * cube(s.width) - h * cube(b)) / 12;
  s.J = 2 * t * std::pow(height * width, 2) / (height + width) + 2 * (height + width) * cube(t) / 3;
  s.plastic_modulus_y = (s.width * s.depth * s.depth - b * h * h) / 4;
  s.plastic_modulus_z = (s.depth * s.width * s.width - h * b * b) / 4;
  s.torsion_modulus = 2 * height * width * t;
  s.shear_area_z = shear_area_of_walls(2, height, t, 1, width / 2, t);
  s.shear_area_y = shear_area_of_walls(2, width, t, 1, height / 2, t);
}

/// Shear area 5/6 A: energy of the parabolic shear stress.
void compute_rectangle(Section& s) {
  s.area = s.depth * s.width;
  s.Iy = s.width * cube(s.depth) / 12;
  s.Iz = s.depth * cube(s.width) / 12;
  s.J = rectangle_torsion_constant(s.depth, s.width);
  s.plastic_modulus_y = s.width * s.depth * s.depth / 4;
  s.plastic_modulus_z = s.depth * s.width * s.width / 4;
  s.torsion_modulus = rectangle_torsion_modulus(s.depth, s.width);
  s.shear_area_y = s.shear_area_z = 5.0 / 6.0 * s.area;
}

/// Shear area 9/10 A: Timoshenko & Gere, energy of the elementary shear stress.
void compute_circle(Section& s) {
  const double d = s.depth;
  s.area = pi * d * d / 4;
  s.Iy = s.Iz = pi * std::pow(d, 4) / 64;
  s.J = 2 * s.Iy;
  s.plastic_modulus_y = s.plastic_modulus_z = cube(d) / 6;
  s.torsion_modulus = pi * cube(d) / 16;
  s.shear_area_y = s.shear_area_z = 0.9 * s.area;
}

/// Shear area: Cowper 1966, hollow circle with Poisson's ratio 0; A/2 for a thin wall.
void compute_pipe(Section& s) {
  const double d = s.depth, inner = d - 2 * s.thickness, middle = d - s.thickness;
  s.area = pi * (d * d - inner * inner) / 4;
  s.Iy = s.Iz = pi * (std::pow(d, 4) - std::pow(inner, 4)) / 64;
  s.J = 2 * s.Iy;
  s.plastic_modulus_y = s.plastic_modulus_z = (cube(d) - cube(inner)) / 6;
  s.torsion_modulus = 2 * (pi * middle * middle / 4) * s.thickness;
  const double m = inner / d, q = std::pow(1 + m * m, 2);
  s.shear_area_y = s.shear_area_z = 6 * q / (7 * q + 20 * m * m) * s.area;
}

}  // namespace

void compute_properties(Section& section) {
  switch (section.shape) {
    case Section::Shape::I:
      compute_I(section);
      break;
    case Section::Shape::box:
      compute_box(section);
      break;
    case Section::Shape::rectangle:
      compute_rectangle(section);
      break;
    case Section::Shape::circle:
      compute_circle(section);
      break;
    case Section::Shape::pipe:
      compute_pipe(section);
      break;
    case Section::Shape::numbers:
      return;
  }
  compute_plastic_shear_areas(section);
}

void compute_plastic_shear_areas(Section& s) {
  switch (s.shape) {
    case Section::Shape::I: {
      const double web = (s.depth - 2 * s.flange) * s.web;
      // (a) rolled: at least eta hw tw, eta = 1 as the code allows conservatively; (d) welded: eta hw tw; (e) across.
      s.plastic_shear_area_z =
          s.fillet > 0 ? std::max(s.area - 2 * s.width * s.flange + (s.web + 2 * s.fillet) * s.flange, web) : web;
      s.plastic_shear_area_y = s.area - web;
      break;
    }
    case Section::Shape::box:  // (f) hollow of one thickness
      s.plastic_shear_area_z = s.area * s.depth / (s.width + s.depth);
      s.plastic_shear_area_y = s.area * s.width / (s.width + s.depth);
      break;
    case Section::Shape::pipe:  // (g)
      s.plastic_shear_area_y = s.plastic_shear_area_z = 2 * s.area / pi;
      break;
    case Section::Shape::rectangle:
      s.plastic_shear_area_y = s.plastic_shear_area_z = 2 * s.area / 3;
      break;
    case Section::Shape::circle:
      s.plastic_shear_area_y = s.plastic_shear_area_z = 3 * s.area / 4;
      break;
    case Section::Shape::numbers:
      break;
  }
}

std::string dimension_fault(const Section& s) {
  switch (s.shape) {
    case Section::Shape::I:
      if (2 * s.flange >= s.depth) return "the flanges leave no web; accepted: 2 flange < depth";
      if (s.web > s.width) return "the web is wider than the flanges; accepted: web <= width";
      if (s.fillet > (s.depth - 2 * s.flange) / 2 || s.fillet > (s.width - s.web) / 2)
        return "the fillet does not fit; accepted: fillet <= (depth - 2 flange)/2 and <= (width - web)/2";
      return {};
    case Section::Shape::box:
      if (2 * s.thickness >= std::min(s.depth, s.width))
        return "the walls meet; accepted: 2 thickness < depth and < width";
      return {};
    case Section::Shape::pipe:
      if (2 * s.thickness > s.depth) return "the wall is thicker than the radius; accepted: 2 thickness <= diameter";
      return {};
    default:
      return {};
  }
}

}  // namespace topple::structure
