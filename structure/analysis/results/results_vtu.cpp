// Results for ParaView: VTK's XML format for unstructured grids, one file for each combination.
#include <Eigen/Geometry>
#include <charconv>
#include <set>
#include <stdexcept>

#include "analysis/results/output_units.h"
#include "model/index_of.h"
#include "topple/structure/analysis.h"

namespace topple::structure {

namespace {

constexpr std::size_t forces = 6;  ///< leading entries of diagram_names: the internal forces

/// Numbers of one array as text.
class Numbers {
 public:
  void add(double number) {
    char digits[32];
    text_.append(digits, std::to_chars(digits, digits + sizeof digits, number == 0 ? 0.0 : number).ptr);
    text_ += ' ';
  }
  void add(std::size_t number) { text_ += std::to_string(number) + ' '; }
  void add(const Vec3& vector) {
    for (const double number : vector) add(number);
    text_ += '\n';
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string text_;
};

void write_array(std::string& out, const char* type, const std::string& name, int components, const Numbers& numbers) {
  out += "<DataArray type=\"" + std::string(type) + "\" Name=\"" + name + "\" NumberOfComponents=\"" +
         std::to_string(components) + "\" format=\"ascii\">\n" + numbers.text() + "\n</DataArray>\n";
}

/// The drawing of one combination.
class Grid {
 public:
  using Shapes = std::vector<std::pair<std::string, const std::vector<Vec6>*>>;
  Grid(const Building& building, const CombinationResult& result, const std::vector<Vec3>& mesh_nodes, Shapes shapes,
       const std::vector<std::vector<int>>& cuts = {})
      : building_(building),
        result_(result),
        mesh_nodes_(mesh_nodes),
        units_(building.units),
        shapes_(std::move(shapes)),
        cuts_(cuts) {
    drawn_.resize(shapes_.size());
    for (std::size_t m = 0; m < building.members.size(); ++m) add_member(MemberId(m));
    for (std::size_t p = 0; p < building.panels.size(); ++p) add_panel(PanelId(p));
  }

  [[nodiscard]] std::string write() const {
    std::string out =
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" "
        "byte_order=\"LittleEndian\">\n<UnstructuredGrid>\n<Piece NumberOfPoints=\"" +
        std::to_string(points_) + "\" NumberOfCells=\"" + std::to_string(cells_) + "\">\n<Points>\n";
    write_array(out, "Float64", "points", 3, places_);
    out += "</Points>\n<Cells>\n";
    write_array(out, "Int64", "connectivity", 1, connectivity_);
    write_array(out, "Int64", "offsets", 1, offsets_);
    write_array(out, "UInt8", "types", 1, types_);
    out += "</Cells>\n<PointData Vectors=\"displacement\">\n";
    write_array(out, "Float64", "displacement", 3, displacements_);
    for (std::size_t s = 0; s < shapes_.size(); ++s) write_array(out, "Float64", shapes_[s].first, 3, drawn_[s]);
    for (std::size_t q = 0; q < forces; ++q) write_array(out, "Float64", diagram_names[q], 1, diagrams_[q]);
    out += "</PointData>\n<CellData Scalars=\"utilisation\">\n";
    write_array(out, "Float64", "utilisation", 1, utilisations_);
    write_array(out, "Float64", "membrane", 3, membranes_);
    write_array(out, "Float64", "moments", 3, moments_);
    write_array(out, "Float64", "shears", 3, shears_);
    write_array(out, "Int64", "part", 1, parts_);
    out += "</CellData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
    return out;
  }

 private:
  void add_point(const Vec3& place, const Vec3& displacement) {
    const double length = building_.units.length;
    places_.add(Vec3(place / length));
    displacements_.add(Vec3(displacement / length));
    connectivity_.add(points_++);
  }

  void end_cell(std::size_t type, double utilisation, const Vec3& membrane, std::size_t part,
                const Vec3& moments = Vec3::Zero(), const Vec3& shears = Vec3::Zero()) {
    offsets_.add(points_);
    types_.add(type);
    utilisations_.add(utilisation);
    membranes_.add(membrane);
    moments_.add(moments);
    shears_.add(shears);
    parts_.add(part);
    ++cells_;
  }

