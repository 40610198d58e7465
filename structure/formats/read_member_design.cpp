// `design` of a member: what a design check needs beside the section.
#include <algorithm>

#include "formats/model_reader.h"

namespace topple::structure::formats {

namespace {

void read_restraints(const JsonValue& value, const Scale& scale, MemberDesign& design) {
  if (value.is_array()) {
    for (const JsonValue at : value) {
      (void)at.positive();
      design.restraints.push_back(scaled(at, scale.length));
    }
    std::sort(design.restraints.begin(), design.restraints.end());
    return;
  }
  const std::string_view name = value.text("\"none\", \"continuous\", or a list of distances from the first end");
  if (name != "none" && name != "continuous")
    value.refuse("\"none\", \"continuous\", or a list of distances from the first end");
  design.restrained_throughout = name == "continuous";
}

}  // namespace

MemberDesign read_member_design(const JsonValue& value, const Scale& scale) {
  MemberDesign design;
  if (value.is_text()) {
    if (value.text() != "none") value.refuse("an object, or \"none\"");
    design.checked = false;
    return design;
  }
  value.only({"length_y", "length_z", "length_torsion", "factor_y", "factor_z", "factor_torsion", "restraints",
              "moment_factor", "equivalent_moment_y", "equivalent_moment_z", "stiffener_spacing"});
  constexpr std::array<const char*, 3> ways{"y", "z", "torsion"};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string way = ways[i];
    const auto length = value.find("length_" + way), factor = value.find("factor_" + way);
    if (length && factor) factor->fail("`length_" + way + "` is given too; accepted: one of the two");
    if (length) {
      (void)length->not_negative();
      design.lengths[i] = scaled(*length, scale.length);
    }
    if (factor) design.factors[i] = factor->not_negative();
  }
  if (const auto restraints = value.find("restraints")) read_restraints(*restraints, scale, design);
  if (const auto factor = value.find("moment_factor")) design.moment_factor = factor->positive();
  if (const auto factor = value.find("equivalent_moment_y")) design.equivalent_moment_y = factor->positive();
  if (const auto factor = value.find("equivalent_moment_z")) design.equivalent_moment_z = factor->positive();
  if (const auto spacing = value.find("stiffener_spacing")) {
    (void)spacing->positive();
    design.stiffener_spacing = scaled(*spacing, scale.length);
  }
  return design;
}

}  // namespace topple::structure::formats
