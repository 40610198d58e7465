// Load cases and combinations.
#include "formats/model_reader.h"
#include "model/index_of.h"

namespace topple::structure::formats {

namespace {

LoadFrame read_frame(const JsonValue& load, bool point) {
  const auto value = load.find("frame");
  if (!value) return LoadFrame::global;
  const std::string_view accepted = point ? "\"global\" or \"local\"" : "\"global\", \"local\" or \"projected\"";
  const std::string_view frame = value->text(accepted);
  if (frame == "global") return LoadFrame::global;
  if (frame == "local") return LoadFrame::local;
  if (frame == "projected" && !point) return LoadFrame::projected;
  value->refuse(accepted);
}

/// A distance from the first end: within the member, but for rounding of the file's decimals, which is taken away. What
/// is as good as an end is one: no part of the member is shorter.
double read_place(const JsonValue& value, const Member& member, const Scale& scale) {
  const double place = scaled(value, scale.length), slack = 1e-6 * member.length;
  if (place < -slack || place > member.length + slack)
    value.refuse("a distance from the first end, from 0 to the member's length of " +
                 std::to_string(member.length / scale.length));
  const double end = 1e-9 * member.length;
  return place < end ? 0 : place > member.length - end ? member.length : place;
}

void read_extent(const JsonValue& load, const Member& member, const Scale& scale, MemberLoad& result) {
  result.from = 0;
  result.to = member.length;
  if (const auto from = load.find("from")) result.from = read_place(*from, member, scale);
  if (const auto to = load.find("to")) result.to = read_place(*to, member, scale);
  if (!(result.from < result.to)) load.fail("the load has no length; accepted: `from` below `to`");
}

void read_trapezoid(const JsonValue& object, const Scale& scale, MemberLoad& result) {
  object.only({"x", "y", "z", "rx", "ry", "rz"});
  for (const JsonValue pair : object) {
    if (!pair.is_array()) pair.refuse("an array of two: the intensity at `from` and at `to`");
    pair.expect_array(2, 2);
    const int component = component_of(pair.key());
    const double factor = scale.load(component) / scale.length;
    auto number = pair.begin();
    result.first[component] = scaled(*number, factor);
    ++number;
    result.last[component] = scaled(*number, factor);
  }
}

void need_thermal_expansion(const JsonValue& value, const Material& material) {
  if (!material.thermal_expansion)
    value.fail("a temperature, for which materials." + material.name +
               ".thermal_expansion is missing; accepted: that key");
}

/// Temperatures of the faces at +y and -y, +z and -z, and the depths between them: as many programs have them. With an
/// `expansion` of its own, the strains are those of that coefficient.
void read_faces(const JsonValue& value, const ModelDraft& draft, const Material& material, MemberLoad& load) {
  value.only({"expansion", "depth_y", "depth_z", "faces_y", "faces_z"});
  double scale = 1;
  const auto expansion = value.find("expansion");
  if (expansion && expansion->number() == 0) {
    scale = 0;
  } else {
    need_thermal_expansion(value, material);
    if (expansion) {
      if (*material.thermal_expansion == 0) expansion->fail("the material's thermal_expansion is 0; accepted: 0");
      scale = expansion->number() / *material.thermal_expansion;
    }
  }
  double sum = 0;
  const auto pair = [&](const char* faces, const char* depth) {
    const JsonValue list = value.require(faces);
    list.expect_array(2, 2);
    auto face = list.begin();
    const double plus = (*face).number();
    ++face;
    const double minus = (*face).number();
    sum += plus + minus;
    (void)value.require(depth).positive();
    return scale * (plus - minus) / scaled(value.require(depth), draft.scale.length);
  };
  load.gradient_y = pair("faces_y", "depth_y");
  load.gradient_z = pair("faces_z", "depth_z");
  load.temperature = scale * sum / 4;
}

MemberLoad read_member_load(const JsonValue& value, MemberId id, const ModelDraft& draft) {
  const Member& member = draft.building[id];
  const Scale& scale = draft.scale;
  MemberLoad load;
  load.member = id;
  value.expect_object();
  if (const auto uniform = value.find("uniform")) {
    value.only({"uniform", "from", "to", "frame"});
    load.frame = read_frame(value, false);
    load.first = load.last = read_components(*uniform, [&](int c) { return scale.load(c) / scale.length; });
    read_extent(value, member, scale, load);
  } else if (const auto trapezoid = value.find("trapezoid")) {
    value.only({"trapezoid", "from", "to", "frame"});
    load.frame = read_frame(value, false);
    read_trapezoid(*trapezoid, scale, load);
    read_extent(value, member, scale, load);
  } else if (const auto point = value.find("point")) {
    value.only({"point", "at", "frame"});
    load.kind = MemberLoad::Kind::point;
    load.frame = read_frame(value, true);
    load.first = read_components(*point, [&](int c) { return scale.load(c); });
    load.from = load.to = read_place(value.require("at"), member, scale);
  } else if (const auto temperature = value.find("temperature")) {
    value.only({"temperature"});
    load.kind = MemberLoad::Kind::temperature;
    load.to = member.length;
    if (temperature->find("faces_y") || temperature->find("faces_z")) {
      read_faces(*temperature, draft, draft.building[member.material], load);
      return load;
    }
    temperature->only({"uniform", "gradient_y", "gradient_z"});
    need_thermal_expansion(*temperature, draft.building[member.material]);
    if (const auto number = temperature->find("uniform")) load.temperature = number->number();
    if (const auto number = temperature->find("gradient_y")) load.gradient_y = scaled(*number, 1 / scale.length);
    if (const auto number = temperature->find("gradient_z")) load.gradient_z = scaled(*number, 1 / scale.length);
  } else {
    value.fail("no kind of load; accepted: one of \"uniform\", \"trapezoid\", \"point\", \"temperature\"");
  }
  return load;
}

void read_panel_load(const JsonValue& value, const ModelDraft& draft, LoadCase& load_case) {
  value.only({"pressure", "temperature"});
  PanelLoad load;
  load.panel = draft.panel_of_key(value);
  if (const auto pressure = value.find("pressure")) load.pressure = scaled(*pressure, draft.scale.stress());
  if (const auto temperature = value.find("temperature")) {
    need_thermal_expansion(*temperature, draft.building[draft.building[load.panel].material]);
    load.temperature = temperature->number();
  }
  load_case.panels.push_back(load);
}

void read_settlement(const JsonValue& value, const ModelDraft& draft, LoadCase& load_case) {
  const NodeId node = draft.node_of_key(value);
  value.only({"x", "y", "z", "rx", "ry", "rz"});
  const NodeSupport* support = draft.support_of(node);
  for (const JsonValue entry : value) {
    const int component = component_of(entry.key());
    if (support == nullptr || support->stiffness[component] == 0)
      entry.fail("a settlement where the node " + in_quotes(value.key()) +
                 " has no support; accepted: supported components");
    load_case.settlements.push_back({node, component, scaled(entry, draft.scale.movement(component))});
  }
}

void read_self_weight(const JsonValue& value, LoadCase& load_case) {
  if (value.is_array())
    load_case.self_weight += read_point(value, 1);
  else
    load_case.self_weight += Vec3(0, 0, -value.number("a multiple of gravity downwards, or a vector of three"));
}

void read_case(const JsonValue& value, const ModelDraft& draft, LoadCase& load_case) {
  value.only({"self_weight", "panels", "nodes", "members", "settlements"});
  if (const auto weight = value.find("self_weight")) read_self_weight(*weight, load_case);
  if (const auto panels = value.find("panels")) {
    panels->expect_object();
    for (const JsonValue entry : *panels) read_panel_load(entry, draft, load_case);
  }
  if (const auto nodes = value.find("nodes")) {
    nodes->expect_object();
    for (const JsonValue entry : *nodes) {
      const NodeId node = draft.node_of_key(entry);
      load_case.nodes.push_back({node, read_components(entry, [&](int c) { return draft.scale.load(c); })});
    }
  }
  if (const auto members = value.find("members")) {
    members->expect_object();
    for (const JsonValue list : *members) {
      const MemberId member = draft.member_of_key(list);
      list.expect_array(0, ~std::size_t{0});
      for (const JsonValue entry : list) load_case.members.push_back(read_member_load(entry, member, draft));
    }
  }
  if (const auto settlements = value.find("settlements")) {
    settlements->expect_object();
    for (const JsonValue entry : *settlements) read_settlement(entry, draft, load_case);
  }
}

/// Said once, whatever the number of combinations.
void warn_without_self_weight(Building& building) {
  std::string names;
  std::size_t count = 0;
  constexpr std::size_t named = 3;
  for (const Combination& combination : building.combinations) {
    Vec3 weight = Vec3::Zero();
    for (const auto& [load_case, factor] : combination.factors) weight += factor * building[load_case].self_weight;
    if (!weight.isZero(0)) continue;
    if (++count <= named) names += (count > 1 ? ", " : "") + in_quotes(combination.name);
  }
  if (count == 0) return;
  if (count > named) names += " and " + std::to_string(count - named) + " more";
  building.warnings.push_back((count == 1 ? "combination " : "combinations ") + names +
                              (count == 1 ? " has" : " have") + " no self weight");
}

}  // namespace

void read_case_names(const JsonValue& root, ModelDraft& draft) {
  const auto loads = root.find("loads");
  if (loads) {
    loads->expect_object();
    for (const JsonValue value : *loads) draft.add_case(std::string(value.key()), value);
  }
  if (draft.building.cases.empty()) {
    draft.add_case("self weight", root);
    draft.building.cases.front().self_weight = Vec3(0, 0, -1);
  }
}

void read_loads(const JsonValue& root, ModelDraft& draft) {
  const auto loads = root.find("loads");
  if (!loads) return;
  for (const JsonValue value : *loads) {
    LoadCase& load_case = draft.building.cases[index_of(draft.case_of_key(value))];
    read_case(value, draft, load_case);
  }
}

void read_combinations(const JsonValue& root, ModelDraft& draft) {
  Building& building = draft.building;
  if (const auto combinations = root.find("combinations")) {
    combinations->expect_object();
    for (const JsonValue value : *combinations) {
      if (value.key().empty()) value.fail("a combination without a name; accepted: a name");
      value.expect_object();
      Combination combination;
      combination.name = value.key();
      for (const JsonValue factor : value) combination.factors.emplace_back(draft.case_of_key(factor), factor.number());
      if (combination.factors.empty()) value.fail("a combination of nothing; accepted: load cases with their factors");
      building.combinations.push_back(std::move(combination));
    }
  }
  if (building.combinations.empty())
    for (std::size_t i = 0; i < building.cases.size(); ++i)
      building.combinations.push_back({building.cases[i].name, {{LoadCaseId(i), 1.0}}});
  warn_without_self_weight(building);
}

}  // namespace topple::structure::formats