  [[nodiscard]] double worst(JointId first, int count) const {
    double value = 0;
    for (int i = 0; i < count; ++i)
      value = std::max(value, result_.joints[static_cast<std::size_t>(first.index + i)].value);
    return std::min(value, 1e30);  // beyond all use where a joint has no strength
  }

  /// A shape inside a member: the cubic through its ends' places and slopes; an end that is released there takes the
  /// slope of the chord.
  [[nodiscard]] Vec3 along_member(MemberId id, const std::vector<Vec6>& shape, double f) const {
    const Member& member = building_[id];
    const Vec3 axis = member.axes.row(0);
    std::vector<int> nodes{member.nodes[0].index, member.nodes[1].index};
    if (!cuts_.empty())
      for (const int inner : cuts_[index_of(id)])
        if (static_cast<std::size_t>(inner) < shape.size()) nodes.insert(nodes.end() - 1, inner);
    const std::size_t pieces = nodes.size() - 1;
    const std::size_t piece = std::min(pieces - 1, static_cast<std::size_t>(f * static_cast<double>(pieces)));
    f = f * static_cast<double>(pieces) - static_cast<double>(piece);
    std::array<Vec3, 2> moved, slope;
    const auto of_member = [&](std::size_t end) { return piece + end == (end == 0 ? 0 : pieces); };
    for (std::size_t end = 0; end < 2; ++end) {
      const Vec6& node = shape[static_cast<std::size_t>(nodes[piece + end])];
      const Vec3 turned = node.tail<3>();
      moved[end] = node.head<3>();
      if (of_member(end)) moved[end] += turned.cross(member.offsets[end]);
      slope[end] = member.length / static_cast<double>(pieces) * turned.cross(axis);
    }
    const Vec3 chord = moved[1] - moved[0];
    for (std::size_t end = 0; end < 2; ++end) {
      if (!of_member(end)) continue;
      const Vec6& stiffness = building_[building_.joint(id, static_cast<int>(end))].stiffness;
      for (const int about : {1, 2}) {  // a release about local y frees the slope along z, and the other way round
        if (stiffness(3 + about) != 0) continue;
        const Vec3 across = member.axes.row(3 - about);
        slope[end] += (chord - slope[end]).dot(across) * across;
      }
    }
    const Vec3 bow = f * (1 - f) * ((1 - f) * (slope[0] - chord) - f * (slope[1] - chord));
    return moved[0] + f * chord + bow - bow.dot(axis) * axis;
  }

  /// The displaced chord between the member's ends, and the deflection from it.
  void add_member(MemberId id) {
    constexpr std::size_t poly_line = 4;
    const Member& member = building_[id];
    const MemberResult& result = result_.members[index_of(id)];
    if (result.stations.size() < 2) throw std::invalid_argument("results_vtu: the result has no stations");
    std::array<Vec3, 2> place, moved;
    for (std::size_t end = 0; end < 2; ++end) {
      const Vec6& node = result_.displacements[index_of(member.nodes[end])];
      const Vec3 turned = node.tail<3>();
      place[end] = building_[member.nodes[end]].position + member.offsets[end];
      moved[end] = node.head<3>() + turned.cross(member.offsets[end]);
    }
    for (std::size_t s = 0; s < result.stations.size(); ++s) {
      const double f = static_cast<double>(s) / static_cast<double>(result.stations.size() - 1);
      const auto& values = result.stations[s];
      const Vec3 bent = values[6] * member.axes.row(1) + values[7] * member.axes.row(2);
      add_point((1 - f) * place[0] + f * place[1], (1 - f) * moved[0] + f * moved[1] + bent);
      for (std::size_t k = 0; k < shapes_.size(); ++k) drawn_[k].add(along_member(id, *shapes_[k].second, f));
      for (std::size_t q = 0; q < forces; ++q) diagrams_[q].add(values[q] / units_.diagram_factor(q));
    }
    end_cell(poly_line, worst(building_.joint(id, 0), 2), Vec3::Zero(), index_of(id));
  }

