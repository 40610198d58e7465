#include "formats/read_tool.h"

#include <algorithm>

#include "formats/json/json_keys.h"

namespace topple::structure::formats {

namespace {

Vec3 read_position(const JsonValue& value) {
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

Projectile read_projectile(const JsonValue& value) {
  value.only({"from", "velocity", "mass", "radius"});
  Projectile projectile;
  projectile.from = read_position(value.require("from"));
  projectile.velocity = vector_within(value.require("velocity"), ranges::speed, "m/s");
  read_optional(value, "mass", projectile.mass, within(ranges::mass));
  read_optional(value, "radius", projectile.radius, within(ranges::radius));
  return projectile;
}

WreckingBall read_wrecking_ball(const JsonValue& value) {
  value.only({"anchor", "cable", "from", "mass", "radius"});
  WreckingBall ball;
  ball.anchor = read_position(value.require("anchor"));
  ball.from = read_position(value.require("from"));
  ball.cable = value.require("cable").in(ranges::length);
  read_optional(value, "mass", ball.mass, within(ranges::mass));
  read_optional(value, "radius", ball.radius, within(ranges::radius));
  const double away = (ball.from - ball.anchor).norm();
  if (away > ball.cable)
    value.require("cable").fail("the ball begins " + std::to_string(away) +
                                " m from the anchor; accepted: a cable that reaches it");
  return ball;
}

ChargeTool read_charge(const JsonValue& value) {
  value.only({"centre", "radius", "strength"});
  ChargeTool charge;
  charge.centre = read_position(value.require("centre"));
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

template <class Id>
void sort_unique(std::vector<Id>& ids) {
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
}

/// Names and patterns at a key as ids in order, each once; what matches nothing is refused.
template <class Id, class Match>
void read_list(const JsonValue& object, const char* key, const char* kind, std::vector<Id>& ids, Match match) {
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

}  // namespace

Tool ToolReader::read(const JsonValue& value) const {
  const std::string_view key = value.key();
  if (key == "gravity") return GravityTool{vector_within(value, ranges::gravity, "m/s2")};
  value.expect_object();
  if (key == "projectile") return read_projectile(value);
  if (key == "cut") return read_cut(value);
  if (key == "remove") return read_remove(value);
  if (key == "charge") return read_charge(value);
  if (key == "weaken") return read_weaken(value);
  if (key == "wrecking_ball") return read_wrecking_ball(value);
  return read_load(value);
}

LoadTool ToolReader::read_load(const JsonValue& value) const {
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

CutTool ToolReader::read_cut(const JsonValue& value) const {
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

RemoveTool ToolReader::read_remove(const JsonValue& value) const {
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
    value.fail("nothing to remove; accepted: \"members\", \"panels\", \"supports\", \"groups\" with at least one name");
  return remove;
}

/// With a member that is divided, its later pieces (divide_member.h).
std::vector<MemberId> ToolReader::all_pieces(std::vector<MemberId> members) const {
  const std::size_t given = members.size();
  for (std::size_t m = 0; m < given; ++m)
    for (int n = 2;; ++n) {
      const auto piece = names_.member(building_[members[m]].name + "/" + std::to_string(n));
      if (!piece || names_.node(building_[members[m]].name + "/cut-1") == std::nullopt) break;
      members.push_back(*piece);
    }
  return members;
}

std::vector<NodeId> ToolReader::supported_nodes(const std::string& pattern) const {
  std::vector<NodeId> found;
  for (const NodeSupport& support : building_.supports)
    if (matches_pattern(pattern, building_[support.node].name)) found.push_back(support.node);
  return found;
}

/// All members and panels of the groups, in order of id, beside those that are there.
void ToolReader::read_groups(const JsonValue& groups, std::vector<MemberId>& members,
                             std::vector<PanelId>& panels) const {
  for (const std::string& name : read_names(groups)) {
    const NameIndex::Group* group = names_.group(name);
    if (group == nullptr) groups.fail("there is no group " + in_quotes(name) + "; accepted: a group of the model");
    members.insert(members.end(), group->members.begin(), group->members.end());
    panels.insert(panels.end(), group->panels.begin(), group->panels.end());
  }
  sort_unique(members);
  sort_unique(panels);
}

WeakenTool ToolReader::read_weaken(const JsonValue& value) const {
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
  read_optional(value, "strength", weaken.strength, within(ranges::strength_factor));
  read_optional(value, "stiffness", weaken.stiffness, within(ranges::stiffness_factor));
  read_optional(value, "over", weaken.over, within(ranges::instant));
  read_optional(value, "stages", weaken.stages,
                [](const JsonValue& v) { return static_cast<int>(v.whole(1, 1'000'000)); });
  return weaken;
}

Tool read_one_tool(const JsonDocument& document, const Building& building) {
  const JsonValue root = document.root();
  root.only({"projectile", "cut", "remove", "charge", "weaken", "wrecking_ball", "gravity", "load"});
  if (root.size() != 1) root.fail("found " + std::to_string(root.size()) + " tools; accepted: one");
  const JsonValue tool = *root.begin();
  return ToolReader(building, cuts_at_ends(tool, NameIndex(building), building)).read(tool);
}

}  // namespace topple::structure::formats
