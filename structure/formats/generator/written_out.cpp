#include "formats/generator/written_out.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "formats/json/json_writer.h"
#include "formats/model_reader.h"

namespace topple::structure::formats {

namespace {

void copy(JsonWriter& to, const JsonValue& value) {
  if (value.is_object()) {
    to.open('{');
    for (const JsonValue entry : value) copy(to.key(entry.key()), entry);
    to.close('}');
  } else if (value.is_array()) {
    to.open('[');
    for (const JsonValue entry : value) copy(to, entry);
    to.close(']');
  } else if (value.is_number()) {
    to.value(value.number());
  } else if (value.is_bool()) {
    to.value(value.boolean());
  } else if (value.is_text()) {
    to.value(value.text());
  } else {
    to.raw_key("null").follow();
  }
}

/// The number that becomes `si` when it is read with this factor.
double in_file_units(double si, double factor) {
  const double near = si / factor;
  for (const double number : {near, std::nextafter(near, -HUGE_VAL), std::nextafter(near, HUGE_VAL)})
    if (number * factor == si) return number;
  return near;
}

class Writer {
 public:
  explicit Writer(const JsonDocument& model) : root_(model.root()) {
    draft_.building.file = model.name();
    draft_.keep_descriptions = true;
    read_units(root_, draft_);
    read_materials(root_, draft_);
    read_sections(root_, draft_);
    read_joint_types(root_, draft_);
    read_case_names(root_, draft_);
    generate_buildings(root_, draft_);
  }

  std::string write() {
    w_.open('{');
    for (const JsonValue value : root_) {
      const std::string_view key = value.key();
      if (key == "building" || key == "buildings" || written_here(key)) continue;
      copy(w_.newline().key(key), value);
    }
    parts("nodes", draft_.building.nodes, [this](std::size_t i) { node(i); });
    parts("members", draft_.building.members, [this](std::size_t i) { member(i); });
    parts("panels", draft_.building.panels, [this](std::size_t i) { panel(i); });
    supports();
    loads();
    w_.close('}');
    return w_.release() + "\n";
  }

 private:
  static bool written_here(std::string_view key) {
    return key == "nodes" || key == "members" || key == "panels" || key == "supports" || key == "loads";
  }

  /// What the generators made, then what the file lists.
  template <class Part, class Write>
  void parts(const char* key, const std::vector<Part>& made, Write write) {
    const auto listed = root_.find(key);
    if (made.empty() && !listed) return;
    w_.newline().key(key).open('{');
    for (std::size_t i = 0; i < made.size(); ++i) {
      w_.newline().key(made[i].name);
      write(i);
    }
    if (listed)
      for (const JsonValue value : *listed) copy(w_.newline().key(value.key()), value);
    w_.close('}');
  }

  [[nodiscard]] const std::string& name_of(NodeId node) const { return draft_.building[node].name; }

  void node(std::size_t i) {
    w_.open('[');
    for (const double x : draft_.building.nodes[i].position) w_.value(in_file_units(x, draft_.scale.length));
    w_.close(']');
  }

  void groups(const std::vector<std::string>& names) {
    w_.key("groups").open('[');
    for (const std::string& name : names) w_.value(name);
    w_.close(']');
  }

  /// Keys of a rule that mean the same in a part.
  void keys(const JsonValue& rule, std::initializer_list<std::string_view> names) {
    for (const JsonValue value : rule)
      if (std::find(names.begin(), names.end(), value.key()) != names.end()) copy(w_.key(value.key()), value);
  }

  void member(std::size_t i) {
    const Member& member = draft_.building.members[i];
    const JsonValue& rule = draft_.member_descriptions[i];
    const bool post = member.kind == MemberKind::post;
    w_.open('{').key("kind").value(post ? "post" : "beam").key("nodes").open('[');
    w_.value(name_of(member.nodes[0])).value(name_of(member.nodes[1])).close(']');
    keys(rule, {"section", "material", "design"});
    if (const auto joint = rule.find("joint"); joint && !joint->is_null()) {
      w_.key("joints").open('[').value(joint->text());
      post ? (void)w_.raw_key("null").follow() : (void)w_.value(joint->text());
      w_.close(']');
    }
    groups(member.groups);
    w_.close('}');
  }

