// Scenarios: rules of failure, impact and debris, and tools at their times.
#include <algorithm>
#include <set>

#include "formats/divide_cut_members.h"
#include "formats/documents.h"
#include "formats/json/json_document.h"
#include "formats/model_reader.h"
#include "formats/read_fracture.h"
#include "topple/structure/error.h"
#include "topple/structure/formats/files.h"
#include "topple/structure/formats/scenario_text.h"

namespace topple::structure {

namespace formats {

namespace {

/// Reads a number of a range.
auto in(const NumberRange& range) {
  return [range](const JsonValue& value) { return value.in(range); };
}

Vec3 place(const JsonValue& value) {
  value.expect_array(3, 3);
  for (const JsonValue coordinate : value) (void)coordinate.in(ranges::place);
  return read_point(value, 1);
}

/// A vector whose length lies in a range that begins at 0.
Vec3 vector_within(const JsonValue& value, const NumberRange& length, const char* unit) {
  const Vec3 vector = read_point(value, 1);
  if (!length.contains(vector.stableNorm())) value.refuse("three numbers, together " + length.text() + " " + unit);
  return vector;
}

/// Keeps the default where the key is absent.
template <class Target, class Read>
void take(const JsonValue& object, std::string_view key, Target& target, Read read) {
  if (const auto value = object.find(key)) target = read(*value);
}
bool boolean(const JsonValue& value) { return value.boolean(); }

/// Why a key that bounded a step is refused.
constexpr const char* pace_is_the_hosts =
    "a step computes all that happens in it, and the pace of the steps is the host's; leave the key out";

/// More of them in a step serve nothing: a step of a tenth of a second has them at 10 kHz.
constexpr std::int64_t most_substeps = 1000;

class ScenarioReader {
 public:
  ScenarioReader(const JsonValue& root, const Building& building, CutPlaces cuts)
      : root_(root), building_(building), names_(building), cuts_(std::move(cuts)) {}

  Scenario read() {
    scenario_.combination = read_combination();
    take(root_, "title", scenario_.title, [](const JsonValue& v) { return std::string(v.text()); });
    take(root_, "step", scenario_.step, in(ranges::step));
    take(root_, "duration", scenario_.duration, in(ranges::duration));
    take(root_, "until_rest", scenario_.until_rest, boolean);
    take(root_, "seed", scenario_.seed,
         [](const JsonValue& v) { return static_cast<std::uint64_t>(v.whole(0, std::int64_t{1} << 53)); });
    take(root_, "ground", scenario_.ground, in(ranges::place));
    take(root_, "standing", scenario_.standing, [](const JsonValue& v) {
      const std::string_view rule = v.text("\"static\" or \"dynamic\"");
      if (rule != "static" && rule != "dynamic") v.refuse("\"static\" or \"dynamic\"");
      return rule == "dynamic" ? StandingRule::dynamics : StandingRule::statics;
    });
    if (const auto dynamics = root_.find("dynamics")) read_dynamics(*dynamics);
    if (const auto failure = root_.find("failure")) read_failure(*failure);
    if (const auto impact = root_.find("impact")) read_impact(*impact);
    if (const auto debris = root_.find("debris")) read_debris(*debris);
    if (const auto fracture = root_.find("fracture")) scenario_.fracture = read_fracture(*fracture);
    if (const auto events = root_.find("events")) read_events(*events);
    return std::move(scenario_);
  }

  Tool read_tool(const JsonValue& value) const {
    const std::string_view key = value.key();
    if (key == "gravity") return GravityTool{vector_within(value, ranges::gravity, "m/s2")};
    value.expect_object();
    if (key == "projectile") return read_projectile(value);
    if (key == "cut") return read_cut(value);
    if (key == "remove") return read_remove(value);
    if (key == "charge") return read_charge(value);
    if (key == "weaken") return read_weaken(value);
    if (key == "wrecking_ball") return read_wrecking_ball(value);
    value.only({"nodes"});
    LoadTool load;
    for (const JsonValue entry : value.require("nodes")) {
      const auto node = names_.node(std::string(entry.key()));
      if (!node) entry.fail("there is no node " + in_quotes(entry.key()) + "; accepted: a node of the model");
      for (const JsonValue component : entry) (void)component.in(ranges::force);
      load.nodes.push_back({*node, read_components(entry, [](int) { return 1.0; })});
    }
    return load;
  }

