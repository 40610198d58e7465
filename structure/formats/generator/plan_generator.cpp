#include "formats/generator/plan_generator.h"

#include <algorithm>
#include <map>
#include <set>

#include "formats/model_reader.h"
#include "model/index_of.h"

namespace topple::structure::formats {

namespace {

class PlanGenerator {
 public:
  PlanGenerator(const JsonValue& place, ModelDraft& draft) : place_(place), draft_(draft) {}

  void run() {
    place_.only({"name", "origin", "places", "storeys", "storey_height", "post", "beam", "base"});
    read_name();
    read_places();
    read_levels();
    for_each_rule("post", [&](const JsonValue& rule) { read_posts(rule); });
    for_each_rule("beam", [&](const JsonValue& rule) { read_beams(rule); });
    add_base();
  }

 private:
  struct Point {
    std::string name;
    double x = 0, y = 0;
  };
  struct Storeys {
    int first = 1, last = 1;
  };

  void read_name() {
    const auto name = place_.find("name");
    if (!name) return;
    name_ = name->text("a name");
    if (name_.empty() || name_.find('*') != std::string::npos) name->refuse("a name that is not empty and holds no *");
  }

  void read_places() {
    if (const auto origin = place_.find("origin")) origin_ = read_point(*origin, draft_.scale.length);
    const JsonValue places = place_.require("places");
    places.expect_object();
    for (const JsonValue entry : places) {
      entry.expect_array(2, 2);
      auto number = entry.begin();
      Point point;
      point.name = entry.key();
      if (point.name.empty() || point.name.find('*') != std::string::npos)
        entry.fail("a place's name is empty or holds a *; accepted: another name");
      point.x = origin_.x() + scaled(*number, draft_.scale.length);
      ++number;
      point.y = origin_.y() + scaled(*number, draft_.scale.length);
      index_.emplace(point.name, points_.size());
      points_.push_back(std::move(point));
    }
    if (points_.empty()) places.fail("no places; accepted: at least one, as name: [x, y]");
  }

  void read_levels() {
    storeys_ = static_cast<int>(place_.require("storeys").whole(1, most_storeys));
    // A node, a post and two beams at each place on each storey.
    draft_.require_room(place_.require("storeys"), 4.0 * static_cast<double>(points_.size()) * storeys_);
    const JsonValue height = place_.require("storey_height");
    levels_ = {origin_.z()};
    if (height.is_array()) {
      height.expect_array(static_cast<std::size_t>(storeys_), static_cast<std::size_t>(storeys_));
      for (const JsonValue one : height) {
        (void)one.positive();
        levels_.push_back(levels_.back() + scaled(one, draft_.scale.length));
      }
    } else {
      (void)height.positive();
      for (int k = 1; k <= storeys_; ++k) levels_.push_back(origin_.z() + k * scaled(height, draft_.scale.length));
    }
    nodes_.assign(points_.size() * levels_.size(), NodeId());
  }

  template <class Read>
  void for_each_rule(const char* key, Read read) const {
    const JsonValue rules = place_.require(key);
    if (!rules.is_array()) return read(rules);
    for (const JsonValue rule : rules) read(rule);
  }

  [[nodiscard]] Storeys read_storeys(const JsonValue& rule) const {
    Storeys storeys{1, storeys_};
    if (const auto given = rule.find("storeys")) {
      given->expect_array(2, 2);
      auto bound = given->begin();
      storeys.first = static_cast<int>((*bound).whole(1, storeys_));
      ++bound;
      storeys.last = static_cast<int>((*bound).whole(storeys.first, storeys_));
    }
    return storeys;
  }

  [[nodiscard]] MemberDraft read_member(const JsonValue& rule, MemberKind kind) const {
    MemberDraft draft;
    draft.kind = kind;
    draft.section = draft_.section(rule.require("section"));
    draft.material = draft_.material(rule.require("material"));
    if (const auto joint = rule.find("joint")) draft.joints[0] = draft_.joint_type(*joint);
    // A post's top end belongs to its node for good; a beam is jointed at both ends.
    if (kind == MemberKind::beam) draft.joints[1] = draft.joints[0];
    if (const auto groups = rule.find("groups")) draft.groups = read_names(*groups);
    if (const auto design = rule.find("design")) draft.design = read_member_design(*design, draft_.scale);
    return draft;
  }