  void add_panel(PanelId id) {
    const Panel& panel = building_[id];
    const PanelResult& result = result_.panels[index_of(id)];
    for (const PanelElement& element : result.elements) add_quadrilateral(id, element.nodes, element);
    if (!result.elements.empty()) return;
    std::array<int, 4> nodes{};
    for (std::size_t i = 0; i < 4; ++i) nodes[i] = panel.nodes[i].index;
    add_quadrilateral(id, nodes, result);
  }

  /// `result`: of the element, or of the panel as a whole.
  template <class Result>
  void add_quadrilateral(PanelId id, const std::array<int, 4>& nodes, const Result& result) {
    constexpr std::size_t quadrilateral = 9;
    for (const int node : nodes) {
      const auto own = static_cast<std::size_t>(node), of_mesh = own - building_.nodes.size();
      if (own < building_.nodes.size())
        add_point(building_.nodes[own].position, result_.displacements[own].template head<3>());
      else
        add_point(mesh_nodes_[of_mesh], result_.mesh_displacements[of_mesh].template head<3>());
      for (std::size_t k = 0; k < shapes_.size(); ++k)
        drawn_[k].add(Vec3((*shapes_[k].second)[own].template head<3>()));
      for (Numbers& diagram : diagrams_) diagram.add(0.0);
    }
    const double per_length = building_.units.force / building_.units.length;
    end_cell(quadrilateral, worst(building_.joint(id, 0), 4), Vec3(result.membrane.data()) / per_length,
             building_.members.size() + index_of(id), Vec3(result.moments.data()) / building_.units.force,
             Vec3(result.shears[0], result.shears[1], 0) / per_length);
  }

  const Building& building_;
  const CombinationResult& result_;
  const std::vector<Vec3>& mesh_nodes_;
  OutputUnits units_;
  std::size_t points_ = 0, cells_ = 0;
  Numbers places_, displacements_, connectivity_, offsets_, types_, utilisations_, membranes_, moments_, shears_,
      parts_;
  std::array<Numbers, forces> diagrams_;
  Shapes shapes_;
  std::vector<std::vector<int>> cuts_;  ///< AnalysisResult::mode_cuts
  std::vector<Numbers> drawn_;          ///< per shape
};

/// A combination's name as a file's: what a file system may refuse becomes '_'.
std::string vtu_file_name(const std::string& name) {
  std::string safe;
  for (const char c : name) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    safe += plain || c == '-' || c == '_' || c == ' ' || c == '+' || (c == '.' && !safe.empty()) ? c : '_';
  }
  return safe;
}

}  // namespace

namespace {

Grid::Shapes shapes(const AnalysisResult& result, const CombinationResult& combination) {
  Grid::Shapes list;
  for (std::size_t m = 0; m < result.modes.size(); ++m)
    list.emplace_back("mode " + std::to_string(m + 1), &result.modes[m].shape);
  for (std::size_t m = 0; m < combination.buckling.size(); ++m)
    list.emplace_back("buckling " + std::to_string(m + 1), &combination.buckling[m].shape);
  return list;
}

}  // namespace

NamedTexts diagnosis_vtu(const Building& building, const Diagnosis& diagnosis) {
  CombinationResult still;  // nothing but the motion
  still.combination = diagnosis.combination;
  still.displacements.assign(building.nodes.size(), Vec6::Zero());
  still.members.resize(building.members.size());
  for (MemberResult& member : still.members) member.stations.resize(drawing_stations + 1);
  still.panels.resize(building.panels.size());
  still.joints.resize(building.joints.size());
  return {{"diagnosis.vtu", Grid(building, still, {}, {{"motion", &diagnosis.shape}}).write()}};
}

NamedTexts results_vtu(const Building& building, const AnalysisResult& result) {
  NamedTexts files;
  std::set<std::string> taken;
  for (const CombinationResult& combination : result.combinations) {
    std::string name = vtu_file_name(building[combination.combination].name);
    while (!taken.insert(name).second) name += '_';
    files.emplace_back(
        name + ".vtu",
        Grid(building, combination, result.mesh_nodes, shapes(result, combination), result.mode_cuts).write());
  }
  return files;
}

}  // namespace topple::structure
