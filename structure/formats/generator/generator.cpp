// The building generator: a regular grid of post lines and levels becomes nodes, posts, beams, slabs and walls.
#include <set>

#include "formats/generator/generator_plan.h"
#include "formats/generator/plan_generator.h"
#include "formats/model_reader.h"
#include "model/index_of.h"

namespace topple::structure::formats {

namespace {

class Generator {
 public:
  Generator(const JsonValue& place, ModelDraft& draft)
      : place_(place), draft_(draft), plan_(read_building_plan(place, draft)) {}

  void run() {
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

  // Names and what is left out.

  static std::string numbered(const char* kind, int i, int j, int k) {
    return std::string(kind) + "-" + std::to_string(i) + "-" + std::to_string(j) + "-" + std::to_string(k);
  }
  std::string full_name(const std::string& name) const { return plan_.name.empty() ? name : plan_.name + "/" + name; }

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
    for (int k = 1; k <= plan_.storeys; ++k) {
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
    for (int i = 1; i <= plan_.nx; ++i)
      for (int j = 1; j <= plan_.ny; ++j) use(i, j);
  }
  template <class Use>
  void for_each_beam(int k, Use use) const {
    for (int i = 1; i < plan_.nx; ++i)
      for (int j = 1; j <= plan_.ny; ++j) use(numbered("BX", i, j, k), std::array{Cell{i, j, k}, Cell{i + 1, j, k}});
    for (int i = 1; i <= plan_.nx; ++i)
      for (int j = 1; j < plan_.ny; ++j) use(numbered("BY", i, j, k), std::array{Cell{i, j, k}, Cell{i, j + 1, k}});
  }
  template <class Use>
  void for_each_slab(int k, Use use) const {
    if (!plan_.slab[static_cast<std::size_t>(k)]) return;
    for (int i = 1; i < plan_.nx; ++i)
      for (int j = 1; j < plan_.ny; ++j)
        use(numbered("S", i, j, k),
            std::array{Cell{i, j, k}, Cell{i + 1, j, k}, Cell{i + 1, j + 1, k}, Cell{i, j + 1, k}});
  }
  /// Corners go round so that the normal points outwards, on inner lines towards +x or +y; the first two are at the
  /// foot.
  template <class Use>
  void for_each_wall(int k, Use use) const {
    const auto& rule = plan_.wall[static_cast<std::size_t>(k)];
    if (!rule) return;
    const auto wall = [&](const std::string& name, Cell a, Cell b) {
      use(name, std::array{a, b, Cell{b.i, b.j, k}, Cell{a.i, a.j, k}});
    };
    for (const std::string& side : rule->sides) {
      const bool low = side.back() == '-', high = side.back() == '+';
      if (side[0] == 'y') {
        const int j = low ? 1 : high ? plan_.ny : plan_.inner_line(side);
        for (int i = 1; i < plan_.nx; ++i) {
          const Cell near{i, j, k - 1}, far{i + 1, j, k - 1};
          low ? wall(numbered("WX", i, j, k), near, far) : wall(numbered("WX", i, j, k), far, near);
        }
      } else {
        const int i = low ? 1 : high ? plan_.nx : plan_.inner_line(side);
        for (int j = 1; j < plan_.ny; ++j) {
          const Cell near{i, j, k - 1}, far{i, j + 1, k - 1};
          low ? wall(numbered("WY", i, j, k), far, near) : wall(numbered("WY", i, j, k), near, far);
        }
      }
    }
  }

  // Building it.

  std::size_t slot(const Cell& c) const {
    return (static_cast<std::size_t>(c.k) * static_cast<std::size_t>(plan_.nx) + static_cast<std::size_t>(c.i - 1)) *
               static_cast<std::size_t>(plan_.ny) +
           static_cast<std::size_t>(c.j - 1);
  }
  NodeId at(const Cell& c) const { return nodes_[slot(c)]; }

  /// A node is there when anything that is built is attached to it.
  void decide_nodes() {
    wanted_.assign(static_cast<std::size_t>(plan_.nx) * static_cast<std::size_t>(plan_.ny) *
                       static_cast<std::size_t>(plan_.storeys + 1),
                   omitted_.empty());
    if (omitted_.empty()) return;
    for_each_part([&](const std::string& name, const auto& corners) {
      if (built(name))
        for (const Cell& corner : corners) wanted_[slot(corner)] = true;
    });
  }

  void add_nodes() {
    nodes_.resize(wanted_.size());
    for (int k = 0; k <= plan_.storeys; ++k)
      for_each_post(k, [&](int i, int j) {
        if (!wanted_[slot({i, j, k})]) return;
        const Vec3 position(plan_.x[static_cast<std::size_t>(i - 1)], plan_.y[static_cast<std::size_t>(j - 1)],
                            plan_.z[static_cast<std::size_t>(k)]);
        nodes_[slot({i, j, k})] = draft_.add_node(full_name(numbered("N", i, j, k)), position, place_);
      });
  }

  std::vector<std::string> groups(std::vector<std::string> own, int k) const {
    own.push_back("storey-" + std::to_string(k));
    if (!plan_.name.empty()) own.push_back(plan_.name);
    return own;
  }

  void add_member(const MemberDraft& rule, const JsonValue& place, const std::string& name,
                  const std::array<Cell, 2>& ends, int k) {
    if (!built(name)) return;
    MemberDraft member = rule;
    member.name = full_name(name);
    member.nodes = {at(ends[0]), at(ends[1])};
    member.groups = groups(std::move(member.groups), k);
    draft_.add_member(member, place);
  }

  void add_panel(const PanelRule& rule, const JsonValue& place, const std::string& name,
                 const std::array<Cell, 4>& corners, int k) {
    if (!built(name)) return;
    PanelDraft panel = rule.draft;
    panel.panel.name = full_name(name);
    for (std::size_t n = 0; n < 4; ++n) panel.panel.nodes[n] = at(corners[n]);
    panel.panel.groups = groups(std::move(panel.panel.groups), k);
    const PanelId id = draft_.add_panel(panel, place);
    for (const auto& [load_case, pressure] : rule.pressures)
      draft_.building.cases[index_of(load_case)].panels.push_back({id, pressure, 0});
  }

  void add_posts() {
    for (int k = 1; k <= plan_.storeys; ++k) {
      const auto storey = static_cast<std::size_t>(k);
      for_each_post(k, [&](int i, int j) {
        add_member(*plan_.post[storey], *plan_.post_value[storey], numbered("P", i, j, k),
                   {Cell{i, j, k - 1}, Cell{i, j, k}}, k);
      });
    }
  }
  void add_beams() {
    for (int k = 1; k <= plan_.storeys; ++k) {
      const auto storey = static_cast<std::size_t>(k);
      for_each_beam(k, [&](const std::string& name, const std::array<Cell, 2>& ends) {
        add_member(*plan_.beam[storey], *plan_.beam_value[storey], name, ends, k);
      });
    }
  }
  void add_slabs() {
    for (int k = 1; k <= plan_.storeys; ++k) {
      const auto storey = static_cast<std::size_t>(k);
      for_each_slab(k, [&](const std::string& name, const std::array<Cell, 4>& corners) {
        add_panel(*plan_.slab[storey], *plan_.slab_value[storey], name, corners, k);
      });
    }
  }
  void add_walls() {
    for (int k = 1; k <= plan_.storeys; ++k) {
      const auto storey = static_cast<std::size_t>(k);
      for_each_wall(k, [&](const std::string& name, const std::array<Cell, 4>& corners) {
        add_panel(*plan_.wall[storey], *plan_.wall_value[storey], name, corners, k);
      });
    }
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
  BuildingPlan plan_;
  std::vector<std::pair<std::string, bool>> patterns_;  // omit, and whether it matched
  std::set<std::string> omitted_;
  std::vector<bool> wanted_;
  std::vector<NodeId> nodes_;  // by slot(); not valid: nothing is attached there
};

}  // namespace

void generate_buildings(const JsonValue& root, ModelDraft& draft) {
  const auto generate = [&](const JsonValue& building) {
    if (building.is_object() && building.find("places"))
      generate_from_plan(building, draft);
    else
      Generator(building, draft).run();
  };
  if (const auto building = root.find("building")) generate(*building);
  if (const auto buildings = root.find("buildings")) {
    buildings->expect_array(1, ~std::size_t{0});
    for (const JsonValue building : *buildings) generate(building);
  }
}

}  // namespace topple::structure::formats
