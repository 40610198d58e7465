// The building generator: a regular grid of post lines and levels becomes nodes, posts, beams, slabs and walls.
#include <algorithm>
#include <set>

#include "formats/model_reader.h"
#include "formats/unbuilt.h"

namespace topple::structure::formats {

namespace {

constexpr std::int64_t most_lines = 10'000, most_storeys = 10'000, most_posts = 5'000'000;

/// What one `post` or `beam` object says.
struct MemberRule {
  MemberDraft draft;
};
/// What one `slab` or `wall` object says.
struct PanelRule {
  PanelDraft draft;
  std::vector<std::pair<LoadCaseId, double>> pressures;
  std::vector<std::string> sides;  ///< walls
};

/// Rules by storey, 1 to storeys; none: nothing of that kind is built there.
template <class Rule>
using ByStorey = std::vector<std::optional<Rule>>;

class Generator {
 public:
  Generator(const JsonValue& place, ModelDraft& draft) : place_(place), draft_(draft) {}

  void run() {
    place_.only(
        {"name", "origin", "posts", "storeys", "bay", "storey_height", "post", "beam", "slab", "wall", "omit", "base"});
    read_grid();
    read_rules();
    read_omitted();
    decide_nodes();
    add_nodes();
    add_posts();
    add_beams();
    add_slabs();
    add_walls();
    add_base();
  }

 private:
  struct Cell {
    int i, j, k;
  };

  // The grid. Lines are counted from 1, levels from 0.

  void read_grid() {
    if (const auto name = place_.find("name")) {
      name_ = name->text("a name");
      if (name_.empty() || name_.find('*') != std::string::npos)
        name->refuse("a name that is not empty and holds no *");
    }
    if (const auto origin = place_.find("origin")) origin_ = read_point(*origin, draft_.scale.length);
    const JsonValue posts = place_.require("posts");
    posts.expect_array(2, 2);
    auto count = posts.begin();
    nx_ = static_cast<int>((*count).whole(1, most_lines));
    ++count;
    ny_ = static_cast<int>((*count).whole(1, most_lines));
    storeys_ = static_cast<int>(place_.require("storeys").whole(1, most_storeys));
    if (std::int64_t{nx_} * ny_ * storeys_ > most_posts)
      posts.fail("more than " + std::to_string(most_posts) + " posts; accepted: at most so many");
    const JsonValue bay = place_.require("bay");
    if (!bay.is_array()) bay.refuse("an array of two: bays along x and along y");
    bay.expect_array(2, 2);
    auto bays = bay.begin();
    x_ = read_lines(*bays, nx_ - 1, origin_.x());
    ++bays;
    y_ = read_lines(*bays, ny_ - 1, origin_.y());
    z_ = read_lines(place_.require("storey_height"), storeys_, origin_.z());
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
    post_ = read_by_storey<MemberRule>("post", true,
                                       [&](const JsonValue& v) { return read_member_rule(v, MemberKind::post); });
    beam_ = read_by_storey<MemberRule>("beam", true,
                                       [&](const JsonValue& v) { return read_member_rule(v, MemberKind::beam); });
    slab_ = read_by_storey<PanelRule>("slab", false,
                                      [&](const JsonValue& v) { return read_panel_rule(v, PanelKind::slab); });
    wall_ = read_by_storey<PanelRule>("wall", false,
                                      [&](const JsonValue& v) { return read_panel_rule(v, PanelKind::wall); });
  }

  template <class Rule, class Read>
  ByStorey<Rule> read_by_storey(const char* key, bool everywhere, Read read) const {
    ByStorey<Rule> rules(static_cast<std::size_t>(storeys_) + 1);
    const auto value = everywhere ? place_.require(key) : place_.find(key).value_or(place_);
    if (!everywhere && !place_.find(key)) return rules;
    const auto take = [&](const JsonValue& object) {
      object.expect_object();
      std::int64_t first = 1, last = storeys_;
      if (const auto storeys = object.find("storeys")) {
        storeys->expect_array(2, 2);
        auto bound = storeys->begin();
        first = (*bound).whole(1, storeys_);
        ++bound;
        last = (*bound).whole(first, storeys_);
      }
      const Rule rule = read(object);
      for (std::int64_t k = first; k <= last; ++k) {
        auto& slot = rules[static_cast<std::size_t>(k)];
        if (slot)
          object.fail("storey " + std::to_string(k) + " has a " + key + " already; accepted: one for each storey");
        slot = rule;
      }
    };
    if (value.is_array())
      for (const JsonValue object : value) take(object);
    else
      take(value);
    if (everywhere)
      for (int k = 1; k <= storeys_; ++k)
        if (!rules[static_cast<std::size_t>(k)])
          value.fail("storey " + std::to_string(k) + " has no " + key + "; accepted: one for each storey");
    return rules;
  }

