// Results as tables: one file for each kind of part.
#include <charconv>

#include "analysis/results/output_units.h"
#include "formats/tables/formula_guard.h"
#include "topple/structure/analysis.h"

namespace topple::structure {

namespace {

class Table {
 public:
  explicit Table(const std::string& header) : text_(header + "\n") {}
  Table& cell(std::string_view given) {
    const std::string text = formats::guarded(given);
    separate();
    if (text.find_first_of(",\"\n\r") == std::string::npos) {
      text_ += text;
      return *this;
    }
    text_ += '"';
    for (const char c : text) {
      if (c == '"') text_ += '"';
      text_ += c;
    }
    text_ += '"';
    return *this;
  }
  Table& cell(double number) {
    separate();
    char digits[32];
    text_.append(digits, std::to_chars(digits, digits + sizeof digits, number == 0 ? 0.0 : number).ptr);
    return *this;
  }
  void end_row() {
    text_ += '\n';
    fresh_ = true;
  }
  [[nodiscard]] std::string release() { return std::move(text_); }

 private:
  void separate() {
    if (!fresh_) text_ += ',';
    fresh_ = false;
  }
  std::string text_;
  bool fresh_ = true;
};

class Tables {
 public:
  Tables(const Building& building, const AnalysisResult& result)
      : building_(building), result_(result), units_(building.units) {
    if (building.units.consistent) return;
    length_ = " (" + building.units.length_name + ")";
    force_ = " (" + building.units.force_name + ")";
    moment_ = " (" + building.units.force_name + " " + building.units.length_name + ")";
    per_length_ = " (" + building.units.force_name + "/" + building.units.length_name + ")";
    angle_ = " (rad)";
  }

  NamedTexts write() const {
    NamedTexts files = {{"displacements.csv", displacements()},
                        {"reactions.csv", reactions()},
                        {"members.csv", members()},
                        {"joints.csv", joints()},
                        {"panels.csv", panels()}};
    if (!result_.cuts.empty()) files.emplace_back("cuts.csv", cuts());
    return files;
  }

 private:
  /// A row for the whole of every cut, then one for each part of it.
  [[nodiscard]] std::string cuts() const {
    Table table("combination,cut,part,normal" + force_ + ",shear along" + force_ + ",shear across" + force_ +
                ",torsion" + moment_ + ",moment about along" + moment_ + ",moment about across" + moment_);
    for (const CombinationResult& c : result_.combinations)
      for (std::size_t k = 0; k < c.cuts.size(); ++k) {
        const auto row = [&](const std::string& part, const Vec6& force) {
          table.cell(name(c)).cell(result_.cuts[k].name).cell(part);
          for (const double number : units_.load(force)) table.cell(number);
          table.end_row();
        };
        row("", c.cuts[k].force);
        for (const auto& [id, force] : c.cuts[k].members) row(building_[id].name, force);
        for (const auto& [id, force] : c.cuts[k].panels) row(building_[id].name, force);
        for (const auto& [d, force] : c.cuts[k].diaphragms) row(building_.diaphragms[d].name, force);
      }
    return table.release();
  }

  [[nodiscard]] std::string six_names(const std::string& prefix, const std::string& first,
                                      const std::string& second) const {
    std::string names;
    for (std::size_t c = 0; c < 6; ++c) names += "," + prefix + component_names[c] + (c < 3 ? first : second);
    return names;
  }
  [[nodiscard]] const std::string& name(const CombinationResult& c) const { return building_[c.combination].name; }

  [[nodiscard]] std::string displacements() const {
    Table table("combination,node" + six_names("", length_, angle_));
    for (const CombinationResult& c : result_.combinations)
      for (std::size_t n = 0; n < building_.nodes.size(); ++n) {
        table.cell(name(c)).cell(building_.nodes[n].name);
        for (const double number : units_.movement(c.displacements[n])) table.cell(number);
        table.end_row();
      }
    return table.release();
  }

  /// Those of edges under the edge's name, as in results.json.
  [[nodiscard]] std::string reactions() const {
    Table table("combination,node" + six_names("", force_, moment_));
    for (const CombinationResult& c : result_.combinations) {
      const auto row = [&](const std::string& held, const Vec6& reaction) {
        table.cell(name(c)).cell(held);
        for (const double number : units_.load(reaction)) table.cell(number);
        table.end_row();
      };
      for (std::size_t s = 0; s < building_.supports.size(); ++s)
        row(building_[building_.supports[s].node].name, c.reactions[s]);
      for (std::size_t s = 0; s < building_.edge_supports.size(); ++s) {
        const EdgeSupport& support = building_.edge_supports[s];
        row(building_[building_.joint(support.panel, support.edge)].name, c.edge_reactions[s]);
      }
    }
    return table.release();
  }

