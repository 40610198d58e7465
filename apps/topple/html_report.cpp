#include "html_report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <numeric>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include "report_audit.h"
#include "support/version.h"

#ifdef TOPPLE_REPORT
extern "C" const char topple_report_page_begin[];
extern "C" const char topple_report_page_end[];
#endif

namespace topple::app {

using namespace topple::structure;
using Json = structure::JsonTree;

namespace {

std::string_view page() {
#ifdef TOPPLE_REPORT
  return {topple_report_page_begin, static_cast<std::size_t>(topple_report_page_end - topple_report_page_begin)};
#else
  throw std::runtime_error("this program was built without the report page: build it where npm is installed");
#endif
}

/// Six digits: what a picture or a person needs; the page stays small.
double rounded(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return std::strtod(text, nullptr);
}

Json vector_json(const Vec3& v) { return {rounded(v.x()), rounded(v.y()), rounded(v.z())}; }

const char* kind_name(MemberKind kind) {
  switch (kind) {
    case MemberKind::post:
      return "post";
    case MemberKind::beam:
      return "beam";
    default:
      return "brace";
  }
}

std::vector<std::size_t> shown_members(const Building& building, const ResultsSelection* selection) {
  if (selection != nullptr) return selection->members;
  std::vector<std::size_t> all(building.members.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  return all;
}

/// Builds the page's model in the units of the file.
class ModelWriter {
 public:
  ModelWriter(const Building& building, const ResultsSelection* selection)
      : b_(building), selection_(selection), length_(building.units.length) {}

  [[nodiscard]] Json write() const {
    Json model;
    model["title"] = b_.title;
    model["file"] = b_.file;
    model["warnings"] = b_.warnings;
    write_nodes(model);
    model["members"] = members();
    if (selection_ != nullptr) model["lines"] = lines();
    model["panels"] = panels();
    model["supports"] = Json::array();
    for (const NodeSupport& support : b_.supports) model["supports"].push_back(support.node.index);
    write_sections(model);
    write_materials(model);
    model["loads"] = loads();
    model["combinations"] = combinations();
    return model;
  }

 private:
  void write_nodes(Json& model) const {
    model["node_names"] = Json::array();
    model["nodes"] = Json::array();
    for (const Node& node : b_.nodes) {
      model["node_names"].push_back(node.name);
      model["nodes"].push_back(vector_json(node.position / length_));
    }
  }

  [[nodiscard]] Json members() const {
    Json list = Json::array();
    for (const std::size_t m : shown_members(b_, selection_)) {
      const Member& member = b_.members[m];
      const Section& section = b_[member.section];
      // A section given as numbers alone is drawn as a square of its area.
      const double side = std::sqrt(section.area);
      const double depth = section.depth > 0 ? section.depth : side;
      const double width = section.width > 0 ? section.width : depth;
      list.push_back(
          {{"name", member.name},
           {"kind", kind_name(member.kind)},
           {"nodes", {member.nodes[0].index, member.nodes[1].index}},
           {"offsets", {vector_json(member.offsets[0] / length_), vector_json(member.offsets[1] / length_)}},
           {"axes",
            {vector_json(member.axes.row(0)), vector_json(member.axes.row(1)), vector_json(member.axes.row(2))}},
           {"length", rounded(member.length / length_)},
           {"depth", rounded(depth / length_)},
           {"width", rounded(width / length_)},
           {"section", section.name},
           {"material", b_[member.material].name}});
    }
    return list;
  }

  /// The members that are not selected: their nodes, two by two.
  [[nodiscard]] Json lines() const {
    Json list = Json::array();
    for (std::size_t m = 0; m < b_.members.size(); ++m) {
      if (std::binary_search(selection_->members.begin(), selection_->members.end(), m)) continue;
      for (const NodeId node : b_.members[m].nodes) list.push_back(node.index);
    }
    return list;
  }

  [[nodiscard]] Json panels() const {
    Json list = Json::array();
    for (const Panel& panel : b_.panels) {
      Json nodes = Json::array();
      for (const NodeId node : panel.nodes) nodes.push_back(node.index);
      list.push_back({{"name", panel.name}, {"nodes", nodes}});
    }
    return list;
  }

  [[nodiscard]] std::string unit(const char* power) const {
    return b_.units.consistent ? "" : b_.units.length_name + power;
  }

  [[nodiscard]] static Json columns(const std::vector<std::pair<std::string, std::string>>& names_and_units) {
    Json list = Json::array();
    for (const auto& [name, unit] : names_and_units) list.push_back(Json::array({name, unit}));
    return list;
  }

  void write_sections(Json& model) const {
    // Said to be arrays: a list of pairs that begin with texts would become an object.
    model["section_columns"] = columns({{"area", unit("2")},
                                        {"Iy", unit("4")},
                                        {"Iz", unit("4")},
                                        {"J", unit("4")},
                                        {"shear area y", unit("2")},
                                        {"shear area z", unit("2")},
                                        {"depth", unit("")},
                                        {"width", unit("")}});
    model["sections"] = Json::array();
    const double l2 = length_ * length_, l4 = l2 * l2;
    for (const Section& s : b_.sections)
      model["sections"].push_back({s.name, s.area / l2, s.Iy / l4, s.Iz / l4, s.J / l4, s.shear_area_y / l2,
                                   s.shear_area_z / l2, s.depth / length_, s.width / length_});
  }

  void write_materials(Json& model) const {
    const std::string stress = b_.units.consistent ? "" : b_.units.force_name + "/" + b_.units.length_name + "2";
    const std::string density = b_.units.consistent ? "" : b_.units.mass_name + "/" + b_.units.length_name + "3";
    model["material_columns"] =
        columns({{"E", stress}, {"G", stress}, {"Poisson", ""}, {"density", density}, {"yield", stress}});
    model["materials"] = Json::array();
    const double pressure = b_.units.force / (length_ * length_);
    const double mass = b_.units.mass / (length_ * length_ * length_);
    for (const Material& m : b_.materials)
      model["materials"].push_back({m.name, m.youngs_modulus / pressure, m.shear_modulus / pressure, m.poisson_ratio,
                                    m.density / mass,
                                    m.yield_strength ? Json(*m.yield_strength / pressure) : Json(nullptr)});
  }

  [[nodiscard]] Json six(const Vec6& v, double force_factor, double moment_factor) const {
    std::string text;
    for (int i = 0; i < 6; ++i) {
      if (v[i] == 0) continue;
      char part[48];
      std::snprintf(part, sizeof part, "%s%s %.6g", text.empty() ? "" : ", ",
                    component_names[static_cast<std::size_t>(i)], v[i] / (i < 3 ? force_factor : moment_factor));
      text += part;
    }
    return text;
  }

  /// One row for each load; a case with very many loads of one kind is told by their number.
  [[nodiscard]] Json loads() const {
    constexpr std::size_t most_rows = 2000;  // for each kind and case: beyond it a table serves nobody
    Json rows = Json::array();
    const double force = b_.units.force;
    for (const LoadCase& c : b_.cases) {
      if (!c.self_weight.isZero())
        rows.push_back({c.name, "all members and panels", "self weight", rounded(c.self_weight.norm())});
      const auto few = [&](std::size_t count, const char* what) {
        if (count <= most_rows) return true;
        rows.push_back({c.name, std::to_string(count) + " " + what, "loads", nullptr});
        return false;
      };
      if (few(c.nodes.size(), "nodes"))
        for (const NodeLoad& l : c.nodes)
          rows.push_back({c.name, b_[l.node].name, "node load", six(l.load, force, force * length_)});
      if (few(c.members.size(), "members"))
        for (const MemberLoad& l : c.members) rows.push_back(member_load(c, l));
      if (few(c.panels.size(), "panels"))
        for (const PanelLoad& l : c.panels)
          rows.push_back({c.name, b_[l.panel].name, l.temperature != 0 ? "temperature, pressure" : "pressure",
                          l.pressure / (force / (length_ * length_))});
      for (const Settlement& s : c.settlements)
        rows.push_back({c.name, b_[s.node].name,
                        std::string("settlement ") + component_names[static_cast<std::size_t>(s.component)],
                        s.component < 3 ? s.value / length_ : s.value});
    }
    return rows;
  }

  [[nodiscard]] Json member_load(const LoadCase& c, const MemberLoad& l) const {
    const double force = b_.units.force;
    switch (l.kind) {
      case MemberLoad::Kind::point:
        return {c.name, b_[l.member].name, "point load", six(l.first, force, force * length_)};
      case MemberLoad::Kind::temperature:
        return {c.name, b_[l.member].name, "temperature", l.temperature};
      default:
        break;
    }
    const bool uniform = l.first == l.last;
    return {c.name, b_[l.member].name, uniform ? "uniform load" : "trapezoid (at its start)",
            six(uniform || !l.first.isZero() ? l.first : l.last, force / length_, force)};
  }

  [[nodiscard]] Json combinations() const {
    Json rows = Json::array();
    for (const Combination& combination : b_.combinations) {
      std::string text;
      for (const auto& [id, factor] : combination.factors) {
        char part[32];
        std::snprintf(part, sizeof part, "%s%.6g ", text.empty() ? "" : " + ", factor);
        text += part + b_[id].name;
      }
      rows.push_back({combination.name, text});
    }
    return rows;
  }

  const Building& b_;
  const ResultsSelection* selection_;
  double length_;
};

/// Values at the stations of every member, in the model's units: [member][station][diagram].
Json diagrams(const Building& building, const AnalysisResult& result, const ResultsSelection* selection) {
  const double force = building.units.force, length = building.units.length;
  const std::array<double, 8> factor{force,          force,          force,  force * length,
                                     force * length, force * length, length, length};
  Json all = Json::object();
  for (const CombinationResult& c : result.combinations) {
    Json members = Json::array();
    for (const std::size_t m : shown_members(building, selection)) {
      const MemberResult& member = c.members[m];
      Json stations = Json::array();
      for (const auto& values : member.stations) {
        Json row = Json::array();
        for (std::size_t i = 0; i < values.size(); ++i) row.push_back(rounded(values[i] / factor[i]));
        stations.push_back(std::move(row));
      }
      members.push_back(stations.empty() ? Json(nullptr) : std::move(stations));
    }
    all[building[c.combination].name] = std::move(members);
  }
  return all;
}

/// The JSON text with every number of more than nine digits cut to nine: what a page shows, at half of the size.
std::string shortened(const std::string& json) {
  constexpr std::size_t longest = 10;
  std::string out;
  out.reserve(json.size() / 2);
  bool in_text = false;
  for (std::size_t i = 0; i < json.size();) {
    const char c = json[i];
    if (in_text || !(c == '-' || (c >= '0' && c <= '9'))) {
      out += c;
      if (in_text && c == '\\') out += json[++i];
      if (c == '"') in_text = !in_text;
      ++i;
      continue;
    }
    const std::size_t end = std::min(json.find_first_not_of("0123456789+-.eE", i), json.size());
    if (end - i > longest) {
      char text[32];
      out.append(text, static_cast<std::size_t>(std::snprintf(text, sizeof text, "%.9g",
                                                              std::strtod(json.substr(i, end - i).c_str(), nullptr))));
    } else {
      out.append(json, i, end - i);
    }
    i = end;
  }
  return out;
}

/// JSON as the text of a script element: "</" would end it.
std::string in_script(const std::string& json) {
  std::string out;
  out.reserve(json.size());
  for (std::size_t i = 0; i < json.size(); ++i) {
    out += json[i];
    if (json[i] == '<') {
      out.pop_back();
      out += "\\u003c";
    }
  }
  return out;
}

}  // namespace

bool can_write_report() {
#ifdef TOPPLE_REPORT
  return true;
#else
  return false;
#endif
}

namespace {

/// Date of today, as people write it who read numbers of any order.
std::string today() {
  const std::time_t now = std::time(nullptr);
  char text[32];
  std::tm day{};
  localtime_r(&now, &day);
  std::strftime(text, sizeof text, "%Y-%m-%d", &day);
  return text;
}

/// What only the printed report has.
void add_paper(const Building& building, const AnalysisResult& result, const ReportCover& cover, Json& model) {
  model["project"] = cover.project;
  model["author"] = cover.author;
  model["date"] = today();
  if (!commit().empty()) model["commit"] = commit();
  model["result_warnings"] = result.warnings;
  model["load_drawings"] = load_drawings(building);
  model["audits"] = report_audits(building, result, cover.design);
  model["audit_selection"] =
      "Of every section the member that is used most over all combinations is followed below from its properties to "
      "every "
      "clause; all members' clauses are in the tables.";
}

}  // namespace

std::string html_report(const Building& building, const AnalysisResult& result, const std::string& results_json,
                        const ReportCover& cover, const ResultsSelection* selection) {
  constexpr std::string_view mark = "\"TOPPLE_DATA\"";
  const std::string_view whole = page();
  const std::size_t at = whole.find(mark);
  if (at == std::string_view::npos) throw std::runtime_error("the report page has no place for its data");
  Json names = Json::array();
  for (const char* name : diagram_names) names.push_back(name);
  Json model = ModelWriter(building, selection).write();
  if (selection != nullptr)
    model["sample"] =
        "Of " + std::to_string(building.members.size()) + " members this report shows " +
        std::to_string(selection->members.size()) + ": the " + std::to_string(selected_of_section) +
        " of every section that are used most, and evenly many of the others; results.json and --csv have all.";
  add_paper(building, result, cover, model);
  std::string data = "{\"model\":" + model.dump() + ",\"diagram_names\":" + names.dump() +
                     ",\"diagrams\":" + diagrams(building, result, selection).dump() +
                     ",\"results\":" + shortened(results_json) + "}";
  std::string out(whole.substr(0, at));
  out += in_script(data);
  out += whole.substr(at + mark.size());
  return out;
}

}  // namespace topple::app