  MemberRule read_member_rule(const JsonValue& value, MemberKind kind) const {
    value.only({"storeys", "section", "material", "joint", "groups"});
    MemberRule rule;
    rule.draft.kind = kind;
    rule.draft.section = draft_.section(value.require("section"));
    rule.draft.material = draft_.material(value.require("material"));
    if (const auto joint = value.find("joint")) {
      rule.draft.joints[0] = draft_.joint_type(*joint);
      // A post's top end belongs to its node for good; a beam is jointed at both ends.
      if (kind == MemberKind::beam) rule.draft.joints[1] = rule.draft.joints[0];
    }
    if (const auto groups = value.find("groups")) rule.draft.groups = read_names(*groups);
    return rule;
  }

  PanelRule read_panel_rule(const JsonValue& value, PanelKind kind) const {
    refuse_unbuilt_keys(value, UnbuiltPlace::panel);
    if (kind == PanelKind::wall)
      value.only({"storeys", "thickness", "material", "joint", "model", "span", "mesh", "openings", "pressure",
                  "groups", "sides"});
    else
      value.only(
          {"storeys", "thickness", "material", "joint", "model", "span", "mesh", "openings", "pressure", "groups"});
    PanelRule rule;
    Panel& panel = rule.draft.panel;
    panel.kind = kind;
    panel.model = kind == PanelKind::slab ? PanelModel::membrane : PanelModel::cladding;
    const JsonValue thickness = value.require("thickness");
    (void)thickness.positive();
    panel.thickness = scaled(thickness, draft_.scale.length);
    panel.material = draft_.material(value.require("material"));
    if (const auto joint = value.find("joint")) rule.draft.joint = draft_.joint_type(*joint);
    if (const auto model = value.find("model")) panel.model = read_panel_model(*model);
    if (const auto span = value.find("span")) panel.span = read_span(*span);
    if (const auto mesh = value.find("mesh")) panel.mesh = read_mesh(*mesh);
    if (const auto openings = value.find("openings")) panel.openings = read_openings(*openings, draft_.scale);
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
      if (!outer && inner_line(side) == 0)
        sides->fail("there is no side " + in_quotes(side) +
                    "; accepted: \"x-\", \"x+\", \"y-\", \"y+\", inner lines x2 to x" + std::to_string(nx_ - 1) +
                    " and y2 to y" + std::to_string(ny_ - 1));
      if (std::find(rule.sides.begin(), rule.sides.end(), side) != rule.sides.end())
        sides->fail("the side " + in_quotes(side) + " stands twice; accepted: each once");
      rule.sides.push_back(side);
    }
  }

  /// Number of an inner line such as "x2"; 0: it is none.
  int inner_line(const std::string& side) const {
    if (side.size() < 2 || side.size() > 6 || (side[0] != 'x' && side[0] != 'y') || side[1] == '0') return 0;
    if (!std::all_of(side.begin() + 1, side.end(), [](char c) { return c >= '0' && c <= '9'; })) return 0;
    const int line = std::stoi(side.substr(1));
    return line >= 2 && line <= (side[0] == 'x' ? nx_ : ny_) - 1 ? line : 0;
  }

  // Names and what is left out.

  static std::string numbered(const char* kind, int i, int j, int k) {
    return std::string(kind) + "-" + std::to_string(i) + "-" + std::to_string(j) + "-" + std::to_string(k);
  }
  std::string full_name(const std::string& name) const { return name_.empty() ? name : name_ + "/" + name; }

