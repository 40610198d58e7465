// Units, materials, sections.
#include <array>
#include <cmath>

#include "formats/model_reader.h"
#include "formats/read_fracture.h"
#include "sections/catalogue.h"
#include "sections/shape_properties.h"

namespace topple::structure::formats {

namespace {

struct Unit {
  const char* name;
  double factor;
};
// Exact by definition: inch 0.0254 m, pound 0.45359237 kg, pound-force with standard gravity 9.80665 m/s2.
constexpr std::array<Unit, 5> length_units{{{"m", 1}, {"cm", 0.01}, {"mm", 0.001}, {"in", 0.0254}, {"ft", 0.3048}}};
constexpr std::array<Unit, 5> force_units{
    {{"N", 1}, {"kN", 1e3}, {"MN", 1e6}, {"lbf", 4.4482216152605}, {"kip", 4448.2216152605}}};
constexpr std::array<Unit, 3> mass_units{{{"kg", 1}, {"t", 1e3}, {"lb", 0.45359237}}};
constexpr double standard_gravity = 9.80665;  // m/s2

template <std::size_t N>
void read_unit(const JsonValue& units, const char* key, const std::array<Unit, N>& table, double& factor,
               std::string& name) {
  const auto value = units.find(key);
  if (!value) return;
  std::vector<std::string_view> accepted;
  for (const Unit& unit : table) {
    if (value->is_text() && value->text() == unit.name) {
      factor = unit.factor;
      name = unit.name;
      return;
    }
    accepted.emplace_back(unit.name);
  }
  value->refuse(quoted_list(accepted));
}

void read_material(const JsonValue& value, ModelDraft& draft) {
  value.only({"youngs_modulus", "poisson_ratio", "shear_modulus", "density", "yield_strength", "compressive_strength",
              "tensile_strength", "thermal_expansion", "fracture"});
  const double stress = draft.scale.stress();
  Material material;
  material.name = value.key();
  const JsonValue modulus = value.require("youngs_modulus");
  (void)modulus.positive();
  material.youngs_modulus = scaled(modulus, stress);
  const auto poisson = value.find("poisson_ratio"), shear = value.find("shear_modulus");
  if (!poisson && !shear) value.fail("one of \"poisson_ratio\" and \"shear_modulus\" is missing");
  if (poisson) {
    material.poisson_ratio = poisson->number();
    if (!(material.poisson_ratio > -1 && material.poisson_ratio <= 0.5)) poisson->refuse("above -1, at most 0.5");
  }
  if (shear) {
    (void)shear->positive();
    material.shear_modulus = scaled(*shear, stress);
  }
  if (!shear) material.shear_modulus = material.youngs_modulus / (2 * (1 + material.poisson_ratio));
  if (!poisson) material.poisson_ratio = material.youngs_modulus / (2 * material.shear_modulus) - 1;
  if (const auto density = value.find("density")) {
    (void)density->not_negative();
    material.density = scaled(*density, draft.scale.density());
  }
  if (const auto fracture = value.find("fracture")) material.fracture = read_fracture(*fracture, draft.scale.length);
  const auto strength = [&](const char* key, std::optional<double>& target) {
    if (const auto number = value.find(key)) {
      (void)number->positive();
      target = scaled(*number, stress);
    }
  };
  strength("yield_strength", material.yield_strength);
  strength("compressive_strength", material.compressive_strength);
  strength("tensile_strength", material.tensile_strength);
  if (const auto expansion = value.find("thermal_expansion")) material.thermal_expansion = expansion->number();
  draft.add_material(std::move(material), value);
}

double dimension(const JsonValue& section, const char* key, double factor) {
  const JsonValue value = section.require(key);
  (void)value.positive();
  return scaled(value, factor);
}

Section section_of_shape(const JsonValue& value, std::string_view shape, double length) {
  Section section;
  if (shape == "I") {
    value.only({"shape", "depth", "width", "web", "flange", "fillet", "shear_deformation"});
    section.shape = Section::Shape::I;
    section.web = dimension(value, "web", length);
    section.flange = dimension(value, "flange", length);
    if (const auto fillet = value.find("fillet")) {
      (void)fillet->not_negative();
      section.fillet = scaled(*fillet, length);
    }
  } else if (shape == "box") {
    value.only({"shape", "depth", "width", "thickness", "shear_deformation"});
    section.shape = Section::Shape::box;
    section.thickness = dimension(value, "thickness", length);
  } else if (shape == "rectangle") {
    value.only({"shape", "depth", "width", "shear_deformation"});
    section.shape = Section::Shape::rectangle;
  } else if (shape == "circle" || shape == "pipe") {
    if (shape == "circle")
      value.only({"shape", "diameter", "shear_deformation"});
    else
      value.only({"shape", "diameter", "thickness", "shear_deformation"});
    section.shape = shape == "circle" ? Section::Shape::circle : Section::Shape::pipe;
    section.depth = section.width = dimension(value, "diameter", length);
    if (shape == "pipe") section.thickness = dimension(value, "thickness", length);
  } else {
    value.require("shape").refuse("\"I\", \"box\", \"rectangle\", \"circle\", \"pipe\"");
  }
  if (section.depth == 0) {
    section.depth = dimension(value, "depth", length);
    section.width = dimension(value, "width", length);
  }
  if (const std::string fault = dimension_fault(section); !fault.empty()) value.fail(fault);
  compute_properties(section);
  return section;
}

Section section_of_catalogue(const JsonValue& value, const JsonValue& name, const Scale& scale, bool consistent) {
  value.only({"catalogue", "shear_deformation"});
  if (consistent) name.fail("a catalogue name with consistent units; accepted: named units, or the section as numbers");
  (void)scale;
  auto section = find_in_catalogue(name.text("a catalogue name"));
  if (!section) name.refuse("a W, HSS, IPE, HEA or HEB name, such as \"W14x48\", \"HSS6X4X3/8\", \"IPE300\"");
  return *section;
}

Section section_of_numbers(const JsonValue& value, const Scale& scale) {
  value.only({"area", "Iy", "Iz", "J", "shear_area_y", "shear_area_z", "plastic_modulus_y", "plastic_modulus_z",
              "torsion_modulus", "depth", "width", "shear_deformation"});
  Section section;
  section.area = dimension(value, "area", scale.area());
  section.Iy = dimension(value, "Iy", scale.inertia());
  section.Iz = dimension(value, "Iz", scale.inertia());
  section.J = dimension(value, "J", scale.inertia());
  const auto shear_area = [&](const char* key, double& area, std::optional<double>& plastic) {
    if (const auto number = value.find(key)) {
      (void)number->not_negative();
      area = scaled(*number, scale.area());
      if (area > 0) plastic = area;
    }
  };
  shear_area("shear_area_y", section.shear_area_y, section.plastic_shear_area_y);
  shear_area("shear_area_z", section.shear_area_z, section.plastic_shear_area_z);
  const auto modulus = [&](const char* key, std::optional<double>& target) {
    if (value.find(key)) target = dimension(value, key, scale.modulus());
  };
  modulus("plastic_modulus_y", section.plastic_modulus_y);
  modulus("plastic_modulus_z", section.plastic_modulus_z);
  modulus("torsion_modulus", section.torsion_modulus);
  if (value.find("depth")) section.depth = dimension(value, "depth", scale.length);
  if (value.find("width")) section.width = dimension(value, "width", scale.length);
  return section;
}

}  // namespace

void read_units(const JsonValue& root, ModelDraft& draft) {
  Units& units = draft.building.units;
  if (const auto value = root.find("units")) {
    if (value->is_text() && value->text() == "consistent") {
      units.consistent = true;
      units.length_name = units.force_name = units.mass_name = "consistent";
    } else {
      if (!value->is_object()) value->refuse("an object with length, force and mass, or \"consistent\"");
      value->only({"length", "force", "mass"});
      read_unit(*value, "length", length_units, units.length, units.length_name);
      read_unit(*value, "force", force_units, units.force, units.force_name);
      read_unit(*value, "mass", mass_units, units.mass, units.mass_name);
    }
  }
  draft.scale = {units.length, units.force, units.mass};
  draft.building.gravity = standard_gravity;
  if (const auto gravity = root.find("gravity")) {
    (void)gravity->positive();
    draft.building.gravity = scaled(*gravity, units.length);
  }
}

void read_materials(const JsonValue& root, ModelDraft& draft) {
  const auto materials = root.find("materials");
  if (!materials) return;
  materials->expect_object();
  for (const JsonValue value : *materials) read_material(value, draft);
}

void read_sections(const JsonValue& root, ModelDraft& draft) {
  const auto sections = root.find("sections");
  if (!sections) return;
  sections->expect_object();
  for (const JsonValue value : *sections) {
    value.expect_object();
    const auto shape = value.find("shape"), catalogue = value.find("catalogue");
    Section section = shape ? section_of_shape(value, shape->text("the name of a shape"), draft.scale.length)
                      : catalogue
                          ? section_of_catalogue(value, *catalogue, draft.scale, draft.building.units.consistent)
                          : section_of_numbers(value, draft.scale);
    if (const auto deforms = value.find("shear_deformation"); deforms && !deforms->boolean())
      section.shear_area_y = section.shear_area_z = 0;
    for (const double property : {section.area, section.Iy, section.Iz, section.J})
      if (!(property > 0) || !std::isfinite(property))
        value.fail(
            "its properties are not positive, finite numbers in SI units; accepted: dimensions of a real section");
    section.name = value.key();
    draft.add_section(std::move(section), value);
  }
}

}  // namespace topple::structure::formats
