#include "design/steel_section.h"

#include <algorithm>

#include "design/turned_section.h"
#include "topple/structure/error.h"

namespace topple::structure {

namespace {

SteelSection::Kind kind_of(Section::Shape shape) {
  switch (shape) {
    case Section::Shape::I:
      return SteelSection::Kind::I;
    case Section::Shape::box:
      return SteelSection::Kind::box;
    case Section::Shape::pipe:
      return SteelSection::Kind::pipe;
    case Section::Shape::rectangle:
    case Section::Shape::circle:
      return SteelSection::Kind::solid;
    default:
      return SteelSection::Kind::other;
  }
}

/// What puts a member outside of what either code is for; empty: nothing.
std::string outside_of_code(DesignCode code, const DesignMember& member, std::span<const SectionForces> stations) {
  constexpr double softest = 180e9, stiffest = 230e9;  // Pa: steels have 190 to 215
  constexpr double strongest = 460e6 * 1.001;          // Pa, S460
  const Section& section = *member.section;
  const double E = member.material->youngs_modulus, fy = member.material->yield_strength.value_or(0);
  if (E < softest || E > stiffest) return "its Young's modulus is not that of steel, for which the formulas are";
  if (code == DesignCode::en1993 && fy > strongest)
    return "its yield strength is above that of S460, up to which EN 1993-1-1 goes (table 3.1; EN 1993-1-12 beyond)";
  double moment = 0;
  for (const SectionForces& at : stations) moment = std::max(moment, std::abs(at[5]));
  constexpr double rounding = 1e-9;
  if (section.shape == Section::Shape::I && section.Iz > section.Iy &&
      moment * section.width > rounding * fy * section.Iz)
    return "its I section is stronger about the axis along its web, about which no lateral-torsional buckling is "
           "checked";
  return {};
}

DesignResult by_code(DesignCode code, const DesignMember& member, std::span<const SectionForces> stations,
                     const Trail& trail) {
  DesignResult result =
      code == DesignCode::en1993 ? check_en1993(member, stations, trail) : check_aisc360(member, stations, trail);
  if (result.refusal.empty()) result.refusal = outside_of_code(code, member, stations);
  return result;
}

/// Of a section that is stronger about local z, with both axes exchanged.
DesignResult checked(DesignCode code, const DesignMember& member, std::span<const SectionForces> stations,
                     const Trail& trail) {
  DesignResult result;
  if (stronger_about_z(*member.section)) {
    trail.add("section", "y, z", "exchanged below (h and b too): local z is the stronger axis", 1, plain_number);
    const TurnedMember turned(member, stations);
    result = by_code(code, turned.member, turned.stations, trail);
  } else {
    result = by_code(code, member, stations, trail);
  }
  result.lengths = member.lengths;
  result.length_source = member.length_source;
  result.mode_part = member.mode_part;
  result.yielded = member.yielded;
  return result;
}

}  // namespace

SteelSection steel_section(const Section& section, const Material& material) {
  if (!material.yield_strength)
    throw InputError("materials." + material.name +
                     ".yield_strength: a design check needs it, accepted is a number above 0");
  SteelSection steel;
  steel.kind = kind_of(section.shape);
  steel.rolled = section.shape == Section::Shape::I && (section.fillet > 0 || !section.catalogue.empty());
  steel.fy = *material.yield_strength;
  steel.E = material.youngs_modulus;
  steel.G = material.shear_modulus;
  steel.area = section.area;
  steel.Iy = section.Iy;
  steel.Iz = section.Iz;
  steel.J = section.J;
  steel.depth = section.depth;
  steel.width = section.width > 0 ? section.width : section.depth;  // pipe, circle: the diameter
  steel.fillet = section.fillet;
  const bool walled = steel.kind == SteelSection::Kind::box || steel.kind == SteelSection::Kind::pipe;
  steel.web = walled ? section.thickness : section.web;
  steel.flange = walled ? section.thickness : section.flange;
  // Hollow sections of the catalogue: 3 t (EN 1993-1-1 table 5.2, AISC 360 B4.1b(d)), where corners are round. Drawn by
  // its dimensions a box has sharp corners, as plates welded together: their clear distance counts.
  if (steel.kind == SteelSection::Kind::box) steel.corners = (section.catalogue.empty() ? 2 : 3) * section.thickness;
  if (!(steel.depth > 0) || !(steel.width > 0))
    throw InputError("sections." + section.name +
                     ".depth, width: a design check needs them, accepted are numbers above 0");
  steel.elastic_y = 2 * steel.Iy / steel.depth;
  steel.elastic_z = 2 * steel.Iz / steel.width;
  steel.has_plastic = section.plastic_modulus_y && section.plastic_modulus_z;
  steel.plastic_y = section.plastic_modulus_y.value_or(steel.elastic_y);
  steel.plastic_z = section.plastic_modulus_z.value_or(steel.elastic_z);
  if (steel.kind == SteelSection::Kind::I) steel.warping = steel.Iz * std::pow(steel.depth - steel.flange, 2) / 4;
  steel.shear_y = section.plastic_shear_area_y.value_or(section.shear_area_y);
  steel.shear_z = section.plastic_shear_area_z.value_or(section.shear_area_z);
  steel.torsion = section.torsion_modulus.value_or(0);
  return steel;
}

LargestForces largest_forces(std::span<const SectionForces> stations) {
  LargestForces largest;
  const auto raise = [](double& value, double found) { value = std::max(value, std::abs(found)); };
  for (const SectionForces& at : stations) {
    raise(at[0] > 0 ? largest.tension : largest.compression, at[0]);
    raise(largest.shear_y, at[1]);
    raise(largest.shear_z, at[2]);
    raise(largest.torsion, at[3]);
    raise(largest.moment_y, at[4]);
    raise(largest.moment_z, at[5]);
  }
  return largest;
}

void trace_section(const SteelSection& s, const Trail& trail) {
  if (!trail.on()) return;
  trail.add("section", "f_y", "given", s.fy, of_stress);
  trail.add("section", "E", "given", s.E, of_stress);
  trail.add("section", "G", "given", s.G, of_stress);
  trail.add("section", "h", "given", s.depth, of_length);
  trail.add("section", "b", "given", s.width, of_length);
  if (s.web > 0) trail.add("section", "t_w", "given", s.web, of_length);
  if (s.flange > 0) trail.add("section", "t_f", "given", s.flange, of_length);
  if (s.fillet > 0) trail.add("section", "r", "given", s.fillet, of_length);
  trail.add("section", "A", "given or from the outline", s.area, of_area);
  trail.add("section", "I_y", "given or from the outline", s.Iy, of_inertia);
  trail.add("section", "I_z", "given or from the outline", s.Iz, of_inertia);
  trail.add("section", "I_t (J)", "given or from the outline", s.J, of_inertia);
  if (s.warping > 0) trail.add("section", "I_w (C_w)", "I_z (h - t_f)^2/4", s.warping, of_warping);
  trail.add("section", "W_el,y (S_x)", "2 I_y/h", s.elastic_y, of_modulus);
  trail.add("section", "W_el,z (S_y)", "2 I_z/b", s.elastic_z, of_modulus);
  if (!s.has_plastic) return;
  trail.add("section", "W_pl,y (Z_x)", "given or from the outline", s.plastic_y, of_modulus);
  trail.add("section", "W_pl,z (Z_y)", "given or from the outline", s.plastic_z, of_modulus);
}

void trace_forces(const LargestForces& f, const Trail& trail) {
  if (!trail.on()) return;
  trail.add("forces", "N_c", "largest compression along the member", f.compression, of_force);
  trail.add("forces", "N_t", "largest tension along the member", f.tension, of_force);
  trail.add("forces", "V_y", "largest along the member", f.shear_y, of_force);
  trail.add("forces", "V_z", "largest along the member", f.shear_z, of_force);
  trail.add("forces", "T", "largest along the member", f.torsion, of_moment);
  trail.add("forces", "M_y", "largest along the member", f.moment_y, of_moment);
  trail.add("forces", "M_z", "largest along the member", f.moment_z, of_moment);
}

void ClauseList::add(const std::string& clause, double utilisation) {
  const auto known = std::find_if(clauses_.begin(), clauses_.end(), [&](const auto& c) { return c.clause == clause; });
  if (known == clauses_.end())
    clauses_.push_back({clause, utilisation});
  else
    known->utilisation = std::max(known->utilisation, utilisation);
}

DesignResult ClauseList::result() const {
  DesignResult result;
  result.clauses = clauses_;
  result.refusal = refusal_;
  for (const DesignClause& clause : clauses_)
    if (result.governing.empty() || clause.utilisation > result.utilisation) {
      result.utilisation = clause.utilisation;
      result.governing = clause.clause;
    }
  return result;
}

DesignAudit audit_member(DesignCode code, const DesignMember& member, std::span<const SectionForces> stations) {
  DesignAudit audit;
  audit.result = checked(code, member, stations, Trail(audit.steps));
  return audit;
}

DesignResult check_member(DesignCode code, const DesignMember& member, std::span<const SectionForces> stations) {
  return checked(code, member, stations, {});
}

std::string_view length_source_name(LengthSource source) {
  constexpr std::array<std::string_view, 9> names{
      "given",           "between nodes that hold it", "cantilever",
      "assumed to sway", "alignment chart, braced",    "alignment chart, sway",
      "pinned, leaning", "buckling analysis",          "lowest buckling factor"};
  return names[static_cast<std::size_t>(source)];
}

std::string_view mode_part_reason(ModePart part) {
  constexpr std::array<std::string_view, 5> reasons{"", "", "no compression", "hardly bends in the modes",
                                                    "bent by others in the modes, not by its compression"};
  return reasons[static_cast<std::size_t>(part)];
}

}  // namespace topple::structure