 private:
  CombinationId read_combination() const {
    const auto& combinations = building_.combinations;
    std::vector<std::string_view> accepted;
    for (const Combination& combination : combinations) accepted.push_back(combination.name);
    const auto value = root_.find("combination");
    if (!value) {
      if (combinations.size() == 1) return CombinationId(0);
      root_.fail("the key \"combination\" is missing and the model has several; accepted: " + quoted_list(accepted));
    }
    const std::string_view name = value->text("the name of a combination");
    for (std::size_t i = 0; i < combinations.size(); ++i)
      if (combinations[i].name == name) return CombinationId(i);
    value->fail("there is no combination " + in_quotes(name) + "; accepted: " + quoted_list(accepted));
  }

  void read_dynamics(const JsonValue& dynamics) {
    if (scenario_.standing == StandingRule::statics)
      dynamics.fail("what stands does not move in time with \"standing\": \"static\"; accepted: one of the two");
    dynamics.only({"substeps", "damping", "spectral_radius"});
    MotionRules& rules = scenario_.motion;
    take(dynamics, "substeps", rules.substeps,
         [](const JsonValue& v) { return static_cast<int>(v.whole(1, most_substeps)); });
    take(dynamics, "damping", rules.damping, in(ranges::unit));
    take(dynamics, "spectral_radius", rules.spectral_radius, in(ranges::unit));
  }

  void read_failure(const JsonValue& failure) {
    if (const auto quota = failure.find("generations_per_second"))
      quota->fail("nothing limits what may break in a step any more: " + std::string(pace_is_the_hosts));
    failure.only({"bracing", "mechanism", "second_order", "sudden"});
    FailureRules& rules = scenario_.failure;
    take(failure, "bracing", rules.bracing, [](const JsonValue& v) {
      const std::string_view rule = v.text("\"buckling\", \"classic\" or \"none\"");
      if (rule == "buckling") return BracingRule::buckling;
      if (rule == "classic") return BracingRule::classic;
      if (rule != "none") v.refuse("\"buckling\", \"classic\" or \"none\"");
      return BracingRule::none;
    });
    take(failure, "mechanism", rules.mechanism, [](const JsonValue& v) {
      const std::string_view rule = v.text("\"hinge\" or \"detach\"");
      if (rule != "hinge" && rule != "detach") v.refuse("\"hinge\" or \"detach\"");
      return rule == "hinge" ? MechanismRule::hinge : MechanismRule::detach;
    });
    take(failure, "second_order", rules.second_order, boolean);
    if (const auto sudden = failure.find("sudden"); sudden && scenario_.standing == StandingRule::dynamics)
      sudden->fail(
          "a factor of sudden losses acts with \"standing\": \"static\" alone: what moves overshoots by itself");
    take(failure, "sudden", rules.sudden, in(ranges::sudden));
  }

  void read_impact(const JsonValue& impact) {
    impact.only({"restitution", "structure_mass"});
    take(impact, "restitution", scenario_.impact.restitution, in(ranges::unit));
    take(impact, "structure_mass", scenario_.impact.structure_mass, boolean);
  }

  void read_debris(const JsonValue& debris) {
    debris.only({"friction", "restitution", "limit", "smallest_volume"});
    take(debris, "friction", scenario_.debris.friction, in(ranges::friction));
    take(debris, "restitution", scenario_.debris.restitution, in(ranges::unit));
    take(debris, "limit", scenario_.debris.limit, [](const JsonValue& v) -> std::optional<int> {
      if (v.is_null()) return std::nullopt;
      if (!v.is_number()) v.refuse("a whole number from 0 to 1000000, or null for none");
      return static_cast<int>(v.whole(0, 1'000'000));
    });
    take(debris, "smallest_volume", scenario_.debris.smallest_volume, in(ranges::volume));
  }