  void read_posts(const JsonValue& rule) {
    rule.only({"places", "storeys", "section", "material", "joint", "groups", "design"});
    const MemberDraft draft = read_member(rule, MemberKind::post);
    const Storeys storeys = read_storeys(rule);
    std::set<std::size_t> chosen;
    const auto places = rule.find("places");
    if (!places)
      for (std::size_t p = 0; p < points_.size(); ++p) chosen.insert(p);
    else
      for (const JsonValue pattern : *places) {
        const std::string_view text = pattern.text("the name of a place, or a pattern with *");
        const std::size_t before = chosen.size();
        for (std::size_t p = 0; p < points_.size(); ++p)
          if (matches_pattern(text, points_[p].name)) chosen.insert(p);
        if (chosen.size() == before) pattern.fail("no further place is named like " + in_quotes(text));
      }
    for (int k = storeys.first; k <= storeys.last; ++k)
      for (const std::size_t p : chosen) add(draft, "P-" + points_[p].name, {p, p}, {k - 1, k}, k, rule);
  }

  void read_beams(const JsonValue& rule) {
    rule.only({"between", "storeys", "section", "material", "joint", "groups", "load", "design"});
    const MemberDraft draft = read_member(rule, MemberKind::beam);
    const Storeys storeys = read_storeys(rule);
    std::vector<std::pair<LoadCaseId, double>> loads;
    if (const auto load = rule.find("load")) {
      load->expect_object();
      for (const JsonValue entry : *load)
        loads.emplace_back(draft_.case_of_key(entry), scaled(entry, draft_.scale.force / draft_.scale.length));
    }
    for (const JsonValue line : rule.require("between")) {
      // Two places or more: one beam from each to the next.
      line.expect_array(2, ~std::size_t{0});
      std::vector<std::size_t> along;
      for (const JsonValue name : line) {
        const auto found = index_.find(std::string(name.text("the name of a place")));
        if (found == index_.end())
          name.fail("there is no place " + in_quotes(name.text()) + "; accepted: one of `places`");
        along.push_back(found->second);
      }
      for (std::size_t n = 0; n + 1 < along.size(); ++n)
        for (int k = storeys.first; k <= storeys.last; ++k) {
          const std::string name = "B-" + points_[along[n]].name + "-" + points_[along[n + 1]].name;
          const MemberId id = add(draft, name, {along[n], along[n + 1]}, {k, k}, k, rule);
          for (const auto& [load_case, weight] : loads) add_weight(id, load_case, weight);
        }
    }
  }

  void add_weight(MemberId id, LoadCaseId load_case, double weight) {
    MemberLoad load;
    load.member = id;
    load.to = draft_.building[id].length;
    load.first(2) = load.last(2) = -weight;
    draft_.building.cases[index_of(load_case)].members.push_back(load);
  }

  MemberId add(const MemberDraft& rule, const std::string& name, std::array<std::size_t, 2> points,
               std::array<int, 2> levels, int k, const JsonValue& place) {
    MemberDraft member = rule;
    member.name = full_name(name + "-" + std::to_string(k));
    for (std::size_t end = 0; end < 2; ++end) member.nodes[end] = node(points[end], levels[end]);
    member.groups.push_back("storey-" + std::to_string(k));
    if (!name_.empty()) member.groups.push_back(name_);
    return draft_.add_member(member, place);
  }

  /// A node is there when anything is attached to it.
  NodeId node(std::size_t point, int level) {
    NodeId& id = nodes_[static_cast<std::size_t>(level) * points_.size() + point];
    if (!id.valid())
      id = draft_.add_node(full_name("N-" + points_[point].name + "-" + std::to_string(level)),
                           Vec3(points_[point].x, points_[point].y, levels_[static_cast<std::size_t>(level)]), place_);
    return id;
  }

  void add_base() {
    Vec6 stiffness = Vec6::Constant(unlimited);
    const auto base = place_.find("base");
    if (base) stiffness = read_support(*base, draft_.scale);
    for (std::size_t p = 0; p < points_.size(); ++p)
      if (nodes_[p].valid()) draft_.add_support({nodes_[p], stiffness}, base.value_or(place_));
  }

  [[nodiscard]] std::string full_name(const std::string& name) const {
    return name_.empty() ? name : name_ + "/" + name;
  }

  JsonValue place_;
  ModelDraft& draft_;
  std::string name_;
  Vec3 origin_ = Vec3::Zero();
  int storeys_ = 0;
  std::vector<Point> points_;
  std::map<std::string, std::size_t> index_;
  std::vector<double> levels_;
  std::vector<NodeId> nodes_;  ///< by level, then place; not valid: nothing is attached there
};

}  // namespace

void generate_from_plan(const JsonValue& place, ModelDraft& draft) { PlanGenerator(place, draft).run(); }

}  // namespace topple::structure::formats
