// Joint types: stiffness, capacity in seven senses, interaction, ductility.
#include "formats/model_reader.h"

namespace topple::structure::formats {

namespace {

int sense_of(std::string_view name) {
  for (std::size_t s = 0; s < 7; ++s)
    if (name == sense_names[s]) return static_cast<int>(s);
  return -1;
}

/// Factor of a capacity: the first four senses are forces, the others moments.
double factor_of(std::size_t sense, const Scale& scale) { return sense < 4 ? scale.force : scale.moment(); }

void read_thresholds(const JsonValue& capacity, JointType& type, const Scale& scale) {
  capacity.only({"force", "moment"});
  const auto three = [&](const char* key, std::array<Sense, 3> senses) {
    const auto list = capacity.find(key);
    if (!list) return;
    list->expect_array(3, 3);
    std::size_t i = 0;
    for (const JsonValue number : *list) {
      const auto sense = static_cast<std::size_t>(senses[i++]);
      (void)number.positive();
      type.given[sense] = scaled(number, factor_of(sense, scale));
    }
  };
  three("force", {Sense::tension, Sense::shear_y, Sense::shear_z});
  type.given[static_cast<std::size_t>(Sense::compression)] = type.given[static_cast<std::size_t>(Sense::tension)];
  three("moment", {Sense::torsion, Sense::moment_y, Sense::moment_z});
}

void read_capacity(const JsonValue& capacity, JointType& type, const Scale& scale) {
  capacity.expect_object();
  type.has_capacity = true;
  if (capacity.find("force") || capacity.find("moment")) return read_thresholds(capacity, type, scale);
  capacity.only({"from", "ratio", "tension", "compression", "shear_y", "shear_z", "torsion", "moment_y", "moment_z"});
  if (const auto from = capacity.find("from")) {
    if (from->text("\"section\"") != "section") from->refuse("\"section\"");
    type.from_section = true;
  }
  if (const auto ratio = capacity.find("ratio")) {
    if (!type.from_section) ratio->fail("`ratio` without `from`; accepted: beside \"from\": \"section\"");
    type.ratio = ratio->positive();
  }
  for (const JsonValue value : capacity)
    if (const int sense = sense_of(value.key()); sense >= 0) {
      (void)value.positive();
      type.given[static_cast<std::size_t>(sense)] = scaled(value, factor_of(static_cast<std::size_t>(sense), scale));
    }
}

void read_capacity_per_length(const JsonValue& capacity, JointType& type, const Scale& scale) {
  capacity.only({"tension", "compression", "shear_y", "shear_z", "torsion", "moment_y", "moment_z"});
  type.per_length.emplace();
  type.per_length->fill(unlimited);
  for (const JsonValue value : capacity) {
    const auto sense = static_cast<std::size_t>(sense_of(value.key()));
    (void)value.positive();
    (*type.per_length)[sense] = scaled(value, factor_of(sense, scale) / scale.length);
  }
}

void read_stiffness(const JsonValue& stiffness, JointType& type, const Scale& scale) {
  stiffness.only({"x", "y", "z", "rx", "ry", "rz"});
  type.stiffness = Vec6::Constant(unlimited);
  for (const JsonValue value : stiffness) {
    (void)value.not_negative();
    const int component = component_of(value.key());
    (*type.stiffness)[component] = scaled(value, scale.stiffness(component));
  }
}

void read_rules(const JsonValue& value, JointType& type) {
  if (const auto ductility = value.find("ductility")) {
    ductility->only({"moment_y", "moment_z", "torsion"});
    for (const JsonValue rotation : *ductility)
      type.ductility[static_cast<std::size_t>(sense_of(rotation.key()))] = rotation.in(ranges::plastic_rotation);
  }
  const bool ductile = value.find("ductility").has_value();
  if (type.from_section && !ductile) type.interaction = Interaction::sum;
  if (const auto interaction = value.find("interaction")) {
    const std::string_view rule = interaction->text("\"max\" or \"sum\"");
    if (rule != "max" && rule != "sum") interaction->refuse("\"max\" or \"sum\"");
    if (rule == "sum" && ductile) interaction->fail("\"sum\" with `ductility`; accepted: \"max\"");
    type.interaction = rule == "sum" ? Interaction::sum : Interaction::max;
  }
}

}  // namespace

void read_joint_types(const JsonValue& root, ModelDraft& draft) {
  const auto joints = root.find("joints");
  if (!joints) return;
  joints->expect_object();
  for (const JsonValue value : *joints) {
    value.only({"stiffness", "capacity", "capacity_per_length", "strength", "interaction", "ductility"});
    JointType type;
    type.name = value.key();
    if (const auto stiffness = value.find("stiffness")) read_stiffness(*stiffness, type, draft.scale);
    if (const auto capacity = value.find("capacity")) read_capacity(*capacity, type, draft.scale);
    if (const auto capacity = value.find("capacity_per_length")) read_capacity_per_length(*capacity, type, draft.scale);
    if (const auto strength = value.find("strength")) type.strength = strength->positive();
    read_rules(value, type);
    draft.add_joint_type(std::move(type), value);
  }
}

}  // namespace topple::structure::formats
