#pragma once
// What both codes need of a steel section beyond the building's own properties.
#include <cmath>
#include <string>

#include "design/design_trail.h"
#include "topple/structure/design_check.h"

namespace topple::structure {

struct SteelSection {
  enum class Kind { I, box, pipe, solid, other };
  Kind kind = Kind::other;
  bool rolled = false;
  double fy = 0, E = 0, G = 0;
  double area = 0, Iy = 0, Iz = 0, J = 0;
  double depth = 0, width = 0, web = 0, flange = 0, fillet = 0;  ///< box, pipe: web = flange = wall thickness
  double elastic_y = 0, elastic_z = 0;                           ///< elastic section moduli
  double plastic_y = 0, plastic_z = 0;                           ///< plastic ones; the elastic where none is known
  double corners = 0;               ///< box: what two corners take of a wall's outside length, m
  double warping = 0;               ///< Iz (h - tf)^2 / 4 for I, else 0
  double shear_y = 0, shear_z = 0;  ///< plastic shear areas
  double torsion = 0;               ///< torsion modulus; 0: not known
  bool has_plastic = false;

  [[nodiscard]] double radius_y() const { return std::sqrt(Iy / area); }
  [[nodiscard]] double radius_z() const { return std::sqrt(Iz / area); }
  /// Clear height between the flanges (walls of a box); 0 where there is no web.
  [[nodiscard]] double web_height() const { return kind == Kind::I || kind == Kind::box ? depth - 2 * flange : 0; }
};

/// Throws InputError naming the key that is missing.
[[nodiscard]] SteelSection steel_section(const Section& section, const Material& material);
/// The section's properties, as the first steps of an audit.
void trace_section(const SteelSection& steel, const Trail& trail);

/// Largest absolute forces over the stations, axial kept apart by sign.
struct LargestForces {
  double tension = 0, compression = 0, shear_y = 0, shear_z = 0, torsion = 0, moment_y = 0, moment_z = 0;
};
[[nodiscard]] LargestForces largest_forces(std::span<const SectionForces> stations);
void trace_forces(const LargestForces& forces, const Trail& trail);

/// Keeps each clause at its largest value, in order of first appearance.
class ClauseList {
 public:
  void add(const std::string& clause, double utilisation);
  void refuse(const std::string& why) {
    if (refusal_.empty()) refusal_ = why;
  }
  [[nodiscard]] DesignResult result() const;

 private:
  std::vector<DesignClause> clauses_;
  std::string refusal_;
};

[[nodiscard]] DesignResult check_en1993(const DesignMember& member, std::span<const SectionForces> stations,
                                        const Trail& trail);
[[nodiscard]] DesignResult check_aisc360(const DesignMember& member, std::span<const SectionForces> stations,
                                         const Trail& trail);

}  // namespace topple::structure