  [[nodiscard]] std::string members() const {
    std::string header =
        "combination,member,active" + six_names("end 1 ", force_, moment_) + six_names("end 2 ", force_, moment_);
    for (std::size_t q = 0; q < diagram_names.size(); ++q) {
      const std::string unit = q < 3 ? force_ : q < 6 ? moment_ : length_;
      for (const char* side : {" least", " greatest"})
        header += "," + std::string(diagram_names[q]) + side + unit + ",at" + length_;
    }
    if (result_.design_code) header += ",utilisation,governing";
    Table table(header);
    for (const CombinationResult& c : result_.combinations)
      for (std::size_t m = 0; m < building_.members.size(); ++m) {
        const MemberResult& member = c.members[m];
        table.cell(name(c)).cell(building_.members[m].name).cell(member.active ? "yes" : "no");
        for (int i = 0; i < 12; ++i) table.cell(member.end_forces(i) / units_.load_factor(i % 6));
        for (std::size_t q = 0; q < diagram_names.size(); ++q)
          for (const Extreme& end : {member.min[q], member.max[q]})
            table.cell(end.value / units_.diagram_factor(q)).cell(end.at / building_.units.length);
        if (result_.design_code) design(table, c.designs[m]);
        table.end_row();
      }
    return table.release();
  }

  static void design(Table& table, const DesignResult& used) {
    if (used.governing.empty())
      table.cell("").cell("");  // not checked
    else
      table.cell(used.utilisation).cell(used.governing);
  }

  [[nodiscard]] std::string joints() const {
    Table table("combination,joint,utilisation,governing,demand,capacity,unit");
    for (const CombinationResult& c : result_.combinations)
      for (std::size_t j = 0; j < building_.joints.size(); ++j) {
        const Joint& joint = building_.joints[j];
        if (!joint.capacity.breakable) continue;
        const Utilisation& used = c.joints[j];
        // A panel's edge is checked per length of edge.
        double factor =
            used.sense < Sense::torsion ? building_.units.force : building_.units.force * building_.units.length;
        if (joint.panel.valid()) factor /= building_.units.length;
        table.cell(name(c)).cell(joint.name).cell(used.value);
        table.cell(sense_names[static_cast<std::size_t>(used.sense)]).cell(used.demand / factor);
        table.cell(used.capacity / factor).cell(unit_of(used.sense, joint.panel.valid())).end_row();
      }
    return table.release();
  }

  /// As it stands in a cell: "N mm", of an edge "N mm/mm"; nothing in consistent units.
  [[nodiscard]] std::string unit_of(Sense sense, bool per_length) const {
    const Units& units = building_.units;
    if (units.consistent) return "";
    const std::string moment = sense < Sense::torsion ? "" : " " + units.length_name;
    return units.force_name + moment + (per_length ? "/" + units.length_name : "");
  }

  [[nodiscard]] std::string panels() const {
    std::string header = "combination,panel";
    for (const char* n : {"nx", "ny", "nxy"}) header += "," + std::string(n) + per_length_;
    for (const char* n : {"mx", "my", "mxy"}) header += "," + std::string(n) + force_;
    for (const char* n : {"qx", "qy"}) header += "," + std::string(n) + per_length_;
    Table table(header);
    const double per_length = building_.units.force / building_.units.length;
    for (const CombinationResult& c : result_.combinations)
      for (std::size_t p = 0; p < building_.panels.size(); ++p) {
        if (building_.panels[p].model == PanelModel::cladding) continue;
        table.cell(name(c)).cell(building_.panels[p].name);
        for (const double number : c.panels[p].membrane) table.cell(number / per_length);
        for (const double number : c.panels[p].moments) table.cell(number / building_.units.force);
        for (const double number : c.panels[p].shears) table.cell(number / per_length);
        table.end_row();
      }
    return table.release();
  }

  const Building& building_;
  const AnalysisResult& result_;
  OutputUnits units_;
  std::string length_, force_, moment_, per_length_, angle_;
};

}  // namespace

NamedTexts results_csv(const Building& building, const AnalysisResult& result) {
  return Tables(building, result).write();
}

}  // namespace topple::structure