  void read_omitted() {
    const auto omit = place_.find("omit");
    if (!omit) return;
    omit->expect_array(0, ~std::size_t{0});
    for (const JsonValue pattern : *omit) patterns_.emplace_back(pattern.text("a name, or a pattern with *"), false);
    if (patterns_.empty()) return;
    for_each_part([&](const std::string& name, const auto&) {
      for (auto& [pattern, used] : patterns_)
        if (matches_pattern(pattern, name)) {
          omitted_.insert(name);
          used = true;
        }
    });
    std::size_t n = 0;
    for (const JsonValue pattern : *omit)
      if (!patterns_[n++].second)
        pattern.fail("nothing is named like " + in_quotes(pattern.text()) +
                     "; accepted: names of posts, beams, slabs or walls");
  }
  bool built(const std::string& name) const { return omitted_.empty() || omitted_.count(name) == 0; }

  /// Calls use(name, corners) for every part of the grid, those left out included.
  template <class Use>
  void for_each_part(Use use) const {
    for (int k = 1; k <= storeys_; ++k) {
      for_each_post(k, [&](int i, int j) {
        use(numbered("P", i, j, k), std::array{Cell{i, j, k - 1}, Cell{i, j, k}});
      });
      for_each_beam(k, use);
      for_each_slab(k, use);
      for_each_wall(k, use);
    }
  }
  template <class Use>
  void for_each_post(int, Use use) const {
    for (int i = 1; i <= nx_; ++i)
      for (int j = 1; j <= ny_; ++j) use(i, j);
  }
  template <class Use>
  void for_each_beam(int k, Use use) const {
    for (int i = 1; i < nx_; ++i)
      for (int j = 1; j <= ny_; ++j) use(numbered("BX", i, j, k), std::array{Cell{i, j, k}, Cell{i + 1, j, k}});
    for (int i = 1; i <= nx_; ++i)
      for (int j = 1; j < ny_; ++j) use(numbered("BY", i, j, k), std::array{Cell{i, j, k}, Cell{i, j + 1, k}});
  }
  template <class Use>
  void for_each_slab(int k, Use use) const {
    if (!slab_[static_cast<std::size_t>(k)]) return;
    for (int i = 1; i < nx_; ++i)
      for (int j = 1; j < ny_; ++j)
        use(numbered("S", i, j, k),
            std::array{Cell{i, j, k}, Cell{i + 1, j, k}, Cell{i + 1, j + 1, k}, Cell{i, j + 1, k}});
  }
  /// Corners go round so that the normal points outwards, on inner lines towards +x or +y; the first two are at the
  /// foot.
  template <class Use>
  void for_each_wall(int k, Use use) const {
    const auto& rule = wall_[static_cast<std::size_t>(k)];
    if (!rule) return;
    const auto wall = [&](const std::string& name, Cell a, Cell b) {
      use(name, std::array{a, b, Cell{b.i, b.j, k}, Cell{a.i, a.j, k}});
    };
    for (const std::string& side : rule->sides) {
      const bool low = side.back() == '-', high = side.back() == '+';
      if (side[0] == 'y') {
        const int j = low ? 1 : high ? ny_ : inner_line(side);
        for (int i = 1; i < nx_; ++i) {
          const Cell near{i, j, k - 1}, far{i + 1, j, k - 1};
          low ? wall(numbered("WX", i, j, k), near, far) : wall(numbered("WX", i, j, k), far, near);
        }
      } else {
        const int i = low ? 1 : high ? nx_ : inner_line(side);
        for (int j = 1; j < ny_; ++j) {
          const Cell near{i, j, k - 1}, far{i, j + 1, k - 1};
          low ? wall(numbered("WY", i, j, k), far, near) : wall(numbered("WY", i, j, k), near, far);
        }
      }
    }
  }

  // Building it.

  std::size_t slot(const Cell& c) const {
    return (static_cast<std::size_t>(c.k) * static_cast<std::size_t>(nx_) + static_cast<std::size_t>(c.i - 1)) *
               static_cast<std::size_t>(ny_) +
           static_cast<std::size_t>(c.j - 1);
  }
  NodeId at(const Cell& c) const { return nodes_[slot(c)]; }

  /// A node is there when anything that is built is attached to it.
  void decide_nodes() {
    wanted_.assign(
        static_cast<std::size_t>(nx_) * static_cast<std::size_t>(ny_) * static_cast<std::size_t>(storeys_ + 1),
        omitted_.empty());
    if (omitted_.empty()) return;
    for_each_part([&](const std::string& name, const auto& corners) {
      if (built(name))
        for (const Cell& corner : corners) wanted_[slot(corner)] = true;
    });
  }

