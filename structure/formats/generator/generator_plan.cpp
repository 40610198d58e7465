// Reads a `building` of the file into its plan.
#include "formats/generator/generator_plan.h"

#include <algorithm>

#include "formats/model_reader.h"

namespace topple::structure::formats {

namespace {

constexpr std::int64_t most_lines = 10'000;

class PlanReader {
 public:
  PlanReader(const JsonValue& place, const ModelDraft& draft) : place_(place), draft_(draft) {}

  BuildingPlan read() {
    place_.only(
        {"name", "origin", "posts", "storeys", "bay", "storey_height", "post", "beam", "slab", "wall", "omit", "base"});
    read_grid();
    read_rules();
    return std::move(plan_);
  }

 private:
  // The grid. Lines are counted from 1, levels from 0.

  void read_grid() {
    if (const auto name = place_.find("name")) {
      plan_.name = name->text("a name");
      if (plan_.name.empty() || plan_.name.find('*') != std::string::npos)
        name->refuse("a name that is not empty and holds no *");
    }
    Vec3 origin = Vec3::Zero();
    if (const auto given = place_.find("origin")) origin = read_point(*given, draft_.scale.length);
    const JsonValue posts = place_.require("posts");
    posts.expect_array(2, 2);
    auto count = posts.begin();
    plan_.nx = static_cast<int>((*count).whole(1, most_lines));
    ++count;
    plan_.ny = static_cast<int>((*count).whole(1, most_lines));
    plan_.storeys = static_cast<int>(place_.require("storeys").whole(1, most_storeys));
    // A node, a post, two beams, a slab and two walls at each crossing of lines on each storey.
    draft_.require_room(posts, 7.0 * plan_.nx * plan_.ny * plan_.storeys);
    const JsonValue bay = place_.require("bay");
    if (!bay.is_array()) bay.refuse("an array of two: bays along x and along y");
    bay.expect_array(2, 2);
    auto bays = bay.begin();
    plan_.x = read_lines(*bays, plan_.nx - 1, origin.x());
    ++bays;
    plan_.y = read_lines(*bays, plan_.ny - 1, origin.y());
    plan_.z = read_lines(place_.require("storey_height"), plan_.storeys, origin.z());
  }

  /// Places of lines whose distances are one number for all or a list.
  std::vector<double> read_lines(const JsonValue& value, int spaces, double start) const {
    std::vector<double> places{start};
    const auto add = [&](const JsonValue& distance) {
      (void)distance.positive();
      places.push_back(places.back() + scaled(distance, draft_.scale.length));
    };
    if (value.is_array()) {
      value.expect_array(static_cast<std::size_t>(spaces), static_cast<std::size_t>(spaces));
      for (const JsonValue distance : value) add(distance);
    } else {
      if (!value.is_number()) value.refuse("a number, or an array of " + std::to_string(spaces));
      (void)value.positive();
      for (int n = 1; n <= spaces; ++n) places.push_back(start + n * scaled(value, draft_.scale.length));
    }
    return places;
  }

  // Rules.

  void read_rules() {
    plan_.post = read_by_storey<MemberDraft>("post", true, plan_.post_value,
                                             [&](const JsonValue& v) { return read_member_rule(v, MemberKind::post); });
    plan_.beam = read_by_storey<MemberDraft>("beam", true, plan_.beam_value,
                                             [&](const JsonValue& v) { return read_member_rule(v, MemberKind::beam); });
    plan_.slab = read_by_storey<PanelRule>("slab", false, plan_.slab_value,
                                           [&](const JsonValue& v) { return read_panel_rule(v, PanelKind::slab); });
    plan_.wall = read_by_storey<PanelRule>("wall", false, plan_.wall_value,
                                           [&](const JsonValue& v) { return read_panel_rule(v, PanelKind::wall); });
  }

  template <class Rule, class Read>
  ByStorey<Rule> read_by_storey(const char* key, bool everywhere, ByStorey<JsonValue>& values, Read read) const {
    ByStorey<Rule> rules(static_cast<std::size_t>(plan_.storeys) + 1);
    values.resize(rules.size());
    if (!everywhere && !place_.find(key)) return rules;
    const JsonValue value = place_.require(key);
    const auto take = [&](const JsonValue& object) {
      object.expect_object();
      std::int64_t first = 1, last = plan_.storeys;
      if (const auto storeys = object.find("storeys")) {
        storeys->expect_array(2, 2);
        auto bound = storeys->begin();
        first = (*bound).whole(1, plan_.storeys);
        ++bound;
        last = (*bound).whole(first, plan_.storeys);
      }
      const Rule rule = read(object);
      for (std::int64_t k = first; k <= last; ++k) {
        auto& slot = rules[static_cast<std::size_t>(k)];
        if (slot)
          object.fail("storey " + std::to_string(k) + " has a " + key + " already; accepted: one for each storey");
        slot = rule;
        values[static_cast<std::size_t>(k)] = object;
      }
    };
    if (value.is_array())
      for (const JsonValue object : value) take(object);
    else
      take(value);
    if (everywhere)
      for (int k = 1; k <= plan_.storeys; ++k)
        if (!rules[static_cast<std::size_t>(k)])
          value.fail("storey " + std::to_string(k) + " has no " + key + "; accepted: one for each storey");
    return rules;
  }