  void read_events(const JsonValue& events) {
    if (!events.is_array()) events.refuse("an array of events");
    for (const JsonValue value : events) {
      value.expect_object();
      value.only({"at", "projectile", "cut", "remove", "charge", "weaken", "wrecking_ball", "gravity", "load"});
      Event event;
      event.at = value.require("at").in(ranges::instant);
      if (value.size() != 2)
        value.fail("found " + std::to_string(value.size() - 1) +
                   " tools; accepted: `at` and one of \"projectile\", \"cut\", \"remove\", \"charge\", \"weaken\", "
                   "\"wrecking_ball\", \"gravity\", \"load\"");
      for (const JsonValue tool : value)
        if (tool.key() != "at") event.tool = read_tool(tool);
      scenario_.events.push_back(std::move(event));
    }
    std::stable_sort(scenario_.events.begin(), scenario_.events.end(),
                     [](const Event& a, const Event& b) { return a.at < b.at; });
  }

  static Projectile read_projectile(const JsonValue& value) {
    value.only({"from", "velocity", "mass", "radius"});
    Projectile projectile;
    projectile.from = place(value.require("from"));
    projectile.velocity = vector_within(value.require("velocity"), ranges::speed, "m/s");
    take(value, "mass", projectile.mass, in(ranges::mass));
    take(value, "radius", projectile.radius, in(ranges::radius));
    return projectile;
  }

  static WreckingBall read_wrecking_ball(const JsonValue& value) {
    value.only({"anchor", "cable", "from", "mass", "radius"});
    WreckingBall ball;
    ball.anchor = place(value.require("anchor"));
    ball.from = place(value.require("from"));
    ball.cable = value.require("cable").in(ranges::length);
    take(value, "mass", ball.mass, in(ranges::mass));
    take(value, "radius", ball.radius, in(ranges::radius));
    const double away = (ball.from - ball.anchor).norm();
    if (away > ball.cable)
      value.require("cable").fail("the ball begins " + std::to_string(away) +
                                  " m from the anchor; accepted: a cable that reaches it");
    return ball;
  }

  CutTool read_cut(const JsonValue& value) const {
    value.only({"joints", "members"});
    CutTool cut;
    read_list(value, "joints", "joint", cut.joints,
              [&](const std::string& name) { return names_.joints_matching(name); });
    if (const auto members = value.find("members"))
      for (const JsonValue entry : *members)
        for (const MemberId id : names_.members_matching(std::string(entry.require("member").text()))) {
          const auto place = cuts_.find({building_[id].name, entry.require("where").number()});
          if (place != cuts_.end()) cut.joints.push_back(*names_.joint(place->second));
        }
    sort_unique(cut.joints);
    if (cut.joints.empty()) value.fail("nothing to cut; accepted: \"joints\" or \"members\" with at least one name");
    return cut;
  }

  RemoveTool read_remove(const JsonValue& value) const {
    value.only({"members", "panels", "supports", "groups"});
    RemoveTool remove;
    read_list(value, "members", "member", remove.members,
              [&](const std::string& name) { return all_pieces(names_.members_matching(name)); });
    read_list(value, "panels", "panel", remove.panels,
              [&](const std::string& name) { return names_.panels_matching(name); });
    read_list(value, "supports", "supported node", remove.supports,
              [&](const std::string& name) { return supported_nodes(name); });
    if (const auto groups = value.find("groups")) read_groups(*groups, remove.members, remove.panels);
    if (remove.members.empty() && remove.panels.empty() && remove.supports.empty())
      value.fail(
          "nothing to remove; accepted: \"members\", \"panels\", \"supports\", \"groups\" with at least one name");
    return remove;
  }

  /// With a member that is divided, its later pieces (divide_member.h).
  [[nodiscard]] std::vector<MemberId> all_pieces(std::vector<MemberId> members) const {
    const std::size_t given = members.size();
    for (std::size_t m = 0; m < given; ++m)
      for (int n = 2;; ++n) {
        const auto piece = names_.member(building_[members[m]].name + "/" + std::to_string(n));
        if (!piece || names_.node(building_[members[m]].name + "/cut-1") == std::nullopt) break;
        members.push_back(*piece);
      }
    return members;
  }

  std::vector<NodeId> supported_nodes(const std::string& pattern) const {
    std::vector<NodeId> found;
    for (const NodeSupport& support : building_.supports)
      if (matches_pattern(pattern, building_[support.node].name)) found.push_back(support.node);
    return found;
  }