  void add_nodes() {
    nodes_.resize(wanted_.size());
    for (int k = 0; k <= storeys_; ++k)
      for_each_post(k, [&](int i, int j) {
        if (!wanted_[slot({i, j, k})]) return;
        const Vec3 position(x_[static_cast<std::size_t>(i - 1)], y_[static_cast<std::size_t>(j - 1)],
                            z_[static_cast<std::size_t>(k)]);
        nodes_[slot({i, j, k})] = draft_.add_node(full_name(numbered("N", i, j, k)), position, place_);
      });
  }

  std::vector<std::string> groups(std::vector<std::string> own, int k) const {
    own.push_back("storey-" + std::to_string(k));
    if (!name_.empty()) own.push_back(name_);
    return own;
  }

  void add_member(const MemberRule& rule, const std::string& name, const std::array<Cell, 2>& ends, int k) {
    if (!built(name)) return;
    MemberDraft member = rule.draft;
    member.name = full_name(name);
    member.nodes = {at(ends[0]), at(ends[1])};
    member.groups = groups(std::move(member.groups), k);
    draft_.add_member(member, place_.require(member.kind == MemberKind::post ? "post" : "beam"));
  }

  void add_panel(const PanelRule& rule, const std::string& name, const std::array<Cell, 4>& corners, int k) {
    if (!built(name)) return;
    PanelDraft panel = rule.draft;
    panel.panel.name = full_name(name);
    for (std::size_t n = 0; n < 4; ++n) panel.panel.nodes[n] = at(corners[n]);
    panel.panel.groups = groups(std::move(panel.panel.groups), k);
    const PanelId id = draft_.add_panel(panel, place_.require(panel.panel.kind == PanelKind::slab ? "slab" : "wall"));
    for (const auto& [load_case, pressure] : rule.pressures)
      draft_.building.cases[static_cast<std::size_t>(load_case.index)].panels.push_back({id, pressure, 0});
  }

  void add_posts() {
    for (int k = 1; k <= storeys_; ++k)
      for_each_post(k, [&](int i, int j) {
        add_member(*post_[static_cast<std::size_t>(k)], numbered("P", i, j, k), {Cell{i, j, k - 1}, Cell{i, j, k}}, k);
      });
  }
  void add_beams() {
    for (int k = 1; k <= storeys_; ++k)
      for_each_beam(k, [&](const std::string& name, const std::array<Cell, 2>& ends) {
        add_member(*beam_[static_cast<std::size_t>(k)], name, ends, k);
      });
  }
  void add_slabs() {
    for (int k = 1; k <= storeys_; ++k)
      for_each_slab(k, [&](const std::string& name, const std::array<Cell, 4>& corners) {
        add_panel(*slab_[static_cast<std::size_t>(k)], name, corners, k);
      });
  }
  void add_walls() {
    for (int k = 1; k <= storeys_; ++k)
      for_each_wall(k, [&](const std::string& name, const std::array<Cell, 4>& corners) {
        add_panel(*wall_[static_cast<std::size_t>(k)], name, corners, k);
      });
  }

  void add_base() {
    Vec6 stiffness = Vec6::Constant(unlimited);
    const auto base = place_.find("base");
    if (base) stiffness = read_support(*base, draft_.scale);
    for_each_post(0, [&](int i, int j) {
      if (const NodeId node = at({i, j, 0}); node.valid()) draft_.add_support({node, stiffness}, base.value_or(place_));
    });
  }

  JsonValue place_;
  ModelDraft& draft_;
  std::string name_;
  Vec3 origin_ = Vec3::Zero();
  int nx_ = 0, ny_ = 0, storeys_ = 0;
  std::vector<double> x_, y_, z_;
  ByStorey<MemberRule> post_, beam_;
  ByStorey<PanelRule> slab_, wall_;
  std::vector<std::pair<std::string, bool>> patterns_;  // omit, and whether it matched
  std::set<std::string> omitted_;
  std::vector<bool> wanted_;
  std::vector<NodeId> nodes_;  // by slot(); not valid: nothing is attached there
};

}  // namespace

void generate_buildings(const JsonValue& root, ModelDraft& draft) {
  if (const auto building = root.find("building")) Generator(*building, draft).run();
  if (const auto buildings = root.find("buildings")) {
    buildings->expect_array(1, ~std::size_t{0});
    for (const JsonValue building : *buildings) Generator(building, draft).run();
  }
}

}  // namespace topple::structure::formats