  MemberDraft read_member_rule(const JsonValue& value, MemberKind kind) const {
    value.only({"storeys", "section", "material", "joint", "groups", "design"});
    MemberDraft rule;
    rule.kind = kind;
    rule.section = draft_.section(value.require("section"));
    rule.material = draft_.material(value.require("material"));
    if (const auto joint = value.find("joint")) {
      rule.joints[0] = draft_.joint_type(*joint);
      // A post's top end belongs to its node for good; a beam is jointed at both ends.
      if (kind == MemberKind::beam) rule.joints[1] = rule.joints[0];
    }
    if (const auto groups = value.find("groups")) rule.groups = read_names(*groups);
    if (const auto design = value.find("design")) rule.design = read_member_design(*design, draft_.scale);
    return rule;
  }

  PanelRule read_panel_rule(const JsonValue& value, PanelKind kind) const {
    if (kind == PanelKind::wall)
      value.only({"storeys", "thickness", "material", "joint", "model", "span", "mesh", "openings", "pressure",
                  "groups", "sides", "fracture"});
    else
      value.only({"storeys", "thickness", "material", "joint", "model", "span", "mesh", "openings", "pressure",
                  "groups", "fracture"});
    PanelRule rule;
    Panel& panel = rule.draft.panel;
    panel.kind = kind;
    panel.model = kind == PanelKind::slab ? PanelModel::membrane : PanelModel::cladding;
    const JsonValue thickness = value.require("thickness");
    (void)thickness.positive();
    panel.thickness = scaled(thickness, draft_.scale.length);
    panel.material = draft_.material(value.require("material"));
    if (const auto joint = value.find("joint")) rule.draft.joint = draft_.joint_type(*joint);
    read_panel_keys(value, draft_.scale, panel);
    if (const auto groups = value.find("groups")) panel.groups = read_names(*groups);
    if (const auto pressure = value.find("pressure")) {
      pressure->expect_object();
      for (const JsonValue entry : *pressure)
        rule.pressures.emplace_back(draft_.case_of_key(entry), scaled(entry, draft_.scale.stress()));
    }
    if (kind == PanelKind::wall) read_sides(value, rule);
    return rule;
  }

  void read_sides(const JsonValue& value, PanelRule& rule) const {
    rule.sides = {"x-", "x+", "y-", "y+"};
    const auto sides = value.find("sides");
    if (!sides) return;
    rule.sides.clear();
    for (const std::string& side : read_names(*sides)) {
      const bool outer = side == "x-" || side == "x+" || side == "y-" || side == "y+";
      if (!outer && plan_.inner_line(side) == 0)
        sides->fail("there is no side " + in_quotes(side) +
                    "; accepted: \"x-\", \"x+\", \"y-\", \"y+\", inner lines x2 to x" + std::to_string(plan_.nx - 1) +
                    " and y2 to y" + std::to_string(plan_.ny - 1));
      if (std::find(rule.sides.begin(), rule.sides.end(), side) != rule.sides.end())
        sides->fail("the side " + in_quotes(side) + " stands twice; accepted: each once");
      rule.sides.push_back(side);
    }
  }

  JsonValue place_;
  const ModelDraft& draft_;
  BuildingPlan plan_;
};

}  // namespace

int BuildingPlan::inner_line(const std::string& side) const {
  if (side.size() < 2 || side.size() > 6 || (side[0] != 'x' && side[0] != 'y') || side[1] == '0') return 0;
  if (!std::all_of(side.begin() + 1, side.end(), [](char c) { return c >= '0' && c <= '9'; })) return 0;
  const int line = std::stoi(side.substr(1));
  return line >= 2 && line <= (side[0] == 'x' ? nx : ny) - 1 ? line : 0;
}

BuildingPlan read_building_plan(const JsonValue& place, const ModelDraft& draft) {
  return PlanReader(place, draft).read();
}

}  // namespace topple::structure::formats