  void panel(std::size_t i) {
    const Panel& panel = draft_.building.panels[i];
    w_.open('{').key("kind").value(panel.kind == PanelKind::slab ? "slab" : "wall").key("nodes").open('[');
    for (const NodeId node : panel.nodes) w_.value(name_of(node));
    w_.close(']');
    keys(draft_.panel_descriptions[i],
         {"thickness", "material", "joint", "model", "span", "mesh", "openings", "fracture"});
    groups(panel.groups);
    w_.close('}');
  }

  void supports() {
    const auto listed = root_.find("supports");
    const auto& made = draft_.building.supports;
    if (made.empty() && !listed) return;
    w_.newline().key("supports").open('{');
    for (const NodeSupport& support : made) {
      w_.newline().key(name_of(support.node)).open('{');
      for (int i = 0; i < 6; ++i) {
        const double stiffness = support.stiffness[i];
        if (stiffness == 0) continue;
        w_.key(component_names[static_cast<std::size_t>(i)]);
        if (stiffness == unlimited)
          w_.value(true);
        else
          w_.value(in_file_units(stiffness, draft_.scale.stiffness(i)));
      }
      w_.close('}');
    }
    if (listed)
      for (const JsonValue value : *listed) copy(w_.newline().key(value.key()), value);
    w_.close('}');
  }

  // Loads: those that rules bring are added to what a case has already.

  void loads() {
    const auto cases = root_.find("loads");
    if (!cases) return;
    w_.newline().key("loads").open('{');
    for (const JsonValue value : *cases) {
      w_.newline().key(value.key()).open('{');
      for (const JsonValue entry : value)
        if (entry.key() != "panels" && entry.key() != "members") copy(w_.key(entry.key()), entry);
      pressures(value);
      beam_weights(value);
      w_.close('}');
    }
    w_.close('}');
  }

  void pressures(const JsonValue& load_case) {
    std::map<std::string, double, std::less<>> brought;
    for (std::size_t i = 0; i < draft_.building.panels.size(); ++i)
      if (const auto rule = draft_.panel_descriptions[i].find("pressure"))
        if (const auto pressure = rule->find(load_case.key()))
          brought.emplace(draft_.building.panels[i].name, pressure->number());
    const auto listed = load_case.find("panels");
    if (brought.empty() && !listed) return;
    w_.key("panels").open('{');
    if (listed)
      for (const JsonValue panel : *listed) {
        w_.newline().key(panel.key()).open('{');
        double more = 0;
        if (const auto found = brought.find(panel.key()); found != brought.end()) {
          more = found->second;
          brought.erase(found);
          if (!panel.find("pressure")) w_.key("pressure").value(more);
        }
        for (const JsonValue load : panel)
          if (load.key() == "pressure")
            w_.key("pressure").value(load.number() + more);
          else
            copy(w_.key(load.key()), load);
        w_.close('}');
      }
    for (const auto& [name, pressure] : brought)
      w_.newline().key(name).open('{').key("pressure").value(pressure).close('}');
    w_.close('}');
  }

  void beam_weights(const JsonValue& load_case) {
    std::map<std::string, double, std::less<>> brought;
    for (std::size_t i = 0; i < draft_.building.members.size(); ++i)
      if (const auto rule = draft_.member_descriptions[i].find("load"))
        if (const auto weight = rule->find(load_case.key()))
          brought.emplace(draft_.building.members[i].name, weight->number());
    const auto listed = load_case.find("members");
    if (brought.empty() && !listed) return;
    const auto weigh = [&](double weight) {
      w_.open('{').key("uniform").open('{').key("z").value(-weight).close('}').close('}');
    };
    w_.key("members").open('{');
    if (listed)
      for (const JsonValue member : *listed) {
        w_.newline().key(member.key()).open('[');
        if (const auto found = brought.find(member.key()); found != brought.end()) {
          weigh(found->second);
          brought.erase(found);
        }
        for (const JsonValue load : member) copy(w_, load);
        w_.close(']');
      }
    for (const auto& [name, weight] : brought) {
      w_.newline().key(name).open('[');
      weigh(weight);
      w_.close(']');
    }
    w_.close('}');
  }

  JsonValue root_;
  ModelDraft draft_;
  JsonWriter w_;
};

}  // namespace

bool has_generator(const JsonDocument& model) {
  return model.root().find("building").has_value() || model.root().find("buildings").has_value();
}

std::string written_out(const JsonDocument& model) { return Writer(model).write(); }

}  // namespace topple::structure::formats