  /// All members and panels of the groups, in order of id, beside those that are there.
  void read_groups(const JsonValue& groups, std::vector<MemberId>& members, std::vector<PanelId>& panels) const {
    for (const std::string& name : read_names(groups)) {
      const NameIndex::Group* group = names_.group(name);
      if (group == nullptr) groups.fail("there is no group " + in_quotes(name) + "; accepted: a group of the model");
      members.insert(members.end(), group->members.begin(), group->members.end());
      panels.insert(panels.end(), group->panels.begin(), group->panels.end());
    }
    sort_unique(members);
    sort_unique(panels);
  }

  WeakenTool read_weaken(const JsonValue& value) const {
    value.only({"groups", "members", "joints", "strength", "stiffness", "over", "stages"});
    WeakenTool weaken;
    std::vector<PanelId> panels;  // they lose strength alone
    if (const auto groups = value.find("groups")) read_groups(*groups, weaken.members, panels);
    read_list(value, "members", "member", weaken.members,
              [&](const std::string& name) { return all_pieces(names_.members_matching(name)); });
    read_list(value, "joints", "joint", weaken.joints,
              [&](const std::string& name) { return names_.joints_matching(name); });
    for (const MemberId member : weaken.members)
      for (int end = 0; end < 2; ++end) weaken.joints.push_back(building_.joint(member, end));
    for (const PanelId panel : panels)
      for (int edge = 0; edge < 4; ++edge) weaken.joints.push_back(building_.joint(panel, edge));
    sort_unique(weaken.joints);
    if (weaken.joints.empty())
      value.fail("nothing is named; accepted: \"groups\", \"members\" or \"joints\" with at least one name");
    if (!value.find("strength") && !value.find("stiffness"))
      value.fail("nothing weakens; accepted: \"strength\", \"stiffness\", or both");
    take(value, "strength", weaken.strength, in(ranges::strength_factor));
    take(value, "stiffness", weaken.stiffness, in(ranges::stiffness_factor));
    take(value, "over", weaken.over, in(ranges::instant));
    take(value, "stages", weaken.stages, [](const JsonValue& v) { return static_cast<int>(v.whole(1, 1'000'000)); });
    return weaken;
  }

  static ChargeTool read_charge(const JsonValue& value) {
    value.only({"centre", "radius", "strength"});
    ChargeTool charge;
    charge.centre = place(value.require("centre"));
    charge.radius = value.require("radius").in(ranges::length);
    if (const auto strength = value.find("strength")) {
      strength->expect_array(2, 2);
      auto number = strength->begin();
      charge.strength_at_centre = (*number).in(ranges::strength_factor);
      ++number;
      charge.strength_at_radius = (*number).in(ranges::strength_factor);
    }
    return charge;
  }

  /// Names and patterns at a key as ids in order, each once; what matches nothing is refused.
  template <class Id, class Match>
  static void read_list(const JsonValue& object, const char* key, const char* kind, std::vector<Id>& ids, Match match) {
    const auto list = object.find(key);
    if (!list) return;
    list->expect_array(0, ~std::size_t{0});
    for (const JsonValue name : *list) {
      const std::vector<Id> found = match(std::string(name.text("a name, or a pattern with *")));
      if (found.empty())
        name.fail(std::string("there is no ") + kind + " " + in_quotes(name.text()) +
                  "; accepted: a name or pattern of the model");
      ids.insert(ids.end(), found.begin(), found.end());
    }
    sort_unique(ids);
  }
  template <class Id>
  static void sort_unique(std::vector<Id>& ids) {
    std::sort(ids.begin(), ids.end());
    ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  }

  JsonValue root_;
  const Building& building_;
  NameIndex names_;
  CutPlaces cuts_;
  Scenario scenario_;
};

/// Nothing but what a scenario may hold.
void require_scenario(const JsonDocument& document) {
  const JsonValue root = document.root();
  if (!root.is_object()) root.refuse("an object");
  if (const auto budget = root.find("budget"))
    budget->fail("nothing limits what a step may compute any more: " + std::string(pace_is_the_hosts));
  root.only({"topple", "title", "model", "combination", "step", "duration", "until_rest", "seed", "ground", "standing",
             "dynamics", "failure", "impact", "debris", "fracture", "events"});
  const JsonValue version = root.require("topple");
  if (!version.is_number() || version.number() != 1) version.refuse("1, the version of the format");
}

std::pair<Building, Scenario> read_document(const JsonDocument& document, const std::filesystem::path& folder) {
  require_scenario(document);
  return read_scenario_document(document, read_model(model_of_scenario(document, folder), Purpose::demolish));
}

/// Cuts of a tool that no scenario foresaw: at the members' own joints alone.
CutPlaces cuts_at_ends(const JsonValue& tool, const NameIndex& names, const Building& building) {
  CutPlaces cuts;
  const auto members = tool.key() == "cut" && tool.is_object() ? tool.find("members") : std::nullopt;
  if (!members) return cuts;
  members->expect_array(0, ~std::size_t{0});
  for (const JsonValue entry : *members) {
    entry.only({"member", "where"});
    const JsonValue pattern = entry.require("member"), where = entry.require("where");
    const double place = where.number();
    if (place != 0 && place != 1)
      where.refuse("0 or 1; a member that the scenario cuts inside goes by its joint, \"NAME/cut-1:1\"");
    const auto found = names.members_matching(std::string(pattern.text("a member's name, or a pattern with *")));
    if (found.empty())
      pattern.fail("there is no member " + in_quotes(pattern.text()) + "; accepted: a name or pattern of the model");
    for (const MemberId id : found)
      cuts[{building[id].name, place}] = building[building.joint(id, place == 0 ? 0 : 1)].name;
  }
  return cuts;
}

Tool read_one_tool(const JsonDocument& document, const Building& building) {
  const JsonValue root = document.root();
  root.only({"projectile", "cut", "remove", "charge", "weaken", "wrecking_ball", "gravity", "load"});
  if (root.size() != 1) root.fail("found " + std::to_string(root.size()) + " tools; accepted: one");
  const JsonValue tool = *root.begin();
  return ScenarioReader(root, building, cuts_at_ends(tool, NameIndex(building), building)).read_tool(tool);
}

}  // namespace

std::filesystem::path model_of_scenario(const JsonDocument& document, const std::filesystem::path& folder) {
  const JsonValue model = document.root().require("model");
  const std::string name(model.text("a shipped model's name, or a path from the scenario's folder"));
  try {
    return find_model(name, folder);
  } catch (const InputError& error) {
    model.fail(error.what());
  }
}

std::pair<Building, Scenario> read_scenario_document(const JsonDocument& document, Building building) {
  require_scenario(document);
  const JsonValue root = document.root();
  CutPlaces cuts = divide_cut_members(root, building);
  Scenario scenario = ScenarioReader(root, building, std::move(cuts)).read();
  scenario.file = document.name();
  const auto model = root.find("model");
  scenario.model = model ? std::string(model->text()) : building.file;
  return {std::move(building), std::move(scenario)};
}

}  // namespace formats

std::pair<Building, Scenario> read_scenario(const std::filesystem::path& file) {
  return formats::read_document(formats::JsonDocument::from_file(file), file.parent_path());
}

std::pair<Building, Scenario> parse_scenario(std::string_view text, const std::string& name,
                                             const std::filesystem::path& folder) {
  return formats::read_document(formats::JsonDocument::from_text(text, name), folder);
}

std::pair<Building, Scenario> parse_scenario(std::string_view text, const std::string& name, Building building) {
  refuse_unbuilt(building, Purpose::demolish);
  return formats::read_scenario_document(formats::JsonDocument::from_text(text, name), std::move(building));
}

Tool parse_tool(std::string_view text, const std::string& name, const Building& building) {
  return formats::read_one_tool(formats::JsonDocument::from_text(text, name), building);
}

bool is_scenario(const std::filesystem::path& file) {
  if (file.extension() != ".json") return false;
  const auto document = formats::JsonDocument::from_file(file);
  return document.root().is_object() && document.root().find("model").has_value();
}

Scenario idle_scenario(const Building& building) {
  Scenario scenario;
  scenario.title = building.title;
  scenario.model = building.file;
  // The one that a building is demolished under, where there is a choice.
  scenario.combination = CombinationId(0);
  for (std::size_t i = 0; i < building.combinations.size(); ++i)
    if (building.combinations[i].name == "collapse") scenario.combination = CombinationId(i);
  return scenario;
}

}  // namespace topple::structure
